//! Whether the axis slides at all.
//!
//! Levels, and the curve between them, are what friction comes to once the bristles are bent. In a
//! stroke that is shorter than their way from one side to the other, a search still finds levels that
//! suit the bend of the presliding curve, encoder steps included, and their deviations say only how well
//! those are known.

use crate::estimate::parameter::Parameter;

/// Parameters that show while the axis slides.
const SLIDING: [&str; 4] = ["coulomb", "static", "stribeck_velocity", "sigma2"];

/// Flags what shows while the axis slides, where a stroke (m or rad) is shorter than the way of the
/// bristles from one side to the other, the Coulomb levels over sigma0.
pub(super) fn stays_in_presliding(stroke: f64, parameters: &mut [Parameter]) {
    let value = |name: &str| parameters.iter().find(|p| p.name == name).map(|p| p.value);
    let levels = match (value("coulomb"), value("coulomb_pos"), value("coulomb_neg")) {
        (Some(level), ..) => 2.0 * level,
        (_, Some(positive), Some(negative)) => positive + negative,
        _ => return,
    };
    let Some(stiffness) = value("sigma0") else {
        return;
    };
    if stroke * stiffness >= levels {
        return;
    }
    let shows =
        |name: &str| SLIDING.contains(&name.trim_end_matches("_pos").trim_end_matches("_neg"));
    for p in parameters
        .iter_mut()
        .filter(|p| p.identifiable && shows(&p.name))
    {
        p.identifiable = false;
        p.reason = "the stroke is shorter than the bristles' way from one side to the other".into();
    }
}
