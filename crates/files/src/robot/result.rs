//! `robot.json`: everything an identification of a robot found. Schema `stiction.robot/1`, only ever extended.

use crate::error::Warning;
use crate::result::{Action, ValueEntry};
use serde::{Deserialize, Serialize};

/// Name of the schema.
pub const SCHEMA: &str = "stiction.robot/1";

/// The whole file; described key by key in `docs/robot.md`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotFile {
    /// `stiction.robot/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// Seed of the searches.
    pub seed: u64,
    /// Name of the robot.
    pub name: String,
    /// The URDF.
    pub urdf: FileEntry,
    /// The robot file; absent where none was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<FileEntry>,
    /// Gravity in the frame of the base link, m/s^2.
    pub gravity: [f64; 3],
    /// What the robot carried; not part of the inertias.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tool: Option<super::Tool>,
    /// Joints whose motors move several of them; friction and inertia are those of the joints.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub couplings: Vec<super::Coupling>,
    /// The column of the time; absent where the log has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<JointColumn>,
    /// The logs.
    pub inputs: Vec<RobotInput>,
    /// How motion and torque were filtered.
    pub conditioning: FilterEntry,
    /// Whether the model may be used, and what to do next.
    pub trust: RobotTrust,
    /// The joints, in the order of the robot.
    pub joints: Vec<JointEntry>,
    /// Combinations of inertial parameters that motion can determine.
    pub base: Vec<BaseEntry>,
    /// Inertias of the bodies, physically consistent and nearest to what the log shows.
    pub bodies: Vec<BodyEntry>,
    /// What to beware of.
    pub warnings: Vec<Warning>,
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileEntry {
    /// Path as given.
    pub path: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// A log that was read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotInput {
    /// Path as given.
    pub path: String,
    /// The part that this is; absent where it is the whole log.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
    /// Whether it is fitted, or validated on.
    pub fitted: bool,
    /// Samples.
    pub samples: usize,
    /// Rate, Hz.
    pub rate_hz: f64,
}

/// How motion and torque were filtered for the rigid body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FilterEntry {
    /// Cut-off of the low-pass on the positions, Hz.
    pub source_cutoff_hz: f64,
    /// Cut-off of the low-pass on torques and regressor, Hz.
    pub common_cutoff_hz: f64,
    /// Cut-off of a low-pass that the torques passed before they were logged, Hz; absent where none is seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque_cutoff_hz: Option<f64>,
}

/// Whether the model may be used.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotTrust {
    /// Whether the model predicts the torque of every fitted joint on samples that were not fitted.
    pub trustworthy: bool,
    /// Why not; the joint is named.
    pub reasons: Vec<String>,
    /// What to do next.
    pub next: Action,
}

/// One joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointEntry {
    /// Name in the URDF.
    pub name: String,
    /// `rotary` or `linear`.
    pub kind: String,
    /// Unit of the torque: `N*m` or `N`.
    pub unit: String,
    /// The columns of the log: role, column, unit.
    pub columns: Vec<JointColumn>,
    /// What was identified; absent of a joint that was not fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fit: Option<JointFit>,
}

/// A column of a joint.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct JointColumn {
    /// `position`, `velocity`, `force` and their like.
    pub role: String,
    /// Its number in the file, counted from 1, with its name.
    pub column: String,
    /// The unit in which it is read, with scale and sign.
    pub unit: String,
    /// The line of the robot file that says the same.
    pub line: String,
}

/// What was identified of a joint. Forces are in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointFit {
    /// Folder of its `result.json` and `model.toml`, from that of this file.
    pub folder: String,
    /// Family of the friction law.
    pub law: String,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
    /// Coulomb friction; absent where the law has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coulomb: Option<Estimated>,
    /// Viscous friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscous: Option<Estimated>,
    /// Static friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_friction: Option<Estimated>,
    /// Share of the transmitted torque that friction grows by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<Estimated>,
    /// Inertia of the rotor at the joint, kg m^2 or kg.
    pub armature: Estimated,
    /// Coulomb and viscous friction as simulators take it: `frictionloss` and `damping`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub simulators: Option<[ValueEntry; 2]>,
    /// Root mean square of the measured torque about its mean.
    pub torque_rms: f64,
    /// Root mean square of what the model leaves of it on the fitted samples.
    pub fit_rms: f64,
    /// The same on samples that were not fitted.
    pub held_out_rms: f64,
    /// What those are: `validation` for logs or parts that were set aside, `held-out` for blocks of the fitted ones.
    pub judged_on: String,
    /// Root mean square of the error of the rigid torque by its covariance.
    pub rigid_deviation: f64,
    /// Whether the model predicts the torque of this joint.
    pub trustworthy: bool,
    /// Whether the friction law may drive a compensator by itself.
    pub compensates: bool,
    /// Why not.
    pub reasons: Vec<String>,
}

/// A number with half of its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimated {
    /// The value.
    pub value: f64,
    /// Half of the 95 % interval; absent where the data do not bound it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub half_width: Option<f64>,
    /// Whether the data determine it.
    pub identifiable: bool,
}

/// A combination of inertial parameters that motion can determine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BaseEntry {
    /// The parameters and their factors in words, such as `Izz(elbow) + 0.36 mx(wrist)`.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// Half of its 95 % interval.
    pub half_width: f64,
    /// Its value in the URDF.
    pub urdf: f64,
}

/// Inertia of a body for a simulator or a controller, at its centre of mass along the directions of the link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyEntry {
    /// The joint that moves it.
    pub joint: String,
    /// The link that has the inertia in the URDF.
    pub link: String,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the frame of the link, m.
    pub center: [f64; 3],
    /// xx, xy, yy, xz, yz, zz about that centre, kg m^2.
    pub inertia: [f64; 6],
    /// Mass in the URDF, kg.
    pub urdf_mass: f64,
}
