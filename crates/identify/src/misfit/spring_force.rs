//! A force that grows with the position, as that of a spring, a cable chain or a bellows.

use super::coupling::beside::Beside;

/// Part of the residual that it explains, beyond all that a law can take up, from which it is a cause of its own.
const LEAST_SHARE: f64 = 0.3;
/// Fewest lengths of the bristles in a stroke: on a shorter one they are a spring themselves.
const FEWEST_LENGTHS: f64 = 50.0;

/// A force that grows with the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringForce {
    /// What is left of it beside the law, per length: N/m, or with rad; driving back.
    pub stiffness: f64,
    /// Part of the variance of the residual that it explains, 0 to 1.
    pub share: f64,
    /// The stroke, m or rad.
    pub stroke: f64,
}

/// Looks for one along the positions of the kept samples, `length` (m or rad) being that of the bristles.
pub(super) fn sought(position: &[f64], length: f64, beside: &Beside) -> Option<SpringForce> {
    let extent = |(low, high): (f64, f64), x: &f64| (low.min(*x), high.max(*x));
    let (low, high) = position
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), extent);
    let stroke = high - low;
    if !(stroke > FEWEST_LENGTHS * length && stroke.is_finite()) {
        return None;
    }
    let middle = 0.5 * (low + high);
    let way: Vec<f64> = position.iter().map(|x| x - middle).collect();
    let found = beside.explained(&way);
    (found.share >= LEAST_SHARE && found.coefficient > 0.0).then_some(SpringForce {
        stiffness: found.coefficient,
        share: found.share,
        stroke,
    })
}
