//! Whether the axis slides at all, and in both directions.
//!
//! The friction levels and the curve between them only show once the bristles are fully deflected. In a
//! stroke that is shorter than their way from one side to the other, a search still finds levels that fit
//! the curvature of the presliding curve, encoder steps included, and their standard deviations describe
//! only how well those fitted values are known.

use crate::conditioning::record::Record;
use crate::parameter::Parameter;
use stiction_parameters::{Quantity, Side};
use stiction_policy::interval;

/// Parameters that show while the axis slides.
const SLIDING: [Quantity; 4] = [
    Quantity::Coulomb,
    Quantity::Static,
    Quantity::StribeckVelocity,
    Quantity::Sigma2,
];

/// Flags what the motion of a record cannot show, whatever the deviations of the parameters are.
pub(super) fn flag_what_the_motion_hides(record: &Record, parameters: &mut [Parameter]) {
    stays_in_presliding(record.stroke(), parameters);
    flag_one_direction(parameters, || record.moves_both_ways());
}

/// Flags the Coulomb level and the constant force beside it, where the axis moves in one direction only: all that sliding
/// shows is their sum.
pub(crate) fn flag_one_direction(
    parameters: &mut [Parameter],
    moves_both_ways: impl FnOnce() -> bool,
) {
    // Levels of their own for each direction hold a constant force too.
    let holds_a_constant = |p: &Parameter| {
        p.identified
            && (p.name == Quantity::Offset
                || (p.name.quantity == Quantity::Coulomb && p.name.side != Side::Both))
    };
    if !parameters.iter().any(holds_a_constant) || moves_both_ways() {
        return;
    }
    for p in parameters.iter_mut().filter(|p| p.identified) {
        let other = match p.name.quantity {
            Quantity::Offset => "Coulomb friction",
            Quantity::Coulomb if p.name.side == Side::Both => "the offset",
            Quantity::Coulomb | Quantity::Static if p.name.side != Side::Both => "a constant force",
            _ => continue,
        };
        if p.identifiable {
            p.identifiable = false;
            p.reason =
                format!("cannot be separated from {other}: the axis moves in one direction only");
        }
    }
}

/// Flags the parameters of sliding where the axis does not slide, or not far enough to show them.
fn stays_in_presliding(stroke: f64, parameters: &mut [Parameter]) {
    never_turned_over(stroke, parameters);
    // Elements slip at their yield, bristles never quite.
    let has_elements = parameters.iter().any(is_yield);
    let reaches = if has_elements {
        1.0
    } else {
        interval::MIN_TRAVELS
    };
    let Some(ways) = ways(stroke, parameters).filter(|ways| *ways < reaches) else {
        return;
    };
    let reason = match ways < 1.0 {
        true => "the stroke is shorter than the travel of the bristles from one side to the other"
            .to_string(),
        false => format!(
            "the stroke is {ways:.1} times the travel of the bristles from one side to the other, of which they need {reaches} to come \
             within a twentieth of the level"
        ),
    };
    let levels = |p: &Parameter| {
        SLIDING.contains(&p.name.quantity) || p.name.quantity == Quantity::Offset && ways >= 1.0
    };
    let open = parameters.iter_mut();
    for p in open.filter(|p| p.identified && p.identifiable && levels(p)) {
        p.identifiable = false;
        p.reason.clone_from(&reason);
    }
}

/// Flags the elements that never slip from one side to the other, and what they take part in: such an element is a spring as far
/// as the motion shows.
fn never_turned_over(stroke: f64, parameters: &mut [Parameter]) {
    let is_beyond = |p: &&mut Parameter| is_yield(p) && p.identified && 2.0 * p.value > stroke;
    let mut never = false;
    for p in parameters.iter_mut().filter(is_beyond) {
        p.identifiable = false;
        p.reason = "the stroke is shorter than its travel from one side to the other: as far as the motion shows it is a spring".into();
        never = true;
    }
    let levels = [Quantity::Coulomb, Quantity::Static];
    let levels = |p: &&mut Parameter| p.identifiable && levels.contains(&p.name.quantity);
    for p in parameters.iter_mut().filter(|p| never && levels(p)) {
        p.identifiable = false;
        p.reason = "an element never slips from one side to the other".into();
    }
}

