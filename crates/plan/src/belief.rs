//! What is believed of an axis that was identified once.

use crate::candidate::{Candidate, PARAMETERS};
use stiction_friction::ParamError;

/// A first identification: values and how well they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Belief {
    /// The identified axis.
    pub axis: Candidate,
    /// Relative standard deviation of each parameter; `None` where the data did not determine it.
    pub deviations: [Option<f64>; PARAMETERS],
}

/// Deviations to either side that are thought possible.
const WIDE: f64 = 2.0;
/// Factors to either side: at least, since a first fit is rarely as good as it says, of what is not determined, and at most.
const LEAST: f64 = 1.3;
const OPEN: f64 = 3.0;
const MOST: f64 = 10.0;
/// Places of static and Coulomb friction among the parameters.
const COULOMB: usize = 3;
const STATIC: usize = 4;
/// Least Fs/Fc - 1.
const LEAST_EXCESS: f64 = 0.02;

impl Belief {
    /// Refuses an axis that is none.
    pub fn validate(&self) -> Result<(), ParamError> {
        self.axis.validate()
    }

    /// How many times larger or smaller each may be; for static friction it is the factor of Fs/Fc - 1.
    pub fn factors(&self) -> [f64; PARAMETERS] {
        let ratio = 1.0 + 1.0 / self.axis.excess();
        std::array::from_fn(|i| {
            let steeper = if i == STATIC { ratio } else { 1.0 };
            match self.deviations[i] {
                Some(deviation) => libm::exp(WIDE * steeper * deviation).clamp(LEAST, MOST),
                None => OPEN,
            }
        })
    }

    /// The axis at a place in the unit cube.
    fn at(&self, unit: [f64; PARAMETERS]) -> Candidate {
        let factors = self.factors();
        let mut values = self.axis.values();
        let by: [f64; PARAMETERS] =
            std::array::from_fn(|i| libm::pow(factors[i], 2.0 * unit[i] - 1.0));
        for (value, by) in values.iter_mut().zip(by) {
            *value *= by;
        }
        let excess = (self.axis.excess() * by[STATIC]).max(LEAST_EXCESS);
        values[STATIC] = values[COULOMB] * (1.0 + excess);
        Candidate::from_values(values)
    }

    /// `count` axes, spread evenly by a scrambled Sobol sequence; other seeds are other axes.
    pub fn draw(&self, count: usize, seed: u32) -> Vec<Candidate> {
        let unit = |i: usize, d: usize| f64::from(sobol_burley::sample(i as u32, d as u32, seed));
        (0..count)
            .map(|i| self.at(std::array::from_fn(|d| unit(i, d))))
            .collect()
    }
}
