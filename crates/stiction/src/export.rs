//! A model as code for a controller, or as friction of a simulator.

use crate::{Error, Model, Notice};
use serde_json::Value;
use std::path::Path;
use stiction_export as engine;
use stiction_files::Warning;
use stiction_friction::compensator::Compensator;
use stiction_workflows::export::{self as workflow, ExportOptions, Target};

/// What is fed forward beside friction, of what the model has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Feedforward {
    /// Mass times the acceleration of the reference.
    Mass,
    /// The weight: the constant force of the law, and on a rotary axis sine and cosine of its angle.
    Gravity,
    /// Waves of the force along the position.
    Cogging,
    /// Gravity, inertia and Coriolis forces of the rigid body of a robot.
    RigidBody,
}

/// Which intervals draws are from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Width {
    /// The same motion on another day.
    Repeatability,
    /// Another motion.
    Transfer,
}

/// What a workflow exported, of an axis or a robot.
macro_rules! exported {
    ($made:expr) => {{
        let own = $made.map_err(Error::of)?;
        Ok(Exported {
            result: serde_json::to_value(&own).expect("plain data"),
            files: own.files,
            warnings: own.warnings,
            trustworthy: own.trustworthy,
        })
    }};
}

/// An export to be made; what is not set follows from the law. docs/export.md says which target takes which setting.
///
/// ```
/// # let text = stiction::library::machine("xl330")?.model().unwrap().to_toml();
/// use stiction::{Export, Model, Target};
/// let model = Model::parse(&text)?; // or Model::read("result/model.toml")
/// let code = Export::new(Target::C, 1e-3).gain(0.5).model(&model)?; // called every millisecond
/// assert!(code.files().any(|(path, _)| path.ends_with(".c")));
/// // code.write("controller")?;
/// # Ok::<(), stiction::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Export(ExportOptions);

impl Export {
    /// For a target, called every `cycle_time` seconds.
    pub fn new(target: Target, cycle_time: f64) -> Self {
        Self(ExportOptions::new(target, cycle_time))
    }

    /// Beginning of the names in the code. Default: from the model's name.
    #[must_use]
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.0.name = Some(name.into());
        self
    }

    /// Largest force, in the unit of the model's. Default: twice the sum of static friction and offset, for a table the largest force that
    /// it can hold.
    #[must_use]
    pub fn limit(mut self, force: f64) -> Self {
        self.0.limit = Some(force);
        self
    }

    /// Force that the motor is rated for, in the unit of the model's; for [`Target::Tf5200`].
    #[must_use]
    pub fn rated_force(mut self, force: f64) -> Self {
        self.0.rated_force = Some(force);
        self
    }

    /// Share of the friction that is compensated, 0 to 1. Default: 0.75.
    #[must_use]
    pub fn gain(mut self, share: f64) -> Self {
        self.0.gain = Some(share);
        self
    }

    /// Time in which the compensation goes from 0 to its full value, s.
    #[must_use]
    pub fn ramp(mut self, seconds: f64) -> Self {
        self.0.safety.ramp = Some(seconds);
        self
    }

    /// Speed up to which the axis counts as standing, m/s (rad/s).
    #[must_use]
    pub fn dead_zone(mut self, speed: f64) -> Self {
        self.0.safety.dead_zone = Some(speed);
        self
    }

    /// Fastest change of the force, in the unit of the model's force per second.
    #[must_use]
    pub fn slew(mut self, rate: f64) -> Self {
        self.0.safety.slew = Some(rate);
        self
    }

    /// Moving time that the watchdog compares, s; 0: no watchdog.
    #[must_use]
    pub fn window(mut self, seconds: f64) -> Self {
        self.0.safety.window = Some(seconds);
        self
    }

    /// Lets the levels follow the machine while it runs, from the force of the drive.
    #[must_use]
    pub fn adapting(mut self) -> Self {
        self.0.adapt = true;
        self
    }

    /// Writes so many draws of what a simulator takes, from intervals of this width; the same seed gives the same draws.
    #[must_use]
    pub fn draws(mut self, count: usize, seed: u64, width: Width) -> Self {
        let width = match width {
            Width::Repeatability => engine::Width::Repeatability,
            Width::Transfer => engine::Width::Transfer,
        };
        self.0.draws = Some(engine::Draws { count, seed, width });
        self
    }

    /// Feeds this forward beside friction too.
    #[must_use]
    pub fn feedforward(mut self, part: Feedforward) -> Self {
        let all = &mut self.0.feedforward;
        match part {
            Feedforward::Mass => all.mass = true,
            Feedforward::Gravity => all.gravity = true,
            Feedforward::Cogging => all.cogging = true,
            Feedforward::RigidBody => all.rigid = true,
        }
        self
    }

    /// The code of a model.
    ///
    /// # Errors
    /// Where the model cannot be exported to this target, or a setting is out of range.
    pub fn model(&self, model: &Model) -> Result<Exported, Error> {
        exported!(workflow::export(&model.0, &self.0))
    }

    /// The code of a model file; an error in it is named by its line.
    ///
    /// # Errors
    /// As [`Export::model`], and where the file cannot be read.
    pub fn file(&self, file: impl AsRef<Path>) -> Result<Exported, Error> {
        exported!(workflow::export_file(file, &self.0))
    }

    /// All joints of a `robot.toml` that an identification wrote; `urdf` stands for the URDF that it names.
    ///
    /// # Errors
    /// As [`Export::file`], and where the target takes no robot.
    pub fn robot_file(
        &self,
        file: impl AsRef<Path>,
        urdf: Option<&Path>,
    ) -> Result<Exported, Error> {
        exported!(workflow::export_robot_file(file, urdf, &self.0))
    }

    /// The compensator as a value, to be stepped once a cycle: what is written for [`Target::Rust`], whatever the target.
    ///
    /// # Errors
    /// As [`Export::model`].
    pub fn compensator(&self, model: &Model) -> Result<Compensator<f64>, Error> {
        workflow::compensator(&model.0, &self.0).map_err(Error::of)
    }
}

/// The files of an export.
#[derive(Clone, Debug)]
pub struct Exported {
    files: Vec<workflow::File>,
    warnings: Vec<Warning>,
    trustworthy: bool,
    result: Value,
}

impl Exported {
    /// The files: path from their folder, with `/` between its parts, and content.
    pub fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        let files = self.files.iter();
        files.map(|file| (file.path.as_str(), file.bytes.as_slice()))
    }

    /// What to know before it runs.
    pub fn warnings(&self) -> impl Iterator<Item = Notice> {
        self.warnings.iter().map(Notice::of)
    }

    /// Whether the identification found that each law may be used to compensate.
    pub fn is_trustworthy(&self) -> bool {
        self.trustworthy
    }

    /// Names, limits and settings, as `stiction export --json` writes them.
    pub fn result(&self) -> &Value {
        &self.result
    }

    /// Writes the files into a folder that is new, empty or of an earlier export: whole, or not at all. Files that an export wrote there
    /// are replaced, others kept.
    ///
    /// # Errors
    /// Where the folder holds something else, a file to be replaced was changed, or it cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), Error> {
        stiction_files::write_folder(folder, self.files(), false).map_err(Error::of)
    }

    /// The same over whatever files of these names are there.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn overwrite(&self, folder: impl AsRef<Path>) -> Result<(), Error> {
        stiction_files::write_folder(folder, self.files(), true).map_err(Error::of)
    }
}
