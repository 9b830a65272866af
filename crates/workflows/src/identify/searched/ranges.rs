//! The box that a search looks in: what `[search.box]` of the axis file gives, else what the record suggests.

use crate::error::Error;
use crate::source::Source;
use crate::wording::Setting;
use libm::log;
use stiction_codes::Code;
use stiction_files::Axis;
use stiction_search::Bounds;

/// What is searched, in the order of `[search.box]`.
const UNKNOWNS: [&str; 6] = [
    "sigma0",
    "sigma1",
    "sigma2",
    "coulomb",
    "static - coulomb",
    "stribeck_velocity",
];

/// All six at once.
pub(crate) const SIX: &[usize] = &[0, 1, 2, 3, 4, 5];
/// The steady curve.
pub(crate) const CURVE: &[usize] = &[2, 3, 4, 5];
/// What the bristles add.
pub(crate) const BRISTLE: &[usize] = &[0, 1];

/// Names of some of them.
pub(crate) fn names(which: &[usize]) -> Vec<String> {
    which.iter().map(|&i| UNKNOWNS[i].into()).collect()
}

/// A box with the ranges that the axis file gives in place of its own. A box that repeats `which` for each direction has
/// the same range in both.
pub(crate) fn given(
    axis: &Axis,
    inputs: &[Source],
    bounds: Bounds,
    which: &[usize],
) -> Result<Bounds, Error> {
    if !axis.has_search_box() {
        return Ok(bounds);
    }
    let ranges = axis.search_box(&inputs[0].log)?;
    let (mut low, mut high) = (bounds.low().to_vec(), bounds.high().to_vec());
    for (i, ends) in low.iter_mut().zip(&mut high).enumerate() {
        if let Some([least, most]) = ranges[which[i % which.len()]] {
            (*ends.0, *ends.1) = (log(least), log(most));
        }
    }
    Bounds::new(low, high).map_err(|e| Error::usage(e.to_string(), "a lower end below the upper"))
}

/// The separable cost searches ratios of the six parameters, for which their ranges say nothing.
pub(crate) fn refuse_beside_separable(axis: &Axis) -> Result<(), Error> {
    if !axis.has_search_box() {
        return Ok(());
    }
    let found = "given, and the separable cost searches ratios of these parameters";
    let allowed = "a search over the six parameters themselves (cost six), or no [search.box]";
    Err(
        match axis.refuse("search.box", found, allowed, Code::BadConfig) {
            Some(error) => error.into(),
            None => Error::usage(
                ["[search.box] beside ".into(), Setting::Cost.is("separable")],
                allowed,
            ),
        },
    )
}
