//! An identification of a robot from logs to outcome: the rigid body of all joints, the friction of each, the rigid body again.

use super::assemble::{self, Parts};
use super::filters::Filters;
use super::findings;
use super::load::{Loaded, load};
use super::motion::{Part, Records, give_force, refused};
use super::options::{Files, Options};
use super::outcome::{self, JointOutcome, RobotOutcome};
use crate::error::Error;
use crate::identify::{self, Asked, Found, identify_asked};
use std::time::Instant;
use stiction_identify as engine;
use stiction_identify::{
    Delay, Estimate, FrictionAlong, LawKind, Observer, Prior, Record, RigidFit,
};
use stiction_say::OfRobot;

/// How often the friction of the joints and the rigid body beside it are fitted, all but the last time with one law. Source: simulated
/// arms, whose base parameters are in their intervals after three.
const ROUNDS: usize = 3;

/// Reads the logs of a robot, fits its rigid body and the friction of every joint, and judges them.
///
/// # Errors
/// Where an input cannot be read or nothing can be identified from it.
pub fn robot(
    files: &Files,
    options: &Options,
    observer: &mut dyn Observer,
) -> Result<RobotOutcome, Error> {
    let clock = Instant::now();
    let mut loaded = load(files, options)?;
    let found = findings::of_joints(&loaded);
    findings::refuse(&loaded, &found)?;
    loaded.notices.extend(found);
    let mut filters = Filters::of(&loaded);
    let records = Records::of(&loaded, Part::Fitted, &filters.of_rigid_body())?;
    let prior = Prior::of(&loaded.robot);
    let cutoff = engine::torque_cutoff(loaded.machine(), &records.joints(&loaded, &[]), &prior);
    filters = filters.behind(cutoff);
    for joint in &mut loaded.joints {
        joint.axis.conditioning = filters.of_joint(&joint.axis.conditioning);
        // All joints have one clock: what a single one would gain by a delay or a filter of its own is an error of the rigid body.
        if joint.axis.terms.delay == Delay::Fitted {
            joint.axis.terms.delay = Delay::NONE;
        }
    }
    // What differs between the directions is an error of the rigid body sooner than another friction.
    let own = identify::Options {
        seed: options.seed,
        symmetric: true,
        ..identify::Options::default()
    };
    let first = identify::Options {
        law: Some(LawKind::Dahl),
        compare_laws: false,
        ..own.clone()
    };
    let of_rigid_body = |part, loaded: &Loaded| Records::of(loaded, part, &filters.of_rigid_body());
    let mut records = of_rigid_body(Part::Fitted, &loaded)?;
    let mut held_out = match loaded.joints.iter().any(|joint| !joint.held_out.is_empty()) {
        true => Some(of_rigid_body(Part::HeldOut, &loaded)?),
        false => None,
    };
    let mut rigid = fit(&loaded, &records, &[], &prior)?;
    let names = loaded.joints.iter().filter(|joint| joint.fit);
    let names = names.map(|joint| loaded.robot.joints()[joint.joint].name.as_str());
    let folders = outcome::folders(names);
    let mut joints = Vec::new();
    for round in 0..ROUNDS {
        if round > 0 {
            let frictions = of_laws(&loaded, &records, &joints, engine::friction_along);
            rigid = fit(&loaded, &records, &frictions, &prior)?;
        }
        give_force(&mut loaded, Part::Fitted, &filters, &mut records, &rigid);
        if let Some(held_out) = &mut held_out {
            give_force(&mut loaded, Part::HeldOut, &filters, held_out, &rigid);
        }
        joints.clear();
        let each = loaded.joints.iter().filter(|joint| joint.fit);
        for (joint, folder) in each.zip(&folders) {
            let asked = Asked {
                options: if round == 0 { &first } else { &own },
                axis: &joint.axis,
                clock,
            };
            let (fitted, held_out) = (joint.fitted.clone(), joint.held_out.clone());
            let outcome = identify_asked(asked, fitted, held_out, observer);
            let name = loaded.robot.joints()[joint.joint].name.clone();
            joints.push(JointOutcome::new(name, folder.clone(), outcome, joint));
        }
    }
    let fitted = left(&loaded, &records, &rigid, &joints);
    let unseen = held_out.as_ref();
    let unseen = unseen.map(|records| left(&loaded, records, &rigid, &joints));
    let deviations = rigid.deviations(loaded.machine(), &records.joints(&loaded, &[]));
    for joint in &mut joints {
        let mut all = loaded.joints.iter().zip(&deviations);
        let own = all.find(|(own, _)| loaded.robot.joints()[own.joint].name == joint.name);
        joint.rigid_deviation = own.map_or(0.0, |(_, deviation)| *deviation);
        for (place, all) in [Some(&fitted), unseen.as_ref()].into_iter().enumerate() {
            let own = all.and_then(|all| all.iter().find(|(name, _)| *name == joint.name));
            joint.left[place] = own.map_or(Vec::new(), |(_, left)| left.clone());
        }
    }
    let mut notices = std::mem::take(&mut loaded.notices);
    notices.extend(findings::of_urdf(&loaded.robot, &prior, &rigid));
    notices.extend(cutoff.map(|hertz| OfRobot::Filtered { hertz }));
    let result = assemble::result(Parts {
        loaded: &loaded,
        filters: &filters,
        rigid: &rigid,
        joints: &joints,
        notices,
        seed: options.seed,
    })?;
    Ok(RobotOutcome {
        result,
        urdf: loaded.urdf,
        rigid,
        joints,
    })
}

/// Something of the law of each joint on the records; `None` of one that could not be fitted.
fn of_laws<T>(
    loaded: &Loaded,
    records: &Records,
    joints: &[JointOutcome],
    of: impl Fn(&Record, &Estimate) -> T,
) -> Vec<Option<T>> {
    let each = loaded.joints.iter().zip(&records.of_joints);
    each.map(|(joint, record)| {
        let name = &loaded.robot.joints()[joint.joint].name;
        let own = joints.iter().find(|own| own.name == *name)?;
        match &own.outcome.as_ref().ok()?.found {
            Found::Force(fit) => Some(of(record, &fit.estimate)),
            _ => None,
        }
    })
    .collect()
}

/// What the whole model leaves of the torque of each joint on these records.
fn left(
    loaded: &Loaded,
    records: &Records,
    rigid: &RigidFit,
    joints: &[JointOutcome],
) -> Vec<(String, Vec<f64>)> {
    let of_joints = records.joints(loaded, &[]);
    let forces = rigid.at_samples(loaded.machine(), &of_joints);
    let models = of_laws(loaded, records, joints, |record, law| {
        engine::predict(record, law).model
    });
    let each = of_joints.iter().zip(forces).zip(models);
    each.map(|((own, rigid), friction)| {
        let name = loaded.robot.joints()[own.joint].name.clone();
        let measured = own.record.gather(|s| &s.force);
        let parts = measured.iter().zip(rigid).zip(friction.unwrap_or_default());
        (
            name,
            parts
                .map(|((u, rigid), friction)| u - rigid - friction)
                .collect(),
        )
    })
    .collect()
}

fn fit(
    loaded: &Loaded,
    records: &Records,
    frictions: &[Option<FrictionAlong>],
    prior: &Prior,
) -> Result<RigidFit, Error> {
    let joints = records.joints(loaded, frictions);
    let found = engine::rigid_fit(loaded.machine(), &joints, prior);
    found.map_err(|e| refused(&loaded.joints, Part::Fitted, e))
}
