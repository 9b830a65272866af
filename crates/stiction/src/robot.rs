//! A robot: logs of all its joints and a URDF in, its rigid body and the friction of each joint out.
//!
//! ```no_run
//! let found = stiction::robot::Identification::of(["run.db3"]).urdf("arm.urdf").run()?;
//! for joint in found.joints() {
//!     if let Some(fit) = joint.fit() {
//!         println!("{}: {}", joint.name(), fit.law_kind());
//!     }
//! }
//! found.write("result")?; // robot.json, robot.toml, report.html, and of each joint its model
//! # Ok::<(), stiction::Error>(())
//! ```

use crate::progress::Watched;
use crate::{Error, Fit, Notice, Progress};
use serde_json::Value;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use stiction_files::robot::result::SCHEMA;
use stiction_pages::{bundle, report, text};
use stiction_workflows::Verdict;
use stiction_workflows::robot::{self as workflow, Files, JointOutcome, Options, RobotOutcome};

/// An identification of a robot to be run.
pub struct Identification<'a> {
    files: Files,
    options: Options,
    observer: Watched<'a>,
}

impl<'a> Identification<'a> {
    /// Of the files of logs that are fitted together.
    pub fn of<P: Into<PathBuf>>(logs: impl IntoIterator<Item = P>) -> Self {
        Self {
            files: Files {
                logs: logs.into_iter().map(Into::into).collect(),
                ..Files::default()
            },
            options: Options::default(),
            observer: Watched::default(),
        }
    }

    /// The URDF. Default: that of the robot file.
    #[must_use]
    pub fn urdf(mut self, file: impl Into<PathBuf>) -> Self {
        self.files.urdf = Some(file.into());
        self
    }

    /// The robot file (docs/robot.md). Default: all is left to the URDF and to detection.
    #[must_use]
    pub fn robot(mut self, file: impl Into<PathBuf>) -> Self {
        self.files.robot = Some(file.into());
        self
    }

    /// Files of logs that are not fitted: the result says how well the model predicts them.
    #[must_use]
    pub fn validate<P: Into<PathBuf>>(mut self, logs: impl IntoIterator<Item = P>) -> Self {
        self.files.validate.extend(logs.into_iter().map(Into::into));
        self
    }

    /// Fits the first part of the time of each log, 0 to 1, and validates on the rest.
    #[must_use]
    pub fn split(mut self, part: f64) -> Self {
        self.options.split = Some(part);
        self
    }

    /// Seed of the searches, 0 by default; the same seed gives the same bits.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.options.seed = seed;
        self
    }

    /// Sees the progress, and may stop the work; what was found by then is kept.
    #[must_use]
    pub fn observer(
        mut self,
        observer: impl FnMut(&Progress) -> ControlFlow<()> + Send + 'a,
    ) -> Self {
        self.observer = Watched::by(observer);
        self
    }

    /// Identifies the robot.
    ///
    /// # Errors
    /// Where a file cannot be read, the logs do not go with the URDF, or nothing can be identified.
    pub fn run(mut self) -> Result<RobotFit, Error> {
        let found = workflow::robot(&self.files, &self.options, &mut self.observer);
        found.map(RobotFit).map_err(Error::of)
    }
}

/// What was identified of a robot.
#[derive(Debug)]
pub struct RobotFit(RobotOutcome);

impl RobotFit {
    /// The joints whose friction was to be fitted, in the order of the robot.
    pub fn joints(&self) -> impl ExactSizeIterator<Item = Joint<'_>> {
        self.0.joints.iter().map(Joint)
    }

    /// What the result is worth, in one word.
    pub fn verdict(&self) -> Verdict {
        self.0.verdict()
    }

    /// Whether the model predicts the torque of every fitted joint on samples that were not fitted.
    pub fn is_trustworthy(&self) -> bool {
        self.0.result.trust.trustworthy
    }

    /// Why not; empty if it does.
    pub fn reasons(&self) -> &[String] {
        &self.0.result.trust.reasons
    }

    /// What to know although the identification went on.
    pub fn warnings(&self) -> impl Iterator<Item = Notice> {
        self.0.result.warnings.iter().map(Notice::of)
    }

    /// Everything that was found, as `robot.json` has it (docs/robot.md): inertias, base parameters, joints.
    pub fn result(&self) -> Value {
        serde_json::to_value(&self.0.result).expect("plain data")
    }

    /// The report, one HTML file without scripts.
    pub fn report(&self) -> String {
        report::robot(&self.0, Path::new("result")).to_html()
    }

    /// As the command line prints it.
    pub fn text(&self) -> String {
        text::robot_in_full(&self.0)
    }

    /// Writes `robot.json`, `robot.toml`, `report.html` and a folder for each joint that was fitted, whole or not at all; their paths.
    ///
    /// # Errors
    /// Where the folder cannot be written, or holds something that stiction did not write.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        let folder = folder.as_ref();
        let written = stiction_files::check_folder_of(folder, SCHEMA, false)
            .and_then(|()| stiction_files::check_inputs(folder, self.0.inputs()))
            .and_then(|()| bundle::robot(&self.0, folder).write(folder));
        written.map_err(Error::of)
    }
}

/// A joint of a robot.
#[derive(Clone, Copy, Debug)]
pub struct Joint<'a>(&'a JointOutcome);

impl<'a> Joint<'a> {
    /// Name in the URDF.
    pub fn name(&self) -> &'a str {
        &self.0.name
    }

    /// Its friction as that of an axis; `None` where it could not be fitted. The torque of the rigid body is one that acts from outside,
    /// so another log is predicted by an identification of the robot with that log to validate on.
    pub fn fit(&self) -> Option<Fit> {
        self.0.outcome.as_ref().ok().cloned().map(Fit)
    }

    /// Why it could not be fitted.
    pub fn refused(&self) -> Option<String> {
        self.0.outcome.as_ref().err().map(ToString::to_string)
    }
}
