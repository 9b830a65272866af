//! A robot file with identified joints to code and files of simulators.

use super::asked::few_enough;
use super::{ExportOptions, File, check, domain, place, resolve};
use crate::error::Error;
use crate::robot::read_urdf;
use crate::wording::Setting;
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_export::{Error as ExportError, Load, Provenance, RobotJoint, Target};
use stiction_files::model::ReadModel;
use stiction_files::robot::{IdentifiedBody, IdentifiedJoint, IdentifiedRobot};
use stiction_files::{Robot, Warning, write_folder};
use stiction_rigid::GRAVITY;
use stiction_rigid::urdf::{Inertial, Pose};
use stiction_say::{Notice, OfRobot};

/// The files of all joints of a robot.
#[derive(Clone, Debug, serde::Serialize)]
#[non_exhaustive]
pub struct ExportedRobot {
    /// The target.
    pub target: &'static str,
    /// Beginning of the names in the code.
    pub name: String,
    /// Time between two calls, s.
    pub cycle_time: f64,
    /// The joints, in the order of the robot file.
    pub joints: Vec<ExportedJoint>,
    /// Paths of the files, relative to their folder.
    pub written: Vec<String>,
    /// The files.
    #[serde(skip)]
    pub files: Vec<File>,
    /// What to know before it runs.
    pub warnings: Vec<Warning>,
    /// Whether the friction law of every joint may be used to compensate.
    pub trustworthy: bool,
}

/// A joint of an export.
#[derive(Clone, Debug, serde::Serialize)]
#[non_exhaustive]
pub struct ExportedJoint {
    /// Name in the URDF.
    pub joint: String,
    /// Friction law.
    pub law: String,
    /// Largest friction that is compensated, in `force_unit`.
    pub limit: f64,
    /// Unit of the torque.
    pub force_unit: String,
}

impl ExportedRobot {
    /// Writes the files into `dir`, as [`Exported::write`](super::Exported::write).
    ///
    /// # Errors
    /// When the folder holds something else, a file to be replaced was changed, or it cannot be written.
    pub fn write(&self, dir: impl AsRef<Path>, force: bool) -> Result<(), Error> {
        let files = self.files.iter();
        let files = files.map(|f| (f.path.as_str(), f.bytes.as_slice()));
        Ok(write_folder(dir, files, force)?)
    }
}

