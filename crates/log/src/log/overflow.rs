//! Positions that begin again, told from their numbers: they jump by nearly their whole range, and go on beyond as before.

use stiction_policy::position;

/// Bits of counters.
const COUNTERS: std::ops::RangeInclusive<u32> = 8..=48;
/// Part of the period by which its numbers may go beyond it by rounding.
const ROUNDING: f64 = 1e-3;
/// How far rounding moves a whole number of counts.
const OFF_WHOLE: f64 = 0.01;
/// What the counts of an encoder are a multiple of, where they are no power of two.
const ROUND: u64 = 100;

/// Whether a position jumps as one that begins again after this travel does.
pub(crate) fn begins_again(values: &[f64], period: f64) -> bool {
    off(values, period).is_some()
}

/// How much the steps at the jumps differ from those before them once the period is taken out; `None` where it does not begin again
/// after this travel.
fn off(values: &[f64], period: f64) -> Option<f64> {
    let numbers: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    let (low, high) = crate::findings::extremes(&numbers)?;
    if !(position::MIN_COVERED * period..=period * (1.0 + ROUNDING)).contains(&(high - low)) {
        return None;
    }
    let step = |i: usize| numbers[i + 1] - numbers[i];
    let left = |i: usize| step(i) - period * (step(i) / period).round();
    let steps = numbers.len() - 1;
    let jumps: Vec<usize> = (0..steps)
        .filter(|i| step(*i).abs() > 0.5 * period)
        .collect();
    let change = |i: &usize| {
        let beside = if *i > 0 { *i - 1 } else { *i + 1 };
        (beside < steps).then(|| (left(*i) - left(beside)).abs())
    };
    let changes: Vec<f64> = jumps.iter().filter_map(change).collect();
    let on = changes
        .iter()
        .filter(|c| **c <= position::MAX_STEP_CHANGE * period)
        .count();
    (on > 0 && on as f64 >= position::MIN_STEADY_JUMPS * jumps.len() as f64)
        .then(|| changes.iter().sum())
}

/// The counts after which a counter begins again, from its numbers; `None` where they do not jump so.
pub(crate) fn counts(values: &[f64]) -> Option<u64> {
    let numbers = values.iter().copied().filter(|x| x.is_finite());
    let is_whole = |x: &f64| (x - x.round()).abs() <= OFF_WHOLE;
    let whole = numbers.clone().filter(is_whole).count();
    let (low, high) = crate::findings::extremes(values)?;
    if (whole as f64) < position::MIN_WHOLE_SHARE * numbers.count() as f64
        || high - low > 2_f64.powi(53)
    {
        return None;
    }
    let shown = (high - low).round() as u64 + 1;
    if shown < 1 << COUNTERS.start() {
        return None;
    }
    let counter = shown.next_power_of_two();
    let by_bits = off(values, counter as f64).filter(|_| COUNTERS.contains(&counter.ilog2()));
    let round = shown.next_multiple_of(ROUND);
    let other = match (round - shown) as f64 <= position::MAX_HIDDEN_COUNTS * round as f64 {
        true => round,
        false => shown,
    };
    let by_turns =
        off(values, other as f64).filter(|_| passed(values, other as f64) > position::MIN_PERIODS);
    match (by_bits, by_turns) {
        (Some(bits), Some(turns)) if turns < bits => Some(other),
        (Some(_), _) => Some(counter),
        (None, turns) => turns.map(|_| other),
    }
}

/// How many periods a position has gone through.
fn passed(values: &[f64], period: f64) -> f64 {
    let mut whole: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    super::unwrap::straighten(&mut whole, period);
    crate::findings::extremes(&whole).map_or(0.0, |(low, high)| (high - low) / period)
}

#[cfg(test)]
mod tests {
    use super::{begins_again, counts};

    fn sine(size: f64, period: f64) -> Vec<f64> {
        let x = |k: usize| (size * libm::sin(1e-3 * k as f64)).round();
        (0..20_000).map(|k| x(k).rem_euclid(period)).collect()
    }

    #[test]
    fn counters_are_told_slow_and_fast() {
        assert_eq!(counts(&sine(300.0, 65536.0)), Some(65536));
        assert_eq!(counts(&sine(300.0, 4294967296.0)), Some(4294967296));
        assert_eq!(counts(&sine(8e4, 65536.0)), Some(65536));
        // A quarter of the counter within a sample.
        assert_eq!(counts(&sine(1.6e7, 65536.0)), Some(65536));
        assert_eq!(counts(&sine(8e4, 4000.0)), Some(4000));
    }

    #[test]
    fn what_jumps_otherwise_is_no_counter() {
        assert_eq!(counts(&sine(8e4, 1e9)[..1500]), None);
        // Noise, and a position that is set back and forth.
        let noise = |k: u64| (((k * k * 2_654_435_761) >> 7) % 65536) as f64;
        assert_eq!(counts(&(0..5000).map(noise).collect::<Vec<_>>()), None);
        let square = |k: u64| (k / 500 % 2) as f64 * 2e4;
        assert_eq!(counts(&(0..9000).map(square).collect::<Vec<_>>()), None);
        let between: Vec<f64> = sine(8e4, 65536.0).iter().map(|x| 0.3 * x).collect();
        assert_eq!(counts(&between), None);
        assert!(begins_again(&between, 0.3 * 65536.0));
        assert_eq!(counts(&[]), None);
        assert_eq!(counts(&[f64::NAN, 0.0, 65535.0]), None);
    }
}
