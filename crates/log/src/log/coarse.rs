//! Time stamps of a clock that is coarser than the sampling: rows at one rate, whose stamps are rounded to its ticks.

use crate::findings::median;
use std::ops::Range;
use stiction_policy::clock;

/// What is left of a step by the arithmetic of decimal numbers, of a tick.
const SAME: f64 = 1e-3;
/// Most halvings of a record, and fewest rows of a part, in which a stretch without missing rows is looked for.
const HALVINGS: u32 = 6;
const FEWEST_ROWS: usize = 200;

/// A clock that rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coarse {
    /// What its stamps are rounded to, s.
    pub tick: f64,
    /// The one rate of the rows, Hz: of those that the stamps leave open the one with the fewest digits.
    pub rate_hz: f64,
}

impl Coarse {
    /// The clock of these stamps, s: where their steps are but two neighbouring multiples of a tick, one of which may be none, and no
    /// stamp is further than a tick from where one rate has it.
    pub fn of(time: &[f64]) -> Option<Self> {
        let (first, last) = (*time.first()?, *time.last()?);
        let steps = time.len() - 1;
        if steps < clock::MIN_PATTERN_STEPS || !(last - first).is_finite() {
            return None;
        }
        // The stamps at the ends may have a part of their rows: between the first and the last change none has.
        let from = time.iter().position(|t| *t != first)?;
        let to = time.iter().rposition(|t| *t != last)? + 1;
        let (rows, lasted) = (to.checked_sub(from)?, time[to] - time[from]);
        let step = lasted / rows as f64;
        let tick = tick(time, step)?;
        let at = |k: usize| time[from] + (k as f64 - from as f64) * step;
        let near = |(k, t): (usize, &f64)| (t - at(k)).abs() <= tick * (1.0 + SAME);
        if !time.iter().enumerate().all(near) || !alike_often(time, tick / step) {
            return None;
        }
        // Each end is known to a tick, and each change to a row.
        let of_all = |seconds: f64| steps as f64 / seconds;
        let of_changes = |rows: f64| rows / lasted;
        let least = of_all(last - first + tick).max(of_changes(rows as f64 - 1.0));
        let most = of_all(last - first - tick).min(of_changes(rows as f64 + 1.0));
        let rate_hz = roundest(least, most);
        Some(Self { tick, rate_hz })
    }

    /// The clock of the longest stretch that has one, and its rows, where rows are missing elsewhere: halves of the stamps, quarters,
    /// and so on.
    pub fn of_a_part(time: &[f64]) -> Option<(Self, Range<usize>)> {
        (0..=HALVINGS).find_map(|halved| {
            let parts = 1 << halved;
            let ends = |part: usize| part * time.len() / parts..(part + 1) * time.len() / parts;
            let long = (0..parts)
                .map(ends)
                .filter(|rows| halved == 0 || rows.len() >= FEWEST_ROWS);
            let mut found = long.filter_map(|rows| Some((Self::of(&time[rows.clone()])?, rows)));
            found.next()
        })
    }

    /// The rate of rows of which some are missing here and there, Hz, from the stamps that have all of theirs; `None` where no rows share
    /// a stamp, or none are missing.
    pub fn of_full_stamps(time: &[f64]) -> Option<f64> {
        let groups: Vec<usize> = time.chunk_by(|a, b| a == b).map(<[f64]>::len).collect();
        let inside = groups.get(1..groups.len().checked_sub(1)?)?;
        let mut steps: Vec<f64> = time
            .windows(2)
            .map(|w| w[1] - w[0])
            .filter(|s| *s > 0.0)
            .collect();
        let tick = median(&mut steps)?;
        // What is rounded from one stamp to the next one evens out in two.
        let mut pairs: Vec<usize> = inside.windows(2).map(|two| two[0] + two[1]).collect();
        pairs.sort_unstable();
        let full = pairs
            .len()
            .checked_sub(1 + (clock::MIN_FULL_STAMPS * pairs.len() as f64) as usize);
        let (least, most) = (*pairs.first()?, *pairs.get(full?)?);
        let is_missing = pairs.len() >= clock::MIN_PATTERN_STEPS && most > 2 && least + 2 < most;
        is_missing.then(|| most as f64 / (2.0 * tick))
    }

