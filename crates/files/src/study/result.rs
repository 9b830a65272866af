//! `study.json`: everything a study found. Schema `stiction.study/1`, only ever extended.

use crate::error::Warning;
use serde::{Deserialize, Serialize};

/// Name of the schema.
pub const SCHEMA: &str = "stiction.study/1";

/// The whole file; described key by key in `docs/study.md`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyFile {
    /// `stiction.study/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// Name of the study.
    pub name: String,
    /// Seed of noise and draws.
    pub seed: u64,
    /// `complete` or `interrupted`.
    pub status: String,
    /// Files that were read.
    pub inputs: Vec<StudyInput>,
    /// The simulated axis.
    pub axis: SimulatedAxis,
    /// The second axis, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub second_axis: Option<SimulatedAxis>,
    /// Reference motions, those of two axes last.
    pub paths: Vec<PathEntry>,
    /// What changed on the axis while it ran.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<EventEntry>,
    /// What the identification allows to promise, one entry for each path, controller and compensator.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub promise: Vec<PromiseEntry>,
    /// Why nothing is promised: what a model lacks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_promised: Option<String>,
    /// One row for each path, controller, compensator and kind of parameters.
    pub results: Vec<ResultRow>,
    /// The same over the values of a key.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sweeps: Vec<SweepEntry>,
    /// Exported C beside the compensator that it was written from, where it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exported_c: Option<ExportedEntry>,
    /// What to beware of.
    pub warnings: Vec<Warning>,
}

/// Exported C beside the compensator that it was written from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExportedEntry {
    /// Folder of the C.
    pub folder: String,
    /// Header and source.
    pub files: Vec<StudyInput>,
    /// Whether it was written from the model file of the study.
    pub same_model: bool,
    /// Largest difference of the forces that is allowed, of the larger of force and static friction.
    pub allowed_difference: f64,
    /// One for each path under each controller.
    pub runs: Vec<ExportedRow>,
}

/// A path under a controller without compensation, with the compensator in Rust and with the C.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExportedRow {
    /// Name of the path.
    pub path: String,
    /// Name of the controller.
    pub controller: String,
    /// `rms_error`, `peak_error` and `reversal_peak`.
    pub metrics: Vec<ExportedValue>,
    /// Largest difference of the forces of both on the inputs of the run with the C.
    pub force_difference: f64,
    /// Its unit.
    pub force_unit: String,
    /// When it was, s from the beginning of the run; negative at the standstill before it.
    pub at_s: f64,
    /// Largest difference of the position between the run with the C and that in Rust, m or rad.
    pub position_difference: f64,
    /// Whether the difference of the forces is beyond what is allowed.
    pub differs: bool,
    /// Whether the watchdog of the C switched off.
    pub switched_off: bool,
}

/// A metric of the three runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExportedValue {
    /// Name, such as `peak_error`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Without compensation.
    pub without: f64,
    /// With the compensator in Rust.
    pub rust: f64,
    /// With the C.
    pub c: f64,
    /// By how much the error in Rust is below that without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rust_reduction_percent: Option<f64>,
    /// The same with the C.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub c_reduction_percent: Option<f64>,
}

impl ExportedRow {
    /// A metric by its name.
    pub fn metric(&self, name: &str) -> Option<&ExportedValue> {
        self.metrics.iter().find(|m| m.name == name)
    }
}

/// What compensation leaves of the largest error, as far as the identification of the axis tells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PromiseEntry {
    /// Name of the path.
    pub path: String,
    /// Name of the controller.
    pub controller: String,
    /// Name of the compensator.
    pub compensator: String,
    /// Whether the axes are controlled together.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub coupled: bool,
    /// The metric: `peak_error`, on a contour `contour_peak`.
    pub metric: String,
    /// Part of it that is left, percent: what 90 % of axes as the identification leaves them open lie between.
    pub left90_percent: [f64; 2],
    /// Axes that were drawn.
    pub draws: usize,
    /// Fraction of the force that is let through, of a compensator of a law with a given level.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
}

/// A change of the axis while it runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EventEntry {
    /// s from the beginning of a run.
    pub time_s: f64,
    /// The mass from then on, kg or kg m^2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Factor on the friction of the law from then on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
}

/// A key with several values in turn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepEntry {
    /// The key, such as `law.sigma0` or `path.amplitude`.
    pub key: String,
    /// SI unit of the values; empty for numbers.
    pub unit: String,
    /// The values, ascending.
    pub values: Vec<f64>,
    /// One for each path, controller and compensator, all with exact parameters.
    pub results: Vec<SweepRow>,
}

/// The metrics of a path, controller and compensator over a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Name of the path.
    pub path: String,
    /// Name of the controller.
    pub controller: String,
    /// Name of the compensator.
    pub compensator: String,
    /// Whether the axes are controlled together.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub coupled: bool,
    /// The metrics.
    pub metrics: Vec<SweepMetric>,
}

/// One metric over a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepMetric {
    /// Name, such as `peak_error`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// One for each value of the sweep; `null` where the motion has no such metric or the run could not be made.
    pub values: Vec<Option<f64>>,
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyInput {
    /// Path, as it was opened.
    pub path: String,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
}

