//! What an axis file asks for and a plan does not count on.

use std::fmt;
use stiction_number::full;

/// A key of the axis file, or a term of a first model, that is not planned for.
#[derive(Clone, Debug, PartialEq)]
pub enum Unplanned {
    /// Friction depends on the load.
    Load(&'static str),
    /// Friction depends on the temperature.
    Temperature(&'static str),
    /// Friction depends on the transmitted torque.
    Transmitted(&'static str),
    /// A level of each log.
    Logs(&'static str),
    /// Maxwell-slip elements have no level that depends on the position.
    ElementsByPosition(&'static str),
    /// A map of the level.
    Map,
    /// The Stribeck exponent is fitted.
    FittedExponent,
    /// The Stribeck exponent is given.
    Exponent(f64),
    /// Elements, with the commands that lead to them.
    Elements(String),
    /// No mass is fitted.
    NoMass,
    /// Terms of the first identification.
    FirstModel(Vec<String>),
}

const ABSENT: &str = "planned as if absent, and no interval is expected of it";
const GAUSSIAN: &str = "planned with the Gaussian curve, an exponent of 2";
const CURVE: &str = "Add constant speeds on either side of the Stribeck velocity, such as moves there and back at six speeds in equal ratios";

impl fmt::Display for Unplanned {
    #[rustfmt::skip] // One line a sentence.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Load(key) => write!(f, "terms.{key}: {ABSENT}. Vary the load between runs: record this motion under at least three loads (least, middle, largest) and identify the logs together"),
            Self::Temperature(key) => write!(f, "terms.{key}: {ABSENT}. Vary the temperature between runs: record this motion cold and warm, at least 10 K apart, best also half-way, and identify the logs together"),
            Self::Transmitted(key) => write!(f, "terms.{key}: {ABSENT}. Vary the transmitted torque: record this motion with and without a payload, or on both sides of the vertical and near it (at least two runs), and identify the logs together"),
            Self::Logs(key) => write!(f, "terms.{key}: {ABSENT}. It differs from log to log: record this motion in each state to be compared, at least twice in all"),
            Self::ElementsByPosition(key) => write!(f, "terms.{key}: {ABSENT}. Maxwell-slip elements have no level that depends on the position: plan and identify with --law lugre for it"),
            Self::Map => f.write_str("terms.coulomb_position = \"map\": planned as a straight line, and no interval is expected of the rest. Constant speeds over the whole stroke, there and back, show it"),
            Self::FittedExponent => write!(f, "terms.stribeck_exponent = \"fit\": {GAUSSIAN}, and no interval is expected of it. {CURVE}"),
            Self::Exponent(exponent) => write!(f, "terms.stribeck_exponent = {}: {GAUSSIAN}. {CURVE}", full(*exponent)),
            Self::Elements(steps) => write!(f, "terms.gms_elements: planned for LuGre, and no interval is expected of the elements. Their number and yield points follow from a first log, not from limits: {steps}"),
            Self::NoMass => f.write_str("mass = \"none\": planned as if the mass were fitted, so intervals may come out narrower. Nothing has to be added"),
            Self::FirstModel(terms) => write!(f, "the first identification has {}: {ABSENT}. Ask for it under [terms] of the axis file, where it is fitted again", terms.join(", ")),
        }
    }
}
