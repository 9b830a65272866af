//! What a law leaves systematically, and what to do about it, in words.

use super::trust::RICHER_LAW_WINS_BELOW;
use super::{clocks, coupled, dynamics, pitch, settled};
use crate::source::Source;
use stiction_codes::Code;
use stiction_files::result::{CauseEntry, Cure, LawEntry, MisfitEntry};
use stiction_files::{Warning, symbols};
use stiction_identify::{Cause, Dependence, Divided, FittedLaw, LawKind, Misfit, Ripple};
use stiction_number::{Percent, four_digits};

/// Part of what a drift leaves from which on a channel of the log that shows it is taken into the fit first.
const PART_OF_DRIFT: f64 = 0.5;
/// The same of a level along the stroke, which is then said beside a drift.
const OR_ALONG_THE_STROKE: f64 = 0.8;

/// What counts say of a curve that they are likelier with another exponent of, and the line that has it fitted.
const ANOTHER_CURVE: &str = "the Stribeck curve falls off in another way than that of this law";
const FIT_EXPONENT: &str = "stribeck_exponent = \"fit\"";

/// What goes into the result.
pub(super) fn entry(law: &FittedLaw, force_unit: &str) -> Option<MisfitEntry> {
    let misfit = law.misfit.as_ref()?;
    let of_a_wave = [Cause::Ripple, Cause::Position];
    let is_one = misfit
        .cause()
        .is_some_and(|cause| of_a_wave.contains(&cause));
    let ripple = misfit.ripple.filter(|_| is_one);
    let mut entry = MisfitEntry {
        by: misfit.by.name().into(),
        cause: misfit.cause().map(|cause| code(cause).to_string()),
        rmse: misfit.rms,
        unit: force_unit.into(),
        share_percent: 100.0 * misfit.share,
        pitch: ripple.map(|r| r.pitch),
        pitch_std_percent: ripple.map(|r| 100.0 * r.deviation / r.pitch),
        amplitude: ripple.map(|r| r.amplitude),
        frequency_hz: None,
        resonance_hz: None,
        encoder: None,
        lost_motion: None,
        coupling_std_percent: None,
        load_percent: None,
        clock_drift_ppm: misfit.clocks.map(|clocks| 1e6 * clocks.drift),
        clock_drift_std_ppm: misfit.clocks.map(|clocks| 1e6 * clocks.deviation),
    };
    if let Some(coupling) = &misfit.coupling {
        coupled::state(coupling, &mut entry);
    }
    Some(entry)
}

fn code(cause: Cause) -> Code {
    match cause {
        Cause::Drift => Code::FrictionDrift,
        Cause::Position => Code::PositionDependence,
        Cause::Load => Code::LoadDependence,
        Cause::Temperature => Code::TemperatureDependence,
        Cause::Ripple => Code::PositionRipple,
        Cause::SpringForce => Code::SpringForce,
        Cause::Resonance => Code::Resonance,
        Cause::Backlash => Code::Backlash,
        Cause::Dynamics => Code::UnmodelledDynamics,
        Cause::Clocks => Code::ClocksApart,
        Cause::Limit => Code::ForceNotGiven,
        Cause::Held => Code::HeldAtRest,
        Cause::Shape => Code::LawShape,
    }
}

/// Names the likely cause of what the residual leaves systematically, and a curve that counts make likelier.
pub(super) fn named(
    law: &FittedLaw,
    sources: &[Source],
    laws: &[LawEntry],
    options: &str,
    warnings: &mut Vec<Warning>,
) {
    if let Some(exponent) = law.likelier_exponent {
        let message = format!(
            "{ANOTHER_CURVE}: where the axis rests, the counts of its encoder are likelier with an exponent of {exponent} than \
             with that of a Gaussian, 2. What describes the curve is no constant of the machine. Set {FIT_EXPONENT} under \
             [terms] in the axis file"
        );
        warnings.push(Warning::new(Code::LawShape, message));
    }
    let Some(misfit) = &law.misfit else { return };
    let Some(cause) = misfit.cause().filter(|cause| is_shown(*cause, law, laws)) else {
        return;
    };
    let message = message(misfit, cause, law, (sources, options));
    warnings.push(Warning::new(code(cause), message));
}

/// Whether a cause is more than a guess: another shape is one where elements were fitted beside and hold better.
fn is_shown(cause: Cause, law: &FittedLaw, laws: &[LawEntry]) -> bool {
    cause != Cause::Shape || elements_hold_better(law, laws)
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
                error.is_some_and(|error| error < RICHER_LAW_WINS_BELOW * own)
            })
        })
}

