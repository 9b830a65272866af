//! Annealed survival.

use crate::error::{Error, require};
use serde::{Deserialize, Serialize};

/// Annealed survival of children: `P = exp(-(J - Jm)/(Jm T))`, with `Jm` the cost to compare with (in
/// the annealing GA that of the last of the elite) and the temperature `T = start factor^generation`;
/// Z25 eq. (21) on the relative cost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Annealing {
    /// Temperature of the first generation of a round, > 0.
    pub start: f64,
    /// Its factor per generation, above 0 to 1.
    pub factor: f64,
}

impl Annealing {
    pub(crate) fn check(&self, method: &'static str) -> Result<(), Error> {
        let Self { start, factor } = *self;
        let within = start > 0.0 && start.is_finite();
        require(within, method, "start", start, "above 0, finite")?;
        let within = factor > 0.0 && factor <= 1.0;
        require(within, method, "factor", factor, "above 0 to 1")
    }

    /// Probability that a child survives compared with a cost `with`, in a generation counted from 0.
    pub(crate) fn survival(&self, cost: f64, with: f64, generation: usize) -> f64 {
        if cost <= with {
            return 1.0;
        }
        let temperature = self.start * libm::pow(self.factor, generation as f64);
        let rise = (cost - with) / (with * temperature);
        // A child of infinite cost does not survive, nor does any costlier child beside a perfect fit (cost 0).
        if rise.is_nan() { 0.0 } else { libm::exp(-rise) }
    }
}

#[cfg(test)]
mod tests {
    use super::Annealing;

    #[test]
    fn corners() {
        let annealing = Annealing {
            start: 5.0,
            factor: 0.5,
        };
        let at = |cost, with| annealing.survival(cost, with, 0);
        assert_eq!(at(1.0, 1.0), 1.0);
        assert_eq!(at(0.5, 1.0), 1.0);
        assert_eq!(at(6.0, 1.0), libm::exp(-1.0));
        assert_eq!(annealing.survival(6.0, 1.0, 1), libm::exp(-2.0));
        assert_eq!(at(f64::INFINITY, 1.0), 0.0);
        assert_eq!(at(1.0, 0.0), 0.0);
        assert_eq!(at(f64::INFINITY, f64::INFINITY), 1.0);
    }
}
