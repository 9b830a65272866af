//! What the axis file lacks where a law explains little, or explains it oddly: the travel after which the position wraps, the sign of
//! the force, or gravity.

use super::trust::{Evidence, LEAST_R2, Reasons};
use crate::source::Source;
use stiction_codes::Code;
use stiction_files::result::Next;
use stiction_identify::{Swing, explained_by_gravity};
use stiction_log::Motion;
use stiction_number::Percent;
use stiction_parameters::Quantity;

/// What takes a weight into the fit.
const LINE: &str = "gravity = true";

/// What lays a force from another file upon the motion.
const ANOTHER_CLOCK: &str = "the force comes from another file, whose clock may be another: set offset = \"estimate\" beside its file \
     under [columns]";

/// What turns a force round.
const TURNED: &str = "inertia, Coulomb and viscous friction would all have to be negative: the force has the other sign than the motion; set \
     invert = true beside its column under [columns]";

/// Relative error of a fit, percent, above which something else than friction and inertia is looked for: a quarter.
const MUCH_LEFT_PERCENT: f64 = 25.0;
/// Stroke of a joint, rad, from which a law that finds it in presliding throughout has taken gravity for bristles: those of no joint
/// are so long.
const BEYOND_BRISTLES: f64 = 0.1;
/// Part of what friction and inertia leave that follows gravity from which it is named there.
const LIKE_BRISTLES: f64 = 0.3;
/// Names what the axis file lacks where a law explains little, or nothing of it makes sense: the wrap of the position, the sign of
/// the force, or gravity. Whether it is gravity.
pub(super) fn named(evidence: &Evidence, reasons: &mut Reasons) -> bool {
    let law = evidence.law;
    let much = law.fit.relative_error_percent;
    let held = law.stays_in_presliding() && swings(evidence, BEYOND_BRISTLES);
    let poor = much.is_nan() || much > MUCH_LEFT_PERCENT || held;
    let least = if held { LIKE_BRISTLES } else { LEAST_R2 };
    let found = |code: Code| {
        let each = evidence.sources.iter();
        let mut each = each.flat_map(|source| &source.log.findings);
        each.find(|finding| finding.code == code)
    };
    // Where the position jumps, all else is seen in pieces; one that begins again is refused whatever is left.
    let is_refused = evidence
        .sources
        .iter()
        .any(|source| source.log.overflow().is_some());
    let jumps = found(Code::PositionJump)
        .filter(|_| !is_refused && (poor || found(Code::ForceSign).is_some()));
    if let Some(finding) = jumps {
        reasons.push(finding.message.clone(), Next::AxisFile);
    }
    let enable = found(Code::EnableIgnored).filter(|_| poor);
    if let Some(finding) = found(Code::ForceSign).or(enable) {
        reasons.push(finding.message.clone(), Next::AxisFile);
    } else if poor && evidence.moves_both_ways && all_negative(evidence) {
        reasons.push(TURNED.to_string(), Next::AxisFile);
    } else if poor && evidence.sources.iter().any(|s| s.log.force_as_stamped) {
        reasons.push(ANOTHER_CLOCK.to_string(), Next::AxisFile);
    } else if poor && let Some(part) = like_gravity(evidence).filter(|part| *part > least) {
        let text = format!(
            "{} follows the sine and cosine of the angle, as gravity does: set {LINE} under [terms]",
            of_what_is_left(part)
        );
        reasons.push(text, Next::AxisFile);
        return true;
    }
    false
}

/// Whether inertia and each friction of a law that has both come out at nothing, as where the force has the other sign.
fn all_negative(evidence: &Evidence) -> bool {
    let parameters = || evidence.law.parameters.iter().filter(|p| p.identified);
    let none = |quantity: Quantity| {
        let mut own = parameters()
            .filter(|p| p.name.quantity == quantity)
            .peekable();
        own.peek().is_some() && own.all(|p| p.value <= 0.0)
    };
    [Quantity::Mass, Quantity::Coulomb, Quantity::Sigma2]
        .into_iter()
        .all(none)
}

fn of_what_is_left(part: f64) -> String {
    let part = Percent::error(100.0 * part).digits(2);
    format!("{part} of what friction and inertia leave")
}

/// The part of what friction and inertia leave that follows the angle of a joint, where no gravity is asked for.
fn like_gravity(evidence: &Evidence) -> Option<f64> {
    if evidence.motion != Motion::Rotary || evidence.law.terms.gravity {
        return None;
    }
    let swings = evidence.sources.iter().filter_map(swing);
    Some(explained_by_gravity(&swings.collect::<Vec<_>>()))
}

/// Whether a joint swings farther than this, rad, in a log.
fn swings(evidence: &Evidence, far: f64) -> bool {
    evidence.sources.iter().any(|source| {
        let angles = source.log.position.iter().flatten();
        let extent = |(low, high): (f64, f64), x: &f64| (low.min(*x), high.max(*x));
        let (low, high) = angles.fold((f64::INFINITY, f64::NEG_INFINITY), extent);
        high - low > far
    })
}

fn swing(source: &Source) -> Option<Swing<'_>> {
    let log = &source.log;
    Some(Swing {
        time: &log.time,
        angle: log.position.as_ref()?,
        force: log.force.as_ref()?,
        rate: log.rate_hz,
    })
}
