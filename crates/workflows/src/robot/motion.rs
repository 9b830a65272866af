//! Logs of the joints on one clock: the records that the rigid body is fitted to, and its torque back in each log.

use super::filters::Filters;
use super::load::{JointLogs, Loaded};
use crate::error::Error;
use crate::source::Source;
use stiction_identify as engine;
use stiction_identify::{Conditioning, FrictionAlong, Record, RigidFit, RobotJoint, Samples};
use stiction_log::{Found, Log};

/// Stamps of two joints that are closer than this part of a sample are one.
const SAME_STAMP: f64 = 0.1;

/// The records of all joints.
pub(super) struct Records {
    /// By joint, in the order of the loaded ones.
    pub of_joints: Vec<Record>,
    /// Whether the torque of a joint counts: it is logged, and the joint moves.
    pub counts: Vec<bool>,
}

/// Which logs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Fitted,
    HeldOut,
}

impl Part {
    pub fn of(self, joint: &JointLogs) -> &[Source] {
        match self {
            Part::Fitted => &joint.fitted,
            Part::HeldOut => &joint.held_out,
        }
    }

    pub fn of_mut(self, joint: &mut JointLogs) -> &mut [Source] {
        match self {
            Part::Fitted => &mut joint.fitted,
            Part::HeldOut => &mut joint.held_out,
        }
    }
}

impl Records {
    /// Conditions the logs of all joints alike.
    pub fn of(loaded: &Loaded, part: Part, conditioning: &Conditioning) -> Result<Self, Error> {
        let joints = &loaded.joints;
        let mut samples: Vec<Vec<Samples>> = vec![Vec::new(); joints.len()];
        for log in 0..part.of(&joints[0]).len() {
            let sources = joints.iter().map(|joint| part.of(joint).get(log));
            let sources: Option<Vec<&Source>> = sources.collect();
            let Some(sources) = sources else {
                return Err(Error::usage(
                    "logs without the same joints",
                    "logs that all have the same joints, or one log alone",
                ));
            };
            let together = together(&sources)?;
            for (own, together) in samples.iter_mut().zip(together) {
                own.push(together);
            }
        }
        let condition = |own: &Vec<Samples>| {
            engine::condition(own, conditioning).map_err(|e| refused(joints, part, e))
        };
        Ok(Self {
            of_joints: samples.iter().map(condition).collect::<Result<_, _>>()?,
            counts: joints
                .iter()
                .map(|joint| part.of(joint).iter().all(|source| moves(&source.log)))
                .collect(),
        })
    }

    /// The joints as the engine takes them, with shapes of their friction.
    pub fn joints<'a>(
        &'a self,
        loaded: &Loaded,
        frictions: &'a [Option<FrictionAlong>],
    ) -> Vec<RobotJoint<'a>> {
        let each = loaded.joints.iter().zip(&self.of_joints).enumerate();
        each.map(|(i, (joint, record))| RobotJoint {
            joint: joint.joint,
            record,
            counts: self.counts[i],
            friction: frictions.get(i).and_then(Option::as_ref),
        })
        .collect()
    }
}

/// Whether the friction of a joint can be seen in a log: it moves, and its force is logged.
fn moves(log: &Log) -> bool {
    log.force.is_some() && !log.finds(|found| matches!(found, Found::NoMotion { .. }))
}

/// An error of the engine about these logs.
pub(super) fn refused(joints: &[JointLogs], part: Part, source: engine::Error) -> Error {
    let logs = part.of(&joints[0]).iter();
    let names: Vec<String> = logs.map(|log| log.path.display().to_string()).collect();
    Error::identify(names.join(", "), source)
}

/// One log of all joints, at the rows that all of them have.
fn together(sources: &[&Source]) -> Result<Vec<Samples>, Error> {
    let start = sources
        .iter()
        .map(|s| s.log.start)
        .fold(f64::INFINITY, f64::min);
    let rate = sources.iter().map(|s| s.log.rate_hz).fold(0.0, f64::max);
    let stamps = |source: &Source| -> Vec<i64> {
        let late = source.log.start - start;
        let stamp = |t: &f64| ((late + t) * rate / SAME_STAMP).round() as i64;
        source.log.time.iter().map(stamp).collect()
    };
    let all: Vec<Vec<i64>> = sources.iter().map(|source| stamps(source)).collect();
    let in_all = |stamp: &i64| all.iter().all(|own| own.binary_search(stamp).is_ok());
    let common: Vec<i64> = all[0].iter().copied().filter(in_all).collect();
    let each = sources.iter().zip(&all);
    let own = each.map(|(source, own)| {
        let whole = samples(source)?;
        if own.len() == common.len() {
            return Ok(whole);
        }
        let rows: Vec<usize> = common
            .iter()
            .filter_map(|stamp| own.binary_search(stamp).ok())
            .collect();
        Ok(picked(&whole, &rows))
    });
    let mut joints: Vec<Samples> = own.collect::<Result<_, Error>>()?;
    // The rigid body needs the motion of all joints: what begins anew in one does so in all.
    let mut breaks: Vec<usize> = joints.iter().flat_map(|own| own.breaks.clone()).collect();
    breaks.sort_unstable();
    breaks.dedup();
    let time = joints[0].time.clone();
    for own in &mut joints {
        own.breaks.clone_from(&breaks);
        own.time.clone_from(&time);
    }
    Ok(joints)
}

