//! The output-error workflow: the axis simulated, its position fitted.

use super::assemble::{self, Parts};
use super::condition::{check_share, settings};
use super::conditioning::{self, conditioned};
use super::disagree;
use super::force_unit;
use super::load::{Asked, Loaded};
use super::logs::{log_warnings, refused, validation_warnings};
use super::machine;
use super::outcome::{Found, Outcome, Simulated};
use super::procedure::break_away;
use super::trust::{self, Evidence};
use crate::entries;
use crate::error::Error;
use crate::source::Source;
use crate::wording::Setting;
use stiction_files::Axis;
use stiction_files::result::{ShortHorizonEntry, SimulationEntry, ValidationEntry};
use stiction_files::symbols;
use stiction_identify as engine;
use stiction_identify::{
    Delay, Estimate, Fit, Hold, Law, LawKind, Observer, Recording, Series, Signals, Simulation,
    SimulationFit, Status, Terms,
};
use stiction_policy::choice;

/// Laws that can be simulated.
fn is_simulated(law: LawKind) -> bool {
    matches!(
        law,
        LawKind::CoulombViscous
            | LawKind::Stribeck
            | LawKind::Dahl
            | LawKind::LuGre
            | LawKind::MaxwellSlip
            | LawKind::Gms
    )
}

