//! What the axis file lacks where a law explains little, or explains it oddly: the travel after which the position wraps, the sign of
//! the force, or gravity.

use super::trust::{Evidence, LEAST_R2, Reasons};
use crate::source::Source;
use stiction_codes::Code;
use stiction_files::result::Next;
use stiction_identify::{Swing, explained_by_gravity};
use stiction_log::Motion;
use stiction_number::Percent;

/// Relative error of a fit, percent, above which something else than friction and inertia is looked for: a quarter.
const MUCH_LEFT_PERCENT: f64 = 25.0;
/// Stroke of a joint, rad, from which a law that finds it in presliding throughout has taken gravity for bristles: those of no joint
/// are so long.
const BEYOND_BRISTLES: f64 = 0.1;
/// Part of what friction and inertia leave that follows gravity from which it is named there.
const LIKE_BRISTLES: f64 = 0.3;
/// The same where friction explains the force well, but another in each direction, or something else is left: friction that differs
/// with the direction makes up for much of a weight.
const LIKE_DIRECTIONS: f64 = 0.7;
/// Stroke of a joint, rad, from which gravity is no constant force.
const BEYOND_A_CONSTANT: f64 = 1.0;

/// Names what the axis file lacks where a law explains little, or nothing of it makes sense, or it is another in each direction: the wrap of the position, the sign of
/// the force, or gravity. Whether it is gravity.
pub(super) fn named(evidence: &Evidence, reasons: &mut Reasons) -> bool {
    let law = evidence.law;
    let much = law.fit.relative_error_percent;
    let swings = |far: f64| evidence.sources.iter().any(|source| reaches(source, far));
    let held = law.stays_in_presliding() && swings(BEYOND_BRISTLES);
    let poor = much.is_nan() || much > MUCH_LEFT_PERCENT || held;
    let misfit = law.misfit.as_ref();
    let odd = law.law.asymmetric || misfit.is_some_and(|misfit| misfit.cause().is_some());
    let doubtful = odd && swings(BEYOND_A_CONSTANT);
    let least = match (held, poor) {
        (true, _) => LIKE_BRISTLES,
        (false, true) => LEAST_R2,
        (false, false) => LIKE_DIRECTIONS,
    };
    let found = |code: Code| {
        let each = evidence.sources.iter();
        let mut each = each.flat_map(|source| &source.log.findings);
        each.find(|finding| finding.code == code)
    };
    // Where the position jumps, all else is seen in pieces.
    let jumps = found(Code::PositionJump).filter(|_| poor || found(Code::ForceSign).is_some());
    if let Some(finding) = jumps {
        reasons.push(finding.message.clone(), Next::AxisFile);
    }
    if let Some(finding) = found(Code::ForceSign) {
        reasons.push(finding.message.clone(), Next::AxisFile);
    } else if (poor || doubtful) && evidence.motion == Motion::Rotary && !law.terms.gravity {
        let swings = evidence.sources.iter().filter_map(swing);
        let part = explained_by_gravity(&swings.collect::<Vec<_>>());
        if part > least {
            let text = format!(
                "{} of what friction and inertia leave follows the sine and cosine of the angle, as gravity does: set \
                 gravity = true under [terms]",
                Percent::error(100.0 * part).digits(2)
            );
            reasons.push(text, Next::AxisFile);
            return true;
        }
    }
    false
}

/// Whether a joint swings farther than this, rad.
fn reaches(source: &Source, far: f64) -> bool {
    let angles = source.log.position.iter().flatten();
    let extent = |(low, high): (f64, f64), x: &f64| (low.min(*x), high.max(*x));
    let (low, high) = angles.fold((f64::INFINITY, f64::NEG_INFINITY), extent);
    high - low > far
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
