//! URDF and logs to the logs of each joint.

use super::coupled;
use super::filters::Filters;
use super::options::{Files, Options};
use crate::error::Error;
use crate::identify::check_share;
use crate::source::{Source, mapped, whole};
use crate::wording::Setting;
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use stiction_files::Robot;
use stiction_files::axis::{Use, entry};
use stiction_formats::Table;
use stiction_identify::Machine;
use stiction_log::mapping::{JointColumns, Parts, assume_units, joints};
use stiction_log::{Found, Motion, Role, Selector, republished};
use stiction_number::short;
use stiction_rigid as rigid;
use stiction_rigid::urdf::Kind;
use stiction_say::OfRobot;

/// Largest URDF, bytes.
const LARGEST_URDF: u64 = rigid::urdf::MOST_BYTES as u64;

/// A URDF as it was read.
#[derive(Clone, Debug)]
pub struct Urdf {
    /// Path as given.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// SHA-256 of the text.
    pub sha256: String,
}

/// The logs of one joint, of which the first are fitted.
pub(super) struct JointLogs {
    /// Its number in the robot.
    pub joint: usize,
    /// Whether its friction is to be fitted.
    pub fit: bool,
    pub axis: stiction_files::Axis,
    pub fitted: Vec<Source>,
    pub held_out: Vec<Source>,
}

/// Everything that is read.
pub(super) struct Loaded {
    pub file: Robot,
    pub urdf: Urdf,
    pub robot: rigid::Robot,
    /// Where each joint stands that was not logged, rad or m.
    pub at: Vec<f64>,
    /// In the order of the robot.
    pub joints: Vec<JointLogs>,
    pub notices: Vec<OfRobot>,
}

impl Loaded {
    /// The robot as the engine takes it, with torques as they act.
    pub fn machine(&self) -> Machine<'_> {
        Machine {
            robot: &self.robot,
            at: &self.at,
            channel: None,
        }
    }

    /// The same with torques as they are logged.
    pub fn logged<'a>(&'a self, filters: &'a Filters) -> Machine<'a> {
        Machine {
            channel: filters.channel.as_ref(),
            ..self.machine()
        }
    }
}

/// Reads what an identification of a robot starts from.
pub(super) fn load(files: &Files, options: &Options) -> Result<Loaded, Error> {
    if let Some(part) = options.split {
        check_share(part)?;
    }
    let file = match &files.robot {
        Some(path) => Robot::read(path)?,
        None => Robot::default(),
    };
    let given = files.urdf.as_ref().or(file.urdf.as_ref());
    let path = given.ok_or_else(|| {
        Error::usage(
            "no URDF, whose links and joints the rigid body follows from",
            [
                Setting::Urdf.is("ARM.urdf"),
                ", or urdf = \"ARM.urdf\" in robot.toml".into(),
            ],
        )
    })?;
    let urdf = read_urdf(path)?;
    let refused = |source| Error::Urdf {
        file: urdf.path.clone(),
        source: Box::new(source),
    };
    let document = rigid::Document::parse(&urdf.text).map_err(refused)?;
    let mut robot = rigid::Robot::new(&document).map_err(refused)?;
    if let Some(gravity) = file.gravity {
        robot.set_gravity(gravity);
    }
    if let Some(tool) = &file.tool {
        let attached = robot.attach(&tool.link, tool.mass, tool.center, [0.0; 6]);
        attached.map_err(|e| file.refuse("tool", e.to_string(), "a link of the URDF"))?;
    }
    check_names(&file, &robot)?;
    let mut notices: Vec<OfRobot> = robot.findings().iter().map(notice).collect();
    let independent = robot.independent();
    let names: Vec<&str> = independent
        .iter()
        .map(|joint| robot.joints()[*joint].name.as_str())
        .collect();
    if files.logs.is_empty() {
        return Err(Error::usage(
            "no log given",
            "at least one log of the robot",
        ));
    }
    let motions: Vec<Motion> = independent
        .iter()
        .map(|joint| motion_of(robot.joints()[*joint].kind))
        .collect();
    let mut of_each: Vec<JointLogs> = Vec::new();
    let all = files.logs.iter().map(|path| (path, false));
    let all = all.chain(files.validate.iter().map(|path| (path, true)));
    for (path, held_out) in all {
        let (table, sha256) = whole(path, file.axis())?;
        let mut found = joints(&table, &names).map_err(|e| Error::File(e.in_file(path).into()))?;
        if assume_units(&table, &mut found, &motions) {
            notices.push(OfRobot::UnitsAssumed);
        }
        let stamps = stamps(&file, &robot, &independent, &found, &table);
        let republished = stamps.and_then(|time| republished(&table, time, &found));
        let table = match republished {
            Some(again) => {
                notices.push(OfRobot::Republished {
                    repeats: again.repeats,
                    hertz: again.rate_hz,
                });
                again.table
            }
            None => table,
        };
        let log = Log {
            path,
            sha256,
            table,
            found,
        };
        let split = options.split.filter(|_| !held_out);
        for (place, joint) in independent.iter().enumerate() {
            let Some(axis) = axis_of(&file, &robot, *joint, &log.found[place]) else {
                continue;
            };
            let own = match of_each.iter_mut().find(|own| own.joint == *joint) {
                Some(own) => own,
                None => {
                    let name = &robot.joints()[*joint].name;
                    of_each.push(JointLogs {
                        joint: *joint,
                        fit: file.joint(name).is_none_or(|own| own.fit),
                        axis: axis.clone(),
                        fitted: Vec::new(),
                        held_out: Vec::new(),
                    });
                    of_each.last_mut().expect("one was added")
                }
            };
            log.read_into(own, &axis, split, held_out)?;
        }
    }
    of_each.sort_by_key(|own| own.joint);
    if !of_each.iter().any(|own| own.fit) {
        return Err(no_joint(&files.logs[0], &names));
    }
    check_units(&robot, &of_each)?;
    coupled::uncouple(&file, &robot, &mut of_each)?;
    let mut at = vec![0.0; robot.len()];
    for joint in &independent {
        let joint_of = &robot.joints()[*joint];
        let stated = file.joint(&joint_of.name).and_then(|own| own.at);
        if of_each.iter().any(|own| own.joint == *joint) {
            if stated.is_some() {
                let key = format!("joint.{}.at", joint_of.name);
                let found = "the log has its position";
                let allowed = "joints that are not logged; leave this out";
                return Err(file.refuse(&key, found, allowed).into());
            }
            continue;
        }
        let limit = joint_of.limit;
        let within = 0.0_f64
            .max(limit.lower.unwrap_or(f64::NEG_INFINITY))
            .min(limit.upper.unwrap_or(f64::INFINITY));
        at[*joint] = stated.map_or(within, |(at, _)| at);
        if stated.is_none() {
            notices.push(OfRobot::NotLogged {
                joint: joint_of.name.clone(),
                at: at[*joint],
                unit: unit_of(joint_of.kind),
            });
        }
    }
    Ok(Loaded {
        file,
        urdf,
        robot,
        at,
        joints: of_each,
        notices,
    })
}