/// Simulates the axis and fits its position.
pub(super) fn run(
    asked: Asked,
    loaded: Loaded,
    observer: &mut dyn Observer,
) -> Result<Outcome, Error> {
    let Asked { options, axis, .. } = asked;
    let sources = &loaded.sources;
    let kind = options.one_law();
    if !is_simulated(kind) {
        return Err(Error::usage(
            [
                Setting::Method.is(options.procedures.method.name()),
                " with ".into(),
                Setting::Law.is(kind.name()),
            ],
            "coulomb-viscous, stribeck, dahl, lugre, maxwell-slip or gms",
        ));
    }
    let first = &sources[0].log;
    let motion = first.motion;
    let force_unit = first.force_unit.clone();
    let stated = axis.terms_for(first, options.asymmetric)?;
    if stated.quadratic_viscous || !stated.dependences.is_empty() {
        return Err(Error::usage(
            [
                Setting::Method.is(options.procedures.method.name()),
                " with friction that depends on load, temperature, position or v|v|".into(),
            ],
            "offset, gravity and cogging beside the law",
        ));
    }
    let terms = stated.clone();
    let controller = axis.controller_for(first)?;
    let law = Law {
        asymmetric: options.asymmetric,
        exponent: axis.exponent(),
        elements: axis.gms_elements.unwrap_or(0),
        ..Law::new(kind)
    };
    let mut recordings = recordings(sources)?;
    let mut unseen_logs: Vec<(String, Recording)> = Vec::new();
    if let Some(part) = options.split {
        let rests = split(&mut recordings, part)?;
        let name = |i: usize| match sources.len() {
            1 => "rest of the log".to_string(),
            _ => format!("rest of {}", sources[i].path.display()),
        };
        unseen_logs.extend(rests.into_iter().enumerate().map(|(i, r)| (name(i), r)));
    }
    for source in &loaded.held_out {
        let recording = self::recordings(std::slice::from_ref(source))?.remove(0);
        unseen_logs.push((source.name(), recording));
    }
    let fail = |source| refused(sources, source);
    let start = match options.split {
        None => separable(sources, axis, law, &stated, options.seed, observer),
        // That fit would have used the samples that are held out.
        Some(_) => None,
    };
    let quantum = axis.conditioning.resolution.or_else(|| {
        sources
            .iter()
            .filter_map(|s| s.log.quantum)
            .reduce(f64::min)
    });
    let simulation = Simulation {
        controller,
        hold: axis.hold,
        segment: axis.segment,
        quantum,
        start: start.as_ref(),
    };
    let found =
        engine::output_error(&recordings, law, &terms, &simulation, observer).map_err(fail)?;
    let mut unseen = Vec::new();
    for (name, recording) in unseen_logs {
        let one = engine::simulate_unseen(&[recording], &found, observer)
            .map_err(|source| Error::identify(name.clone(), source))?;
        unseen.push((name, one));
    }

    let odd = machine::unlikely(asked, &loaded, &found.fitted);
    let evidence = Evidence {
        law: &found.fitted,
        signal: "position",
        moves_both_ways: found.signals.moves_both_ways(quantum),
        sources,
        laws: &[],
        // The laws that the data choose among are fitted to the force: no way on from here.
        chosen: true,
        better: None,
        held_out_rmse: None,
        validation: &[],
        simpler: &[],
        held_out: &[],
        options: disagree::options(asked),
        unscaled: force_unit::cause(asked, &sources[0].log),
        can_be_simulated: false,
        motion,
        apart: None,
        contradicted: odd.as_ref(),
        unused: None,
    };
    let mut warnings = log_warnings(sources);
    warnings.extend(validation_warnings(&loaded.held_out, sources));
    let was_sought = !(found.is_closed_loop() && axis.hold == Hold::Centred);
    if terms.delay == Delay::Fitted && found.fitted.terms.delay == Delay::NONE && was_sought {
        warnings.push(stiction_say::Notice::DelayOutOfRange.into());
    }
    let judged = trust::of_position(&evidence, &found, &unseen, warnings);
    let started = if start.is_some() { "separable" } else { "runs" };
    let break_away = break_away(&loaded.beside, &found.fitted)?;
    let mut result = assemble::result(Parts {
        asked,
        sources,
        conditioning: notes(&found, axis, started),
        unsettled: None,
        law: &found.fitted,
        validation: &[],
        laws: Vec::new(),
        late: 0.0,
        without: Vec::new(),
        law_chosen_by: "user",
        judged,
    });
    break_away.into_result(&mut result);
    // What was fitted is the position; the entries of a force keep their name for it.
    let force = |fit: &Fit| entries::fit(fit, &result.fit.signal, &force_unit);
    let position = |fit: &Fit| entries::fit(fit, "position", symbols::length_unit(motion));
    let entry = SimulationEntry {
        kind: if found.is_closed_loop() {
            "closed"
        } else {
            "open"
        }
        .into(),
        force_is: match axis.hold {
            Hold::Held => "held",
            Hold::Centred => "centred",
        }
        .into(),
        runs: found.runs,
        stretches: found.stretches,
        segment_s: found.segment(),
        start_values: found.starts(),
        substeps: found.substeps,
        start: started.into(),
        position: position(&found.position),
        quantisation_floor: found.floor,
        force: found.force.as_ref().map(&force),
        validation_force: unseen
            .iter()
            .filter_map(|(_, u)| u.force.as_ref().map(&force))
            .collect(),
        validation_runs: unseen.iter().map(|(_, u)| u.runs).collect(),
        whole: found.whole.as_ref().map(position),
        short_horizon: found.short.map(|short| ShortHorizonEntry {
            seconds: short.seconds,
            fit: position(&short.position),
            validation: unseen
                .iter()
                .map(|(_, u)| u.short.map(|s| position(&s.position)))
                .collect(),
        }),
    };
    result.validation = unseen
        .iter()
        .map(|(path, u)| ValidationEntry {
            path: path.clone(),
            fit: position(&u.position),
            low_speed: None,
        })
        .collect();
    result.fit = position(&found.position);
    result.simulation = Some(entry);
    let validation = unseen
        .iter()
        .map(|(name, u)| (name.clone(), series(&u.signals)))
        .collect();
    let found = Found::Position(Box::new(Simulated { fit: found, unseen }));
    Ok(Outcome::new(result, found, validation, loaded.sources))
}

fn recordings(sources: &[Source]) -> Result<Vec<Recording>, Error> {
    sources
        .iter()
        .map(|source| {
            Ok(Recording {
                samples: source.samples()?,
                reference: source.log.reference.clone(),
            })
        })
        .collect()
}

