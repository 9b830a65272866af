//! A robot: logs of all its joints and a URDF in, its rigid body and the friction of each joint out.
//!
//! ```no_run
//! use stiction::{Silent, robot};
//!
//! let files = robot::Files {
//!     logs: vec!["run.db3".into()],
//!     urdf: Some("arm.urdf".into()),
//!     ..robot::Files::default()
//! };
//! let found = robot::robot(&files, &robot::Options::default(), &mut Silent)?;
//! for joint in &found.joints {
//!     if let Some(fit) = robot::fit(joint) {
//!         println!("{}: {:?}", joint.name, fit.law_kind());
//!     }
//! }
//! robot::write(&found, "result")?; // robot.json, robot.toml, report.html, and of each joint its model
//! # Ok::<(), stiction::Error>(())
//! ```

use crate::{Error, Fit, bundle};
use std::path::{Path, PathBuf};

pub use stiction_files::robot::result::{
    BaseEntry, BodyEntry, Estimated, FileEntry, FilterEntry, JointColumn, JointEntry, JointFit,
    RobotFile, RobotInput, RobotTrust, SCHEMA,
};
pub use stiction_files::robot::{Coupling, Robot, RobotJoint, Tool};
pub use stiction_identify::RigidFit;
pub use stiction_workflows::robot::{Files, JointOutcome, Options, RobotOutcome, Urdf, robot};

/// The friction of a joint as that of an axis; `None` where it could not be fitted. The torque of the rigid body is one that acts from
/// outside, so another log is predicted by [`robot()`] with that log as one to validate on.
pub fn fit(joint: &JointOutcome) -> Option<Fit> {
    let outcome = joint.outcome.as_ref().ok()?.clone();
    Some(Fit { outcome })
}

/// The files that were read: logs, URDF, robot file.
pub fn inputs(outcome: &RobotOutcome) -> impl Iterator<Item = &Path> {
    let result = &outcome.result;
    let logs = result.inputs.iter().map(|input| input.path.as_str());
    let files = [Some(&result.urdf), result.robot.as_ref()];
    let files = files.into_iter().flatten().map(|file| file.path.as_str());
    logs.chain(files).map(Path::new)
}

/// Writes `robot.json`, `robot.toml`, `report.html` and a folder for each joint that was fitted, whole or not at all.
///
/// # Errors
/// Where the folder cannot be written, or holds something that stiction did not write.
pub fn write(outcome: &RobotOutcome, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
    let folder = folder.as_ref();
    stiction_files::check_folder_of(folder, SCHEMA, false)?;
    stiction_files::check_inputs(folder, inputs(outcome))?;
    Ok(bundle::robot(outcome, folder).write(folder)?)
}
