//! One log of a batch, and what was identified of it.

use crate::result::ResultFile;
use serde::{Deserialize, Serialize};
use stiction_codes::Code;

/// One log of a batch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LogRow {
    /// Path as it was found or listed.
    pub path: String,
    /// SHA-256 of the bytes that were read, hexadecimal; none where they could not be read.
    pub sha256: Option<String>,
    /// Machine that the log is of: from the list, else the name in the axis file.
    pub machine: Option<String>,
    /// When it was recorded, s; from the list.
    pub time: Option<f64>,
    /// Temperature: from the list, else the mean of the log's own column, in its unit.
    pub temperature: Option<f64>,
    /// Axis file.
    pub axis: Option<String>,
    /// Family of the law that is reported.
    pub law: Option<String>,
    /// Whether each direction has parameters of its own.
    pub asymmetric: Option<bool>,
    /// Method.
    pub method: Option<String>,
    /// Whether the law may be used for compensation on motion like that of the log.
    pub trustworthy: Option<bool>,
    /// Relative error of the fit, percent.
    pub relative_error_percent: Option<f64>,
    /// Samples that count.
    pub samples: Option<u64>,
    /// Codes of the warnings, each once, in alphabetical order.
    pub warnings: Vec<Code>,
    /// Code of the error where nothing was identified.
    pub error: Option<Code>,
    /// Text of the error.
    pub message: Option<String>,
    /// Folder of the report below that of the batch, where reports are written.
    pub report: Option<String>,
    /// Version of stiction.
    pub version: String,
    /// Seed of the search.
    pub seed: u64,
    /// SHA-256 of the log, the options, the axis file and the version: what has the same is not identified again.
    pub key: String,
    /// Parameters; none where nothing was identified.
    pub parameters: Vec<ParameterRow>,
}

/// One parameter of a log.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ParameterRow {
    /// Name, such as `coulomb`.
    #[serde(rename = "parameter")]
    pub name: String,
    /// Value in `unit`; none where it is no finite number.
    pub value: Option<f64>,
    /// SI unit.
    pub unit: String,
    /// Standard deviation; none where the data say nothing.
    pub std: Option<f64>,
    /// Lower end of the 95 % interval; none where it is open.
    pub low: Option<f64>,
    /// Upper end of it.
    pub high: Option<f64>,
    /// Whether the log determines it.
    pub identifiable: bool,
    /// `identified` or `given`.
    pub origin: String,
}

impl LogRow {
    /// Takes what was identified.
    pub fn take(&mut self, result: &ResultFile) {
        let mut warnings: Vec<Code> = result.warnings.iter().map(|w| w.code).collect();
        // Of many logs nobody reads the reports, and what an axis file would settle changes every number.
        if result.inputs.iter().any(|input| !input.assumed.is_empty()) {
            warnings.push(Code::UnitAssumed);
        }
        warnings.sort_by_key(|code| code.as_str());
        warnings.dedup();
        self.law = Some(result.law.clone());
        self.asymmetric = Some(result.asymmetric);
        self.method = Some(result.method.clone());
        self.trustworthy = Some(result.trust.trustworthy);
        self.relative_error_percent = Some(result.fit.relative_error_percent);
        self.samples = Some(result.fit.samples as u64);
        self.warnings = warnings;
        let finite = |x: f64| x.is_finite().then_some(x);
        let parameters = result.parameters.iter().map(|p| {
            let range = p.range();
            ParameterRow {
                name: p.name.clone(),
                value: finite(p.value),
                unit: p.unit.clone(),
                std: p.std,
                low: range.and_then(|(low, _)| finite(low)),
                high: range.and_then(|(_, high)| finite(high)),
                identifiable: p.identifiable,
                origin: p.origin.name().into(),
            }
        });
        self.parameters = parameters.collect();
    }
}
