//! What logs and fit of a robot say of its URDF and its columns.

use super::load::{Loaded, unit_of};
use crate::error::Error;
use stiction_identify::{Prior, RigidFit, pseudo_inverse};
use stiction_log::mapping::is_commanded;
use stiction_log::{Found, Role};
use stiction_policy::robot;
use stiction_rigid::Robot;
use stiction_say::OfRobot;

/// Refuses positions so far beyond the limits of their joints that they are in other units, and logs without any torque.
pub(super) fn refuse(loaded: &Loaded, found: &[OfRobot]) -> Result<(), Error> {
    let is_in_other_units = |own: &&OfRobot| match own {
        OfRobot::BeyondLimits { seen, limits, .. } => {
            seen[1] - seen[0] > robot::OTHER_UNITS * (limits[1] - limits[0])
        }
        _ => false,
    };
    if let Some(own) = found.iter().find(is_in_other_units) {
        return Err(Error::usage(own.to_string(), "positions in rad or m"));
    }
    let without = |own: &&OfRobot| matches!(own, OfRobot::NoTorque { .. });
    let asked = loaded.joints.iter().filter(|own| own.fit).count();
    match found.iter().find(without) {
        Some(first) if found.iter().filter(without).count() == asked => Err(Error::usage(
            first.to_string(),
            "torques or currents of the joints",
        )),
        _ => Ok(()),
    }
}

/// What to know of the joints of the fitted logs, before anything is fitted.
pub(super) fn of_joints(loaded: &Loaded) -> Vec<OfRobot> {
    let mut out = Vec::new();
    for own in &loaded.joints {
        let joint = &loaded.robot.joints()[own.joint];
        let name = joint.name.clone();
        let logs = || own.fitted.iter().map(|source| &source.log);
        if let Some((low, high)) = logs()
            .filter_map(|log| range(log.position.as_deref()?))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            && let (Some(least), Some(most)) = (joint.limit.lower, joint.limit.upper)
        {
            let beyond = robot::BEYOND_LIMITS * (most - least);
            if least < most && (low < least - beyond || high > most + beyond) {
                out.push(OfRobot::BeyondLimits {
                    joint: name.clone(),
                    seen: [low, high],
                    limits: [least, most],
                    unit: unit_of(joint.kind),
                });
            }
        }
        if !own.fit {
            out.push(OfRobot::LeftOut { joint: name });
        } else if logs().any(|log| log.force.is_none()) {
            out.push(OfRobot::NoTorque { joint: name });
        } else if logs().all(|log| log.finds(|found| matches!(found, Found::NoMotion { .. }))) {
            out.push(OfRobot::Still { joint: name });
        } else {
            let mut columns = logs().flat_map(|log| &log.columns);
            let commanded =
                columns.find(|own| own.role == Some(Role::Force) && is_commanded(&own.column));
            out.extend(commanded.map(|own| OfRobot::Commanded {
                joint: name,
                column: own.column.clone(),
            }));
        }
    }
    out
}

fn range(values: &[f64]) -> Option<(f64, f64)> {
    let finite = values.iter().copied().filter(|x| x.is_finite());
    finite
        .map(|x| (x, x))
        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// What the fit says against the URDF: a body far from it, or a load that it lacks.
pub(super) fn of_urdf(robot: &Robot, prior: &Prior, rigid: &RigidFit) -> Option<OfRobot> {
    let far = (0..robot.len()).map(|body| (body, distance(prior, rigid, body)));
    let (body, times) = far.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let link = robot.links()[robot.bodies()[body].carrier].name.clone();
    let far = (times > robot::MAX_URDF_DISTANCE).then_some(OfRobot::FarFromUrdf { link, times });
    // A load moves the last body far from its URDF, and no other.
    match last_body(robot) == Some(body) {
        true => payload(robot, prior, rigid).or(far),
        false => far.or_else(|| payload(robot, prior, rigid)),
    }
}

/// How far a body is from that of the URDF, in standard deviations of the prior.
fn distance(prior: &Prior, rigid: &RigidFit, body: usize) -> f64 {
    let own = 10 * body..10 * body + 10;
    let change = |i: usize| rigid.parameters[i] - prior.parameters[i];
    let row = |i: usize| -> f64 {
        let each = own.clone();
        each.map(|j| change(i) * prior.information[(i, j)] * change(j))
            .sum()
    };
    own.clone().map(row).sum::<f64>().max(0.0).sqrt()
}

/// A load on the last body that the URDF does not have, where there is one beyond doubt.
///
/// The load may be any body, while all bodies are those of the URDF within their prior. With posterior mean m and
/// covariance C of the parameters, P the inverse of the covariance of the prior and m0 its mean, and E the columns of the load's
/// parameters, the load is `(E' (P - P C P) E)^-1 E' P (m - m0)`.
fn payload(robot: &Robot, prior: &Prior, rigid: &RigidFit) -> Option<OfRobot> {
    let body = last_body(robot)?;
    let size = rigid.parameters.len();
    let covariance = rigid.covariance.view((0, 0), (size, size));
    let changed = prior
        .parameters
        .iter()
        .zip(&rigid.parameters)
        .map(|(nominal, own)| own - nominal)
        .collect::<Vec<f64>>();
    let free = prior.information.columns(10 * body, 10);
    // The covariance is symmetric.
    let left = free.rows(10 * body, 10) - free.tr_mul(&covariance.tr_mul(&free));
    let right = free.tr_mul(&nalgebra::DVector::from_vec(changed));
    let covariance = pseudo_inverse(left);
    let mass = (covariance.row(0) * right)[0];
    let deviation = covariance[(0, 0)].max(0.0).sqrt();
    let total: f64 = robot.parameters().iter().step_by(10).sum();
    let is_sure = mass > robot::PAYLOAD_DEVIATIONS * deviation && deviation > 0.0;
    (is_sure && mass > robot::MIN_PAYLOAD * total).then(|| OfRobot::Payload {
        link: robot.links()[robot.bodies()[body].carrier].name.clone(),
        mass,
        deviation,
    })
}

/// The last body that all motion beyond it hangs on: the hand, whose fingers are bodies of their own.
fn last_body(robot: &Robot) -> Option<usize> {
    let children = |of: Option<usize>| -> Vec<usize> {
        let joints = robot.joints().iter().enumerate();
        joints
            .filter(|(_, joint)| joint.parent == of)
            .map(|(i, _)| i)
            .collect()
    };
    let mut last = None;
    while let [only] = children(last)[..] {
        last = Some(only);
    }
    last
}
