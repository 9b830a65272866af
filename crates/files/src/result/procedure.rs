//! What the procedures add to `result.json`; each section stands only where it was used.

use super::SearchedEntry;
use serde::{Deserialize, Serialize};

/// The static map: forces at constant velocities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StaticMapEntry {
    /// Unit of velocities.
    pub velocity_unit: String,
    /// Unit of forces.
    pub force_unit: String,
    /// Scatter of the points beyond their standard errors, in `force_unit`.
    pub scatter: f64,
    /// The points, by velocity.
    pub points: Vec<StaticPointEntry>,
    /// Stretches of nearly constant velocity that were not used as points.
    pub rejected: Vec<RejectedEntry>,
    /// What a search found before least squares, where one was asked for.
    #[serde(default)]
    pub searched: Option<SearchedEntry>,
}

/// One constant-velocity stretch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StaticPointEntry {
    /// Log it is from.
    pub path: String,
    /// First instant that counts, s.
    pub start_s: f64,
    /// Last instant, s.
    pub end_s: f64,
    /// Mean velocity.
    pub velocity: f64,
    /// Mean force.
    pub force: f64,
    /// Standard error of the mean force.
    pub force_std: f64,
    /// Force of the map.
    pub model: f64,
    /// Weight that the robust loss left it, 0 to 1.
    pub weight: f64,
    /// Samples that count.
    pub samples: usize,
    /// Effective number of independent samples among them.
    pub effective_samples: f64,
    /// Time dropped at the start, s.
    pub dropped_s: f64,
    /// Whole cogging pitches averaged over.
    pub pitches: usize,
}

/// A stretch that was left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RejectedEntry {
    /// Log it is in.
    pub path: String,
    /// First instant, s.
    pub start_s: f64,
    /// Last instant, s.
    pub end_s: f64,
    /// Mean velocity.
    pub velocity: f64,
    /// Why.
    pub reason: String,
}

/// One break-away run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BreakAwayEntry {
    /// The log.
    pub path: String,
    /// Rate of the force until break-away, force unit per second.
    pub rate: f64,
    /// Force at break-away, force unit.
    pub force: f64,
    /// Standard deviation of the force about its ramp, force unit.
    pub force_scatter: f64,
    /// Instant, s.
    pub time_s: f64,
    /// Displacement until then, m or rad.
    pub displacement: f64,
    /// Speed that counts as broken away, m/s or rad/s.
    pub threshold: f64,
    /// Force at which the model passes the same speed, on a ramp of this rate; `null` without a model.
    pub predicted_force: Option<f64>,
    /// Friction at break-away: the force without mass times acceleration there and without the offset; `null` where the mass
    /// is not known.
    #[serde(default)]
    pub friction: Option<f64>,
    /// What of the force is mass times acceleration; `null` where the mass is not known.
    #[serde(default)]
    pub inertia: Option<f64>,
    /// What of the force is the offset of the model; 0 without one.
    #[serde(default)]
    pub offset: f64,
    /// Friction at the same speed in the prediction.
    #[serde(default)]
    pub predicted_friction_there: Option<f64>,
    /// First maximum of friction in the same prediction.
    pub predicted_friction: Option<f64>,
    /// Slips after which the axis stuck again; 0 where it breaks away once and goes on.
    #[serde(default)]
    pub slips: usize,
}

/// Force steps below break-away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PreslidingStepEntry {
    /// The parameters of the result are those of `"simulated"`, the fit by simulation.
    pub used: String,
    /// Unit of displacements.
    pub displacement_unit: String,
    /// Unit of forces.
    pub force_unit: String,
    /// Damping ratio `(sigma1 + sigma2)/(2 sqrt(sigma0 M))` of the result.
    pub damping_ratio: f64,
    /// How much later the position is logged than the force, s.
    pub delay_s: f64,
    /// Its standard deviation, s; `None` at the end of its range.
    pub delay_std_s: Option<f64>,
    /// The published inversion of each log, for comparison.
    pub published: Vec<InversionEntry>,
}

/// The published inversion of one step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InversionEntry {
    /// The log.
    pub path: String,
    /// Height of the force step.
    pub height: f64,
    /// Displacement at which it settles.
    pub settled: f64,
    /// Overshoot as a part of it; `null` without.
    pub overshoot: Option<f64>,
    /// Damping ratio; `null` without overshoot.
    pub damping_ratio: Option<f64>,
    /// `u/x_ss`.
    pub sigma0: f64,
    /// `2 zeta sqrt(sigma0 M) - sigma2`; `null` without overshoot.
    pub sigma1: Option<f64>,
    /// sigma0 against the result, percent.
    pub sigma0_off_percent: f64,
    /// sigma1 against the result, percent.
    pub sigma1_off_percent: Option<f64>,
}

/// Static parameters first, dynamic ones after, against all at once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwoStepEntry {
    /// Where the static parameters come from: `"logs"`, `"static logs"` or `"model"`.
    pub statics: String,
    /// Residual of the two steps on the record, rms.
    pub rmse: f64,
    /// Residual of the joint fit on the same record, rms.
    pub joint_rmse: f64,
    /// Parameters side by side.
    pub parameters: Vec<TwoStepParameter>,
    /// Why they differ, in words.
    pub explanation: Vec<String>,
}

/// One parameter both ways.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwoStepParameter {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// In two steps.
    pub value: f64,
    /// Its standard deviation.
    pub std: Option<f64>,
    /// All at once.
    pub joint: f64,
    /// Its standard deviation.
    pub joint_std: Option<f64>,
    /// The difference in standard deviations of the joint fit; `null` where that has none.
    pub difference_in_std: Option<f64>,
}
