//! Everything that came out of an identification of a robot, in memory.

use super::load::{JointLogs, Urdf};
use crate::error::Error;
use crate::identify::Outcome;
use crate::source::Source;
use std::path::Path;
use stiction_files::robot::result::RobotFile;
use stiction_identify::{RigidFit, Series};
use stiction_signal::interpolate;

/// Everything that came out, in memory.
#[derive(Debug)]
pub struct RobotOutcome {
    /// What goes into `robot.json`.
    pub result: RobotFile,
    /// The URDF.
    pub urdf: Urdf,
    /// The rigid body.
    pub rigid: RigidFit,
    /// The joints whose friction was to be fitted, in the order of the robot.
    pub joints: Vec<JointOutcome>,
}

/// What came out of one joint.
#[derive(Debug)]
pub struct JointOutcome {
    /// Its name in the URDF.
    pub name: String,
    /// Folder of its files, from that of the robot.
    pub folder: String,
    /// Its friction, identified as that of one axis; the force of the rigid body acts from outside.
    pub outcome: Result<Outcome, Error>,
    /// Torque of the rigid body at the samples of the fit, N m or N: what is measured and modelled there is less by this much.
    pub rigid: Vec<f64>,
    /// The same at the samples of each validation.
    pub rigid_held_out: Vec<Vec<f64>>,
    /// What the model leaves of the torque on the fitted logs, and on those that were not, N m or N; torque and model have passed the
    /// filters of the rigid body.
    pub left: [Vec<f64>; 2],
    /// Root mean square of the error of the torque of rigid body and armature on the fitted logs by its covariance, N m or N.
    pub rigid_deviation: f64,
}

impl RobotOutcome {
    /// The files that were read: logs, URDF, robot file.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        let result = &self.result;
        let logs = result.inputs.iter().map(|input| input.path.as_str());
        let files = [Some(&result.urdf), result.robot.as_ref()];
        let files = files.into_iter().flatten().map(|file| file.path.as_str());
        logs.chain(files).map(Path::new)
    }
}

impl JointOutcome {
    /// What came out of a joint with these logs.
    pub(super) fn new(
        name: String,
        folder: String,
        outcome: Result<Outcome, Error>,
        logs: &JointLogs,
    ) -> Self {
        let (rigid, rigid_held_out) = match &outcome {
            Ok(outcome) => (
                rigid_at(&outcome.law().series, &logs.fitted),
                outcome
                    .validation
                    .iter()
                    .zip(&logs.held_out)
                    .map(|((_, series), log)| rigid_at(series, std::slice::from_ref(log)))
                    .collect(),
            ),
            Err(_) => (Vec::new(), Vec::new()),
        };
        Self {
            name,
            folder,
            outcome,
            rigid,
            rigid_held_out,
            left: [Vec::new(), Vec::new()],
            rigid_deviation: 0.0,
        }
    }
}

/// Folders of joints: their names with what no file name may have replaced, no two of them the same on any file system.
pub(super) fn folders<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let allowed = |c: char| match c.is_alphanumeric() || "-_.".contains(c) {
        true => c,
        false => '_',
    };
    let mut out: Vec<String> = Vec::new();
    for name in names {
        let own: String = name.chars().map(allowed).collect();
        let own = match own.trim_start_matches('.') {
            "" => "joint",
            own => own,
        };
        let numbered = (2..).map(|n| format!("joints/{own}-{n}"));
        let mut free = std::iter::once(format!("joints/{own}")).chain(numbered);
        let is_free = |folder: &String| {
            let same = |other: &String| other.to_lowercase() == folder.to_lowercase();
            !out.iter().any(same)
        };
        out.extend(free.find(is_free));
    }
    out
}

/// Torque of the rigid body at the samples of a series.
fn rigid_at(series: &Series, logs: &[Source]) -> Vec<f64> {
    let mut out = vec![0.0; series.time.len()];
    for (number, source) in logs.iter().enumerate() {
        let rows: Vec<usize> = (0..out.len())
            .filter(|row| series.log[*row] == number)
            .collect();
        let at: Vec<f64> = rows.iter().map(|row| series.time[*row]).collect();
        let external = source.log.external.as_deref().unwrap_or_default();
        let read = interpolate(&source.log.time, external, &at).unwrap_or_default();
        for (row, external) in rows.into_iter().zip(read) {
            out[row] = -external;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::folders;

    #[test]
    fn no_two_joints_share_a_folder() {
        let names = ["a b", "a_b", "A_B", "..", "joint", "../x", "schulter"];
        let due = [
            "a_b", "a_b-2", "A_B-3", "joint", "joint-2", "_x", "schulter",
        ];
        let due: Vec<String> = due.iter().map(|name| format!("joints/{name}")).collect();
        assert_eq!(folders(names.into_iter()), due);
    }
}
