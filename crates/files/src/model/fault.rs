//! Checks a model file that parsed: whether its numbers, units and names fit its law.

mod directions;
mod elements;
mod range;
mod units;

use super::covariance;
use super::form::{ModelFile, ModelParameter};
use super::refusal::Fault;
use stiction_formats::{Dimension, Unit};
use stiction_log::Motion;
use stiction_parameters::{LawKind, Name, Quantity, Side};
pub(super) use units::same_unit;

/// Largest magnitude of a number of a model, in its SI unit, and the inverse of the smallest above 0. No machine comes near;
/// products of three of them stay finite (below 1e308).
const LARGEST_NUMBER: f64 = 1e100;
/// What is wrong with a name: what was found, what is allowed.
fn stranger(name: &str) -> Option<(String, String)> {
    let Some(known) = parameter_of(name) else {
        let short: String = name.chars().take(60).collect();
        let found = format!("unknown parameter {short:?}");
        return Some((
            found,
            "the names that an identification writes, such as sigma0 or coulomb_pos".into(),
        ));
    };
    (known.side != Side::Both && !known.quantity.may_differ_by_side()).then(|| {
        let allowed = format!(
            "{}: it is the same in both directions",
            known.quantity.stem()
        );
        (name.into(), allowed)
    })
}

/// The parameter of a name, as files have it. The yield forces of elements are unknowns of a search, and in no file.
fn parameter_of(name: &str) -> Option<Name> {
    let known: Name = name.parse().ok()?;
    (!matches!(known.quantity, Quantity::ElementForce(_))).then_some(known)
}

/// Everything that is wrong with a model, in its order. What its parameters have to be together is looked at where all of
/// them could be read (`whole`).
pub(super) fn faults(model: &ModelFile, whole: bool) -> Vec<Fault> {
    let mut all = Vec::new();
    let law = LawKind::from_name(&model.law);
    if law.is_none() {
        let laws: Vec<_> = LawKind::ALL.iter().map(|law| law.name()).collect();
        let allowed = format!("one of {}", laws.join(", "));
        let short: String = model.law.chars().take(60).collect();
        all.push(("law".into(), format!("{short:?}"), allowed));
    }
    let motion = match model.kind.as_str() {
        "linear" => Some(Motion::Linear),
        "rotary" => Some(Motion::Rotary),
        other => {
            let short: String = other.chars().take(60).collect();
            let found = format!("{short:?}");
            all.push(("kind".into(), found, "linear or rotary".into()));
            None
        }
    };
    let unit = motion.and_then(|motion| force_unit(model, motion));
    // Units of parameters are those of this kind of axis, with this unit of the force.
    let motion = motion.filter(|_| unit.is_none());
    all.extend(unit);
    all.extend(source(model));
    all.extend(range::cold(model));
    let before = all.len();
    for i in 0..model.parameter.len() {
        let own = parameter(model, law, motion, i);
        // A value that is wrong contradicts its interval as well.
        all.extend(contradiction(model, i).filter(|_| own.is_empty()));
        all.extend(own);
    }
    if whole {
        all.extend(directions::faults(model));
        all.extend(law.into_iter().flat_map(|law| elements::faults(model, law)));
        all.extend(range::references(model));
    }
    if all.len() == before {
        all.extend(covariance::fault(model));
    }
    all
}

/// What drives an axis.
const DRIVES: [Dimension; 5] = [
    Dimension::FORCE,
    Dimension::TORQUE,
    Dimension::CURRENT,
    Dimension::VOLTAGE,
    Dimension::ONE,
];

/// The unit of what drives an axis, written one way: `N*m` of `N m` and `Nm`; `None` where it is none.
pub(super) fn drive(text: &str) -> Option<String> {
    let plain = |c: char| c.is_alphanumeric() || " */^-·".contains(c);
    let unit = Unit::parse(text).ok()?;
    let is_one = unit.factor() == 1.0 && DRIVES.contains(&unit.dimension());
    let good = is_one && text.trim() == text && text.chars().all(plain);
    good.then(|| unit.dimension().si_text())
}

/// Refuses an unknown unit, which would go into every text about the model: identification writes that of a force, or
/// of what drives the axis (`A`, `V`, `1`).
fn force_unit(model: &ModelFile, motion: Motion) -> Option<Fault> {
    let unit = &model.force_unit;
    drive(unit).is_none().then(|| {
        let short: String = unit.chars().take(60).collect();
        let force = crate::symbols::force_unit(motion);
        let allowed =
            format!("{force:?}, or the unit of what drives the axis: \"A\", \"V\", \"1\"");
        ("force_unit".into(), format!("{short:?}"), allowed)
    })
}

