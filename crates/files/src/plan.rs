//! `plan.toml`: a motion to record, and what its log can be expected to show. Schema `stiction.plan/1`.

mod read;

pub use read::{ReadExpected, ReadPlan};

use crate::error::Warning;
use serde::Serialize;
use stiction_plan::Atom;

/// Name of the schema.
pub const SCHEMA: &str = "stiction.plan/1";

/// The whole file. SI units throughout; those of a rotary axis have rad for m, N m for N and kg m2 for kg.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PlanFile {
    /// `stiction.plan/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// Name of the axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// `linear` or `rotary`.
    pub kind: String,
    /// Seed of the axes that it was made for.
    pub seed: u64,
    /// `complete`, or `interrupted`: the choice could have become better.
    pub status: String,
    /// Which motion it is: `designed`, or a hand-made one that was better than what was designed.
    pub motion: String,
    /// From rest to rest, s.
    pub duration: f64,
    /// Position, m (rad), at which the axis has to stand when the motion starts, from which set points count; pieces count from 0.
    #[serde(skip_serializing_if = "is_zero")]
    pub start: f64,
    /// Axes on which pieces were simulated, and others on which the whole motion was.
    pub axes: [usize; 2],
    /// Seconds of motion that were simulated.
    pub simulated: f64,
    /// Choices of pieces that were judged.
    pub evaluations: u64,
    /// Factor on the predicted deviations by which those that are found exceed them, included in what follows.
    pub trust: f64,
    /// Whether it is planned for parameters of each direction.
    #[serde(skip_serializing_if = "is_false")]
    pub asymmetric: bool,
    /// The law that it is planned for where that is not LuGre: `maxwell-slip` or `gms`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub law: Option<String>,
    /// How many elements that has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elements: Option<usize>,
    /// What was not given and is assumed: key, value and unit.
    pub assumed: Vec<Assumed>,
    /// Files that were read.
    pub inputs: Vec<InputEntry>,
    /// What the axis may do.
    pub limits: LimitsEntry,
    /// What moves it and reads it.
    pub rig: RigEntry,
    /// The ranges of the axes that it was made for.
    pub prior: Vec<RangeEntry>,
    /// What a log of it can be expected to show.
    pub parameter: Vec<ExpectedEntry>,
    /// What was wanted, beside what is expected.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub wanted: Vec<WantedEntry>,
    /// Worst parameter of an axis, beside that of motions that need no design.
    pub compared: Vec<ComparedEntry>,
    /// The largest of what happened on any simulated axis.
    pub largest: LargestEntry,
    /// Where to abort.
    pub abort: AbortEntry,
    /// What is not planned for though the axis file asks for it, and what to do about it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warning: Vec<Warning>,
    /// The pieces in their order.
    pub atom: Vec<AtomEntry>,
}

/// For `serde`, which hands on a reference.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The same.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_false(value: &bool) -> bool {
    !*value
}

/// A value that was assumed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Assumed {
    /// Key of the axis file.
    pub key: String,
    /// In `unit`.
    pub value: f64,
    /// SI unit.
    pub unit: String,
}

/// A file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InputEntry {
    /// As given.
    pub path: String,
    /// SHA-256.
    pub sha256: String,
}

/// Limits of the axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LimitsEntry {
    /// From where it stands to either side, m (rad).
    pub stroke: [f64; 2],
    /// Part of the stroke left free at either end.
    pub end_zone: f64,
    /// m/s (rad/s)
    pub speed: f64,
    /// m/s^2 (rad/s^2)
    pub acceleration: f64,
    /// m/s^3 (rad/s^3)
    pub jerk: f64,
    /// N (N m)
    pub rated_force: f64,
    /// N (N m)
    pub peak_force: f64,
}

/// Drive, controller, encoder.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RigEntry {
    /// Rate of the log and of the set points, Hz.
    pub rate: f64,
    /// One encoder step, m (rad).
    pub resolution: f64,
    /// Noise of the logged force, N (N m).
    pub force_noise: f64,
    /// Bandwidth of the speed loop, Hz.
    pub bandwidth: f64,
}