/// The joints of a robot file that an identification wrote, as files of a target. `urdf` stands for the URDF that the file names.
///
/// # Errors
/// When a file cannot be read or has nothing identified, the target takes no robot, or a joint cannot be exported.
pub fn export_robot_file(
    file: impl AsRef<Path>,
    urdf: Option<&Path>,
    options: &ExportOptions,
) -> Result<ExportedRobot, Error> {
    check(options)?;
    of_all(options)?;
    let file = file.as_ref();
    let robot = Robot::read(file)?;
    let found = robot.identified().filter(|own| !own.joints.is_empty());
    let found = found.ok_or_else(|| {
        let allowed = "the robot.toml that stiction robot writes, with [joint.NAME.identified]";
        robot.refuse("joint", "no joint is identified", allowed)
    })?;
    let path = match urdf.map(PathBuf::from).or_else(|| robot.urdf.clone()) {
        Some(path) => path,
        None => {
            let allowed = "urdf = \"ROBOT.urdf\" here, or --urdf ROBOT.urdf";
            return Err(robot.refuse("urdf", "is missing", allowed).into());
        }
    };
    let read = read_urdf(&path)?;
    let mut warnings = Vec::new();
    if found
        .urdf_sha256
        .as_ref()
        .is_some_and(|sum| *sum != read.sha256)
    {
        let path = path.display().to_string();
        warnings.push(Notice::Robot(OfRobot::OtherUrdf { path }).into());
    }
    let lacks = lacks(&robot, found, options.target);
    warnings.extend(lacks.into_iter().map(|own| Notice::Robot(own).into()));
    let title = robot.name.clone().unwrap_or_else(|| "robot".into());
    let identifier = match &options.name {
        Some(name) => name.clone(),
        None => stiction_export::identifier(&title),
    };
    let notes = warnings
        .iter()
        .map(|w: &Warning| w.message.clone())
        .collect();
    let joints = joints(found, options, &mut warnings)?;
    few_enough(options, joints.iter().map(|(_, joint)| &joint.model))?;
    let exported = stiction_export::Robot {
        identifier,
        urdf: read.text,
        inertials: found.bodies.iter().map(inertial).collect(),
        gravity: robot.gravity.unwrap_or(GRAVITY),
        load: robot.tool.as_ref().map(|tool| Load {
            link: tool.link.clone(),
            mass: tool.mass,
            center: tool.center,
        }),
        feeds_rigid: options.feedforward.rigid,
        draws: options.draws,
        notes,
        provenance: Provenance {
            model_sha256: robot.file().map_or(String::new(), |(_, sum)| sum.into()),
            ..joints[0].1.model.provenance.clone()
        },
        joints: joints.iter().map(|(_, joint)| joint.clone()).collect(),
        title,
    };
    let files = stiction_export::export_robot(&exported, options.target);
    let files = files.map_err(|e| of_joint(e, &path, &joints, options))?;
    let told = |(read, joint): &(ReadModel, RobotJoint)| ExportedJoint {
        joint: joint.name.clone(),
        law: read.model.law.clone(),
        limit: joint.model.settings.limit,
        force_unit: joint.model.force_unit.clone(),
    };
    Ok(ExportedRobot {
        target: options.target.name(),
        name: exported.identifier,
        cycle_time: options.cycle_time,
        joints: joints.iter().map(told).collect(),
        written: files.iter().map(|f| f.path.clone()).collect(),
        files,
        warnings,
        trustworthy: joints.iter().all(|(read, _)| read.model.trustworthy),
    })
}

/// What is known of a robot and has no place in the files of a target.
fn lacks(robot: &Robot, found: &IdentifiedRobot, target: Target) -> Vec<OfRobot> {
    let mut out = Vec::new();
    if !target.is_simulated() {
        let coupled = robot.couplings.iter().map(|own| own.joints.clone());
        out.extend(coupled.map(|joints| OfRobot::Coupled { joints }));
        return out;
    }
    let target_name = target.name();
    out.extend(robot.tool.as_ref().map(|tool| OfRobot::ToolLeftOut {
        link: tool.link.clone(),
        mass: tool.mass,
        target: target_name,
    }));
    if target == Target::Urdf && found.joints.iter().any(|joint| joint.armature > 0.0) {
        out.push(OfRobot::ArmatureLeftOut {
            target: target_name,
        });
    }
    out
}

/// Refuses options that are no options of all joints together.
fn of_all(options: &ExportOptions) -> Result<(), Error> {
    let own = [
        ("limit", options.limit),
        ("slew", options.safety.slew),
        ("dead zone", options.safety.dead_zone),
    ];
    let allowed =
        "each has its own from its law; export the model.toml of a joint by itself to give another";
    if let Some((what, _)) = own.iter().find(|(_, value)| value.is_some()) {
        return Err(Error::usage(
            format!("one {what} for all joints of a robot"),
            allowed,
        ));
    }
    if options.adapt {
        return Err(Error::usage(
            "levels that follow the machine for a robot: they would take torques of the other joints for friction",
            ["leave out ".into(), Setting::Adapt.into()],
        ));
    }
    let fed = options.feedforward;
    if fed.mass || fed.gravity || fed.cogging {
        return Err(Error::usage(
            format!("a feedforward of {} for a robot", fed.names().join(", ")),
            "friction, and rigid for gravity and inertia of the whole robot",
        ));
    }
    Ok(())
}

