//! What a motion is judged with.

use crate::candidate::PARAMETERS;
use crate::information::Sums;

/// The noise of the log, and what is known already.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// Standard deviation of the noise of a logged force, > 0, N (N m).
    pub force_noise: f64,
    /// Relative deviations from a log that will be identified together with that of the motion; `None` where it says nothing.
    pub known: [Option<f64>; PARAMETERS],
}

impl Aim {
    /// Nothing is known.
    pub fn new(force_noise: f64) -> Self {
        Aim {
            force_noise,
            known: [None; PARAMETERS],
        }
    }

    /// What is known already, as sums.
    pub(crate) fn start(&self) -> Sums {
        let mut sums = Sums::ZERO;
        let power = self.force_noise * self.force_noise;
        for (i, known) in self.known.iter().enumerate() {
            if let Some(deviation) = known.filter(|d| *d > 0.0) {
                sums.gram[i * (i + 1) / 2 + i] = power / (deviation * deviation);
            }
        }
        sums
    }
}
