//! A robot: the friction of all joints, each as a model of its own, and the rigid body of a URDF.

mod body;
mod c;
mod isaac_lab;
mod mujoco;
mod names;
pub(crate) mod python;

pub use names::joint_identifiers;

use crate::joint::{Joint, at_rest, six_digits};
use crate::model::Provenance;
use crate::{
    Draws, Error, File, Model, Target, bam, check, check_identifier, domain, header, newton, ros2,
};
use body::Body;
use stiction_rigid::urdf::{Inertial, Kind};
use stiction_rigid::{NewDynamics, NewInertial, rewrite};

/// A robot whose joints have a friction law each.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Name of the robot, any text.
    pub title: String,
    /// What the names in the code begin with; see [`identifier`](crate::identifier).
    pub identifier: String,
    /// Text of the URDF; the identified numbers are written into it.
    pub urdf: String,
    /// Identified inertias of links, in the directions of their frames.
    pub inertials: Vec<(String, Inertial)>,
    /// Gravity in the frame of the root link, m/s².
    pub gravity: [f64; 3],
    /// What the robot carries, which is not part of the URDF.
    pub load: Option<Load>,
    /// Joints whose friction was identified, in the order of the URDF.
    pub joints: Vec<RobotJoint>,
    /// Whether the code also feeds forward gravity, inertia and Coriolis forces; [`Target::C`] only.
    pub feeds_rigid: bool,
    /// Draws from the ranges of the joints, for `domain-json`, `mujoco`, `isaaclab`, `newton` and `bam`.
    pub draws: Option<Draws>,
    /// Sentences for the head of every file.
    pub notes: Vec<String>,
    /// Where the numbers came from; the model file is that of the robot.
    pub provenance: Provenance,
}

/// A joint whose friction was identified.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotJoint {
    /// Name in the URDF.
    pub name: String,
    /// Its friction. The names in the code are those of [`joint_identifiers`].
    pub model: Model,
    /// Inertia of the rotor at the joint, kg m² or kg.
    pub armature: f64,
    /// Coulomb friction, N m or N, and viscous friction, N m s/rad or N s/m, as simulators take them; if absent the nearest to the
    /// law.
    pub simulators: Option<[f64; 2]>,
}

/// A load on a link, a point mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Name of the link.
    pub link: String,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the frame of the link, m.
    pub center: [f64; 3],
}

/// The targets that take a robot, in words.
pub(crate) const TARGETS: &str = "urdf, mujoco, isaaclab, newton, bam, domain-json, ros2 and c";

/// The files of a robot for a target.
///
/// # Errors
/// If the target takes no robot or cannot express a joint, or the URDF does not have the joints.
pub fn export_robot(robot: &Robot, target: Target) -> Result<Vec<File>, Error> {
    check_identifier(&robot.identifier)?;
    if robot.feeds_rigid && target != Target::C {
        return Err(Error::RobotFeedforward {
            target: target.name(),
        });
    }
    let mut robot = named(robot)?;
    robot.urdf = rewritten(&robot, target)?;
    for joint in &robot.joints {
        let checked = check::check(&joint.model, target.narrowest());
        checked.map_err(|e| joint.refused(e))?;
    }
    let mut files = of_target(&robot, target)?;
    if target == Target::DomainJson || target.takes_draws() && robot.draws.is_some() {
        let head = domain::Head {
            identifier: &robot.identifier,
            title: &robot.title,
            notes: robot.notes.clone(),
            provenance: &robot.provenance,
            comment: comment(&robot, "# ", false),
        };
        let joints = owns(&robot, target.name())?;
        files.extend(domain::files(&head, &joints, robot.draws.as_ref()));
    }
    Ok(files)
}

/// The joints as simulators take them.
fn owns<'a>(robot: &'a Robot, target: &'static str) -> Result<Vec<domain::Own<'a>>, Error> {
    let own = |joint: &'a RobotJoint| {
        let steady = joint.steady(target)?;
        let numbers = [steady.friction, steady.damping];
        Ok(domain::Own::of_robot(
            &joint.name,
            &joint.model,
            joint.armature,
            numbers,
        ))
    };
    robot.joints.iter().map(own).collect()
}

fn of_target(robot: &Robot, target: Target) -> Result<Vec<File>, Error> {
    match target {
        Target::Newton => {
            let joints = owns(robot, "newton")?;
            let head = comment(robot, "# ", true);
            let mut files = vec![urdf(robot)];
            files.extend(newton::files(&robot.identifier, head, &joints));
            Ok(files)
        }
        Target::Bam => {
            let each = robot.joints.iter().map(|joint| {
                let steady = joint.steady("bam")?;
                let numbers = [steady.friction, steady.damping];
                bam::file(&joint.model, Some(joint.armature), numbers).map_err(|e| joint.refused(e))
            });
            each.collect()
        }
        Target::DomainJson => Ok(Vec::new()),
        Target::Urdf => Ok(vec![urdf(robot)]),
        Target::Mujoco => mujoco::files(robot),
        Target::IsaacLab => isaac_lab::files(robot),
        Target::Ros2 => ros2_package(robot),
        Target::C => c::files(robot),
        other => Err(Error::NoRobot {
            target: other.name(),
        }),
    }
}