    /// The longest step of stamps between which no row is missing, s.
    pub fn longest_step(&self) -> f64 {
        1.0 / self.rate_hz + self.tick * (1.0 + clock::MAX_RATE_ROUNDING)
    }

    /// What is to be written instead of the time.
    pub fn line(&self) -> String {
        format!("rate = \"{} Hz\"", self.rate_hz)
    }
}

/// Whether as many rows have one stamp as fall into a tick, one more or one less where that is no whole number: of rows that are
/// missing here and there any number is left.
fn alike_often(time: &[f64], rows_in_a_tick: f64) -> bool {
    let mut groups = time.chunk_by(|a, b| a == b).map(<[f64]>::len);
    // Those at the ends are cut off.
    groups.next();
    let inside: Vec<usize> = groups.collect();
    let inside = &inside[..inside.len().saturating_sub(1)];
    let (least, most) = (rows_in_a_tick * (1.0 - SAME), rows_in_a_tick * (1.0 + SAME));
    rows_in_a_tick < 1.0
        || inside
            .iter()
            .all(|rows| (least.floor()..=most.ceil()).contains(&(*rows as f64)))
}

/// How far two steps are apart that are all that there are, the shorter of which is a multiple of that.
fn tick(time: &[f64], step: f64) -> Option<f64> {
    let steps = || time.windows(2).map(|pair| pair[1] - pair[0]);
    let (least, most) = steps().fold((f64::INFINITY, 0.0_f64), |(a, b), s| (a.min(s), b.max(s)));
    let tick = most - least;
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * tick;
    let multiple = (least / tick).round();
    let is_rounded = least >= -SAME * tick
        && tick >= clock::MIN_TICK * step
        && same(multiple * tick, least)
        && steps().all(|s| same(s, least) || same(s, most));
    let long = steps().filter(|s| same(*s, most)).count();
    let short = time.len() - 1 - long;
    // Every hundredth step twice as long as the others: of rows of which every hundredth is lost, or of a rate a hundredth below the
    // ticks of a clock. Clocks that round tick in tenths, hundredths or thousandths.
    let is_decimal = is_power_of_ten(tick);
    let may_be_lost =
        multiple == 1.0 && (long as f64) < clock::MAX_DOUBLE_STEPS * steps().count() as f64;
    (is_rounded && (is_decimal || !may_be_lost) && long.min(short) >= clock::MIN_STEPS_OF_A_LENGTH)
        .then_some(tick)
}

fn is_power_of_ten(x: f64) -> bool {
    let exponent = libm::log10(x);
    (exponent - exponent.round()).abs() < SAME
}

/// The number with the fewest digits between two above zero.
fn roundest(low: f64, high: f64) -> f64 {
    let mid = 0.5 * (low + high);
    let mut rounded = (0..9).filter_map(|digits| format!("{mid:.digits$e}").parse().ok());
    rounded
        .find(|rate| (low..=high).contains(rate))
        .unwrap_or(mid)
}

#[cfg(test)]
mod tests {
    use super::Coarse;

    /// Stamps at a rate, rounded down to a tick.
    fn stamps(rate: f64, tick: f64, count: usize) -> Vec<f64> {
        let at = |k: usize| (k as f64 / rate / tick).floor() * tick;
        (0..count).map(at).collect()
    }

    #[test]
    fn rows_at_one_rate_have_it_whatever_rounds_their_stamps() {
        for rate in [
            300.0, 600.0, 666.7, 700.0, 733.0, 800.0, 1020.0, 1500.0, 4000.0,
        ] {
            let found = Coarse::of(&stamps(rate, 1e-3, 20_000)).map(|clock| clock.rate_hz);
            let Some(found) = found else {
                panic!("{rate} Hz is not seen");
            };
            assert!((found / rate - 1.0).abs() < 1e-4, "{rate} Hz: {found}");
        }
        let found = Coarse::of(&stamps(700.0, 1e-3, 20_000)).unwrap();
        assert_eq!(found.rate_hz, 700.0);
        assert!((found.tick - 1e-3).abs() < 1e-9);
    }

