//! `result.json`: everything an identification found. Schema `stiction.result/1`, only ever extended.

mod action;
mod effects;
mod friction;
mod kinds;
mod operating_range;
mod planned;
mod procedure;
mod searched;
mod trust;

use crate::error::Warning;
pub use action::Action;
pub use effects::{EffectEntry, SizeEntry};
pub use friction::{BandEntry, FrictionAtEntry, FrictionCurveEntry, FrictionLineEntry, ValueEntry};
pub use kinds::{Origin, Status};
pub use operating_range::{LevelAlongEntry, PitchEntry, RangeEntry};
pub use planned::{PieceEntry, PlannedEntry, PlannedParameter};
pub use procedure::{
    BreakAwayEntry, InversionEntry, PreslidingStepEntry, RejectedEntry, StaticMapEntry,
    StaticPointEntry, TwoStepEntry, TwoStepParameter,
};
pub use searched::{Evaluations, SearchedEntry, SearchedParameter, SearchedPoint, end_of};
use serde::{Deserialize, Serialize};
use stiction_codes::Code;
pub use trust::{BetterLaw, CauseEntry, Compensation, Trust};

/// Name of the schema.
pub const SCHEMA: &str = "stiction.result/1";

/// The whole file; described key by key in `docs/result.md`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResultFile {
    /// `stiction.result/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// Seed of the search.
    pub seed: u64,
    /// The logs that were fitted.
    pub inputs: Vec<Input>,
    /// The axis, resolved.
    pub axis: ResolvedAxis,
    /// Family of the law.
    pub law: String,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
    /// What of the law is left out: `stribeck` (`Fs = Fc`), `sigma1` (0).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without: Vec<String>,
    /// Who chose the law: `user`, or by what the data did: `cross-validation`, `validation`, `bic`.
    #[serde(default = "by_user")]
    pub law_chosen_by: String,
    /// Search method.
    pub method: String,
    /// What the law may be used for, and what to do next.
    pub trust: Trust,
    /// Parameters of the law.
    pub parameters: Vec<ParameterEntry>,
    /// Covariance of the identified parameters.
    pub covariance: CovarianceEntry,
    /// What the law leaves of the force; absent after a method that does not fit the force sample by sample.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remaining: Option<RemainingEntry>,
    /// Fit on the logs it was fitted to.
    pub fit: FitEntry,
    /// The same near zero speed; absent where no sample is slow.
    pub low_speed: Option<LowSpeedEntry>,
    /// What the residual shows, the largest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<EffectEntry>,
    /// Fit on logs (or parts of them) that were not fitted.
    pub validation: Vec<ValidationEntry>,
    /// What was simulated, where the method simulates the axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub simulation: Option<SimulationEntry>,
    /// Laws side by side on held-out samples.
    pub laws: Vec<LawEntry>,
    /// Forces at constant velocities, where the method uses them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_map: Option<StaticMapEntry>,
    /// Static parameters first against all at once, where that is the method.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_then_dynamic: Option<TwoStepEntry>,
    /// Force steps, where that is the method.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub presliding_step: Option<PreslidingStepEntry>,
    /// Break-away runs, where given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub break_away: Vec<BreakAwayEntry>,
    /// Numbers of elements that were tried for a Maxwell-slip law; absent where there was no choice.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub elements: Vec<ElementsEntry>,
    /// Largest speed of the samples that were fitted, m/s or rad/s; absent where nothing moved.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub top_speed: Option<f64>,
    /// What the samples that were fitted have seen of position, load, temperature and acceleration.
    #[serde(default, skip_serializing_if = "RangeEntry::is_empty")]
    pub range: RangeEntry,
    /// Pitches of waves along the position; absent without any.
    #[serde(default, skip_serializing_if = "PitchEntry::is_empty")]
    pub pitch: PitchEntry,
    /// What the logs show of the plan that they were recorded by, where it was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub planned: Option<PlannedEntry>,
    /// Friction in steady sliding by speed; absent where the axis does not slide.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_curve: Option<FrictionCurveEntry>,
    /// The Coulomb level along the stroke; absent where it is one level.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub level_along: Vec<LevelAlongEntry>,
    /// How the search went.
    pub search: Search,
    /// What a search found before the least squares that end it; absent for other methods.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub searched: Option<SearchedEntry>,
    /// What to beware of.
    pub warnings: Vec<Warning>,
}

