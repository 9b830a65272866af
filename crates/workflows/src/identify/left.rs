//! The effects that a residual shows, in words, and what takes each into the fit.

use super::{pitch, settled};
use crate::source::Source;
use stiction_codes::Code;
use stiction_files::result::{Action, CauseEntry, EffectEntry, LawEntry, SizeEntry};
use stiction_files::{Warning, symbols};
use stiction_identify::{Dependence, Effect, FittedLaw, Found, LawKind};
use stiction_log::Motion;
use stiction_number::{Percent, four_digits};
use stiction_policy::{choice, effect, motion};

/// Deviations of a 95 % interval.
const QUANTILE: f64 = 1.96;

/// What counts say of a curve that they are likelier with another exponent of, and the line that has it fitted.
const ANOTHER_CURVE: &str = "friction falls off over the speed in another way than in this law: the counts of the encoder are likelier with an exponent of";
const FIT_EXPONENT: &str = "stribeck_exponent = \"fit\"";

/// What goes into the result.
pub(super) fn entries(
    law: &FittedLaw,
    laws: &[LawEntry],
    motion: Motion,
    force_unit: &str,
) -> Vec<EffectEntry> {
    let entry = |found: &Found| {
        let deviation = 100.0 * found.deviation;
        let sizes = sizes(&found.effect, motion, force_unit);
        let known = deviation.is_finite() && !sizes.is_empty();
        EffectEntry {
            code: code(&found.effect),
            explains_percent: 100.0 * found.explains,
            std_percent: known.then_some(deviation),
            sizes,
        }
    };
    shown(law, laws).map(entry).collect()
}

fn code(effect: &Effect) -> Code {
    match effect {
        Effect::Drift(_) => Code::FrictionDrift,
        Effect::Position(..) | Effect::LevelWave(_) => Code::PositionDependence,
        Effect::Load(_) => Code::LoadDependence,
        Effect::Temperature(_) => Code::TemperatureDependence,
        Effect::Ripple(_) => Code::PositionRipple,
        Effect::SpringForce(_) => Code::SpringForce,
        Effect::Resonance { .. } => Code::Resonance,
        Effect::Backlash { .. } => Code::Backlash,
        Effect::Dynamics(_) => Code::UnmodelledDynamics,
        Effect::Clocks(_) => Code::ClocksApart,
        Effect::Limit(..) => Code::ForceNotGiven,
        Effect::Mass(_) => Code::MassDisagrees,
        Effect::Delay(_) => Code::DelayDisagrees,
        Effect::Bristles | Effect::Curve => Code::LawShape,
    }
}

/// How large an effect is, the size that has a deviation first.
fn sizes(effect: &Effect, motion: Motion, force_unit: &str) -> Vec<SizeEntry> {
    let length = symbols::length_unit(motion);
    let size = |name: &str, value: f64, unit: &str| SizeEntry {
        name: name.into(),
        value,
        unit: unit.into(),
    };
    let levels = |[low, high]: [f64; 2]| {
        vec![
            size("least_level", 100.0 * low, "%"),
            size("largest_level", 100.0 * high, "%"),
        ]
    };
    match *effect {
        Effect::Drift(ends) | Effect::Load(ends) | Effect::Temperature(ends) => levels(ends),
        Effect::Position(ends, _) => levels(ends),
        Effect::Ripple(wave) => vec![
            size("pitch", wave.pitch, length),
            size("amplitude", wave.amplitude, force_unit),
        ],
        Effect::LevelWave(wave) => vec![
            size("pitch", wave.pitch, length),
            size("amplitude", 100.0 * wave.amplitude, "%"),
        ],
        Effect::SpringForce(stiffness) => {
            vec![size(
                "stiffness",
                stiffness,
                &format!("{force_unit}/{length}"),
            )]
        }
        Effect::Resonance {
            frequency, load, ..
        } => vec![
            size("frequency", frequency, "Hz"),
            size("resonance", frequency / (1.0 - load).sqrt(), "Hz"),
            size("load", 100.0 * load, "%"),
        ],
        Effect::Backlash { width, load } => vec![
            size("lost_motion", width, length),
            size("load", 100.0 * load, "%"),
        ],
        Effect::Dynamics(square) => vec![size("time", time(square), "s")],
        Effect::Clocks(drift) => vec![size("drift", drift, "s/s")],
        Effect::Limit(force, beyond) => vec![
            size("force", force, force_unit),
            size("beyond", 100.0 * beyond, "%"),
        ],
        // What a fit with the other value says stands in the message.
        Effect::Mass(_) | Effect::Delay(_) | Effect::Bristles | Effect::Curve => Vec::new(),
    }
}

