//! The axis file as typed: every value still text, nothing checked but its form.

use serde::Deserialize;
use std::collections::BTreeMap;

/// How every message begins that says what a value may be where several kinds are allowed.
pub(crate) const EXPECTS: &str = "give ";

/// The whole file.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawAxis {
    pub name: Option<String>,
    pub kind: Option<String>,
    pub rate: Option<String>,
    pub mass: Option<String>,
    #[serde(default)]
    pub columns: RawColumns,
    #[serde(default)]
    pub log: RawLog,
    #[serde(default)]
    pub text: RawText,
    #[serde(default)]
    pub conditioning: RawConditioning,
    #[serde(default)]
    pub terms: RawTerms,
    #[serde(default)]
    pub report: RawReport,
    pub controller: Option<RawController>,
    #[serde(default)]
    pub simulation: RawSimulation,
}

/// `[columns]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawColumns {
    pub time: Option<RawChannel>,
    pub position: Option<RawChannel>,
    pub velocity: Option<RawChannel>,
    #[serde(alias = "torque", alias = "current")]
    pub force: Option<RawChannel>,
    pub reference: Option<RawChannel>,
    pub temperature: Option<RawChannel>,
    pub load: Option<RawChannel>,
}

/// A column by name, by number, or with all that is known of it.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "give a column name, a column number from 1, or a table with column and, where needed, unit, scale and invert, such as { column = \"qm\", unit = \"m\" }"
)]
pub(crate) enum RawChannel {
    Name(String),
    Index(i64),
    Full(RawFull),
}

/// `{ column = .., unit = .., scale = .., invert = .. }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawFull {
    pub column: RawSelector,
    pub unit: Option<String>,
    pub scale: Option<RawScale>,
    #[serde(default)]
    pub invert: bool,
}

/// A column by name or number.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "give a column name or a column number from 1")]
pub(crate) enum RawSelector {
    Name(String),
    Index(i64),
}

/// A scale with its unit, or a plain number.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "give a scale such as \"35.15 N/V\" or a plain number"
)]
pub(crate) enum RawScale {
    Text(String),
    Number(f64),
}

/// `[log]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawLog {
    pub crop: Option<[String; 2]>,
    pub wrap: Option<String>,
    pub force_limit: Option<String>,
    pub resolution: Option<String>,
}

/// `[text]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawText {
    pub separator: Option<String>,
    pub decimal: Option<String>,
    pub header: Option<bool>,
    pub preamble: Option<usize>,
}

/// `[conditioning]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawConditioning {
    pub source: Option<String>,
    pub source_cutoff: Option<String>,
    pub common_cutoff: Option<String>,
    pub decimate: Option<usize>,
    pub min_speed: Option<String>,
}

/// `[terms]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawTerms {
    pub offset: Option<bool>,
    pub gravity: Option<bool>,
    #[serde(default)]
    pub cogging: Vec<String>,
    pub quadratic_viscous: Option<bool>,
    pub coulomb_load: Option<bool>,
    pub coulomb_temperature: Option<bool>,
    pub coulomb_position: Option<bool>,
    #[serde(default)]
    pub coulomb_pitch: Vec<String>,
    pub sigma2_temperature: Option<bool>,
    pub stribeck_exponent: Option<RawExponent>,
    pub delay: Option<String>,
    pub gms_elements: Option<usize>,
}

/// A number, or the word that makes it an unknown.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "give a number from 0.1 to 10, or \"fit\"")]
pub(crate) enum RawExponent {
    Number(f64),
    Word(String),
}

/// `[report]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawReport {
    pub low_speed: Option<String>,
}

/// `[controller]`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawController {
    pub kind: String,
    pub position_gain: String,
    pub speed_gain: String,
    pub integral_gain: Option<String>,
    pub velocity_feedforward: Option<f64>,
    pub mass_feedforward: Option<String>,
    pub force_limit: Option<String>,
    pub rate: Option<String>,
}

/// `[simulation]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RawSimulation {
    pub force: Option<String>,
    pub segment: Option<String>,
}

/// Parses the text; the error has line and column in its message.
pub(crate) fn parse(text: &str) -> Result<RawAxis, toml::de::Error> {
    toml::from_str(text)
}

/// Keys and lines, to say where a value stands that parsed but makes no sense.
pub(crate) fn line_of(text: &str, key: &str) -> Option<usize> {
    let mut seen = BTreeMap::new();
    let mut table = String::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if let Some(name) = line.strip_prefix('[').and_then(|l| l.split(']').next()) {
            table = format!("{}.", name.trim());
        } else if let Some((name, _)) = line.split_once('=') {
            seen.entry(format!("{table}{}", name.trim().trim_matches('"')))
                .or_insert(i + 1);
        }
    }
    seen.get(key).copied()
}