impl ResultFile {
    /// Largest sample rate of its logs, Hz; `None` where it is not known.
    pub fn rate_hz(&self) -> Option<f64> {
        let rates = self.inputs.iter().map(|input| input.rate_hz);
        let known = rates.filter(|rate| rate.is_finite() && *rate > 0.0);
        known.reduce(f64::max)
    }

    /// The searches that were made, in their order: for the steady curve, then for the rest.
    pub fn searches(&self) -> impl Iterator<Item = &SearchedEntry> {
        let curve = self.static_map.as_ref();
        let curve = curve.and_then(|map| map.searched.as_ref());
        curve.into_iter().chain(&self.searched)
    }
}

/// The entry of results that were written before the data could choose a law.
fn by_user() -> String {
    "user".into()
}

/// The resolved axis as it goes into `result.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResolvedAxis {
    /// Name of the axis.
    pub name: Option<String>,
    /// The axis file; absent where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Whether the logs are all that the axis file lists under `[[log]]`.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub listed: bool,
    /// Whether the axis file has `[limits]`, within which a motion can be planned.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub limits: bool,
    /// `linear` or `rotary`.
    pub kind: String,
    /// Unit of the force channel after scaling.
    pub force_unit: String,
    /// How each column was understood.
    pub columns: Vec<String>,
    /// How the record was conditioned.
    pub conditioning: Vec<String>,
    /// How long the logs are not fitted at the start and after gaps, where that is much of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unsettled: Option<Unsettled>,
    /// Linear terms beside the friction law.
    pub terms: Vec<String>,
}

/// What of the logs is not fitted, since the force depends there on what was before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unsettled {
    /// How long, s.
    pub seconds: f64,
    /// What part of them that is, 0 to 1.
    pub part: f64,
    /// How far the axis slides until it does not, m or rad.
    pub travel: f64,
}

/// One log as it was read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// Path as given.
    pub path: String,
    /// The part of it that is fitted, in words; none where that is all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
    /// Samples read.
    pub samples: usize,
    /// Median sample rate, Hz.
    pub rate_hz: f64,
    /// What was detected.
    pub detected: Vec<String>,
    /// Stretches that the fit did not see, though nothing is wrong with them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub excluded: Vec<ExcludedEntry>,
    /// Columns that come from other files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joined: Vec<JoinedEntry>,
    /// Rows that a column of the log leaves out; none without such a column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_enabled: Option<NotEnabledEntry>,
    /// Units that neither file nor axis file gives: every number rests on them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assumed: Vec<AssumedEntry>,
}

/// A column that comes from another file than the log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JoinedEntry {
    /// What the column is: `force`.
    pub column: String,
    /// Path of the file.
    pub path: String,
    /// SHA-256 of that file, hexadecimal.
    pub sha256: String,
}

/// Rows in which the axis is not enabled, or in another mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NotEnabledEntry {
    /// The column that says so, by number and name: `7 "Enabled"`.
    pub column: String,
    /// Rows that are left out.
    pub rows: usize,
    /// Of so many.
    pub of: usize,
}

/// A unit that was assumed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AssumedEntry {
    /// What the column is: `position`, `force`.
    pub column: String,
    /// The unit that was assumed.
    pub unit: String,
    /// The line for `[columns]` of the axis file that settles it.
    pub line: String,
}

/// A stretch of a log that the fit did not see.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExcludedEntry {
    /// Why; each code has a page in `docs/codes/`.
    pub code: Code,
    /// Time of its first sample, s from the first sample of the log.
    pub from_s: f64,
    /// Time of its last sample, s.
    pub to_s: f64,
    /// Its samples.
    pub samples: usize,
}

/// One parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterEntry {
    /// Name, such as `sigma0`.
    pub name: String,
    /// Symbol for people.
    pub symbol: String,
    /// Value in `unit`.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// Standard deviation of the same test on another day; `null` where the data say nothing.
    pub std: Option<f64>,
    /// What encoder steps and filters are estimated to have added; `null` where not estimated.
    #[serde(default)]
    pub bias: Option<f64>,
    /// 95 % interval; `null` where the data bound it on no side, a `null` end where on one side only.
    pub ci95: Option<[Option<f64>; 2]>,
    /// Half widths of its 95 % interval by what it is asked for; `null` where only `ci95` is known, which is that of `repeat`.
    #[serde(default)]
    pub half_width: Option<HalfWidthEntry>,
    /// `linear`, `profile` or `state-space`; `null` without an interval.
    #[serde(default)]
    pub interval: Option<String>,
    /// Whether the data determine it.
    pub identifiable: bool,
    /// `identified` or `given`.
    pub origin: Origin,
    /// Why it is not identifiable; empty if it is.
    pub reason: String,
    /// What a parameter that is not identifiable moves together with.
    #[serde(default)]
    pub moves_with: Vec<PartnerEntry>,
    /// What motion would determine it; empty if it is identifiable.
    #[serde(default)]
    pub advice: String,
}

