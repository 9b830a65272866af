//! What cannot be of a model file that parsed: its numbers, units and names against its law.

use super::{ModelFile, covariance};
use crate::symbols;
use stiction_identify::{Dimension, LawKind};
use stiction_log::{Motion, Unit};

/// Place, what was found, what is allowed.
pub(super) type Fault = (&'static str, String, String);

/// Numbers of a model stay within this size, and those above 0 above its inverse: no machine is
/// near, and their products stay finite.
const LARGEST: f64 = 1e100;
/// Exponents of a Stribeck curve, as in the axis file.
const EXPONENTS: std::ops::RangeInclusive<f64> = 0.1..=10.0;

/// Stems of the parameters that have a value for each direction in an asymmetric model.
const SIDED: [&str; 4] = ["coulomb", "static", "stribeck_velocity", "sigma2"];

/// Whether a law has a parameter.
type Laws = fn(LawKind) -> bool;

/// What is known of a parameter by the stem of its name.
struct Known {
    dimension: Dimension,
    /// The smallest value, if there is one: 0 itself, or above it.
    least: Option<Least>,
    /// The laws that have it.
    of: Laws,
}

#[derive(PartialEq)]
enum Least {
    Zero,
    AboveZero,
}

fn known(stem: &str) -> Option<Known> {
    use Least::{AboveZero, Zero};
    let any: Laws = |_| true;
    let (dimension, least, of) = match stem {
        "sigma0" => (
            Dimension::Stiffness,
            Some(Zero),
            LawKind::has_bristle as Laws,
        ),
        "sigma1" => (
            Dimension::Damping,
            Some(Zero),
            LawKind::has_micro_damping as Laws,
        ),
        "sigma2" => (Dimension::Damping, Some(Zero), any),
        "coulomb" => (Dimension::Force, Some(Zero), any),
        "static" => (Dimension::Force, Some(Zero), LawKind::has_stribeck as Laws),
        "stribeck_velocity" => (
            Dimension::Speed,
            Some(AboveZero),
            LawKind::has_stribeck as Laws,
        ),
        "stribeck_exponent" => (
            Dimension::One,
            Some(AboveZero),
            LawKind::has_stribeck as Laws,
        ),
        "mass" => (Dimension::Inertia, Some(Zero), any),
        "offset" => (Dimension::Force, None, any),
        "delay" => (Dimension::Time, None, any),
        _ if symbols::is_element(stem) => {
            let length = stem.starts_with("yield_");
            let dimension = if length {
                Dimension::Length
            } else {
                Dimension::Stiffness
            };
            (dimension, Some(Zero), LawKind::has_elements as Laws)
        }
        _ => return None,
    };
    Some(Known {
        dimension,
        least,
        of,
    })
}

/// Whether a term beside the law may have a value for each direction; `None` for no such term. The name is without the
/// suffix of a direction.
fn term(stem: &str) -> Option<bool> {
    let wave = |of: &str| {
        let rest = stem.strip_prefix(of).unwrap_or_default();
        let number = rest.strip_suffix("_sin").or(rest.strip_suffix("_cos"));
        number.is_some_and(|n| n.parse::<u32>().is_ok())
    };
    match stem {
        "breakaway_ratio" | "attraction" | "gravity_sin" | "gravity_cos" => Some(false),
        "load_reference" | "temperature_reference" | "position_reference" => Some(false),
        "quadratic_viscous" | "coulomb_load" | "coulomb_temperature" => Some(true),
        "coulomb_position" | "sigma2_temperature" => Some(true),
        _ if wave("cogging") => Some(false),
        _ if wave("coulomb_pitch") => Some(true),
        _ => None,
    }
}

/// What is wrong with a name: what was found, what is allowed.
fn stranger(name: &str) -> Option<(String, String)> {
    let stem = stem(name);
    let sided = match known(stem) {
        Some(_) => Some(SIDED.contains(&stem)),
        None => term(stem),
    };
    match sided {
        None => {
            let short: String = name.chars().take(60).collect();
            let found = format!("{short:?}, which is no parameter of any law");
            Some((found, "names as stiction identify writes them".into()))
        }
        Some(false) if stem != name => {
            let allowed = format!("{stem}: it is the same in both directions");
            Some((name.into(), allowed))
        }
        _ => None,
    }
}

/// The name without the suffix of a direction.
fn stem(name: &str) -> &str {
    let side = name.strip_suffix("_pos").or(name.strip_suffix("_neg"));
    side.unwrap_or(name)
}

/// Whether two texts are one unit, however written.
fn same_unit(found: &str, wanted: &str) -> bool {
    let parsed = |text| Unit::parse(text).map(|unit| (unit.dimension(), unit.factor()));
    found == wanted || matches!((parsed(found), parsed(wanted)), (Ok(a), Ok(b)) if a == b)
}

/// What is wrong with the directions: place, what was found, what is allowed.
fn directions(model: &ModelFile) -> Option<Fault> {
    let has = |name: &str| model.parameter.iter().any(|p| p.name == name);
    let mut sided = None;
    for stem in SIDED {
        let names = [
            stem.to_string(),
            format!("{stem}_pos"),
            format!("{stem}_neg"),
        ];
        match names.each_ref().map(|name| has(name)) {
            [_, false, false] => {}
            [false, true, true] => sided = Some(names[1].clone()),
            _ => {
                let present: Vec<_> = names
                    .iter()
                    .map(String::as_str)
                    .filter(|n| has(n))
                    .collect();
                let allowed = format!("{stem}, or {stem}_pos and {stem}_neg");
                return Some(("parameter: ", present.join(" and "), allowed));
            }
        }
    }
    match (model.asymmetric, sided) {
        (false, Some(name)) => Some((
            "asymmetric: ",
            format!("false beside {name}"),
            "true".into(),
        )),
        (true, None) if SIDED.into_iter().any(has) => {
            let found = "true, and no parameter has a direction".into();
            Some((
                "asymmetric: ",
                found,
                "coulomb_pos and coulomb_neg and so on, or false".into(),
            ))
        }
        _ => None,
    }
}

/// The first thing that is wrong with a model.
pub(super) fn fault(model: &ModelFile) -> Option<Fault> {
    let Some(law) = LawKind::from_name(&model.law) else {
        let laws: Vec<_> = LawKind::ALL.iter().map(|law| law.name()).collect();
        let allowed = format!("one of {}", laws.join(", "));
        return Some(("law: ", format!("{:?}", model.law), allowed));
    };
    let motion = match model.kind.as_str() {
        "linear" => Motion::Linear,
        "rotary" => Motion::Rotary,
        other => return Some(("kind: ", format!("{other:?}"), "linear or rotary".into())),
    };
    if let Some(fault) = force_unit(model, motion) {
        return Some(fault);
    }
    (0..model.parameter.len())
        .find_map(|i| parameter(model, law, motion, i))
        .map(|(found, allowed)| ("parameter: ", found, allowed))
        .or_else(|| directions(model))
        .or_else(|| {
            covariance::fault(model).map(|(found, allowed)| ("covariance: ", found, allowed))
        })
}

/// A unit that is none, which would go into every text about the model: identification writes that of a force, or of what
/// drives the axis (`A`, `V`, `1`).
fn force_unit(model: &ModelFile, motion: Motion) -> Option<Fault> {
    let unit = &model.force_unit;
    let plain = |c: char| c.is_alphanumeric() || " */^-·".contains(c);
    let good = unit.trim() == unit
        && unit.chars().all(plain)
        && Unit::parse(unit).is_ok_and(|unit| unit.factor() == 1.0);
    (!good).then(|| {
        let short: String = unit.chars().take(60).collect();
        let force = crate::symbols::force_unit(motion);
        let allowed =
            format!("{force:?}, or the unit of what drives the axis: \"A\", \"V\", \"1\"");
        ("force_unit: ", format!("{short:?}"), allowed)
    })
}

/// What is wrong with one parameter: what was found, what is allowed.
fn parameter(
    model: &ModelFile,
    law: LawKind,
    motion: Motion,
    i: usize,
) -> Option<(String, String)> {
    let p = &model.parameter[i];
    let (name, value) = (&p.name, stiction_number::four_digits(p.value));
    if model.parameter[..i].iter().any(|other| other.name == *name) {
        return Some((format!("{name} twice"), "each once".into()));
    }
    if p.value.is_nan() || p.value.abs() > LARGEST {
        return Some((
            format!("{name} = {value}"),
            format!("from -{LARGEST:e} to {LARGEST:e}"),
        ));
    }
    if let Some(fault) = stranger(name) {
        return Some(fault);
    }
    // An end that is not known is infinite.
    if let Some([low, high]) = p
        .ci95
        .filter(|[low, high]| low.is_nan() || high.is_nan() || low > high)
    {
        let found = format!("{name}: ci95 = [{low:?}, {high:?}]");
        return Some((found, "the lower end, then the upper".into()));
    }
    if let Some(std) = p.std.filter(|std| std.is_nan() || *std < 0.0) {
        return Some((format!("{name}: std = {std:?}"), "0 or above".into()));
    }
    let known = known(stem(name))?;
    let unit = symbols::unit(known.dimension, motion, &model.force_unit, "");
    if !same_unit(&p.unit, &unit) {
        return Some((
            format!("{name} in {:?}", p.unit),
            format!("{unit:?}, with its value"),
        ));
    }
    if !(known.of)(law) {
        return Some((
            format!("{name} in a model of {law}"),
            "parameters of that law".into(),
        ));
    }
    if name == "stribeck_exponent" && !EXPONENTS.contains(&p.value) {
        let (low, high) = (EXPONENTS.start(), EXPONENTS.end());
        return Some((format!("{name} = {value}"), format!("from {low} to {high}")));
    }
    let allowed = match known.least {
        Some(Least::Zero) if p.value < 0.0 => "not negative",
        Some(Least::AboveZero) if p.value <= 0.0 => "above 0",
        Some(_) if p.value != 0.0 && p.value < 1.0 / LARGEST => "at least 1e-100",
        _ => return None,
    };
    Some((format!("{name} = {value}"), allowed.into()))
}

/// The first parameter that a model lacks of its law, without the suffix of its direction; a
/// procedure may well find a part of them only.
pub(super) fn missing(model: &ModelFile) -> Option<&'static str> {
    let law = LawKind::from_name(&model.law)?;
    let needed = [
        ("sigma0", law.has_bristle()),
        ("sigma1", law.has_micro_damping()),
        ("sigma2", true),
        ("coulomb", true),
        ("static", law.has_stribeck()),
        ("stribeck_velocity", law.has_stribeck()),
    ];
    let has = |name: &str| model.parameter.iter().any(|p| stem(&p.name) == name);
    needed
        .into_iter()
        .find_map(|(name, wanted)| (wanted && !has(name)).then_some(name))
}

/// A top speed that is none.
pub(super) fn top_speed(model: &ModelFile) -> Option<Fault> {
    let speed = model.source.top_speed?;
    let within = speed > 0.0 && speed <= LARGEST;
    (!within).then(|| {
        let found = stiction_number::shortest(speed);
        ("source: top_speed = ", found, "above 0, or left out".into())
    })
}