/// A log whose columns have been given to joints.
struct Log<'a> {
    path: &'a Path,
    sha256: String,
    table: Table,
    found: Vec<JointColumns>,
}

impl Log<'_> {
    /// Reads the log of one joint, in two parts where it is to be split.
    fn read_into(
        &self,
        joint: &mut JointLogs,
        axis: &stiction_files::Axis,
        split: Option<f64>,
        held_out: bool,
    ) -> Result<(), Error> {
        let read = |axis: &stiction_files::Axis| -> Result<Source, Error> {
            let sha256 = self.sha256.clone();
            let table = Cow::Borrowed(&self.table);
            let mut source = mapped(self.path, sha256, table, axis, (None, Use::Fitted))?;
            // Gravity and coupling drive a joint and are driven by it.
            let of_sign = |found: &Found| matches!(found, Found::ForceBrakes { .. });
            source
                .log
                .findings
                .retain(|finding| !of_sign(&finding.kind));
            Ok(source)
        };
        let source = read(axis)?;
        let Some(part) = split else {
            match held_out {
                true => joint.held_out.push(source),
                false => joint.fitted.push(source),
            }
            return Ok(());
        };
        let first = axis.mapping.crop.map_or(0.0, |(from, _)| from);
        let length = source.log.time.last().copied().unwrap_or(0.0);
        let until = first + part * length;
        let within = |from: f64, to: f64| {
            let mut axis = axis.clone();
            axis.mapping.parts = Some(Parts::inside(vec![(from, to)]));
            let mut source = read(&axis)?;
            source.part = Some(format!("{} to {} s", short(from), short(to)));
            Ok::<_, Error>(source)
        };
        joint.fitted.push(within(first, until)?);
        joint.held_out.push(within(until, first + length)?);
        Ok(())
    }
}

