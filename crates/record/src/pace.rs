//! The distances of time stamps: the rate that a device really has, and where samples are missing.

use std::collections::BTreeMap;

/// Most distances that are told apart.
const MOST: usize = 1000;

/// What a time stamp is after those before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Later.
    Later,
    /// The same, or a little earlier.
    Repeated,
    /// Much earlier: the clock began anew.
    Back,
}

/// Counts distances of time stamps in multiples of the period that was asked for.
pub(crate) struct Pace {
    period: f64,
    stamps: Option<(f64, f64)>,
    distances: BTreeMap<u64, u64>,
}

/// What is known of all distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Found {
    /// Most frequent rate, Hz; 0 without two samples.
    pub rate: f64,
    /// Places where samples are missing.
    pub gaps: u64,
    /// Samples that are missing there.
    pub lost: u64,
}

impl Pace {
    /// Of samples at a rate in Hz.
    pub fn new(rate: f64) -> Self {
        Self {
            period: rate.recip(),
            stamps: None,
            distances: BTreeMap::new(),
        }
    }

    /// Takes a time stamp, s; those that are not later leave no trace.
    pub fn add(&mut self, time: f64) -> Step {
        let Some((first, last)) = self.stamps else {
            self.stamps = Some((time, time));
            return Step::Later;
        };
        if time <= last {
            // Order may change within what a device sends at once.
            return match time < last - 1.0 || time < first {
                true => Step::Back,
                false => Step::Repeated,
            };
        }
        let steps = ((time - last) / self.period).round().max(1.0) as u64;
        let is_full = self.distances.len() >= MOST && !self.distances.contains_key(&steps);
        match self.distances.last_entry() {
            Some(mut longest) if is_full => *longest.get_mut() += 1,
            _ => *self.distances.entry(steps).or_default() += 1,
        }
        self.stamps = Some((first, time));
        Step::Later
    }

    /// Time from the first to the last stamp, s.
    pub fn span(&self) -> f64 {
        self.stamps.map_or(0.0, |(first, last)| last - first)
    }

    /// Time from the first stamp to this one, s.
    pub fn since_first(&self, time: f64) -> f64 {
        self.stamps.map_or(0.0, |(first, _)| time - first)
    }

    /// The rate and what is missing.
    pub fn found(&self) -> Found {
        let most = self.distances.iter().rev().max_by_key(|(_, count)| **count);
        let usual = most.map_or(1, |(steps, _)| *steps);
        let mut found = Found {
            rate: most.map_or(0.0, |_| (self.period * usual as f64).recip()),
            gaps: 0,
            lost: 0,
        };
        for (steps, count) in &self.distances {
            // To the nearest number of periods.
            let missing = ((steps + usual / 2) / usual).saturating_sub(1);
            if missing > 0 {
                found.gaps += count;
                found.lost += count * missing;
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::{Found, Pace, Step};

    #[test]
    fn missing_samples_are_counted_at_the_rate_that_the_device_has() {
        // Asked for 1 kHz, the task runs at 500 Hz; 3 and 1 samples are missing.
        let mut pace = Pace::new(1000.0);
        let ticks = (0..100).filter(|k| ![10, 11, 12, 50].contains(k));
        for k in ticks {
            assert_eq!(pace.add(7.0 + 0.002 * f64::from(k)), Step::Later);
        }
        let found = pace.found();
        let Found { rate, gaps, lost } = found;
        assert!((rate - 500.0).abs() < 1e-9, "{found:?}");
        assert_eq!((gaps, lost), (2, 4));
        assert!((pace.span() - 0.198).abs() < 1e-9);
    }

    #[test]
    fn a_clock_that_begins_anew_is_told_from_a_repeated_stamp() {
        let mut pace = Pace::new(100.0);
        assert_eq!(pace.add(5.0), Step::Later);
        assert_eq!(pace.add(9.0), Step::Later);
        assert_eq!(pace.add(9.0), Step::Repeated);
        assert_eq!(pace.add(8.99), Step::Repeated);
        assert_eq!(pace.add(6.0), Step::Back);
        assert_eq!(pace.add(0.01), Step::Back);
        assert_eq!(pace.span(), 4.0);
    }
}
