//! Integer time stamps as seconds.

/// What an integer time stamp counts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Clock {
    /// From 1970: only differences matter to a motion log, and only they fit an `f64`.
    Epoch,
    /// From nothing: a duration.
    Duration,
}

/// The time between two counts: `times / over` seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Period {
    pub(crate) times: u64,
    pub(crate) over: u64,
}

/// Seconds from `ticks`, and what was done, in words.
///
/// Time stamps are counted from the first one before they are turned into `f64`: 1.8e18 ns since
/// 1970 would be rounded to 256 ns, their differences are exact. A missing stamp is NaN.
pub(crate) fn seconds(ticks: &[Option<i64>], period: Period, clock: Clock) -> (Vec<f64>, String) {
    let first = match clock {
        Clock::Epoch => ticks.iter().flatten().next().copied().unwrap_or(0),
        Clock::Duration => 0,
    };
    let values = ticks
        .iter()
        .map(|tick| tick.map_or(f64::NAN, |tick| one(tick, first, period)))
        .collect();
    let done = match clock {
        Clock::Epoch => format!(
            "time stamps, converted to seconds from the first ({first} x {}/{} s after 1970-01-01)",
            period.times, period.over
        ),
        Clock::Duration => "durations, converted to seconds".to_owned(),
    };
    (values, done)
}

fn one(tick: i64, first: i64, period: Period) -> f64 {
    // Both operands of the division are exact for spans below 2^53 counts: one rounding.
    let counts = (i128::from(tick) - i128::from(first)).saturating_mul(i128::from(period.times));
    counts as f64 / period.over as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const NANOSECOND: Period = Period {
        times: 1,
        over: 1_000_000_000,
    };

    #[test]
    fn differences_survive_a_late_epoch() {
        let start = 1_767_225_600_000_000_000;
        let ticks = [Some(start), Some(start + 1_000_001), None];
        let (seconds, done) = seconds(&ticks, NANOSECOND, Clock::Epoch);
        assert_eq!(seconds[..2], [0.0, 1.000001e-3]);
        assert!(seconds[2].is_nan());
        assert!(done.contains("1767225600000000000"), "{done}");
    }

    #[test]
    fn durations_keep_their_zero_and_extremes_do_not_overflow() {
        let day = Period {
            times: 86_400,
            over: 1,
        };
        assert_eq!(seconds(&[Some(2)], day, Clock::Duration).0, [172_800.0]);
        let far = seconds(&[Some(i64::MIN), Some(i64::MAX)], NANOSECOND, Clock::Epoch).0;
        assert_eq!(far[1], (u64::MAX as f64) / 1e9);
    }
}