/// Time constant of a low-pass of first order with half this square, s.
fn time(square: f64) -> f64 {
    (2.0 * square.abs()).sqrt()
}

/// What an effect is.
fn words(effect: &Effect) -> &'static str {
    match effect {
        Effect::Drift(_) => "friction changes during the log",
        Effect::Position(..) => "friction changes along the stroke",
        Effect::LevelWave(_) => "the level of friction repeats with the position",
        Effect::Load(_) => "friction changes with the load",
        Effect::Temperature(_) => "friction changes with the temperature",
        Effect::Ripple(wave) if wave.replaces.is_some() => {
            "what repeats with the position has another pitch than in the fit"
        }
        Effect::Ripple(_) => "a force repeats with the position",
        Effect::SpringForce(_) => {
            "a force changes with the position, as that of a spring, a cable chain or a weight does"
        }
        Effect::Resonance { read_at_load, .. } => match read_at_load {
            true => "motor and load vibrate against each other, the encoder on the load",
            false => "motor and load vibrate against each other, the encoder on the motor",
        },
        Effect::Backlash { .. } => "a gap lies between motor and load",
        Effect::Dynamics(square) if *square < 0.0 => {
            "between force and motion are dynamics that a rigid mass does not have, as of a filter of the logged force, a spring or a gap"
        }
        Effect::Dynamics(_) => {
            "the axis feels the force later and smoother than it was logged, as behind a slow current loop"
        }
        Effect::Clocks(_) => "force and motion were stamped by two clocks that run apart",
        Effect::Limit(..) => "the drive gave less than the force that was logged",
        Effect::Mass(_) => "the mass is another one than the axis file states",
        Effect::Delay(_) => "the delay is another one than the axis file states",
        Effect::Bristles => "friction after a reversal has another shape than this law",
        Effect::Curve => "friction over the speed has another shape than this law",
    }
}

/// Its sizes, for a person.
fn sized(found: &Found, motion: Motion, force_unit: &str) -> String {
    let percent = |value: f64| format!("{} %", stiction_number::short(value));
    let all = sizes(&found.effect, motion, force_unit);
    let each = all.iter().enumerate().map(|(i, size)| {
        let value = match size.unit.as_str() {
            "%" => percent(size.value),
            "" => four_digits(size.value),
            unit => format!("{} {unit}", four_digits(size.value)),
        };
        let about = QUANTILE * found.deviation;
        let is_level = size.name.ends_with("level");
        let known = i == 0 && !is_level && about.is_finite() && about < 1.0;
        let about = match known {
            true => format!(" ± {}", Percent::error(100.0 * about).digits(2)),
            false => String::new(),
        };
        format!("{} {value}{about}", size.name.replace('_', " "))
    });
    each.collect::<Vec<_>>().join(", ")
}

