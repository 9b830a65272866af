//! What a search of `stiction_search` sees of an identification: a cost over a box.
//!
//! | cost | unknowns | solved exactly for each candidate |
//! |---|---|---|
//! | [`SixParameters`] | logarithms of sigma0, sigma1, sigma2, Fc, Fs - Fc, vs (Zhang et al. 2025) | mass, offset and what else stands beside the law |
//! | [`Nonlinear`] | those of the separable method | everything linear |
//! | [`Curve`] | logarithms of Fc, Fs - Fc, vs, sigma2 of a static law, for each direction | |
//! | [`Simulated`] | the six of LuGre, position out for a given force | |
//!
//! A cost is the sum of squares of the residual over that of the measured signal: the square of the
//! relative error. Mass and offset are solved and are no genes: they are linear, nobody knows a box for
//! them, and the six keep the meaning they have in the publication.
//!
//! The six-parameter cost of a record without a common filter is computed in lanes
//! (`stiction_lanes`); with one, the columns of the law must pass it as the force did, which is done
//! by the scalar recursion.

mod algebra;
mod boxes;
mod curve;
mod nonlinear;
mod simulated;
mod six;
mod sums;

pub use boxes::six_parameters as box_of_six;
pub use curve::Curve;
pub use nonlinear::Nonlinear;
pub use simulated::Simulated;
pub use six::SixParameters;
pub use stiction_lanes::Scheme;

use crate::conditioning::record::Record;
use crate::error::Error;
use stiction_parameters::{Name, Quantity};
use stiction_search::Bounds;

/// One sample in so many makes the coarse stand-in.
const COARSE_EVERY: usize = 8;
/// It never has fewer samples than this.
const FEWEST_COARSE: usize = 500;

/// A coarse stand-in for a record, for searches that begin on one; `None` where it is not to be had.
pub fn thinned(record: &Record) -> Option<Record> {
    record.thinned((record.len() / COARSE_EVERY).max(FEWEST_COARSE))
}

/// Parameters by name, with the values of a point.
pub type Named = Vec<(Name, f64)>;

/// A problem whose points stand for parameters.
pub trait Candidates: stiction_search::Problem {
    /// Parameters of the law at a point of the box.
    fn parameters(&self, point: &[f64]) -> Named;
}

/// The six parameters `[sigma0, sigma1, sigma2, Fc, Fs, vs]` of a genome.
fn physical(x: &[f64]) -> [f64; 6] {
    let [s0, s1, s2, fc, excess, vs] = std::array::from_fn(|i| libm::exp(x[i]));
    [s0, s1, s2, fc, fc + excess, vs]
}

fn named([s0, s1, s2, fc, fs, vs]: [f64; 6]) -> Named {
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
const LARGEST_LOGARITHM: f64 = 92.0;

/// Refuses a box in which candidates would overflow, or with another number of dimensions.
fn checked(bounds: Bounds, dimensions: usize) -> Result<Bounds, Error> {
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