/// The robot with identifiers and titles of its joints that are distinct.
fn named(robot: &Robot) -> Result<Robot, Error> {
    let body = Body::of(robot)?;
    let names: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
    for (i, name) in names.iter().enumerate() {
        let reason = match body.robot.joint(name) {
            None => "the URDF has no such moving joint",
            Some(own) if body.robot.joints()[own].mimic.is_some() => {
                "it follows another joint in the URDF"
            }
            Some(_) if names[..i].contains(name) => "it is given twice",
            Some(own) => match (body.robot.joints()[own].kind, robot.joints[i].model.rotary) {
                (Kind::Prismatic, true) => {
                    "it slides, and its friction law is of a joint that turns"
                }
                (Kind::Revolute | Kind::Continuous, false) => {
                    "it turns, and its friction law is of a joint that slides"
                }
                _ => continue,
            },
        };
        return Err(Error::RobotJoint {
            joint: name.to_string(),
            reason,
        });
    }
    let mut out = robot.clone();
    let identifiers = joint_identifiers(&robot.identifier, &names);
    for (joint, identifier) in out.joints.iter_mut().zip(identifiers) {
        joint.model.identifier = identifier;
        joint.model.title = format!("{}, joint {}", robot.title, joint.name);
    }
    Ok(out)
}

/// The URDF with the identified inertias and, for a simulation, friction.
fn rewritten(robot: &Robot, target: Target) -> Result<String, Error> {
    let inertials = robot.inertials.iter().map(|(link, inertial)| NewInertial {
        link,
        inertial: *inertial,
    });
    let mut dynamics = Vec::new();
    for joint in robot.joints.iter().filter(|_| target.is_simulated()) {
        let steady = joint.steady(target.name())?;
        dynamics.push(NewDynamics {
            joint: &joint.name,
            damping: steady.damping,
            friction: steady.friction,
        });
    }
    let inertials: Vec<_> = inertials.collect();
    Ok(rewrite(&robot.urdf, &inertials, &dynamics)?)
}

/// Friction of a joint as simulators have it: `sgn(v) friction + damping v`, and static friction.
struct Steady {
    friction: f64,
    damping: f64,
    at_rest: f64,
}

impl RobotJoint {
    /// An error with the name of the joint.
    fn refused(&self, source: Error) -> Error {
        Error::OfJoint {
            joint: self.name.clone(),
            source: Box::new(source),
        }
    }

    /// Refuses a torque in another unit than N m, or force than N.
    fn in_newtons(&self, target: &'static str) -> Result<(), Error> {
        let model = &self.model;
        if model.in_newtons() {
            return Ok(());
        }
        Err(self.refused(Error::ForceUnit {
            target,
            found: model.force_unit().into(),
            allowed: if model.rotary { "N m" } else { "N" },
        }))
    }

    /// Its friction in SI.
    fn steady(&self, target: &'static str) -> Result<Steady, Error> {
        self.in_newtons(target)?;
        let model = &self.model;
        let nearest = Joint::of(model);
        let own = self.simulators;
        let [friction, damping] = own
            .unwrap_or([nearest.friction, nearest.damping])
            .map(six_digits);
        Ok(Steady {
            friction,
            damping,
            at_rest: six_digits(at_rest(&model.friction)).max(friction),
        })
    }
}

fn urdf(robot: &Robot) -> File {
    File::text(format!("{}.urdf", robot.identifier), robot.urdf.clone())
}

/// The head of a file of all joints; with the parameters of each where `parameters`.
fn comment(robot: &Robot, prefix: &str, parameters: bool) -> String {
    let count = robot.joints.len();
    let mut lines = vec![format!(
        "Friction of {count} joints of the robot '{}', written by stiction {}.",
        robot.title, robot.provenance.version
    )];
    if !robot.notes.is_empty() {
        lines.push(String::new());
        lines.extend(robot.notes.iter().map(|note| format!("NOTE: {note}")));
    }
    lines.push(String::new());
    lines.push(format!(
        "Robot file: sha256 {}",
        robot.provenance.model_sha256
    ));
    for (path, hash) in &robot.provenance.inputs {
        lines.push(format!("Identified from {path}, sha256 {hash}"));
    }
    for joint in robot.joints.iter().filter(|_| parameters) {
        lines.push(String::new());
        lines.extend(header::lines(&joint.model, false));
    }
    let plain: Vec<String> = lines.iter().map(|line| header::plain(line)).collect();
    header::joined(&plain, prefix)
}

/// A package with the classes of all joints and one file of parameters.
fn ros2_package(robot: &Robot) -> Result<Vec<File>, Error> {
    let mut yaml = format!(
        "{}\n#\n# For --params-file of ros2 run, or parameters of a launch file.\n/**:\n  ros__parameters:\n",
        comment(robot, "# ", false)
    );
    let mut files = Vec::new();
    for joint in &robot.joints {
        let refused = |e| joint.refused(e);
        let folder = format!("test/{}", joint.model.identifier);
        files.extend(ros2::classes(&joint.model, &folder).map_err(refused)?);
        yaml.push_str(&ros2::parameters(&joint.model).map_err(refused)?);
    }
    let path = format!("config/{}_friction.yaml", robot.identifier);
    files.push(File::text(path, yaml));
    Ok(files)
}