/// What the rigid body needs of one joint, rests at the ends included.
fn samples(source: &Source) -> Result<Samples, Error> {
    let log = &source.log;
    let Some(position) = &log.position else {
        return Err(Error::usage(
            format!("{}: no position", source.name()),
            "the position of every joint, of which gravity and inertia depend",
        ));
    };
    let count = log.time.len();
    Ok(Samples {
        time: log.time.clone(),
        position: Some(position.clone()),
        force: log.force.clone().unwrap_or_else(|| vec![0.0; count]),
        valid: log.valid_in_motion(),
        at_rest: log.at_rest(),
        breaks: log.segments.iter().skip(1).map(|s| s.start).collect(),
        ..Samples::default()
    })
}

/// Some rows of samples.
fn picked(samples: &Samples, rows: &[usize]) -> Samples {
    let of =
        |x: &[f64]| -> Vec<f64> { rows.iter().filter_map(|row| x.get(*row)).copied().collect() };
    let flags =
        |x: &[bool]| -> Vec<bool> { rows.iter().filter_map(|row| x.get(*row)).copied().collect() };
    let breaks = samples.breaks.iter();
    Samples {
        time: of(&samples.time),
        position: samples.position.as_deref().map(of),
        force: of(&samples.force),
        valid: flags(&samples.valid),
        at_rest: flags(&samples.at_rest),
        breaks: breaks
            .map(|at| rows.partition_point(|row| row < at))
            .collect(),
        ..Samples::default()
    }
}

/// Gives each log of each joint the force of the rigid body as one that acts from outside.
pub(super) fn give_force(
    loaded: &mut Loaded,
    part: Part,
    filters: &Filters,
    records: &mut Records,
    rigid: &RigidFit,
) {
    let forces: Vec<_> = {
        let machine = loaded.logged(filters);
        let joints = records.joints(loaded, &[]);
        let force_on = |joint: &JointLogs| rigid.force_on(machine, &joints, joint.joint);
        loaded.joints.iter().map(force_on).collect()
    };
    let each = loaded.joints.iter_mut().zip(&mut records.of_joints);
    for ((joint, record), forces) in each.zip(forces) {
        for (segment, own) in record.segments.iter_mut().zip(&forces) {
            segment.channels.external = own.force.iter().map(|force| -force).collect();
        }
        for (at, source) in part.of_mut(joint).iter_mut().enumerate() {
            let segments = record.segments.iter().zip(&forces);
            let own: Vec<_> = segments.filter(|(segment, _)| segment.log == at).collect();
            let time = &source.log.time;
            let of_rigid = |values: &dyn Fn(usize) -> Vec<f64>| -> Vec<f64> {
                let mut out = vec![0.0; time.len()];
                for (i, (segment, _)) in own.iter().enumerate() {
                    let values = values(i);
                    let from = segment.time.first().copied().unwrap_or(0.0);
                    // Between two stretches each row takes the last one that begins before it.
                    let first = if i == 0 {
                        0
                    } else {
                        time.partition_point(|t| *t < from)
                    };
                    for (out, t) in out.iter_mut().zip(time).skip(first) {
                        *out = -read(&values, (t - from) / segment.step);
                    }
                }
                out
            };
            source.log.external = Some(of_rigid(&|i| own[i].1.force.clone()));
            let modes = own.first().map_or(0, |(_, force)| force.deviations.len());
            source.external_deviations = (0..modes)
                .map(|mode| of_rigid(&|i| own[i].1.deviations[mode].clone()))
                .collect();
        }
    }
}

/// A value between samples, those at the ends beyond them.
fn read(values: &[f64], at: f64) -> f64 {
    let last = values.len().saturating_sub(1);
    let before = (at.max(0.0) as usize).min(last);
    let part = (at - before as f64).clamp(0.0, 1.0);
    let one = values.get(before).copied().unwrap_or(0.0);
    let next = values.get((before + 1).min(last)).copied().unwrap_or(one);
    one + part * (next - one)
}
