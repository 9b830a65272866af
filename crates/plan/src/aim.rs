//! What a motion is judged with.

/// The noise of the log, and what is known already.
#[derive(Clone, Debug, PartialEq)]
pub struct Aim {
    /// Standard deviation of the noise of a logged force, > 0, N (N m).
    pub force_noise: f64,
    /// Deviations from a log that will be identified together with that of the motion, in the order and the
    /// [units](crate::Candidate::units) of the parameters; `None` where it says nothing, none at all without such a log.
    pub known: Vec<Option<f64>>,
}

impl Aim {
    /// Nothing is known.
    pub fn new(force_noise: f64) -> Self {
        Aim {
            force_noise,
            known: Vec::new(),
        }
    }

    /// Adds what is known already to a matrix of sums, the lower triangle by rows.
    pub(crate) fn start(&self, gram: &mut [f64]) {
        let power = self.force_noise * self.force_noise;
        for (i, known) in self.known.iter().enumerate() {
            if let Some(deviation) = known.filter(|d| *d > 0.0) {
                gram[i * (i + 1) / 2 + i] += power / (deviation * deviation);
            }
        }
    }
}
