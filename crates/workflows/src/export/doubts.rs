//! What is said beside code: what should not be used, what a log leaves open, what the code leaves out.

use super::terms;
use stiction_codes::Code;
use stiction_files::model::Lowered;
use stiction_files::shell::cycle_time;
use stiction_files::{ModelFile, Warning};
use stiction_parameters::{Name, Quantity};
use stiction_policy::export;

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
    if !file.trustworthy {
        found.push(Warning::new(
            Code::ExportUntrusted,
            "the identification flagged this model as not trustworthy; a compensation with it may be too strong",
        ));
    }
    let aside = |name: &str| BESIDE.iter().any(|stem| name.starts_with(stem));
    let names = |wanted: &dyn Fn(&stiction_files::model::ModelParameter) -> bool| -> Vec<&str> {
        let chosen = file.parameter.iter().filter(|p| wanted(p));
        chosen.map(|p| p.name.as_str()).collect()
    };
    let loose = names(&|p| !p.identifiable && p.origin != "given" && !aside(&p.name));
    if !loose.is_empty() {
        found.push(Warning::new(
            Code::NotIdentifiable,
            format!(
                "the log leaves {} open: the law predicts friction on motion like that of the log, and may be wrong on \
                 any other",
                loose.join(", ")
            ),
        ));
    }
    let left = names(&|p| aside(&p.name) && p.name != "delay" && !is_taken(&p.name));
    if !left.is_empty() {
        found.push(Warning::new(
            Code::ExportTerms,
            format!(
                "{} is not friction and not in the compensator; feed it forward separately{}",
                left.join(", "),
                with_it(&left, beside.map(|b| b.taken.as_slice()))
            ),
        ));
    }
    found.extend(of_weight(file, beside));
    let lacking = beside.map_or(&[][..], |b| &b.lacking);
    found.extend(at_reference(file, taken, lacking));
    found
}

/// Says that the code is to be called at another rate than that of the log.
pub(super) fn another_rate(file: &ModelFile, asked: f64) -> Option<Warning> {
    let of_log = cycle_time(file.source.rate_hz?);
    let is_same = (asked / of_log - 1.0).abs() <= export::MAX_EQUAL_CYCLE;
    (!is_same).then(|| {
        Warning::new(
            Code::ExportRate,
            format!(
                "the code is for one call every {asked} s, and the log has one sample every {of_log} s: called at the rate of the log \
                 its time runs {} times as fast. If the controller runs at that rate, export with --cycle-time {of_log}",
                stiction_number::four_digits(asked / of_log)
            ),
        )
    })
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
        let [value, level] = [offset.value, coulomb.value].map(stiction_number::four_digits);
        let unit = &offset.unit;
        Warning::new(
            Code::ExportTerms,
            format!(
                "a constant force of {value} {unit} stands beside {level} {unit} of Coulomb friction, and the code feeds it forward with the \
                 friction: gain and ramp act on it, and where the watchdog switches off an axis that it holds falls. If it is a weight, use \
                 --feedforward friction,mass,gravity (targets with a feedforward beside friction), which holds it whatever the watchdog does"
            ),
        )
    })
}

/// How the compensator would feed forward what it leaves out.
fn with_it(left: &[&str], taken: Option<&[String]>) -> String {
    let Some(taken) = taken else {
        return String::new();
    };
    let parts = ["mass", "gravity", "cogging"].into_iter().filter(|part| {
        let mine = |name: &str| name.starts_with(part);
        left.iter().any(|name| mine(name)) || taken.iter().any(|name| mine(name))
    });
    let parts: Vec<&str> = std::iter::once("friction").chain(parts).collect();
    format!(", or with it: --feedforward {}", parts.join(","))
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
    let each = each.collect::<Vec<_>>().join("; ");
    let cure = match lacking {
        [] => String::new(),
        lines => format!(
            ". With what the log has seen in the model file the code has it: {}",
            lines.join("; ")
        ),
    };
    (!each.is_empty()).then(|| {
        Warning::new(
            Code::ExportTerms,
            format!(
                "friction changes with what the code does not see, so it has friction as it is there ({each}). Where the axis \
                 works elsewhere it is off by that much: identify the axis as it works{cure}"
            ),
        )
    })
}

/// Where less is used than was identified; `limited` where the limit follows from it.
pub(super) fn less(lowered: &[Lowered], limited: bool) -> Option<Warning> {
    let each = lowered.iter().map(|l| {
        let [from, to] = [l.from, l.to].map(stiction_number::four_digits);
        format!("{} = {to} {} instead of {from}", l.name, l.unit)
    });
    let each = each.collect::<Vec<_>>().join(", ");
    let limit = match limited {
        true => ", and its limit is the largest friction up to the speeds of the log",
        false => "",
    };
    (!lowered.is_empty()).then(|| {
        Warning::new(
            Code::ExportSupported,
            format!(
                "the code makes the least force that the log supports: {each}{limit}. A log that determines them gives more: \
                 stiction check LOG names the motion"
            ),
        )
    })
}