/// Shortens each recording to its first part and returns the remaining parts.
fn split(recordings: &mut [Recording], part: f64) -> Result<Vec<Recording>, Error> {
    check_share(part)?;
    let rest = |r: &mut Recording| {
        let whole = r.samples.time.len();
        let at = (part * whole as f64) as usize;
        let mut rest = r.clone();
        rest.samples.keep(at..whole);
        rest.reference = r.reference.as_mut().map(|x| x.split_off(at));
        r.samples.keep(0..at);
        rest
    };
    Ok(recordings.iter_mut().map(rest).collect())
}

/// The separable fit of the same logs, where it explains them well enough to be started from.
fn separable(
    sources: &[Source],
    axis: &Axis,
    law: Law,
    terms: &Terms,
    seed: u64,
    observer: &mut dyn Observer,
) -> Option<Estimate> {
    let wanted = conditioning::wanted(sources, axis);
    let record = conditioned(sources, &wanted).ok()?;
    let record = match law.kind.has_elements() {
        true => record.settled(),
        false => record,
    };
    let settings = settings(seed);
    let low_speed = engine::low_speed_bound(&record);
    let (found, _) = engine::fit_law(&record, law, terms, low_speed, &settings, observer).ok()?;
    (found.status == Status::Converged && found.fit.r2 >= choice::MIN_START_R2).then_some(found)
}

fn series(signals: &Signals) -> Series {
    Series {
        log: signals.log.clone(),
        time: signals.time.clone(),
        position: signals.position.clone(),
        velocity: signals.velocity.clone(),
        measured: signals.position.clone(),
        model: signals.simulated.clone(),
        other: vec![0.0; signals.time.len()],
    }
}

/// What was simulated, for people.
fn notes(found: &SimulationFit, axis: &Axis, started: &str) -> Vec<String> {
    let mut out = vec![match found.is_closed_loop() {
        true => "closed loop: the controller of the axis file runs on the recorded reference and the \
                 simulated position; position and force are fitted, each weighted by its own residual"
            .to_string(),
        false => "open loop: the logged force drives the simulated axis; the position is fitted"
            .to_string(),
    }];
    let acts = match axis.hold {
        Hold::Held => "the force of a sample holds until the next",
        Hold::Centred => "the force of a sample is the mean around its instant",
    };
    let is_found = found.fitted.parameter("delay").is_some();
    out.push(match (found.fitted.terms.delay, found.is_closed_loop()) {
        (Delay::Fitted, true) if !is_found => format!(
            "{acts}; no dead time between controller and axis was found: the force acts as soon as it is asked for"
        ),
        (Delay::Fitted, true) => format!(
            "{acts}; the dead time between controller and axis, by which the force acts later than that, is fitted"
        ),
        (Delay::Fitted, false) => format!("{acts}; a further delay of the force is fitted"),
        (_, true) if axis.hold == Hold::Centred => format!(
            "{acts}; a dead time between controller and axis is not fitted: a measured force does not say when it was \
             asked for. Where the log shows the command, set force = \"held\" in [simulation]"
        ),
        _ => acts.to_string(),
    });
    let starts = if found.is_closed_loop() {
        "position, velocity, bristle deflection and any integral of the controller"
    } else {
        "position, velocity and bristle deflection"
    };
    let runs = match (found.runs, found.segment()) {
        (1, _) => "one run, simulated whole, whose start".to_string(),
        (n, None) => format!("{n} runs, each simulated whole, whose starts"),
        (n, Some(seconds)) => {
            format!("{n} pieces of up to {seconds} s, each simulated on its own, whose starts")
        }
    };
    out.push(format!(
        "{runs} ({starts}; {} values in all) are fitted too",
        found.starts()
    ));
    out.push(format!(
        "nothing filtered or differentiated; {} in a control period",
        match found.substeps {
            1 => "one plant step".to_string(),
            n => format!("{n} plant steps"),
        }
    ));
    out.push(match started {
        "separable" => "searched from the separable fit of the same logs".into(),
        _ => "searched from many starting points, without a separable fit".to_string(),
    });
    out
}
