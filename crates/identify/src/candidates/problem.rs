//! What every problem of a search over candidates has: its box, its share of coarse costs, its parameters by name.

use crate::conditioning::record::Record;
use crate::error::Error;
use stiction_parameters::{Name, Quantity};
use stiction_search::Bounds;

/// The coarse record, used for cheap evaluations, takes every n-th sample, with this n.
const COARSE_EVERY: usize = 8;
/// It never has fewer samples than this.
const FEWEST_COARSE: usize = 500;

/// A coarse record of fewer samples for searches that begin on one; `None` where it cannot be made.
pub fn thinned(record: &Record) -> Option<Record> {
    record.thinned((record.len() / COARSE_EVERY).max(FEWEST_COARSE))
}

/// Parameters by name, with the values of a point.
pub type Named = Vec<(Name, f64)>;

/// A search problem whose points can be translated into parameters of a law.
pub trait Candidates: stiction_search::Problem {
    /// Parameters of the law at a point of the box.
    fn parameters(&self, point: &[f64]) -> Named;
}

/// The six parameters `[sigma0, sigma1, sigma2, Fc, Fs, vs]` of a genome.
pub(super) fn physical(x: &[f64]) -> [f64; 6] {
    let [s0, s1, s2, fc, excess, vs] = std::array::from_fn(|i| libm::exp(x[i]));
    [s0, s1, s2, fc, fc + excess, vs]
}

pub(super) fn named([s0, s1, s2, fc, fs, vs]: [f64; 6]) -> Named {
    let values = [
        (Quantity::Sigma0, s0),
        (Quantity::Sigma1, s1),
        (Quantity::Sigma2, s2),
        (Quantity::Coulomb, fc),
        (Quantity::Static, fs),
        (Quantity::StribeckVelocity, vs),
    ];
    values.map(|(name, value)| (name.into(), value)).into()
}

/// Largest magnitude of a logarithm: numbers from 1e-40 to 1e40.
pub(super) const LARGEST_LOGARITHM: f64 = 92.0;

/// Refuses a box in which candidates would overflow, or with another number of dimensions.
pub(super) fn checked(bounds: Bounds, dimensions: usize) -> Result<Bounds, Error> {
    if bounds.dimensions() != dimensions {
        return Err(Error::Setting {
            name: "dimensions of the box",
            found: bounds.dimensions() as f64,
            allowed: "one for each unknown",
        });
    }
    let ends = bounds.low().iter().chain(bounds.high());
    match ends.copied().find(|x| x.abs() > LARGEST_LOGARITHM) {
        None => Ok(bounds),
        Some(found) => Err(Error::Setting {
            name: "logarithm in the box",
            found,
            allowed: "a magnitude of at most 92",
        }),
    }
}