/// A range of the prior, in equal ratios.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RangeEntry {
    /// What.
    pub name: String,
    /// Least and largest, SI.
    pub range: [f64; 2],
}

/// Expected for one parameter; all in percent of its value, of a term beside the law of what `of` says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExpectedEntry {
    /// Name, such as `sigma0`.
    pub name: String,
    /// Of a term: `coulomb`, of which what it adds at its most is given in percent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// Of a term: what its size is multiplied by where it is at its most, SI.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<f64>,
    /// Standard deviation on half of the axes at most.
    pub std_percent: f64,
    /// On nine of ten axes at most.
    pub std90_percent: f64,
    /// Half of the 95 % interval, on half of the axes at most.
    pub interval_percent: f64,
    /// On nine of ten axes at most.
    pub interval90_percent: f64,
}

/// A wish: half of the 95 % interval, percent of the value, on nine of ten axes at most.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WantedEntry {
    /// The parameter, or `all`: the worst.
    pub name: String,
    /// Wanted.
    pub percent: f64,
    /// Expected.
    pub expected90_percent: f64,
    /// Whether that is enough.
    pub met: bool,
}

/// A motion beside others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ComparedEntry {
    /// Which.
    pub name: String,
    /// s
    pub duration: f64,
    /// Half of the 95 % interval of the worst parameter, on half of the axes at most, percent.
    pub interval_percent: f64,
    /// On nine of ten axes at most.
    pub interval90_percent: f64,
    /// Whether it keeps within stroke and speed on every simulated axis.
    pub keeps_limits: bool,
}

/// The largest of what happened.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LargestEntry {
    /// True position, m (rad).
    pub position: [f64; 2],
    /// True speed, m/s (rad/s).
    pub speed: f64,
    /// Force, N (N m).
    pub force: f64,
    /// Its root mean square, N (N m).
    pub force_rms: f64,
    /// Difference of reference and position, m (rad).
    pub following_error: f64,
    /// Share of the time with the force at its limit.
    pub saturated: f64,
}

/// Where a run is to be aborted: beyond what any simulated axis did.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AbortEntry {
    /// m (rad)
    pub following_error: f64,
    /// N (N m)
    pub force: f64,
    /// m/s (rad/s)
    pub speed: f64,
}

/// A piece.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AtomEntry {
    /// When it starts, s.
    pub start: f64,
    /// How long it takes, s.
    pub duration: f64,
    /// `sine` or `move`.
    pub kind: String,
    /// Of a sine, m (rad).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<f64>,
    /// Hz
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency: Option<f64>,
    /// s
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fade_in: Option<f64>,
    /// s
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fade_out: Option<f64>,
    /// Of a move, there, m (rad).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// m/s (rad/s)
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// m/s^2 (rad/s^2)
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<f64>,
    /// m/s^3 (rad/s^3)
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jerk: Option<f64>,
}

impl AtomEntry {
    /// A piece that starts at an instant, s.
    pub fn of(start: f64, atom: &Atom) -> Self {
        let entry = AtomEntry {
            start,
            duration: atom.duration(),
            ..AtomEntry::default()
        };
        match *atom {
            Atom::Sine {
                amplitude,
                frequency,
                fade_in,
                fade_out,
                ..
            } => AtomEntry {
                kind: "sine".into(),
                amplitude: Some(amplitude),
                frequency: Some(frequency),
                fade_in: Some(fade_in),
                fade_out: Some(fade_out),
                ..entry
            },
            Atom::Move {
                distance,
                speed,
                acceleration,
                jerk,
            } => AtomEntry {
                kind: "move".into(),
                distance: Some(distance),
                speed: Some(speed),
                acceleration: Some(acceleration),
                jerk: Some(jerk),
                ..entry
            },
        }
    }
}

impl PlanFile {
    /// The text of the file.
    pub fn to_toml(&self) -> String {
        let body = toml::to_string(self).expect("a plan has only tables, numbers and text");
        crate::visible::toml(format!(
            "# The motion to record, planned by stiction. Units are SI; pieces count from where the axis stands.\n{body}"
        ))
    }
}
