//! What became of the samples of a log that a fit does not use.

use std::fmt;

/// Samples on their way from the logs to a fit, and what took them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Losses {
    /// Samples of the logs.
    pub logged: usize,
    /// Of these, in stretches between gaps that are too short.
    pub short: usize,
    /// One sample in so many is taken of the rest, since the filter leaves no more in them; 0 and 1
    /// take all.
    pub decimate: usize,
    /// Of those taken: saturated, missing or frozen ones, and what the filter mixes them into.
    pub excluded: usize,
    /// Of those taken: at ends, where filters settle.
    pub ends: usize,
    /// Of those taken: slower than `min_speed`.
    pub slow: usize,
    /// Of those taken: held back for validation.
    pub held_back: usize,
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
            (self.slow, "are slower than min_speed"),
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
