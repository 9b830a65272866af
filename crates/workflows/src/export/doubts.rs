//! What is said beside code: what should not be used, what a log leaves open, what the code leaves out.

use super::terms;
use stiction_files::model::Lowered;
use stiction_files::shell::cycle_time;
use stiction_files::{ModelFile, Warning};
use stiction_parameters::{Name, Quantity};
use stiction_policy::export;
use stiction_say::Notice;

/// Parameters that need a feedforward of their own, beside that of friction.
const BESIDE: [&str; 4] = ["mass", "delay", "gravity_", "cogging"];

/// What should not be used, what the log leaves open, and what the code leaves out.
pub(super) fn doubts(
    file: &ModelFile,
    beside: Option<&terms::Beside>,
    taken: &[String],
) -> Vec<Warning> {
    let is_taken = |name: &String| taken.contains(name);
    let mut found = Vec::new();
    found.extend(untrusted(file));
    let aside = |name: &str| BESIDE.iter().any(|stem| name.starts_with(stem));
    let names = |wanted: &dyn Fn(&stiction_files::model::ModelParameter) -> bool| -> Vec<String> {
        let chosen = file.parameter.iter().filter(|p| wanted(p));
        chosen.map(|p| p.name.clone()).collect()
    };
    let loose = names(&|p| !p.identifiable && p.origin != "given" && !aside(&p.name));
    if !loose.is_empty() {
        found.push(Notice::Undetermined { names: loose }.into());
    }
    let left = names(&|p| aside(&p.name) && p.name != "delay" && !is_taken(&p.name));
    if !left.is_empty() {
        let left = Notice::LeftToFeedforward {
            feedforward: beside.map(|b| with_it(&left, &b.taken)),
            names: left,
        };
        found.push(left.into());
    }
    found.extend(of_weight(file, beside));
    let lacking = beside.map_or(&[][..], |b| &b.lacking);
    found.extend(at_reference(file, taken, lacking));
    found
}

/// Says that the model should not be used.
pub(super) fn untrusted(file: &ModelFile) -> Option<Warning> {
    (!file.trustworthy).then(|| Notice::Untrusted.into())
}

/// Says that the code is to be called at another rate than that of the log.
pub(super) fn another_rate(file: &ModelFile, asked: f64) -> Option<Warning> {
    let of_log = cycle_time(file.source.rate_hz?);
    let is_same = (asked / of_log - 1.0).abs() <= export::MAX_EQUAL_CYCLE;
    let notice = Notice::AnotherRate {
        cycle: asked,
        of_log,
    };
    (!is_same).then(|| notice.into())
}

/// Says where a constant force as large as a weight is among the friction, which a watchdog switches off.
fn of_weight(file: &ModelFile, beside: Option<&terms::Beside>) -> Option<Warning> {
    if beside.is_some_and(|b| b.terms.weight.is_some()) {
        return None;
    }
    let of = |name: &str| file.parameter.iter().find(|p| p.name == name);
    let offset = of("offset")?;
    let coulomb = of("coulomb").or_else(|| of("coulomb_positive"))?;
    (offset.value.abs() >= export::MIN_WEIGHT * coulomb.value).then(|| {
        let notice = Notice::ConstantForce {
            value: offset.value,
            coulomb: coulomb.value,
            unit: offset.unit.clone(),
        };
        notice.into()
    })
}

/// How the compensator would feed forward what it leaves out.
fn with_it(left: &[String], taken: &[String]) -> String {
    let parts = ["mass", "gravity", "cogging"].into_iter().filter(|part| {
        let mine = |name: &str| name.starts_with(part);
        left.iter().any(|name| mine(name)) || taken.iter().any(|name| mine(name))
    });
    let parts: Vec<&str> = std::iter::once("friction").chain(parts).collect();
    parts.join(",")
}

/// What changes friction and is no input of the code: the code has friction as it is at the reference.
fn at_reference(file: &ModelFile, taken: &[String], lacking: &[&str]) -> Option<Warning> {
    let at = |name: &str| {
        let found = file.parameter.iter().find(|p| p.name == name);
        found.map_or("the mean of the log".into(), |p| {
            format!("{} {}", stiction_number::four_digits(p.value), p.unit)
        })
    };
    let left = file.parameter.iter().filter(|p| !taken.contains(&p.name));
    let each = left.filter_map(|p| {
        let quantity = p.name.parse::<Name>().ok()?.quantity;
        let held = match quantity {
            Quantity::CoulombLoad => format!("at a load of {}", at("load_reference")),
            Quantity::CoulombTemperature | Quantity::Sigma2Temperature => {
                format!("at {}", at("temperature_reference"))
            }
            Quantity::CoulombTransmitted => {
                format!("where {} is transmitted", at("transmitted_reference"))
            }
            Quantity::CoulombDriven => "as where the motor drives".into(),
            Quantity::CoulombPosition => {
                format!("at the position {}", at("position_reference"))
            }
            Quantity::CoulombPitch(..) => "in its mean over the pitch".into(),
            Quantity::CoulombMap(_) => "in its mean over the stroke".into(),
            Quantity::CoulombLog(_) | Quantity::Sigma1Log(_) | Quantity::Sigma2Log(_) => {
                "of the first log".into()
            }
            Quantity::QuadraticViscous => {
                "without the part that grows with the square of the velocity".into()
            }
            _ => return None,
        };
        Some(format!(
            "{} = {} {}: {held}",
            p.name,
            stiction_number::four_digits(p.value),
            p.unit
        ))
    });
    let each: Vec<String> = each.collect();
    let lines = lacking.iter().map(ToString::to_string).collect();
    (!each.is_empty()).then(|| Notice::AtReference { each, lines }.into())
}

/// Where less is used than was identified; `limited` where the limit follows from it.
pub(super) fn less(lowered: &[Lowered], limited: bool) -> Option<Warning> {
    let each = lowered
        .iter()
        .map(|l| (l.name.to_string(), l.to, l.unit.to_string(), l.from))
        .collect();
    (!lowered.is_empty()).then(|| Notice::Lowered { each, limited }.into())
}