/// The warnings of what a residual shows, and of a curve that counts make likelier.
pub(super) fn named(
    law: &FittedLaw,
    sources: &[Source],
    laws: &[LawEntry],
    warnings: &mut Vec<Warning>,
) {
    if let Some(exponent) = law.likelier_exponent {
        let message = format!(
            "{ANOTHER_CURVE} {exponent} than of 2. {}",
            to_do(&fit_exponent())
        );
        warnings.push(Warning::new(Code::LawShape, message));
    }
    for found in shown(law, laws) {
        let log = &sources[0].log;
        let sizes = sized(found, log.motion, &log.force_unit);
        let sizes = match sizes.is_empty() {
            true => String::new(),
            false => format!(" ({sizes})"),
        };
        let then = match cure(found, law, sources) {
            Some(cure) => to_do(&cure),
            None => by_hand(&found.effect),
        };
        let message = format!(
            "{}{sizes}: {}. {then}",
            words(&found.effect),
            explained(found, law)
        );
        warnings.push(Warning::new(code(&found.effect), message));
    }
}

/// The strongest of them as a part of the verdict, with what takes it into the fit.
pub(super) fn cause(law: &FittedLaw, sources: &[Source], laws: &[LawEntry]) -> Option<CauseEntry> {
    if let Some(exponent) = law.likelier_exponent {
        return Some(CauseEntry {
            code: Code::LawShape,
            text: format!("{ANOTHER_CURVE} {exponent}"),
            size: "than of 2".into(),
            cure: Some(fit_exponent()),
        });
    }
    let found = shown(law, laws).next()?;
    Some(CauseEntry {
        code: code(&found.effect),
        text: words(&found.effect).into(),
        size: explained(found, law),
        cure: cure(found, law, sources),
    })
}

/// The effects that are named: another shape only where a law that has it was fitted beside and holds better.
fn shown<'a>(law: &'a FittedLaw, laws: &[LawEntry]) -> impl Iterator<Item = &'a Found> {
    let better = elements_hold_better(law, laws);
    let effects = law.effects.iter();
    effects.filter(move |found| !found.effect.is_a_shape() || better)
}

/// Whether several elements hold better on samples that were not fitted than the one bristle of a law.
fn elements_hold_better(law: &FittedLaw, laws: &[LawEntry]) -> bool {
    let own = laws.iter().find(|own| own.reported);
    let own = own.and_then(|own| own.held_out_error_percent);
    let mut errors = laws.iter().filter(|other| other.elements.is_some());
    !law.law.kind.has_elements()
        && own.is_some_and(|own| {
            errors.any(|other| {
                let error = other.held_out_error_percent;
                error.is_some_and(|error| error < choice::MAX_NAMED_RICHER_ERROR * own)
            })
        })
}

/// What an effect explains, in parts of what is left and of the force.
fn explained(found: &Found, law: &FittedLaw) -> String {
    let of_force = found.explains.sqrt() * law.fit.relative_error_percent;
    format!(
        "explains {} of what the law leaves, {} of the force",
        Percent::error(100.0 * found.explains).digits(2),
        Percent::error(of_force).digits(2)
    )
}

fn fit_exponent() -> Action {
    of_terms(FIT_EXPONENT.into())
}

fn of_terms(line: String) -> Action {
    Action::Line {
        table: "terms".into(),
        line,
        replaces: false,
    }
}

