//! Rates of crossover and mutation, fixed or adaptive.

use serde::{Deserialize, Serialize};

/// A probability between two bounds; fixed where they are equal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// For the fittest, 0 to `high`.
    pub low: f64,
    /// For all below the mean fitness, at most 1.
    pub high: f64,
}

impl Rates {
    /// The same for all.
    pub const fn fixed(rate: f64) -> Self {
        Self {
            low: rate,
            high: rate,
        }
    }

    /// The rate for one fitness, Z25 eqs. (16), (17): `high - (high - low)(f - mean)/(max - mean)`
    /// from the mean up, `high` below.
    pub(crate) fn at(&self, fitness: f64, mean: f64, max: f64) -> f64 {
        if fitness >= mean && max > mean {
            self.high - (self.high - self.low) * ((fitness - mean) / (max - mean))
        } else {
            self.high
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Rates;

    #[test]
    fn corners() {
        let rates = Rates {
            low: 0.25,
            high: 0.75,
        };
        assert_eq!(rates.at(3.0, 1.0, 3.0), 0.25); // the fittest
        assert_eq!(rates.at(1.0, 1.0, 3.0), 0.75); // the mean
        assert_eq!(rates.at(0.0, 1.0, 3.0), 0.75); // below it
        assert_eq!(rates.at(2.0, 1.0, 3.0), 0.5); // half-way
        assert_eq!(rates.at(2.0, 2.0, 2.0), 0.75); // all alike
    }
}