    /// Of 4000 rows in a second every hundredth is lost: no clock ticks at 4 kHz and rounds 3960 rows to it.
    #[test]
    fn rows_that_are_lost_one_by_one_are_no_rounding() {
        for every in [10, 50, 100] {
            let kept = (0..20_000).filter(|k| k % every != every - 1);
            let stamps: Vec<f64> = kept.map(|k| k as f64 * 2.5e-4).collect();
            assert_eq!(Coarse::of(&stamps), None, "one in {every}");
        }
    }

    #[test]
    fn whole_seconds_have_their_rate_whatever_part_of_the_last_there_is() {
        for (rate, count) in [
            (500.0, 18_602),
            (1000.0, 24_040),
            (250.0, 5990),
            (997.0, 30_100),
        ] {
            let mut late = stamps(rate, 1.0, count + 70);
            late.drain(..70);
            for stamps in [stamps(rate, 1.0, count), late] {
                let found = Coarse::of(&stamps).map(|clock| clock.rate_hz);
                assert_eq!(found, Some(rate), "{count} rows");
            }
        }
    }

    #[test]
    fn rows_that_are_missing_leave_a_part_with_the_rate() {
        for rate in [700.0, 1600.0, 3000.0] {
            let mut stamps = stamps(rate, 1e-3, 13_000);
            for row in [12_000, 9000, 5000, 1800] {
                stamps.drain(row..row + 3);
            }
            assert_eq!(Coarse::of(&stamps), None);
            let (clock, rows) = Coarse::of_a_part(&stamps).unwrap();
            assert_eq!(clock.rate_hz, rate);
            assert!(rows.len() >= 1500, "{rows:?}");
        }
        let exact: Vec<f64> = (0..5000).map(|k| f64::from(k) * 1e-3).collect();
        assert_eq!(Coarse::of_a_part(&exact), None);
    }

    /// Rows that are missing at random leave the rate of the full stamps, and no rate that counts them.
    #[test]
    fn rows_that_are_missing_at_random_leave_the_rate_of_full_stamps() {
        let whole = stamps(1000.0, 1e-2, 20_000);
        assert_eq!(Coarse::of_full_stamps(&whole), None);
        let mut state = 1_u32;
        let mut missing = whole;
        missing.retain(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) > 0.1
        });
        let rate = Coarse::of_full_stamps(&missing).unwrap();
        assert_eq!(rate.round(), 1000.0);
        // Halves that are rounded to even stamps make them uneven, and no rows missing.
        let rounded: Vec<f64> = (0..20_000)
            .map(|k| (f64::from(k) * 0.1).round_ties_even() * 1e-2)
            .collect();
        assert_eq!(Coarse::of_full_stamps(&rounded), None);
    }

    #[test]
    fn other_stamps_are_not_taken_for_rounded() {
        // Exact ones, and such as double arithmetic leaves.
        assert_eq!(Coarse::of(&stamps(1000.0, 1e-6, 5000)), None);
        let decimal: Vec<f64> = (0..5000).map(|k| f64::from(k) * 1e-3).collect();
        assert_eq!(Coarse::of(&decimal), None);
        // Some rows are missing.
        let mut missing = stamps(700.0, 1e-3, 5000);
        missing.drain(2000..2005);
        assert_eq!(Coarse::of(&missing), None);
        // One row is missing, or a few.
        let mut gaps = stamps(1000.0, 1e-3, 5000);
        gaps.remove(2500);
        assert_eq!(Coarse::of(&gaps), None);
        gaps.remove(1500);
        assert_eq!(Coarse::of(&gaps), None);
        // A rate that changes on the way.
        let mut other = stamps(600.0, 1e-3, 2000);
        let end = other[1999];
        other.extend(stamps(800.0, 1e-3, 2000).iter().skip(1).map(|t| end + t));
        assert_eq!(Coarse::of(&other), None);
        // Steps of one and two ticks in no even pattern.
        let mut random = vec![0.0];
        let mut state = 1_u32;
        for _ in 0..5000 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let before = random[random.len() - 1];
            random.push(before + 1e-3 * f64::from(1 + (state >> 31)));
        }
        assert_eq!(Coarse::of(&random), None);
        assert_eq!(Coarse::of_a_part(&random), None);
    }
}