/// What takes an effect into the fit, where there is something that the fit has not.
fn cure(found: &Found, law: &FittedLaw, sources: &[Source]) -> Option<Action> {
    let log = &sources[0].log;
    // Elements have no levels that depend on anything.
    let of_level = |term: Dependence| {
        let is_open = !law.law.kind.has_elements() && !has(law, &term);
        is_open.then(|| of_terms(format!("{} = true", term.name())))
    };
    match &found.effect {
        Effect::Drift(_) => settled::part(found, sources),
        Effect::Position(_, straight) => along_the_stroke(*straight, law).map(of_terms),
        Effect::LevelWave(_) if law.law.kind.has_elements() => None,
        Effect::LevelWave(wave) => {
            pitch::line("coulomb_pitch", wave, found.deviation, law, log.motion).map(of_terms)
        }
        Effect::Ripple(wave) => {
            pitch::line("cogging", wave, found.deviation, law, log.motion).map(of_terms)
        }
        Effect::Load(_) => of_level(Dependence::CoulombLoad(0.0)),
        Effect::Temperature(_) => of_level(Dependence::CoulombTemperature(0.0)),
        Effect::SpringForce(_) => {
            let (low, high) = log.position.iter().flatten().fold(
                (f64::INFINITY, f64::NEG_INFINITY),
                |(low, high): (f64, f64), x| (low.min(*x), high.max(*x)),
            );
            // On less a spring and a weight are alike, and sine and cosine are hardly two.
            match log.motion == Motion::Rotary && high - low >= motion::MIN_GRAVITY_ANGLE {
                true => (!law.terms.gravity).then(|| of_terms("gravity = true".into())),
                false => pitch::straight(high - low, law, log.motion).map(of_terms),
            }
        }
        Effect::Bristles if law.terms.dependences.is_empty() => {
            let kind = match law.law.has_stribeck() {
                true => LawKind::Gms,
                false => LawKind::MaxwellSlip,
            };
            Some(Action::Law {
                law: kind.name().into(),
                asymmetric: law.law.asymmetric,
            })
        }
        Effect::Curve if law.law.has_stribeck() && !law.law.exponent_fitted => Some(fit_exponent()),
        Effect::Clocks(drift) => settled::before_the_clocks_part(*drift, sources),
        Effect::Resonance { .. }
        | Effect::Backlash { .. }
        | Effect::Dynamics(_)
        | Effect::Limit(..)
        | Effect::Mass(_)
        | Effect::Delay(_)
        | Effect::Bristles
        | Effect::Curve => None,
    }
}

/// What a cure asks for.
fn to_do(cure: &Action) -> String {
    match cure {
        Action::Line { table, line, .. } => {
            let lines = line.replace('\n', " and ");
            format!("Set {lines} under [{table}] in the axis file")
        }
        Action::Law { law, .. } => format!("Try the law {law}"),
        _ => String::new(),
    }
}

/// What to do where nothing takes an effect into the fit.
fn by_hand(effect: &Effect) -> String {
    match effect {
        Effect::Resonance { frequency, .. } => {
            let rigid = four_digits(effect::RIGID_CUTOFF * frequency);
            return format!(
                "Record with less acceleration, or set common_cutoff = \"{rigid} Hz\" under [conditioning] in the axis file: below that \
                 the axis is rigid, and levels and mass are right"
            );
        }
        Effect::Drift(_) => "Record the axis warmed up, or its temperature beside the rest",
        Effect::Position(..) | Effect::LevelWave(_) => {
            "Record within the range that the axis works in"
        }
        Effect::Load(_) | Effect::Temperature(_) => {
            "Record under the conditions that the axis works in"
        }
        Effect::Backlash { .. } => {
            "To be sure hold the motor and push the load to and fro. Preload the drive train, or record motion that does not cross the gap"
        }
        Effect::Dynamics(_) => "Log the force that acts, unfiltered, such as the measured current",
        Effect::Clocks(_) => "Record both with one clock",
        Effect::Limit(..) => "Log the measured current, or record with less acceleration",
        Effect::Mass(_) => "Write mass = \"fit\" in its place in the axis file",
        Effect::Delay(_) => "Write delay = \"fit\" in its place under [terms] in the axis file",
        Effect::Ripple(_) | Effect::SpringForce(_) | Effect::Bristles | Effect::Curve => {
            "The friction by speed of the result holds whatever the law"
        }
    }
    .into()
}

/// The line that takes a level along the stroke into the fit: a straight line where that describes it, else a map.
fn along_the_stroke(straight: bool, law: &FittedLaw) -> Option<String> {
    if law.law.kind.has_elements() || law.terms.map().is_some() {
        return None;
    }
    let has_line = has(law, &Dependence::CoulombPosition(0.0));
    let value = match straight && !has_line {
        true => "true",
        false => "\"map\"",
    };
    Some(format!("coulomb_position = {value}"))
}

/// Whether a fit has a term like this one.
fn has(law: &FittedLaw, term: &Dependence) -> bool {
    let mut dependences = law.terms.dependences.iter();
    dependences.any(|own| own.name() == term.name())
}
