//! The axis of a study with other parameters than its model has: which can be moved, and how far.

use super::belief::{Belief, law_of};
use super::model::is_simulated;
use super::plan::Machine;
use crate::symbols;
use serde::Serialize;
use stiction_number::four_digits as short;
use stiction_parameters::{Name, Quantity};

/// How far a parameter is moved to where nothing bounds it, as a part of its value, dimensionless ...
const WITHOUT_BOUND: f64 = 3.0;
/// ... and where it has no interval, since it was given, dimensionless.
const GIVEN: f64 = 0.2;

/// A parameter of the axis that can be moved, SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Knob {
    /// Its name, such as `sigma0`.
    pub name: String,
    /// Its symbol for people.
    pub symbol: String,
    /// Unit of all values here.
    pub unit: String,
    /// Its value in the model.
    pub value: f64,
    /// Least value that it is moved to.
    pub low: f64,
    /// Largest value that it is moved to.
    pub high: f64,
    /// Where these come from.
    pub range: Range,
}

/// Where the ends of a range come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Range {
    /// The 95 % interval of the identification.
    Interval,
    /// The log leaves an end open: a third, or three times the value.
    Open,
    /// It has no interval: 20 % to both sides.
    Given,
}

impl Machine {
    /// The parameters that can be moved, in the order of the model. The elements of a law that has them hang together and stay.
    pub fn knobs(&self) -> Vec<Knob> {
        let all = self.model.parameters.iter();
        let moves = |name: Name| {
            let stays = matches!(
                name.quantity,
                Quantity::Delay
                    | Quantity::ElementStiffness(_)
                    | Quantity::ElementYield(_)
                    | Quantity::ElementForce(_)
            );
            is_simulated(name.quantity) && !stays
        };
        let mut knobs: Vec<Knob> = all
            .filter(|p| moves(p.name) && p.name != Quantity::Mass)
            .map(|p| self.knob(p.name, p.value, &p.unit))
            .collect();
        let force = symbols::force_unit(self.motion);
        let unit = symbols::unit(Quantity::Mass.dimension(), self.motion, force, "");
        knobs.push(self.knob(Quantity::Mass.into(), self.mass, &unit));
        knobs.retain(|knob| knob.high > knob.low);
        knobs
    }

    fn knob(&self, name: Name, value: f64, unit: &str) -> Knob {
        let text = name.to_string();
        let file = self.model.file().map(|read| &read.model);
        let found = file.and_then(|model| model.parameter.iter().find(|p| p.name == text));
        let found = found.filter(|p| p.origin != "given" && p.value == value);
        let (range, [low, high]) = match found.map(|p| p.ci95) {
            None => (Range::Given, [f64::NAN; 2]),
            Some(None) => (Range::Open, [f64::NEG_INFINITY, f64::INFINITY]),
            Some(Some(ends)) if ends.iter().all(|x| x.is_finite()) => (Range::Interval, ends),
            Some(Some(ends)) => (Range::Open, ends),
        };
        let beside = |part: f64| match value {
            0.0 => [0.0; 2],
            _ => [value - part * value.abs(), value + part * value.abs()],
        };
        let [low, high] = match range {
            Range::Given => beside(GIVEN),
            _ => {
                let open = [
                    value - value.abs() * (1.0 - 1.0 / WITHOUT_BOUND),
                    value + value.abs() * (WITHOUT_BOUND - 1.0),
                ];
                let or = |end: f64, other: f64| if end.is_finite() { end } else { other };
                [or(low, open[0]), or(high, open[1])]
            }
        };
        // An interval may reach beyond what a law can have.
        let allowed = name.quantity.allowed();
        let least = match allowed.admits(low) {
            true => low,
            false => value / WITHOUT_BOUND,
        };
        Knob {
            symbol: name.symbol(),
            name: text,
            unit: unit.into(),
            value,
            low: least.min(value),
            high: if allowed.admits(high) {
                high.max(value)
            } else {
                value
            },
            range,
        }
    }

    /// The axis with these parameters in place of those of the model.
    ///
    /// # Errors
    /// In words, where a name is none of the [`knobs`](Self::knobs), a value lies beyond its range, or the values make no law.
    pub fn moved(&self, values: &[(String, f64)]) -> Result<Belief, String> {
        let knobs = self.knobs();
        let mut all = self.model.values();
        let mut mass = self.mass;
        for (text, value) in values {
            let knob = knobs.iter().find(|knob| knob.name == *text);
            let Some((knob, name)) = knob.zip(text.parse::<Name>().ok()) else {
                let names: Vec<&str> = knobs.iter().map(|knob| knob.name.as_str()).collect();
                let names = names.join(", ");
                return Err(format!("{text}: cannot be moved; allowed: {names}"));
            };
            // A slider stops at steps, and the last of them may lie a rounding beyond the end.
            let beyond = 1e-9 * (knob.high - knob.low);
            if !(knob.low - beyond..=knob.high + beyond).contains(value) {
                let [value, low, high] = [*value, knob.low, knob.high].map(short);
                return Err(format!("{text} = {value}; allowed: from {low} to {high}"));
            }
            match name.quantity {
                Quantity::Mass => mass = *value,
                _ => all.insert(name, *value),
            }
        }
        let law = law_of(&all, self.law.damping()).map_err(|e| e.to_string())?;
        Ok(Belief { law, mass })
    }
}