/// The models of the joints; what is doubtful about one is told with its name.
fn joints(
    found: &IdentifiedRobot,
    options: &ExportOptions,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<(ReadModel, RobotJoint)>, Error> {
    let mut options = ExportOptions {
        // Those in the code are distinct names of joints.
        name: Some("joint".into()),
        ..options.clone()
    };
    options.feedforward.rigid = false;
    let steady = options.target.is_simulated();
    // In MuJoCo most joints have two numbers, as they have in a URDF.
    let advised = match options.target {
        Target::Bam | Target::DomainJson => options.target,
        _ if steady => Target::Urdf,
        own => own,
    };
    let each = found.joints.iter().map(|joint: &IdentifiedJoint| {
        let mut read = ReadModel::read(&joint.model)?;
        let whole = read.model.clone();
        // The inertia beside friction is that of the rotor, which the robot file has.
        read.model.parameter.retain(|p| p.name != "mass");
        let (mut model, mut doubts) = resolve(&read, &options)?;
        let simulators = match joint.simulators {
            None if steady => {
                // The whole law, of which a target of bristles leaves terms out.
                let whole = ExportOptions {
                    target: Target::Urdf,
                    ..options.clone()
                };
                Some(stiction_export::nearest_line(&resolve(&read, &whole)?.0))
            }
            own => own,
        };
        let advice = stiction_export::advice(&model, advised).into_iter();
        doubts.extend(advice.map(|a| Warning::new(a.code, a.message)));
        model.notes = doubts.iter().map(|w| w.message.clone()).collect();
        // What every joint of a simulation has stands in its file.
        let told = doubts
            .into_iter()
            .filter(|w| !(steady && w.code == Code::ExportSimplified));
        warnings.extend(told.map(|w| {
            // What a robot has no option for.
            let place = match w.code {
                Code::ExportLimit => ". The limit of a joint is one of its parameters in the code",
                _ => "",
            };
            let message = format!("joint {}: {}{place}", joint.name, w.message);
            Warning::new(w.code, message)
        }));
        if steady {
            let known = domain::Known {
                armature: joint.armature,
                line: simulators,
            };
            model.domain = domain::of(&whole, &model, Some(known));
        }
        let joint = RobotJoint {
            name: joint.name.clone(),
            model,
            armature: joint.armature,
            simulators,
        };
        Ok((read, joint))
    });
    each.collect()
}

fn inertial(body: &IdentifiedBody) -> (String, Inertial) {
    let inertial = Inertial {
        mass: body.mass,
        origin: Pose {
            xyz: body.center,
            rpy: [0.0; 3],
        },
        inertia: body.inertia,
        line: 0,
    };
    (body.link.clone(), inertial)
}

/// An error with the file that it is about.
fn of_joint(
    source: ExportError,
    urdf: &Path,
    joints: &[(ReadModel, RobotJoint)],
    options: &ExportOptions,
) -> Error {
    match source {
        ExportError::Urdf(source) => Error::Urdf {
            file: urdf.to_path_buf(),
            source: Box::new(source),
        },
        ExportError::OfJoint { joint, source } => {
            match joints.iter().find(|(_, own)| own.name == joint) {
                Some((read, _)) => place(*source, read, options),
                None => ExportError::OfJoint { joint, source }.into(),
            }
        }
        other => other.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::Feedforward;

    const URDF: &str = r#"<robot name="arm"><link name="base"/>
  <link name="upper"><inertial><origin xyz="0 0 0.5"/><mass value="2"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit effort="50" velocity="2"/></joint></robot>
"#;

    const JOINT: &str = "schema = \"stiction.model/1\"\nkind = \"rotary\"\nlaw = \"coulomb-viscous\"\nasymmetric = false\n\
        force_unit = \"N*m\"\ntrustworthy = true\n[source]\nversion = \"0\"\nmethod = \"separable\"\nseed = 0\ninputs = []\n";

    const ROBOT: &str = "schema = \"stiction.robot/1\"\nname = \"arm\"\nurdf = \"../arm.urdf\"\nurdf_sha256 = \"SUM\"\n\
        gravity = [0.0, 0.0, -9.81]\n[joint.\"shoulder\"]\n[joint.\"shoulder\".identified]\n\
        model = \"joints/shoulder/model.toml\"\narmature = 0.25\nfriction = 1.5\ndamping = 0.5\n[[body]]\n\
        joint = \"shoulder\"\nlink = \"upper\"\nmass = 2.5\ncenter = [0.0, 0.0, 0.5]\ninertia = [0.1, 0.0, 0.1, 0.0, 0.0, 0.1]\n";

    /// A folder as an identification of a robot leaves it, beside the URDF.
    fn folder(robot: &str) -> (tempfile::TempDir, PathBuf) {
        let dir = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(dir.path().join("out/joints/shoulder")).unwrap();
        std::fs::write(dir.path().join("arm.urdf"), URDF).unwrap();
        let mut model = String::from(JOINT);
        for (name, value, unit) in [
            ("coulomb", 1.5, "N*m"),
            ("sigma2", 0.5, "N*m*s/rad"),
            ("mass", 0.25, "kg*m^2"),
        ] {
            model.push_str(&format!(
                "[[parameter]]\nname = \"{name}\"\nvalue = {value:?}\nunit = \"{unit}\"\norigin = \"identified\"\nidentifiable = true\n"
            ));
        }
        std::fs::write(dir.path().join("out/joints/shoulder/model.toml"), model).unwrap();
        let file = dir.path().join("out/robot.toml");
        std::fs::write(&file, robot).unwrap();
        (dir, file)
    }

    fn whole() -> String {
        ROBOT.replace("SUM", &stiction_files::sha256_of(URDF.as_bytes()))
    }

    #[test]
    fn a_robot_is_exported_from_its_folder() {
        let (dir, file) = folder(&whole());
        for (target, path, text) in [
            (
                Target::Urdf,
                "arm.urdf",
                "<dynamics damping=\"0.5\" friction=\"1.5\"/>",
            ),
            (Target::Mujoco, "arm_joints.xml", "armature=\"0.25\""),
            (Target::IsaacLab, "arm_friction.py", "\"shoulder\": 0.25"),
            (
                Target::Newton,
                "arm_newton.py",
                "\"shoulder\": {\"armature\": 0.25, \"friction\": 1.5, \"damping\": 0.5}",
            ),
            (
                Target::Bam,
                "arm_shoulder_bam.json",
                "\"friction_base\": 1.5",
            ),
            (
                Target::DomainJson,
                "arm_domain.json",
                "\"frictionloss\": {\"unit\": \"N m\", \"nominal\": 1.5, \"repeatability\": null",
            ),
            (
                Target::Ros2,
                "config/arm_friction.yaml",
                "arm_shoulder_friction:",
            ),
            (Target::C, "arm_robot.c", "arm_shoulder_step("),
        ] {
            let options = ExportOptions::new(target, 1e-3);
            let exported = export_robot_file(&file, None, &options).unwrap();
            // That of the law, which the axis would reach at speed, and that a URDF has no armature.
            let rotors = "the inertia of the rotors";
            let other =
                |w: &&Warning| w.code != Code::ExportLimit && !w.message.starts_with(rotors);
            assert_eq!(exported.warnings.iter().find(other), None, "{target:?}");
            assert!(exported.trustworthy);
            let found = exported.files.iter().find(|f| f.path == path).unwrap();
            let found = std::str::from_utf8(&found.bytes).unwrap();
            assert!(found.contains(text), "{found}");
            let out = dir.path().join(target.name());
            exported.write(&out, false).unwrap();
            assert!(out.join(path).is_file());
        }
        let mut options = ExportOptions::new(Target::C, 1e-3);
        options.feedforward = Feedforward::from_names(["friction", "rigid"]).unwrap();
        let exported = export_robot_file(&file, None, &options).unwrap();
        let source = exported.files.iter().find(|f| f.path == "arm_robot.c");
        let source = String::from_utf8(source.unwrap().bytes.clone()).unwrap();
        // Mass and first moment as identified, not those of the URDF.
        assert!(
            source.contains("2.5,\n      { 0.0, 0.0, 1.25 }"),
            "{source}"
        );
    }

    #[test]
    fn another_urdf_is_told() {
        let (dir, file) = folder(&whole());
        let other = dir.path().join("other.urdf");
        std::fs::write(&other, format!("{URDF}<!-- -->")).unwrap();
        let options = ExportOptions::new(Target::Urdf, 1e-3);
        let exported = export_robot_file(&file, Some(&other), &options).unwrap();
        let [warning, armature] = exported.warnings.as_slice() else {
            panic!("{:?}", exported.warnings)
        };
        assert!(warning.message.contains("other.urdf is not the URDF"));
        assert!(armature.message.contains("the inertia of the rotors"));
    }

    #[test]
    fn coupled_motors_are_told_where_torques_leave() {
        let coupling = "[tool]\nlink = \"upper\"\nmass = \"2 kg\"\n".to_string()
            + "[[coupling]]\njoints = [\"shoulder\", \"elbow\"]\nmatrix = [[1, 0], [1, 1]]\n";
        let (_dir, file) = folder(&(whole() + &coupling));
        for (target, due) in [(Target::C, 1), (Target::Ros2, 1), (Target::Urdf, 0)] {
            let exported =
                export_robot_file(&file, None, &ExportOptions::new(target, 1e-3)).unwrap();
            let told = exported
                .warnings
                .iter()
                .filter(|w| w.message.contains("shoulder, elbow are coupled"));
            assert_eq!(told.count(), due, "{target:?}");
            let of_tool = |w: &&Warning| {
                w.message
                    .contains("the tool of 2 kg on link upper is not in")
            };
            assert_eq!(
                exported.warnings.iter().filter(of_tool).count(),
                1 - due,
                "{target:?}"
            );
        }
    }

    #[test]
    fn what_is_of_one_joint_is_refused() {
        let (_dir, file) = folder(&whole());
        let said = |target, change: &dyn Fn(&mut ExportOptions)| {
            let mut options = ExportOptions::new(target, 1e-3);
            change(&mut options);
            export_robot_file(&file, None, &options)
                .unwrap_err()
                .to_string()
        };
        for (target, change, due) in [
            (
                Target::St,
                &(|_: &mut ExportOptions| {}) as &dyn Fn(&mut ExportOptions),
                "target st takes no robot; allowed: urdf, mujoco, isaaclab, newton, bam, domain-json, ros2 and c; or export the model.toml of a joint",
            ),
            (
                Target::C,
                &|o| o.limit = Some(3.0),
                "one limit for all joints",
            ),
            (
                Target::C,
                &|o| o.adapt = true,
                "levels that follow the machine for a robot",
            ),
            (
                Target::C,
                &|o| o.feedforward.mass = true,
                "rigid for gravity and inertia",
            ),
            (
                Target::Ros2,
                &|o| o.feedforward.rigid = true,
                "no feedforward of the rigid body; allowed: c",
            ),
        ] {
            let said = said(target, change);
            assert!(said.contains(due), "{said}");
        }
        // What is advised is no option that is refused.
        let options = ExportOptions::new(Target::C, 1e-3);
        let exported = export_robot_file(&file, None, &options).unwrap();
        let limit = |w: &&Warning| w.code == Code::ExportLimit;
        let said = &exported.warnings.iter().find(limit).unwrap().message;
        assert!(
            said.ends_with("is one of its parameters in the code"),
            "{said}"
        );
        let typed = whole().replace("[joint.\"shoulder\".identified]", "");
        let typed = typed.replace("model = \"joints/shoulder/model.toml\"\narmature = 0.25\nfriction = 1.5\ndamping = 0.5\n", "");
        let (_dir, file) = folder(&typed);
        let options = ExportOptions::new(Target::C, 1e-3);
        let said = export_robot_file(&file, None, &options)
            .unwrap_err()
            .to_string();
        assert!(said.contains("no joint is identified"), "{said}");
        let model = file.with_file_name("joints").join("shoulder/model.toml");
        let mut options = ExportOptions::new(Target::C, 1e-3);
        options.feedforward.rigid = true;
        let said = super::super::export_file(model, &options)
            .unwrap_err()
            .to_string();
        assert!(
            said.contains("rigid body for the model of one axis"),
            "{said}"
        );
    }
}
