//! Why a search cannot be started or run.

/// Input with which no search can work. A search that ends badly is a [`Status`](crate::Status).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A setting outside its range.
    #[error("{method}: {name} = {found}; allowed: {allowed}")]
    Setting {
        /// Which method.
        method: &'static str,
        /// Which setting.
        name: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A box with a lower bound above the upper one, or with a bound that is not finite.
    #[error(
        "box, dimension {dimension}: {low:?} to {high:?}; allowed: finite, the lower bound first, and a \
         finite width"
    )]
    Bounds {
        /// Dimension, counted from 0.
        dimension: usize,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
    /// Too few or too many dimensions, or bounds that do not match.
    #[error("box: {low} lower and {high} upper bounds; allowed: equally many, 1 to {most}")]
    Dimensions {
        /// Lower bounds given.
        low: usize,
        /// Upper bounds given.
        high: usize,
        /// Most dimensions.
        most: usize,
    },
    /// The problem lives in another box than the run or the search was started in.
    #[error("the problem's box is not the one that the run and its search were started in")]
    OtherBox,
    /// A method that descends was given a problem that offers no derivatives.
    #[error("this search needs derivatives, and the problem offers costs only")]
    NoDerivatives,
}

/// An error unless the setting is within its range; NaN never is.
pub(crate) fn require(
    within: bool,
    method: &'static str,
    name: &'static str,
    found: f64,
    allowed: &'static str,
) -> Result<(), Error> {
    if within {
        return Ok(());
    }
    Err(Error::Setting {
        method,
        name,
        found,
        allowed,
    })
}