/// The same as a part of the verdict, with what takes it into the fit.
pub(super) fn cause(law: &FittedLaw, sources: &[Source], laws: &[LawEntry]) -> Option<CauseEntry> {
    if let Some(exponent) = law.likelier_exponent {
        return Some(CauseEntry {
            code: Code::LawShape,
            text: ANOTHER_CURVE.into(),
            size: format!("an exponent of {exponent} is likelier than 2"),
            cure: Some(Cure::Line {
                table: "terms".into(),
                line: FIT_EXPONENT.into(),
                replaces: false,
            }),
        });
    }
    let misfit = law.misfit.as_ref()?;
    let cause = misfit.cause().filter(|cause| is_shown(*cause, law, laws))?;
    let share = match (&misfit.clocks, &misfit.coupling, moved(misfit)) {
        _ if cause == Cause::Limit => misfit.limit.map_or(misfit.share, |limit| limit.share),
        (Some(clocks), _, _) => clocks.share,
        (None, Some(coupling), _) => coupling.share,
        (None, None, Some(ripple)) => ripple.share,
        (None, None, None) => misfit.share,
    };
    Some(CauseEntry {
        code: code(cause),
        text: moved(misfit).map_or_else(|| coupled::likely(misfit, words(cause)), |_| MOVED.into()),
        size: of_what_is_left(share, law),
        cure: cure(misfit, cause, law, sources),
    })
}

/// What a wave is that the fit has with a pitch that is off.
const MOVED: &str = "what repeats with the position has another pitch than in the fit";

/// That wave, where it is the cause.
fn moved(misfit: &Misfit) -> Option<&Ripple> {
    misfit
        .ripple
        .as_ref()
        .filter(|ripple| ripple.replaces.is_some())
}

/// What a cause is.
fn words(cause: Cause) -> &'static str {
    match cause {
        Cause::Drift => "friction changes during the log",
        Cause::Position => "friction changes along the stroke",
        Cause::Load => "friction changes with the load",
        Cause::Temperature => "friction changes with the temperature",
        Cause::Ripple => "a force repeats with the position",
        Cause::SpringForce => "a force grows with the position, as that of a spring does",
        Cause::Resonance => "motor and load vibrate against each other",
        Cause::Backlash => "a gap lies between motor and load",
        Cause::Dynamics => {
            "between force and motion are dynamics that a rigid mass and a delay do not have"
        }
        Cause::Clocks => "force and motion were stamped by two clocks that run apart",
        Cause::Held => "something else than friction holds the axis where it rests",
        Cause::Limit => "the drive gave less than the force that was logged",
        Cause::Shape => "friction or inertia has another shape than this law",
    }
}

/// A part of the variance of the residual, and what it is of the force.
fn of_what_is_left(share: f64, law: &FittedLaw) -> String {
    let of_force = share.sqrt() * law.fit.relative_error_percent;
    format!(
        "{} of what the law leaves, {} of the force",
        Percent::error(100.0 * share).digits(2),
        Percent::error(of_force).digits(2)
    )
}

/// What takes a cause into the fit, where there is something that the fit has not.
fn cure(misfit: &Misfit, cause: Cause, law: &FittedLaw, sources: &[Source]) -> Option<Cure> {
    let log = &sources[0].log;
    let of_terms = |(line, replaces)| Cure::Line {
        table: "terms".into(),
        line,
        replaces,
    };
    let wave = || {
        let ripple = misfit.ripple.as_ref()?;
        pitch::line(ripple, law, log.motion).map(of_terms)
    };
    // Elements have no levels that depend on anything.
    let first_of = |terms: &[Dependence]| {
        let terms = match law.law.kind.has_elements() {
            true => &[],
            false => terms,
        };
        let open = terms.iter().find(|term| !has(law, term))?;
        Some(of_terms((format!("{} = true", open.name()), false)))
    };
    match cause {
        Cause::Position if misfit.ripple.is_some() && !law.law.kind.has_elements() => wave(),
        Cause::Position => along_the_stroke(misfit, law).map(of_terms),
        Cause::Load => first_of(&[Dependence::CoulombLoad(0.0)]),
        Cause::Temperature => first_of(&[
            Dependence::CoulombTemperature(0.0),
            Dependence::ViscousTemperature(0.0),
        ]),
        Cause::Ripple => wave(),
        Cause::SpringForce => {
            pitch::straight(misfit.spring_force.as_ref()?, law, log.motion).map(of_terms)
        }
        // Where the level changes with two things, neither explains it by itself.
        Cause::Drift => {
            let beside = [
                (Divided::LevelOverLoad, Dependence::CoulombLoad(0.0)),
                (
                    Divided::LevelOverTemperature,
                    Dependence::CoulombTemperature(0.0),
                ),
            ];
            let beside = beside.map(|(by, term)| (misfit.share_by(by), term));
            let [load, temperature] = beside;
            let (share, term) = if load.0 >= temperature.0 {
                load
            } else {
                temperature
            };
            let by_channel = first_of(&[term]).filter(|_| share >= PART_OF_DRIFT * misfit.share);
            by_channel.or_else(|| settled::part(misfit, law, sources))
        }
        // One bristle is the presliding that several are held against, with the same curve over speed; elements have no levels
        // that depend on anything.
        Cause::Shape
            if [LawKind::Dahl, LawKind::LuGre].contains(&law.law.kind)
                && law.terms.dependences.is_empty() =>
        {
            let law = match law.law.has_stribeck() {
                true => LawKind::Gms,
                false => LawKind::MaxwellSlip,
            };
            Some(Cure::Law {
                law: law.name().into(),
            })
        }
        Cause::Clocks => clocks::stretch(misfit.clocks.as_ref()?, sources),
        Cause::Resonance
        | Cause::Backlash
        | Cause::Dynamics
        | Cause::Limit
        | Cause::Held
        | Cause::Shape => None,
    }
}