/// Refuses currents and other drives of joints of which no gain is known: nothing in them is a torque.
fn check_units(robot: &rigid::Robot, joints: &[JointLogs]) -> Result<(), Error> {
    let mut lines = Vec::new();
    let mut units = Vec::new();
    for own in joints {
        let Some(source) = own.fitted.iter().chain(&own.held_out).next() else {
            continue;
        };
        let log = &source.log;
        let torque = log.motion.force().si_text();
        if log.force.is_none() || log.force_unit == torque {
            continue;
        }
        let joint = &robot.joints()[own.joint].name;
        let channel = log.mapping.force.as_ref();
        let column = channel.map_or_else(String::new, entry);
        let (unit, quoted) = (&log.force_unit, stiction_files::robot::model::quoted(joint));
        lines.push(format!(
            "[joint.{quoted}]\ntorque = {}, scale = \"GAIN {torque}/{unit}\" }}",
            column.trim_end_matches(" }")
        ));
        units.push(format!("{joint} ({unit})"));
    }
    match lines.is_empty() {
        true => Ok(()),
        false => Err(Error::usage(
            format!("no gain is known of what drives {}", units.join(", ")),
            format!(
                "torque for each unit of it, at the joint, in robot.toml:\n{}",
                lines.join("\n")
            ),
        )),
    }
}

/// The column of the time stamps, by the first joint that has columns.
fn stamps(
    file: &Robot,
    robot: &rigid::Robot,
    joints: &[usize],
    found: &[JointColumns],
    table: &Table,
) -> Option<usize> {
    let mut axes = joints.iter().zip(found);
    let axis = axes.find_map(|(joint, found)| axis_of(file, robot, *joint, found))?;
    let time = axis.mapping.complete(table).ok()?.mapping.time?;
    match time.column {
        Selector::Index(number) => table.index(number),
        Selector::Name(name) => table.columns.iter().position(|column| column.name == name),
    }
}

/// The axis of a joint; `None` where the log has neither a position nor a velocity of it.
fn axis_of(
    file: &Robot,
    robot: &rigid::Robot,
    joint: usize,
    found: &JointColumns,
) -> Option<stiction_files::Axis> {
    let joint = &robot.joints()[joint];
    let axis = file.axis_of(&joint.name, motion_of(joint.kind), found);
    let is_there = |role| axis.mapping.channel(role).is_some();
    (is_there(Role::Position) || is_there(Role::Velocity)).then_some(axis)
}

/// Whether such a joint turns or slides.
fn motion_of(kind: Kind) -> Motion {
    match kind {
        Kind::Prismatic => Motion::Linear,
        _ => Motion::Rotary,
    }
}

/// Refuses names in the robot file that the URDF does not have.
fn check_names(file: &Robot, robot: &rigid::Robot) -> Result<(), Error> {
    let allowed = || {
        let names = robot.joints().iter().map(|joint| joint.name.as_str());
        format!(
            "a joint of the URDF: {}",
            names.collect::<Vec<_>>().join(", ")
        )
    };
    if let Some(name) = file.names().find(|name| robot.joint(name).is_none()) {
        let key = format!("joint.{name}");
        return Err(file
            .refuse(&key, "is no joint that moves", &allowed())
            .into());
    }
    for (i, coupling) in file.couplings.iter().enumerate() {
        if let Some(name) = coupling
            .joints
            .iter()
            .find(|name| robot.joint(name).is_none())
        {
            let key = format!("coupling[{}].joints", i + 1);
            let found = format!("{name:?} is no joint that moves");
            return Err(file.refuse(&key, found, &allowed()).into());
        }
    }
    Ok(())
}

fn no_joint(log: &Path, names: &[&str]) -> Error {
    let first = names.first().copied().unwrap_or("NAME");
    Error::usage(
        format!(
            "{} has no columns of the joints {}",
            log.display(),
            names.join(", ")
        ),
        format!(
            "name them in robot.toml, for each joint as in: [joint.{first}] position = \"q1\" torque = {{ column = \"i1\", scale = \
             \"9.8 N*m/A\" }}"
        ),
    )
}

/// Reads the text of a URDF.
pub(crate) fn read_urdf(path: &Path) -> Result<Urdf, Error> {
    let refused = |reason: String| {
        Error::usage(
            format!("{}: {reason}", path.display()),
            "a URDF of the robot",
        )
    };
    let about = stiction_formats::regular(path).map_err(|_| refused("cannot be read".into()))?;
    if about.len() > LARGEST_URDF {
        return Err(refused(format!("has {} bytes", about.len())));
    }
    let text = std::fs::read_to_string(path).map_err(|e| refused(e.to_string()))?;
    Ok(Urdf {
        path: path.to_path_buf(),
        sha256: stiction_files::sha256_of(text.as_bytes()),
        text,
    })
}

fn notice(finding: &rigid::Finding) -> OfRobot {
    match finding.clone() {
        rigid::Finding::NoInertia { link, line } => OfRobot::NoInertia { link, line },
        rigid::Finding::NoLeader { joint, line, of } => OfRobot::NoLeader {
            joint,
            line,
            leader: of,
        },
        rigid::Finding::NotPhysical {
            link,
            line,
            principal,
        } => OfRobot::NotPhysical {
            link,
            line,
            principal,
        },
    }
}

/// The unit of a position of such a joint.
pub(super) fn unit_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Prismatic => "m",
        _ => "rad",
    }
}