/// The axis, resolved to SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulatedAxis {
    /// `linear` or `rotary`.
    pub kind: String,
    /// Where its friction comes from.
    pub origin: String,
    /// Parameters of the law, and the mass.
    pub parameters: Vec<AxisParameter>,
    /// `capped` or `constant`.
    pub sigma1: String,
    /// Moving mass or inertia.
    pub mass: f64,
    /// Control rate, Hz.
    pub rate_hz: f64,
    /// Plant steps in one control period.
    pub substeps: u32,
    /// Transport delay, s.
    pub delay_s: f64,
    /// Time constant of the current loop, s.
    pub current_lag_s: f64,
    /// Largest force of the drive; `null` without a limit.
    pub peak_force: Option<f64>,
    /// One encoder step, m or rad.
    pub encoder: f64,
    /// Standard deviation of the noise on the position, m or rad.
    pub position_noise: f64,
    /// Damper beside the law, N s/m or N m s/rad.
    #[serde(default, skip_serializing_if = "is_none")]
    pub viscous: f64,
    /// Spring to the origin, N/m or N m/rad.
    #[serde(default, skip_serializing_if = "is_none")]
    pub spring: f64,
    /// Force on the axis over time, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disturbance: Option<DisturbanceEntry>,
    /// Load, in the unit of the model, where friction depends on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<f64>,
    /// K, where friction depends on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<f64>,
    /// Where the origin of the axis lies in the log of the model, m (rad), where friction depends on the position.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<f64>,
    /// Amplifier and motor, where the command is a voltage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub voltage: Option<VoltageEntry>,
}

/// A force on the axis over time, against the positive direction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DisturbanceEntry {
    /// `constant`, `sine` or `file`.
    pub kind: String,
    /// N or N m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<f64>,
    /// N or N m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<f64>,
    /// Hz
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency_hz: Option<f64>,
    /// rad
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase_rad: Option<f64>,
}

/// Amplifier and motor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VoltageEntry {
    /// N/A or N m/A.
    pub force_constant: f64,
    /// A/V; one over the resistance of a motor on a voltage.
    pub amplifier_gain: f64,
    /// V s/m or V s/rad.
    pub back_emf: f64,
    /// Largest voltage, V; `null` without a limit.
    pub limit: Option<f64>,
}

/// One parameter of the axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisParameter {
    /// Name, such as `sigma0`.
    pub name: String,
    /// Value in `unit`.
    pub value: f64,
    /// SI unit.
    pub unit: String,
}

/// A reference motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathEntry {
    /// Its name.
    pub name: String,
    /// Kind, as in the study file.
    pub kind: String,
    /// Length, s.
    pub duration_s: f64,
    /// Time from which it counts, s.
    pub skip_s: f64,
}

/// One cell of the grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResultRow {
    /// Name of the path.
    pub path: String,
    /// Name of the controller.
    pub controller: String,
    /// Name of the compensator.
    pub compensator: String,
    /// Whether the axes are controlled together.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub coupled: bool,
    /// The parameters that it assumed for the axis: `exact`, `±10 %`, `100 draws`.
    pub parameters: String,
    /// Runs that count here.
    pub runs: usize,
    /// Runs in which the watchdog switched the compensation off.
    pub switched_off: usize,
    /// The metrics.
    pub metrics: Vec<MetricEntry>,
}

fn is_none(value: &f64) -> bool {
    *value == 0.0
}

fn scheme(compensator: &str, coupled: bool) -> String {
    match (coupled, compensator) {
        (false, name) => name.into(),
        (true, "none") => "coupling".into(),
        (true, name) => format!("{name}, coupling"),
    }
}

impl SweepRow {
    /// The compensator, and the coupling where there is one.
    pub fn scheme(&self) -> String {
        scheme(&self.compensator, self.coupled)
    }

    /// A metric by its name.
    pub fn metric(&self, name: &str) -> Option<&SweepMetric> {
        self.metrics.iter().find(|m| m.name == name)
    }
}

impl PromiseEntry {
    /// The compensator, and the coupling where there is one.
    pub fn scheme(&self) -> String {
        scheme(&self.compensator, self.coupled)
    }
}

impl ResultRow {
    /// The metric by which compensators are compared: the largest error.
    pub fn judged(&self) -> Option<&MetricEntry> {
        let contour = self.metric("contour_peak");
        contour.or_else(|| self.metric("peak_error"))
    }

    /// What became of the compensation: `switched off`, with how often in several runs; else nothing.
    pub fn remarks(&self) -> String {
        match self.switched_off {
            0 => String::new(),
            n if n == self.runs => "switched off".into(),
            n => format!("switched off in {n} of {}", self.runs),
        }
    }

    /// The compensator, and the coupling where there is one.
    pub fn scheme(&self) -> String {
        scheme(&self.compensator, self.coupled)
    }

    /// A metric by its name.
    pub fn metric(&self, name: &str) -> Option<&MetricEntry> {
        self.metrics.iter().find(|m| m.name == name)
    }
}

/// One metric over the runs of a row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MetricEntry {
    /// Name, such as `reversal_peak`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Mean over the runs; the value where there is one run.
    pub mean: f64,
    /// Least of all runs.
    pub least: f64,
    /// Largest of all runs.
    pub largest: f64,
    /// What is left of the same metric without compensation on the same axis, percent: what 90 % of further axes lie
    /// between, of the axes that a promise is drawn from; `null` for other rows, and without compensation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left90_percent: Option<[f64; 2]>,
    /// What 95 % of the runs lie between, for draws from a covariance.
    pub interval95: Option<[f64; 2]>,
    /// By how much the mean is below that of the same path and controller without compensation, percent; negative
    /// where it is above, `null` where that mean is zero or this row is the one without compensation.
    pub reduction_percent: Option<f64>,
    /// The same of the largest.
    pub worst_reduction_percent: Option<f64>,
}
