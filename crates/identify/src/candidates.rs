//! What a search of `stiction_search` needs to know of an identification: a cost function over a box of
//! unknowns.
//!
//! | cost | unknowns | solved exactly for each candidate |
//! |---|---|---|
//! | [`SixParameters`] | logarithms of sigma0, sigma1, sigma2, Fc, Fs - Fc, vs (Zhang et al. 2025) | mass, offset and what else stands beside the law |
//! | [`Nonlinear`] | those of the separable method | everything linear |
//! | [`Dynamic`] | logarithms of sigma0 and sigma1, the steady curve held | as the six |
//! | [`Curve`] | logarithms of Fc, Fs - Fc, vs, sigma2 of a static law, for each direction | a constant force, if asked for |
//! | [`Simulated`] | the six of LuGre, position out for a given force | |
//!
//! A cost is the sum of squares of the residual over that of the measured signal: the square of the
//! relative error. Mass and offset are solved for and are not part of the genome: they enter linearly, no
//! range is known for them beforehand, and the six genes keep the meaning they have in the publication.
//!
//! The six-parameter costs are computed in lanes (`stiction_lanes`), where the record has a common filter that included: the
//! force of a candidate passes it as the measured one did. Derivatives need every column of the law, and with a filter take
//! the scalar recursion.

mod algebra;
mod boxes;
mod curve;
mod dynamic;
mod nonlinear;
mod problem;
mod projected;
mod simulated;
mod six;
mod sums;

pub use boxes::{curve as box_of_curve, six_parameters as box_of_six};
pub use curve::Curve;
pub use dynamic::Dynamic;
pub use nonlinear::Nonlinear;
pub use problem::{Candidates, Named, thinned};
pub use simulated::Simulated;
pub use six::SixParameters;
pub use stiction_lanes::Scheme;