/// What is wrong with one parameter; the law and the kind of the axis where they are known.
fn parameter(
    model: &ModelFile,
    law: Option<LawKind>,
    motion: Option<Motion>,
    i: usize,
) -> Vec<Fault> {
    let p = &model.parameter[i];
    let key = |field: &str| format!("parameter[{}].{field}", i + 1);
    let (name, value) = (&p.name, stiction_number::four_digits(p.value));
    if model.parameter[..i].iter().any(|other| other.name == *name) {
        let found = format!("{name} a second time");
        return vec![(key("name"), found, "each parameter once".into())];
    }
    let mut all = Vec::new();
    let finite = !p.value.is_nan() && p.value.abs() <= LARGEST_NUMBER;
    if !finite {
        let allowed = format!("from -{LARGEST_NUMBER:e} to {LARGEST_NUMBER:e}");
        all.push((key("value"), format!("{name} = {value}"), allowed));
    }
    // An end that is not known is infinite.
    if let Some([low, high]) = p
        .ci95
        .filter(|[low, high]| low.is_nan() || high.is_nan() || low > high)
    {
        let found = format!("{name}: ci95 = [{low:?}, {high:?}]");
        all.push((key("ci95"), found, "the lower end, then the upper".into()));
    }
    if let Some(std) = p.std.filter(|std| !(*std >= 0.0 && std.is_finite())) {
        let found = format!("{name}: std = {std:?}");
        let allowed = "a finite number of 0 or above; leave it out where it is not known";
        all.push((key("std"), found, allowed.into()));
    }
    if let Some((found, allowed)) = stranger(name) {
        all.push((key("name"), found, allowed));
        return all;
    }
    let Some(quantity) = parameter_of(name).map(|name| name.quantity) else {
        return all;
    };
    if let Some(motion) = motion {
        all.extend(units::fault(model, motion, quantity, i));
    }
    if model.kind == "linear" && matches!(quantity, Quantity::Gravity(_)) {
        let found = format!("{name} on a linear axis");
        let allowed = "none: the weight of a linear axis is its offset".into();
        all.push((key("name"), found, allowed));
    }
    if let Some(law) = law.filter(|law| !law.has(quantity)) {
        let found = format!("{name} in a model of {law}");
        all.push((key("name"), found, "parameters of that law".into()));
    }
    let range = quantity.allowed();
    let allowed = if !range.admits(p.value) {
        Some(range.words())
    } else if range.is_never_negative() && p.value != 0.0 && p.value < 1.0 / LARGEST_NUMBER {
        Some("at least 1e-100")
    } else {
        None
    };
    if let Some(allowed) = allowed.filter(|_| finite) {
        all.push((key("value"), format!("{name} = {value}"), allowed.into()));
    }
    all
}

/// An entry of a parameter that contradicts its other entries.
fn contradiction(model: &ModelFile, i: usize) -> Option<Fault> {
    let p = &model.parameter[i];
    let (field, found, allowed) = against_itself(p)?;
    let key = format!("parameter[{}].{field}", i + 1);
    Some((key, format!("{}: {found}", p.name), allowed.into()))
}

/// The same with the key within its table.
fn against_itself(p: &ModelParameter) -> Option<(&'static str, String, &'static str)> {
    let shown = |text: &str| format!("{:?}", text.chars().take(60).collect::<String>());
    if !["identified", "given"].contains(&p.origin.as_str()) {
        let found = format!("origin = {}", shown(&p.origin));
        return Some(("origin", found, "\"identified\" or \"given\""));
    }
    let kinds = ["linear", "profile", "state-space"];
    if let Some(kind) = p.interval.as_deref().filter(|kind| !kinds.contains(kind)) {
        let found = format!("interval = {}", shown(kind));
        return Some((
            "interval",
            found,
            "\"linear\", \"profile\" or \"state-space\"",
        ));
    }
    if p.interval.is_some() && p.ci95.is_none() {
        let found = "interval without ci95".into();
        return Some(("interval", found, "both, or neither"));
    }
    if p.origin == "given" {
        let measured = [("std", p.std.is_some()), ("ci95", p.ci95.is_some())];
        let (field, _) = measured.into_iter().find(|(_, has)| *has)?;
        let found = format!("{field} of a parameter that was given");
        return Some((field, found, "none: only what was identified has one"));
    }
    // One that is no interval is refused as such.
    let [low, high] = p.ci95.filter(|[low, high]| low <= high)?;
    if !(low..=high).contains(&p.value) {
        let found = format!("ci95 = [{low:?}, {high:?}] without its value {:?}", p.value);
        return Some(("ci95", found, "an interval that holds the value"));
    }
    // A profile follows the cost; a linear interval reaches nearly two standard deviations to each side.
    let linear = p.interval.as_deref() != Some("profile");
    let std = p.std.filter(|std| linear && high - low < *std)?;
    let found = format!("ci95 = [{low:?}, {high:?}], narrower than std = {std:?}");
    Some((
        "ci95",
        found,
        "an interval that fits the standard deviation",
    ))
}

/// What is wrong with the numbers of the logs.
fn source(model: &ModelFile) -> impl Iterator<Item = Fault> {
    let numbers = [
        ("source.top_speed", model.source.top_speed),
        ("source.rate_hz", model.source.rate_hz),
    ];
    numbers.into_iter().filter_map(|(key, number)| {
        let found = number.filter(|x| !(*x > 0.0 && *x <= LARGEST_NUMBER))?;
        let found = stiction_number::shortest(found);
        Some((key.into(), found, "above 0, or left out".into()))
    })
}