/// Flags the yields of elements whose stiffness the data leave open: where an element that may be none slips says nothing.
pub(super) fn flag_yields_of_open_elements(parameters: &mut [Parameter]) {
    let open: Vec<u32> = parameters
        .iter()
        .filter(|p| p.identified && !p.identifiable)
        .filter_map(|p| match p.name.quantity {
            Quantity::ElementStiffness(k) => Some(k),
            _ => None,
        })
        .collect();
    let is_of_them = |p: &&mut Parameter| match p.name.quantity {
        Quantity::ElementYield(k) => p.identifiable && open.contains(&k),
        _ => false,
    };
    for p in parameters.iter_mut().filter(is_of_them) {
        p.identifiable = false;
        p.reason = "is that of an element whose stiffness the data leave open".into();
    }
}

fn is_yield(p: &Parameter) -> bool {
    matches!(p.name.quantity, Quantity::ElementYield(_))
}

/// Flags the parameters of sliding after a simulation in which the axis never breaks away, and the mass where its inertia
/// is less than what the simulation leaves. Returns whether that is so.
///
/// Bristles under a force that swings creep: the stroke may be longer than their way from one side to the other although
/// friction never reached the static level.
pub(crate) fn flag_what_never_breaks_away(
    parameters: &mut [Parameter],
    stroke: f64,
    largest_friction: f64,
    (inertia, left): (f64, f64),
) -> bool {
    let of = |quantity: Quantity| {
        let all = parameters
            .iter()
            .filter(move |p| p.name.quantity == quantity);
        all.map(|p| p.value)
    };
    let level = of(Quantity::Static).chain(of(Quantity::Coulomb));
    let level = level.fold(0.0, f64::max);
    let Some(stiffness) = of(Quantity::Sigma0).next() else {
        return false;
    };
    let is_short = stroke * stiffness < interval::MAX_CREEP * 2.0 * level;
    if !(is_short && largest_friction < level || is_presliding(stroke, parameters)) {
        return false;
    }
    for p in parameters
        .iter_mut()
        .filter(|p| p.identified && p.identifiable)
    {
        let reason = match p.name.quantity {
            quantity if SLIDING.contains(&quantity) => {
                "the axis never breaks away: friction stays below the static level"
            }
            Quantity::Mass if inertia < left => {
                "its inertia is less than what the law leaves of the motion"
            }
            _ => continue,
        };
        p.identifiable = false;
        p.reason = reason.into();
    }
    true
}

/// Whether the stroke (m or rad) is shorter than the travel that turns the bristles from one side to the other, which is the
/// sum of the Coulomb levels divided by sigma0.
pub(crate) fn is_presliding(stroke: f64, parameters: &[Parameter]) -> bool {
    ways(stroke, parameters).is_some_and(|ways| ways < 1.0)
}

/// Whether a way (m or rad) after a reversal is long enough for bristles to come within a twentieth of their level; so for a law
/// without them.
pub(crate) fn slides(way: f64, parameters: &[Parameter]) -> bool {
    ways(way, parameters).is_none_or(|ways| ways >= interval::MIN_TRAVELS)
}

/// The stroke in such travels; `None` for a law without a bristle.
fn ways(stroke: f64, parameters: &[Parameter]) -> Option<f64> {
    let of = |quantity: Quantity, side| {
        let mut known = parameters.iter();
        let found = known.find(|p| p.name.quantity == quantity && p.name.side == side);
        found.map(|p| p.value)
    };
    let coulomb = |side| of(Quantity::Coulomb, side);
    let levels = match coulomb(Side::Both) {
        Some(level) => 2.0 * level,
        None => coulomb(Side::Positive)? + coulomb(Side::Negative)?,
    };
    let stiffness = of(Quantity::Sigma0, Side::Both)?;
    Some(stroke * stiffness / levels)
}
