//! What is wrong with the elements of a Maxwell-slip law: each is there once the one before is, and their sums are the
//! levels that stand beside them.

use super::Fault;
use crate::model::form::{ModelFile, ModelParameter};
use stiction_friction::MOST_ELEMENTS;
use stiction_number::four_digits;
use stiction_parameters::{LawKind, Name, Quantity, Side};

/// How far a sum may be from the level that it is, relative to it: numbers of four digits, as tables show them, are that
/// far apart. An identification writes all digits.
const ROUNDING: f64 = 2e-3;

/// An element, as far as the model has it: places of its parameters in the list.
#[derive(Clone, Copy, Default)]
struct Listed {
    stiffness: Option<usize>,
    deflection: Option<usize>,
}

/// Everything that is wrong with the elements of a model of this law.
pub(super) fn faults(model: &ModelFile, law: LawKind) -> Vec<Fault> {
    if !law.has_elements() {
        return Vec::new();
    }
    let mut all = Vec::new();
    let mut listed = [Listed::default(); MOST_ELEMENTS];
    for (i, p) in model.parameter.iter().enumerate() {
        let (k, is_stiffness) = match quantity(p) {
            Some(Quantity::ElementStiffness(k)) => (k as usize, true),
            Some(Quantity::ElementYield(k)) => (k as usize, false),
            _ => continue,
        };
        let Some(element) = k.checked_sub(1).and_then(|k| listed.get_mut(k)) else {
            let allowed = format!("1 to {MOST_ELEMENTS} elements, numbered without a gap");
            all.push((key(i, "name"), p.name.clone(), allowed));
            continue;
        };
        match is_stiffness {
            true => element.stiffness = Some(i),
            false => element.deflection = Some(i),
        }
        if p.value == 0.0 {
            all.push((key(i, "value"), format!("{} = 0", p.name), "above 0".into()));
        }
    }
    all.extend(gap(model, &listed));
    let elements = listed.iter().flat_map(|e| [e.stiffness, e.deflection]);
    let known = (elements.flatten()).all(|i| model.parameter[i].value > 0.0);
    if all.is_empty() && known {
        all.extend(order(model, &listed));
        all.extend(sums(model, law, &listed));
    }
    all
}

/// A parameter of an element without its other one, or after an element that is missing.
fn gap(model: &ModelFile, listed: &[Listed]) -> Option<Fault> {
    let mut before: Option<(usize, Quantity)> = None;
    for (k, element) in (1..).zip(listed) {
        let (stiffness, deflection) = (Quantity::ElementStiffness(k), Quantity::ElementYield(k));
        let (there, missing) = match (element.stiffness, element.deflection) {
            (Some(i), Some(_)) => (i, None),
            (Some(i), None) => (i, Some(deflection)),
            (None, Some(i)) => (i, Some(stiffness)),
            (None, None) => {
                before = before.or(Some((k as usize, stiffness)));
                continue;
            }
        };
        let missing = before.map(|(_, first)| first).or(missing);
        if let Some(missing) = missing {
            let name = &model.parameter[there].name;
            let found = format!("{name} without {}", missing.stem());
            let allowed = "stiffness and yield of every element, numbered 1, 2, 3 without a gap";
            return Some((key(there, "name"), found, allowed.into()));
        }
    }
    None
}

/// An element that does not yield after the one before.
fn order(model: &ModelFile, listed: &[Listed]) -> Option<Fault> {
    let yields: Vec<usize> = listed.iter().filter_map(|e| e.deflection).collect();
    yields.windows(2).find_map(|pair| {
        let [first, next] = [pair[0], pair[1]].map(|i| &model.parameter[i]);
        (next.value <= first.value).then(|| {
            let [low, high] =
                [first, next].map(|p| format!("{} = {}", p.name, four_digits(p.value)));
            let found = format!("{high} after {low}");
            (
                key(pair[1], "value"),
                found,
                "rising yield deflections".into(),
            )
        })
    })
}

/// A level that is not what the elements add up to.
fn sums(model: &ModelFile, law: LawKind, listed: &[Listed]) -> Vec<Fault> {
    let value = |i: Option<usize>| i.map(|i| model.parameter[i].value);
    let elements: Vec<(f64, f64)> = (listed.iter())
        .filter_map(|e| Some((value(e.stiffness)?, value(e.deflection)?)))
        .collect();
    if elements.is_empty() {
        return Vec::new();
    }
    let stiffness: f64 = elements.iter().map(|(k, _)| k).sum();
    let force: f64 = elements.iter().map(|(k, d)| k * d).sum();
    let level = match law.has_stribeck() {
        true => Quantity::Static,
        false => Quantity::Coulomb,
    };
    let totals = [
        (
            Quantity::Sigma0,
            stiffness,
            "the sum of the stiffnesses of its elements",
        ),
        (
            level,
            force,
            "the sum of stiffness times yield deflection of its elements",
        ),
    ];
    let off = totals.into_iter().filter_map(|(quantity, sum, what)| {
        let is_it = |p: &ModelParameter| {
            let name: Option<Name> = p.name.parse().ok();
            name.is_some_and(|name| name.quantity == quantity && name.side != Side::Negative)
        };
        let i = model.parameter.iter().position(is_it)?;
        let p = &model.parameter[i];
        let agrees = (p.value - sum).abs() <= ROUNDING * sum.abs();
        (sum.is_finite() && !agrees).then(|| {
            let found = format!("{} = {}", p.name, four_digits(p.value));
            (
                key(i, "value"),
                found,
                format!("{} {}, {what}", four_digits(sum), p.unit),
            )
        })
    });
    off.collect()
}

fn quantity(p: &ModelParameter) -> Option<Quantity> {
    Some(p.name.parse::<Name>().ok()?.quantity)
}

fn key(i: usize, field: &str) -> String {
    format!("parameter[{}].{field}", i + 1)
}
