//! The effects that a residual shows, in words, and what takes each into the fit.

use super::{pitch, settling};
use crate::source::Source;
use std::ops::Range;
use stiction_codes::Code;
use stiction_files::result::{Action, CauseEntry, EffectEntry, LawEntry, SizeEntry};
use stiction_files::{Warning, symbols};
use stiction_identify::{Dependence, Effect, FittedLaw, Found, LawKind};
use stiction_log::Motion;
use stiction_policy::{choice, effect, motion};
use stiction_say::{Effect as Named, Explained, Extent, Notice, Remedy, What};

/// Deviations of a 95 % interval.
const QUANTILE: f64 = 1.96;

/// The line that has the exponent of the curve fitted.
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
            code: what(&found.effect).code(),
            explains_percent: 100.0 * found.explains,
            std_percent: known.then_some(deviation),
            ci95: gap(found),
            sizes,
        }
    };
    shown(law, laws).map(entry).collect()
}

/// The interval of the width of a gap, of which strokes tell the lesser part: teeth that give way and loads that bounce make it look wider.
fn gap(found: &Found) -> Option<[f64; 2]> {
    let Effect::Backlash { width, .. } = found.effect else {
        return None;
    };
    let about = QUANTILE * found.deviation;
    let Range { start, end } = effect::GAP_OVER_FOUND;
    let ends = [start * (1.0 - about) * width, end * (1.0 + about) * width];
    (about < 1.0).then_some(ends)
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
fn what(effect: &Effect) -> What {
    match *effect {
        Effect::Drift(_) => What::Drift,
        Effect::Position(..) => What::Position,
        Effect::LevelWave(_) => What::LevelWave,
        Effect::Load(_) => What::Load,
        Effect::Temperature(_) => What::Temperature,
        Effect::Ripple(wave) => What::Ripple {
            another_pitch: wave.replaces.is_some(),
        },
        Effect::SpringForce(_) => What::SpringForce,
        Effect::Resonance {
            frequency,
            read_at_load,
            ..
        } => What::Resonance {
            at_load: read_at_load,
            rigid: effect::RIGID_CUTOFF * frequency,
        },
        Effect::Backlash { .. } => What::Backlash,
        Effect::Dynamics(square) => What::Dynamics {
            logged: square < 0.0,
        },
        Effect::Clocks(_) => What::Clocks,
        Effect::Limit(..) => What::Limit,
        Effect::Mass(_) => What::Mass,
        Effect::Delay(_) => What::Delay,
        Effect::Bristles => What::Bristles,
        Effect::Curve => What::Curve,
    }
}

/// Its sizes, the first with its interval where that is known.
fn extents(found: &Found, motion: Motion, force_unit: &str) -> Vec<Extent> {
    let about = QUANTILE * found.deviation;
    let all = sizes(&found.effect, motion, force_unit)
        .into_iter()
        .enumerate();
    all.map(|(i, size)| {
        let is_known = i == 0 && !size.name.ends_with("level") && about < 1.0;
        Extent {
            about: (is_known && about.is_finite()).then_some(about),
            name: size.name,
            value: size.value,
            unit: size.unit,
        }
    })
    .collect()
}

/// The warnings of what a residual shows, and of a curve that counts make likelier.
pub(super) fn named(
    law: &FittedLaw,
    sources: &[Source],
    laws: &[LawEntry],
    warnings: &mut Vec<Warning>,
) {
    if let Some(exponent) = law.likelier_exponent {
        let effect = Named {
            what: What::Exponent(exponent),
            extents: Vec::new(),
            explained: None,
            remedy: remedy(fit_exponent()),
        };
        warnings.push(Notice::Effect(Box::new(effect)).into());
    }
    for found in shown(law, laws) {
        let log = &sources[0].log;
        let effect = Named {
            what: what(&found.effect),
            extents: extents(found, log.motion, &log.force_unit),
            explained: Some(explained(found, law)),
            remedy: cure(found, law, sources).and_then(remedy),
        };
        warnings.push(Notice::Effect(Box::new(effect)).into());
    }
}

/// The strongest of them as a part of the verdict, with what takes it into the fit.
pub(super) fn cause(law: &FittedLaw, sources: &[Source], laws: &[LawEntry]) -> Option<CauseEntry> {
    if let Some(exponent) = law.likelier_exponent {
        return Some(CauseEntry {
            code: Code::LawShape,
            text: What::Exponent(exponent).to_string(),
            size: "not 2".into(),
            cure: Some(fit_exponent()),
        });
    }
    let found = shown(law, laws).next()?;
    Some(CauseEntry {
        code: what(&found.effect).code(),
        text: what(&found.effect).to_string(),
        size: explained(found, law).to_string(),
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

/// What an effect explains.
fn explained(found: &Found, law: &FittedLaw) -> Explained {
    Explained {
        of_residual: found.explains,
        of_force: 0.01 * found.explains.sqrt() * law.fit.relative_error_percent,
    }
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
        Effect::Drift(_) => settling::part(found, sources),
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
        Effect::Clocks(drift) => settling::before_the_clocks_part(*drift, sources),
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
fn remedy(cure: Action) -> Option<Remedy> {
    match cure {
        Action::Line { table, line, .. } => Some(Remedy::Set {
            lines: line.replace('\n', " and "),
            table,
        }),
        Action::Law { law, .. } => Some(Remedy::Law(law)),
        _ => None,
    }
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