/// Half widths of a 95 % interval in the unit of the value, of a parameter that is positive by nature the value times that of its
/// logarithm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HalfWidthEntry {
    /// The same test again, now.
    pub at_once: f64,
    /// The same test on another day.
    pub repeat: f64,
    /// Another motion of the same kind.
    pub transfer: f64,
}

impl ParameterEntry {
    /// The 95 % interval, infinite where it is open; `None` where it is open to both sides.
    pub fn range(&self) -> Option<(f64, f64)> {
        self.ci95.map(|[low, high]| {
            (
                low.unwrap_or(f64::NEG_INFINITY),
                high.unwrap_or(f64::INFINITY),
            )
        })
    }
}

/// A parameter that another one moves together with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PartnerEntry {
    /// Name.
    pub name: String,
    /// Correlation of the two estimates, -1 to 1.
    pub correlation: f64,
}

/// Covariance matrix with its names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CovarianceEntry {
    /// Names of rows and columns.
    pub names: Vec<String>,
    /// Row by row; zero rows for parameters that the data do not determine at all.
    pub matrix: Vec<Vec<f64>>,
}

/// How well a model explains a force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitEntry {
    /// What was fitted.
    pub signal: String,
    /// Its unit.
    pub unit: String,
    /// Root mean square of the residual.
    pub rmse: f64,
    /// `100 rms(residual) / rms(measured)`.
    pub relative_error_percent: f64,
    /// Part of the variance that is explained; `null` for a force that does not vary.
    pub r2: Option<f64>,
    /// Samples that count.
    pub samples: usize,
    /// Effective number of independent samples in the residual.
    pub effective_samples: f64,
}

/// A fit near zero speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LowSpeedEntry {
    /// Samples slower than this count.
    pub bound: f64,
    /// Unit of the bound.
    pub bound_unit: String,
    /// The fit.
    #[serde(flatten)]
    pub fit: FitEntry,
}

/// A fit on a log that was not fitted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ValidationEntry {
    /// Path as given, or which part of the log.
    pub path: String,
    /// The fit.
    #[serde(flatten)]
    pub fit: FitEntry,
    /// The same near zero speed.
    pub low_speed: Option<LowSpeedEntry>,
}

/// The simulated axis of an output-error fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulationEntry {
    /// `open`: the logged force drives the axis; `closed`: the controller of the axis file does.
    #[serde(rename = "loop")]
    pub kind: String,
    /// `held` or `centred`.
    pub force_is: String,
    /// Pieces that were simulated in the fit, each from a start of its own that is fitted too.
    pub runs: usize,
    /// Stretches without a gap that the pieces were cut from.
    #[serde(default)]
    pub stretches: usize,
    /// Longest piece of the fit, s; `null` where every stretch ran whole.
    #[serde(default)]
    pub segment_s: Option<f64>,
    /// Values that were fitted for the starts of the runs, beside the parameters.
    #[serde(default)]
    pub start_values: usize,
    /// Plant steps in one control period (in open loop: in one sample).
    pub substeps: usize,
    /// Where the search started: `separable` or `runs`.
    pub start: String,
    /// Position error.
    pub position: FitEntry,
    /// Rms that one encoder count alone would leave, in the unit of the position; `null` where the
    /// count is not known.
    pub quantisation_floor: Option<f64>,
    /// Force error in closed loop; `null` in open loop, where the force is given.
    pub force: Option<FitEntry>,
    /// Force errors of the validation in closed loop, in the order of `validation`.
    pub validation_force: Vec<FitEntry>,
    /// Stretches without a gap of each validation, each simulated whole from one start, in the order of `validation`.
    #[serde(default)]
    pub validation_runs: Vec<usize>,
    /// Position error where each fitted stretch is simulated whole; `null` where the fit did so.
    #[serde(default)]
    pub whole: Option<FitEntry>,
    /// Position errors over a short horizon; `null` in closed loop, and where no stretch is longer.
    #[serde(default)]
    pub short_horizon: Option<ShortHorizonEntry>,
}

