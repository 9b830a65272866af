//! The axis of a study with other parameters than its model has: which can be moved, and how far.

use super::belief::{Belief, law_of};
use super::model::{Parameter, is_simulated};
use super::plan::Machine;
use crate::symbols;
use serde::Serialize;
use stiction_number::four_digits as short;
use stiction_parameters::{Allowed, Name, Quantity};

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
    /// How many elements of the law it moves together; 0 for a parameter that is one number.
    pub elements: usize,
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
    /// The parameters that can be moved, in the order of the model. The elements of a law that has them move together: their
    /// stiffnesses by `sigma0`, the sum of them, and the forces at which they yield by the levels of the steady curve, of which
    /// each has its share.
    pub fn knobs(&self) -> Vec<Knob> {
        let moves = |name: Name| {
            let stays = matches!(
                name.quantity,
                Quantity::Delay
                    | Quantity::Mass
                    | Quantity::ElementStiffness(_)
                    | Quantity::ElementYield(_)
                    | Quantity::ElementForce(_)
            );
            is_simulated(name.quantity) && !stays
        };
        let all = self.model.parameters.iter().filter(|p| moves(p.name));
        let mut knobs: Vec<Knob> = all.map(|p| self.knob(p.name, p.value, &p.unit)).collect();
        // A model by hand may have the elements and not their sum.
        let total = Name::from(Quantity::Sigma0);
        let stiffnesses: Vec<&Parameter> = self.stiffnesses().collect();
        if let (Some(first), None) = (stiffnesses.first(), self.model.value(total)) {
            let sum = stiffnesses.iter().map(|p| p.value).sum();
            knobs.insert(0, self.knob(total, sum, &first.unit));
        }
        let force = symbols::force_unit(self.motion);
        let unit = symbols::unit(Quantity::Mass.dimension(), self.motion, force, "");
        knobs.push(self.knob(Quantity::Mass.into(), self.mass, &unit));
        knobs.retain(|knob| knob.high > knob.low);
        knobs
    }

    /// Of the elements of the law, where it has any.
    fn stiffnesses(&self) -> impl Iterator<Item = &Parameter> {
        let is_one = |p: &&Parameter| matches!(p.name.quantity, Quantity::ElementStiffness(_));
        self.model.parameters.iter().filter(is_one)
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
        let allowed = name.quantity.allowed();
        let of_all = match name.quantity {
            Quantity::Sigma0 | Quantity::Coulomb | Quantity::Static => self.stiffnesses().count(),
            _ => 0,
        };
        Knob {
            symbol: name.symbol(),
            name: text,
            unit: unit.into(),
            value,
            low: within(allowed, value, low).min(value),
            high: within(allowed, value, high).max(value),
            range,
            elements: of_all,
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
        let stiffnesses: Vec<(Name, f64)> = self.stiffnesses().map(|p| (p.name, p.value)).collect();
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
                // Each keeps its share of the force, so it yields earlier the stiffer it is.
                Quantity::Sigma0 if !stiffnesses.is_empty() => {
                    for (name, stiffness) in &stiffnesses {
                        all.insert(*name, stiffness * (value / knob.value));
                    }
                }
                _ => all.insert(name, *value),
            }
        }
        let law = law_of(&all, self.law.damping()).map_err(|e| e.to_string())?;
        Ok(Belief { law, mass })
    }
}

/// An end of a range as far as a law can have it: an interval may reach beyond.
fn within(allowed: Allowed, value: f64, end: f64) -> f64 {
    match allowed {
        _ if allowed.admits(end) => end,
        // Two thirds of the way to the other end.
        Allowed::Share if end > value => 1.0 - (1.0 - value) / WITHOUT_BOUND,
        Allowed::Exponent => end.clamp(*Allowed::EXPONENTS.start(), *Allowed::EXPONENTS.end()),
        _ if end > value => value,
        _ => value / WITHOUT_BOUND,
    }
}
