//! Why samples of a log are not used in a fit.

use std::fmt;
use stiction_policy::conditioning;

/// Counts of the samples on their way from the logs to a fit, and why the others were left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Losses {
    /// Samples of the logs.
    pub logged: usize,
    /// Of these, in stretches between gaps that are too short.
    pub short: usize,
    /// Of the rest every n-th sample is taken, with this n, since the filter leaves no information at
    /// higher frequencies; 0 and 1 take all.
    pub decimate: usize,
    /// Of those taken: saturated, missing or frozen ones, and those that the filter mixes with them.
    pub excluded: usize,
    /// Of those taken: at ends, where filters settle.
    pub ends: usize,
    /// Of those taken: at rest.
    pub at_rest: usize,
    /// Of those taken: slower than `min_speed`.
    pub slow: usize,
    /// The fastest of these, m/s or rad/s.
    pub fastest_slow: f64,
    /// Of those taken: where the force depends on what was before the log or in a gap.
    pub unsettled: usize,
    /// Of those taken: held back for validation.
    pub held_back: usize,
}

impl Losses {
    /// How many of so many samples have to be usable for the axis to be simulated under their force: where it is known too seldom, no
    /// simulation finds the position.
    pub(crate) fn needed_to_simulate(samples: usize) -> usize {
        (conditioning::MIN_FORCE_SHARE * samples as f64) as usize
    }

    /// Samples that a simulation without filters could use, if it is not refused for the force being unknown in nearly all of them.
    pub fn left_to_simulate(&self) -> usize {
        // A log that is short as a whole is too short for filters only.
        let long = match self.short < self.logged {
            true => self.logged.saturating_sub(self.short),
            false => self.logged,
        };
        let known = long.saturating_sub(self.excluded * self.decimate.max(1));
        match known < Self::needed_to_simulate(long) {
            true => 0,
            false => known,
        }
    }
}

impl fmt::Display for Losses {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "of {} logged", self.logged)?;
        let short = "lie in stretches too short for filters or simulation";
        if self.short > 0 {
            write!(f, ", {} {short}", self.short)?;
        }
        if self.decimate > 1 && self.short < self.logged {
            write!(f, ", decimation takes one in {}", self.decimate)?;
        }
        let taken = [
            (
                self.excluded,
                "are saturated, missing or frozen, or beside such samples",
            ),
            (self.ends, "lie at ends, where filters settle"),
            (self.at_rest, "are at rest"),
            (self.slow, "are slower than min_speed"),
            (
                self.unsettled,
                "lie at the start or after gaps, where the force depends on what was before",
            ),
            (self.held_back, "are held back for validation"),
        ];
        let mut before = ", and of those ";
        for (samples, what) in taken.into_iter().filter(|(samples, _)| *samples > 0) {
            write!(f, "{before}{samples} {what}")?;
            before = ", ";
        }
        Ok(())
    }
}
