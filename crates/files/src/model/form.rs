//! The form of a model file, and how it is written.

use crate::result::{
    CovarianceEntry, FrictionLineEntry, ParameterEntry, PitchEntry, RangeEntry, RemainingEntry,
    ResultFile,
};
use serde::Serialize;
use stiction_codes::Code;
use stiction_parameters::{LawKind, Name, ParameterSet};

/// Name of the schema.
pub const SCHEMA: &str = "stiction.model/1";

/// The whole file.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ModelFile {
    /// `stiction.model/1`.
    pub schema: String,
    /// Name of the axis.
    pub name: Option<String>,
    /// `linear` or `rotary`.
    pub kind: String,
    /// Family of the law.
    pub law: String,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
    /// Unit of the force channel.
    pub force_unit: String,
    /// Whether the result of the identification is trustworthy.
    pub trustworthy: bool,
    /// Where the numbers came from.
    pub source: SourceEntry,
    /// What the samples that were fitted have seen of what friction depends on.
    #[serde(skip_serializing_if = "RangeEntry::is_empty")]
    pub range: RangeEntry,
    /// Pitches of waves along the position.
    #[serde(skip_serializing_if = "PitchEntry::is_empty")]
    pub pitch: PitchEntry,
    /// Gap between motor and load, where one is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backlash: Option<BacklashEntry>,
    /// Parameters of the law.
    pub parameter: Vec<ModelParameter>,
    /// Covariance of the identified parameters from day to day.
    pub covariance: CovarianceEntry,
    /// Coulomb and viscous friction as simulators take it, with half widths of 95 % intervals; absent where they are not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<FrictionLineEntry>,
    /// What the law leaves of the force, where that is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remaining: Option<RemainingEntry>,
}

/// A gap between motor and load, with the encoder on the motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BacklashEntry {
    /// Lost motion, m or rad of the axis.
    pub width: f64,
    /// 95 % interval of the width; absent where somebody wrote the width.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ci95: Option<[f64; 2]>,
    /// The load, as a part of the moving mass, 0 to 1; absent where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<f64>,
}

impl BacklashEntry {
    /// The gap that a result names; `None` where none has a width with an interval.
    fn of(result: &ResultFile) -> Option<Self> {
        let found = result.effects.iter().find(|e| e.code == Code::Backlash)?;
        let entry = Self {
            width: found.size("lost_motion")?,
            ci95: Some(found.ci95?),
            load: found.size("load").map(|percent| 0.01 * percent),
        };
        super::read::is_gap(&entry).then_some(entry)
    }
}

/// Where the numbers came from.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SourceEntry {
    /// Version of stiction.
    pub version: String,
    /// Search method.
    pub method: String,
    /// Seed of the search.
    pub seed: u64,
    /// Largest speed of the logs that were fitted, m/s or rad/s; absent where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub top_speed: Option<f64>,
    /// Largest sample rate of the logs that were fitted, Hz; absent where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate_hz: Option<f64>,
    /// Paths and hashes of the logs.
    pub inputs: Vec<SourceInput>,
}

/// One log.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SourceInput {
    /// Path as given.
    pub path: String,
    /// SHA-256 of the file.
    pub sha256: String,
}

/// One parameter.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ModelParameter {
    /// Name, such as `sigma0`.
    pub name: String,
    /// Symbol for people.
    pub symbol: String,
    /// Value in `unit`.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// Standard deviation; absent where the data say nothing.
    pub std: Option<f64>,
    /// 95 % interval; absent where the data bound it on no side, an infinite end where on one side
    /// only.
    pub ci95: Option<[f64; 2]>,
    /// Half width of the 95 % interval for another motion, in the unit of the value, of a parameter that is positive by nature the
    /// value times that of its logarithm; absent where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transfer: Option<f64>,
    /// `linear` or `profile`; absent without an interval.
    pub interval: Option<String>,
    /// Whether the data determine it.
    pub identifiable: bool,
    /// `identified` or `given`.
    pub origin: String,
}

impl From<&ParameterEntry> for ModelParameter {
    fn from(p: &ParameterEntry) -> Self {
        Self {
            name: p.name.clone(),
            symbol: p.symbol.clone(),
            value: p.value,
            unit: p.unit.clone(),
            std: p.std,
            ci95: p.range().map(|(low, high)| [low, high]),
            transfer: (p.half_width)
                .map(|half| half.transfer)
                .filter(|half| half.is_finite()),
            interval: p.interval.clone(),
            identifiable: p.identifiable,
            origin: p.origin.name().into(),
        }
    }
}

/// Whether a parameter is one of the machine rather than of one of the logs.
fn is_of_the_machine(name: &str) -> bool {
    let name = name.parse::<Name>();
    !name.is_ok_and(|name| name.quantity.is_of_a_log())
}

fn of_the_machine(covariance: &CovarianceEntry) -> CovarianceEntry {
    let names = covariance.names.iter().enumerate();
    let kept: Vec<usize> = names
        .filter(|(_, name)| is_of_the_machine(name))
        .map(|(i, _)| i)
        .collect();
    CovarianceEntry {
        names: kept.iter().map(|&i| covariance.names[i].clone()).collect(),
        matrix: (kept.iter())
            .map(|&i| kept.iter().map(|&j| covariance.matrix[i][j]).collect())
            .collect(),
    }
}

impl ModelFile {
    /// The model that a result holds: of several logs with levels of their own that of the first.
    pub fn from_result(result: &ResultFile) -> Self {
        Self {
            schema: SCHEMA.into(),
            name: result.axis.name.clone(),
            kind: result.axis.kind.clone(),
            law: result.law.clone(),
            asymmetric: result.asymmetric,
            force_unit: result.axis.force_unit.clone(),
            trustworthy: result.trust.trustworthy,
            source: SourceEntry {
                version: result.version.clone(),
                method: result.method.clone(),
                seed: result.seed,
                top_speed: result.top_speed,
                rate_hz: result.rate_hz(),
                inputs: result
                    .inputs
                    .iter()
                    .map(|i| SourceInput {
                        path: i.path.clone(),
                        sha256: i.sha256.clone(),
                    })
                    .collect(),
            },
            range: result.range.clone(),
            pitch: result.pitch.clone(),
            backlash: BacklashEntry::of(result),
            parameter: (result.parameters.iter())
                .filter(|p| is_of_the_machine(&p.name))
                .map(ModelParameter::from)
                .collect(),
            covariance: of_the_machine(&result.covariance),
            line: (result.friction_curve.as_ref()).and_then(|curve| curve.line.clone()),
            // A unit that is wrong by many powers of ten gives sizes that no machine has, and a model with them would not be read.
            remaining: result.remaining.clone().filter(super::read::is_read),
        }
    }

    /// The text of the file.
    pub fn to_toml(&self) -> String {
        let body = toml::to_string(self).expect("a model has only tables, numbers and text");
        crate::visible::toml(format!(
            "# Friction model identified by stiction. Units are SI; ci95 is the 95 % interval.\n{body}"
        ))
    }

    /// Its parameters with their values; `None` for a law of no known name.
    pub fn values(&self) -> Option<ParameterSet> {
        let kind = LawKind::from_name(&self.law)?;
        let values = self.parameter.iter().map(|p| (p.name.as_str(), p.value));
        Some(ParameterSet::from_text(kind, values))
    }
}
