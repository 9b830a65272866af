//! `study.toml`: paths, controllers and compensators on one simulated axis, with parameters right and wrong.
//!
//! Raw as typed, then resolved to SI and the types of the simulation, then run over the whole grid.

mod compensation;
mod contour;
mod course;
pub(crate) mod doubt;
mod machine;
mod model;
mod path;
mod raw;
mod resolve;
pub mod result;
mod rows;
mod run;
mod trace;
mod wrong;

use crate::error::{Error, Warning};
use crate::output::Bundle;
use crate::report;
pub(crate) use contour::ContourTrace;
use contour::{ContourPlan, Second};
use model::Model;
use result::StudyFile;
use std::path::Path;
use stiction_friction::LuGre;
use stiction_friction::compensator::Source;
use stiction_identify::Control;
use stiction_log::Motion;
use stiction_servo::controller::Controller;
use stiction_servo::disturbance::Cogging;
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::learning::Learning;
use stiction_servo::plant::Plant;
use stiction_servo::trajectory::Trajectory;
pub(crate) use trace::{Course, Trace};
use wrong::Family;

/// A study, resolved: ready to run.
pub struct Study {
    name: String,
    seed: u64,
    machine: Machine,
    paths: Vec<PathPlan>,
    second: Option<Second>,
    contours: Vec<ContourPlan>,
    controllers: Vec<Named<Controller>>,
    compensators: Vec<Named<Scheme>>,
    families: Vec<Family>,
    inputs: Vec<result::StudyInput>,
    warnings: Vec<Warning>,
}

/// Something with the name under which it stands in tables.
pub(crate) struct Named<T> {
    pub name: String,
    pub it: T,
}

/// The simulated axis but for controller and compensator.
pub(crate) struct Machine {
    pub motion: Motion,
    pub model: Model,
    /// The law of the axis, with sigma1 capped unless the file says otherwise.
    pub law: LuGre<f64>,
    /// kg (kg m^2)
    pub mass: f64,
    /// Both together.
    pub plant: Plant,
    /// Whether the study gives the mass, rather than the model.
    pub given_mass: bool,
    /// Hz
    pub rate: f64,
    pub substeps: u32,
    pub drive: Drive,
    pub encoder: Encoder,
    /// m (rad)
    pub position_noise: f64,
    pub cogging: Option<Cogging>,
}

/// A reference motion and from when on it counts.
pub(crate) struct PathPlan {
    pub name: String,
    pub kind: &'static str,
    pub trajectory: Box<dyn Trajectory + Send + Sync>,
    /// s
    pub skip: f64,
}

/// What compensates friction.
pub(crate) enum Scheme {
    None,
    Model(ModelScheme),
    /// A disturbance observer alone, with its bandwidth, Hz.
    Observer(f64),
    /// Passes, the last of which counts.
    Learning(Learning, u64),
}

/// A force from the law.
pub(crate) struct ModelScheme {
    pub kind: ModelKind,
    pub source: Source<f64>,
    pub gain: f64,
    /// m/s (rad/s)
    pub dead_zone: f64,
    /// N (N m); `None`: that of the controller.
    pub limit: Option<f64>,
    /// N/s (N m/s)
    pub slew: Option<f64>,
    /// s
    pub ramp: f64,
    pub adaptation: Option<stiction_friction::compensator::Adaptation<f64>>,
    pub watchdog: Option<stiction_friction::compensator::Watchdog<f64>>,
    /// Samples; `None`: what the drive needs, for the reference velocity.
    pub preview: Option<f64>,
    /// Bandwidth of a disturbance observer beside it, Hz.
    pub observer: Option<f64>,
}

/// How much of the law.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ModelKind {
    Coulomb,
    Stribeck,
    LuGre,
}

/// Everything that came out of a study, in memory.
pub struct StudyOutcome {
    /// What goes into `study.json`.
    pub file: StudyFile,
    pub(crate) traces: Vec<Trace>,
    pub(crate) contours: Vec<ContourTrace>,
    /// `trajectories.csv` and `contours.csv`; empty without a path, without a contour.
    courses: [String; 2],
}

impl Study {
    /// Reads and checks a study file, and the model that it names.
    ///
    /// # Errors
    /// With file, line, key, what was found and what is allowed.
    pub fn read(file: &Path) -> Result<Self, Error> {
        let text = crate::typed::read(file, "a study file")?;
        resolve::resolve(&text, file)
    }

    /// Files that the study reads, itself first.
    pub fn inputs(&self) -> impl Iterator<Item = &str> {
        self.inputs.iter().map(|i| i.path.as_str())
    }

    /// Runs the whole grid on all threads. `watch` is told how many runs of how many are done, from one thread at a
    /// time, also between the passes of learning, and may stop the work: what is done then is kept. Results do not depend on the number of threads.
    pub fn run(&self, watch: &mut (dyn FnMut(usize, usize) -> Control + Send)) -> StudyOutcome {
        run::run(self, watch)
    }
}

impl StudyOutcome {
    /// The course of the run of a row with exact parameters.
    pub(crate) fn trace(&self, row: &result::ResultRow) -> Option<&Trace> {
        self.traces.iter().find(|t| {
            t.path == row.path && t.controller == row.controller && t.compensator == row.compensator
        })
    }

    /// The same of a row on a contour.
    pub(crate) fn contour(&self, row: &result::ResultRow) -> Option<&ContourTrace> {
        self.contours.iter().find(|t| {
            t.path == row.path
                && t.controller == row.controller
                && t.compensator == row.compensator
                && t.coupled == row.coupled
        })
    }

    /// `report.html`, `study.json`, and `trajectories.csv`, `contours.csv` with the courses of the runs.
    pub fn bundle(&self) -> Bundle {
        let mut bundle = Bundle::default();
        bundle.add("report.html", report::study(self).to_html());
        let names = ["trajectories.csv", "contours.csv"];
        for (name, rows) in names.into_iter().zip(&self.courses) {
            if !rows.is_empty() {
                bundle.add(name, rows.as_str());
            }
        }
        let json = serde_json::to_string_pretty(&self.file).expect("plain data");
        bundle.add("study.json", json + "\n");
        bundle
    }
}