/// The position errors of simulations that start anew again and again, each start fitted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShortHorizonEntry {
    /// Longest piece simulated from one start, s.
    pub seconds: f64,
    /// Of the fitted logs.
    pub fit: FitEntry,
    /// Of each validation, in its order; `null` where no stretch is longer than the horizon.
    pub validation: Vec<Option<FitEntry>>,
}

/// What a law leaves of the force beyond white noise, by what it goes with; in the unit of the force and SI.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RemainingEntry {
    /// How far the level of friction is from its mean at a place or time, as a part of it.
    pub level: f64,
    /// After a reversal.
    pub shapes: Vec<ShapeEntry>,
    /// From place to place, rms.
    pub place: f64,
    /// Wavelength of that, m or rad.
    pub place_length: f64,
    /// By itself, rms.
    pub wandering: f64,
    /// Time constant of that, s.
    pub memory: f64,
}

/// A force between two travels after a reversal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeEntry {
    /// Rms over reversals.
    pub force: f64,
    /// m or rad
    pub short: f64,
    /// m or rad
    pub long: f64,
}

/// One law in the comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawEntry {
    /// Family.
    pub law: String,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
    /// What of the law is left out, as in [`ResultFile::without`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without: Vec<String>,
    /// Whether its Stribeck exponent is fitted; absent where it is assumed or given.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub exponent_fitted: bool,
    /// Whether a constant force is fitted beside it.
    #[serde(default)]
    pub offset: bool,
    /// Whether quadratic viscous friction was fitted beside it.
    #[serde(default)]
    pub quadratic_viscous: bool,
    /// Elements of a Maxwell-slip law; absent for other laws.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<usize>,
    /// Fitted parameters.
    pub parameters: usize,
    /// Relative error on the samples it was fitted to, percent.
    pub fitted_error_percent: f64,
    /// Relative error on held-out samples, percent; `null` where it could not be had.
    pub held_out_error_percent: Option<f64>,
    /// The same near zero speed.
    pub held_out_low_speed_error_percent: Option<f64>,
    /// Held-out error above the least of all laws, percent of it; `null` without a held-out error.
    #[serde(default)]
    pub held_out_excess_percent: Option<f64>,
    /// Standard error of that difference, percent of the same.
    #[serde(default)]
    pub held_out_excess_std_percent: Option<f64>,
    /// Akaike's criterion above the least of all laws, on effective samples.
    #[serde(default)]
    pub aic_difference: Option<f64>,
    /// Bayesian criterion (Schwarz) above the least of all laws.
    #[serde(default)]
    pub bic_difference: Option<f64>,
    /// Whether the log determines its Coulomb level.
    #[serde(default)]
    pub determined: bool,
    /// Why a compensator should not rely on it although it may hold well, such as a parameter at the end of its search
    /// range; `null` where it may.
    #[serde(default)]
    pub held_back: Option<String>,
    /// Whether this is the simplest law whose held-out error is within its noise, or 5 %, of the
    /// least.
    pub best: bool,
    /// Whether its held-out error is within its noise, or 5 %, of the least.
    #[serde(default)]
    pub as_good: bool,
    /// Whether it is the law of the result.
    #[serde(default)]
    pub reported: bool,
}

/// One number of elements of a Maxwell-slip law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ElementsEntry {
    /// How many elements.
    pub elements: usize,
    /// Relative error where it was fitted, percent.
    pub fitted_error_percent: f64,
    /// Relative error over blocks left out in turn, percent; `null` where it could not be had.
    pub held_out_error_percent: Option<f64>,
    /// Whether it was chosen.
    pub chosen: bool,
}

/// How the search went.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Search {
    /// `converged`, `budget`, `stalled` or `interrupted`.
    pub status: Status,
    /// Evaluations of the model in all.
    pub evaluations: usize,
    /// Of those, with sensitivities.
    pub with_sensitivities: usize,
    /// Of all, on a thinned record.
    pub thinned: usize,
    /// Steps of all descents.
    pub iterations: usize,
    /// Time of the whole identification, s.
    pub wall_s: f64,
}