fn message(
    misfit: &Misfit,
    cause: Cause,
    law: &FittedLaw,
    (sources, options): (&[Source], &str),
) -> String {
    let log = &sources[0].log;
    let share = Percent::error(100.0 * misfit.share).digits(2);
    let of_force = misfit.rms / law.fit.rmse * law.fit.relative_error_percent;
    let of_force = Percent::error(of_force).digits(2);
    let left = format!("{share} of what the law leaves ({of_force} of the force)");
    let levels = || {
        let (low, high) = misfit.levels;
        let part = |x: f64| Percent::error(100.0 * x).signed(0);
        format!("{} to {}", part(low), part(high))
    };
    let what = words(cause);
    let cure = cure(misfit, cause, law, sources);
    let cured = cure.is_some();
    let crops = matches!(&cure, Some(Cure::Line { table, .. }) if table == "log");
    let to_do = cure.map_or(
        match law.terms.map() {
            Some(_) if cause == Cause::Position => {
                "No map over the stroke describes that: record within the range that the axis works in"
            }
            _ => "No straight line over it describes that: record within the range that the axis works in",
        }
        .into(),
        |cure| match cure {
            Cure::Line {
                table,
                line,
                replaces,
            } => {
                let key = line.split(' ').next().unwrap_or_default();
                let instead = match replaces {
                    true => format!(" in place of the line {key}"),
                    false => String::new(),
                };
                let lines = line.replace('\n', " and ");
                format!("Set {lines} under [{table}] in the axis file{instead}")
            }
            Cure::Law { law } => format!("Try the law {law}"),
        },
    );
    if let Some(ripple) = moved(misfit) {
        let share = Percent::error(100.0 * ripple.share).digits(2);
        let found = pitch::found(ripple, log.motion);
        return format!("{MOVED}: {found} explains {share} of what the law leaves. {to_do}");
    }
    // Of a wave, what it is and how surely its pitch is known.
    let wave = misfit.ripple.map(|ripple| {
        let size = four_digits(ripple.amplitude);
        let found = pitch::found(&ripple, log.motion);
        format!("a wave of {size} {} with {found}", log.force_unit)
    });
    match cause {
        Cause::Resonance | Cause::Backlash => {
            misfit.coupling.as_ref().map_or_else(String::new, |found| {
                coupled::message(found, law.fit.relative_error_percent, log)
            })
        }
        Cause::Drift => {
            let has_temperature = has(law, &Dependence::CoulombTemperature(0.0));
            let logged = match has_temperature {
                true => "the temperature that is logged does not explain it",
                false => {
                    "its temperature, logged beside the rest and taken in with coulomb_temperature = true under [terms], would \
                          settle whether it is warmth"
                }
            };
            let to_do = match (cured, crops) {
                (true, false) => format!("{to_do}, which shows much of it"),
                (true, true) => format!(
                    "It has settled at the end of the log. To fit that part alone, {}; {logged}",
                    to_do.replacen('S', "s", 1)
                ),
                (false, _) => format!(
                    "Record the axis warmed up, then: stiction identify another.csv{options} --out another; {logged}"
                ),
            };
            let by_place = misfit.share_by(Divided::LevelOverPosition);
            let by_place = match by_place >= OR_ALONG_THE_STROKE * misfit.share {
                true => format!(
                    ". A level along the stroke explains {} of what is left too: where the motion goes on from place to place, the two look alike. \
                     Motion to and fro at each place tells them apart, and coulomb_position = true under [terms] how much of it lies \
                     along the stroke",
                    Percent::error(100.0 * by_place).digits(2)
                ),
                false => String::new(),
            };
            format!(
                "{what}: {left} is a Coulomb level that goes from {} of its mean, as means over sixteenths of the log; the values are means over the log. {to_do}{by_place}",
                levels()
            )
        }
        Cause::Position => {
            let line = wave.map_or(String::new(), |wave| {
                format!(", which {wave} describes much better than a straight line")
            });
            format!(
                "{what}: {left} is a level that goes from {} of its mean{line}. {to_do}",
                levels()
            )
        }
        Cause::Load => format!(
            "{what}: {left} is a level that goes from {} of its mean over the loads of the log. {to_do}",
            levels()
        ),
        Cause::Temperature => format!(
            "{what}: {left} is a level that goes from {} of its mean over the temperatures of the log. {to_do}",
            levels()
        ),
        Cause::Clocks => misfit.clocks.as_ref().map_or_else(String::new, |found| {
            clocks::message(found, what, cured.then_some(&to_do))
        }),
        Cause::Dynamics => misfit.dynamics.map_or_else(String::new, |found| {
            dynamics::message(&found, (what, &left), log, options)
        }),
        Cause::Held => misfit.held.map_or_else(String::new, |held| {
            let [rests, all] = held.rests;
            format!(
                "{what}: in {rests} of {all} rests the force goes by up to {} {} without a count of motion, several times farther than bristles \
                 let it, as where a brake holds and the controller lets go. {left} comes of what the law makes of it. The law takes up part of it in presliding and in the Stribeck curve. A column that says where the brake holds, given as \
                 enable under [columns], leaves those rows out; else record motion without rests",
                four_digits(held.force),
                log.force_unit
            )
        }),
        Cause::Limit => misfit.limit.map_or_else(String::new, |limit| {
            let unit = &log.force_unit;
            let beyond = Percent::error(100.0 * limit.beyond).digits(2);
            format!(
                "{what}: {left} is what was logged beyond {} {unit}, in {beyond} of the samples, as where the log holds what a \
                 controller asked for and the drive is at its limit. Log the force \
                 or current that the drive measures, or record with less acceleration, so that the drive stays below its limit",
                four_digits(limit.force)
            )
        }),
        Cause::Ripple => {
            let line = wave.map_or(String::new(), |wave| {
                format!(", most of it {wave}. {to_do}")
            });
            format!("{what}: {left}{line}")
        }
        Cause::SpringForce => misfit.spring_force.map_or_else(String::new, |found| {
            format!(
                "{what}: {left} goes with it, {} {}/{} beside what the law has taken of it, as a cable chain, a bellows or a balancing \
                 spring does. {to_do}: a wave so long is straight over the stroke",
                four_digits(found.stiffness),
                log.force_unit,
                symbols::length_unit(log.motion)
            )
        }),
        Cause::Shape => format!(
            "{what}: {left} {}.{}",
            match misfit.by {
                Divided::AfterReversals => "lies after reversals, beyond what is left elsewhere",
                _ => "comes back with speed and travel after each reversal",
            },
            match (law.law.kind.has_elements(), law.law.has_stribeck()) {
                (true, _) => "",
                (false, true) => " Compare the laws gms and elasto-plastic.",
                (false, false) => " Compare the laws maxwell-slip and elasto-plastic.",
            }
        ),
    }
}

/// The line that takes a level along the stroke into the fit, and whether it takes the place of one: a straight line where that
/// explains it, else a map.
fn along_the_stroke(misfit: &Misfit, law: &FittedLaw) -> Option<(String, bool)> {
    if law.law.kind.has_elements() || law.terms.map().is_some() {
        return None;
    }
    let has_line = has(law, &Dependence::CoulombPosition(0.0));
    let value = match misfit.straight && !has_line {
        true => "true",
        false => "\"map\"",
    };
    Some((format!("coulomb_position = {value}"), has_line))
}

/// Whether a fit has a term like this one.
fn has(law: &FittedLaw, term: &Dependence) -> bool {
    let mut dependences = law.terms.dependences.iter();
    dependences.any(|own| own.name() == term.name())
}
