//! The static map of logs of constant velocity: the stretches, the curve, and what to beware of.

use crate::error::Error;
use crate::identify::disagree;
use crate::identify::load::Asked;
use crate::identify::logs::{path_of, refused, run_of, samples};
use crate::identify::options::Options;
use crate::identify::searched;
use crate::source::Source;
use crate::wording::{Setting, TOGETHER_WITH};
use stiction_codes::Code;
use stiction_files::result::{RejectedEntry, StaticMapEntry, StaticPointEntry};
use stiction_files::symbols;
use stiction_files::{Axis, Warning};
use stiction_identify::procedure::{
    Exponent, Run, StaticMap, StaticSettings, Stretches, static_map, static_map_near, stretches,
};
use stiction_identify::{Dependence, LawKind, Observer, Terms};
use stiction_log::Motion;
use stiction_policy::{choice, procedure};
use stiction_say::{Notice, Sought, Unsteady, Value};
use stiction_search::Counts;

/// A map with what goes into the result.
pub(super) struct Mapped {
    pub map: StaticMap,
    pub entry: StaticMapEntry,
    pub warnings: Vec<Warning>,
    /// Whether a search for it was stopped.
    pub interrupted: bool,
    /// Evaluations of that search.
    pub counts: Counts,
}

/// Finds the stretches in logs and fits the map.
pub(super) fn map(
    asked: Asked,
    sources: &[Source],
    observer: &mut dyn Observer,
) -> Result<Mapped, Error> {
    let Asked { options, axis, .. } = asked;
    let motion = sources[0].log.motion;
    let terms = axis.terms_for(&sources[0].log, options.asymmetric)?;
    refuse_uncounted(options, axis, &terms)?;
    let own = samples(sources)?;
    let runs: Vec<Run> = sources
        .iter()
        .zip(&own)
        .map(|(source, samples)| run_of(source, samples, axis))
        .collect();
    let found = stretches(&runs, &terms.cogging).map_err(|e| refused(sources, e))?;
    let settings = StaticSettings {
        asymmetric: options.asymmetric,
        offset: terms.offset && !options.asymmetric,
        stribeck: options.law != Some(LawKind::CoulombViscous),
        exponent: Exponent::Given(axis.exponent()),
    };
    // Least squares refuse what no search could be given either.
    let everywhere = static_map(&found.points, &settings).map_err(|e| refused(sources, e))?;
    let searched = match settings.stribeck {
        true => searched::curve(asked, sources, &found.points, &settings, observer)?,
        false => None,
    };
    let (map, elsewhere) = match &searched {
        None => (everywhere, false),
        Some(step) => {
            let near = static_map_near(&found.points, &settings, &step.near);
            let near = near.map_err(|e| refused(sources, e))?;
            match !asked.options.searching.no_finish
                && everywhere.loss < near.loss * (1.0 - choice::MAX_EQUAL_LOSS)
            {
                true => (everywhere, true),
                false => (near, false),
            }
        }
    };
    let map = match &searched {
        Some(step) if asked.options.searching.no_finish => map.as_searched(&step.values),
        _ => map,
    };
    let mut warnings = warnings(&map, &found, sources, motion);
    if asked.options.searching.no_finish {
        warnings.extend(searched.as_ref().and_then(|step| step.warning()));
    }
    if elsewhere {
        let sought = Sought::Curve;
        warnings.push(Notice::SearchMissed { sought }.into());
    }
    warnings.extend(disagree::named(
        map.disagreement.as_slice(),
        sources,
        motion,
        (&disagree::options(asked), true),
    ));
    let interrupted = searched.as_ref().is_some_and(|step| step.interrupted);
    let counts = searched.as_ref().map(|step| step.counts);
    let entry = StaticMapEntry {
        searched: searched.map(|step| step.entry),
        ..entry(&map, &found, sources, motion)
    };
    Ok(Mapped {
        map,
        entry,
        warnings,
        interrupted,
        counts: counts.unwrap_or_default(),
    })
}

/// Refuses terms that the map would not count: their force would pass for friction, or for scatter of the points.
fn refuse_uncounted(options: &Options, axis: &Axis, terms: &Terms) -> Result<(), Error> {
    let dependence = terms.dependences.first().map(Dependence::name);
    let key = match (terms.gravity, terms.quadratic_viscous) {
        (true, _) => Some("gravity"),
        (_, true) => Some("quadratic_viscous"),
        _ => dependence,
    };
    let Some(key) = key else { return Ok(()) };
    let found = "given, and a map of constant velocities does not count it";
    let allowed = "offset and cogging (averaged over whole pitches); leave the key out where the motion makes its force \
                   cancel or stay small, else fit whole records: the method separable";
    let key = format!("terms.{key}");
    Err(match axis.refuse(&key, found, allowed, Code::BadConfig) {
        Some(error) => error.into(),
        None => Error::usage(
            [
                format!("{key} ").into(),
                TOGETHER_WITH.into(),
                Setting::Method.is(options.procedures.method.name()),
            ],
            allowed,
        ),
    })
}

/// A speed with its unit.
fn speed(value: f64, motion: Motion) -> Value {
    Value::new(value, symbols::speed_unit(motion))
}

fn warnings(
    map: &StaticMap,
    found: &Stretches,
    sources: &[Source],
    motion: Motion,
) -> Vec<Warning> {
    let mut out = Vec::new();
    let distinct = |sign: f64| {
        let mut speeds: Vec<f64> = map
            .points
            .iter()
            .filter(|p| p.velocity * sign > 0.0)
            .map(|p| p.velocity.abs())
            .collect();
        speeds.sort_by(f64::total_cmp);
        speeds.dedup_by(|b, a| *b <= *a * (1.0 + procedure::MAX_EQUAL_SPEED));
        speeds.len()
    };
    let (pos, neg) = (distinct(1.0), distinct(-1.0));
    if pos.min(neg) < procedure::MIN_SPEEDS {
        let few = Notice::FewSpeeds {
            positive: pos,
            negative: neg,
            advised: procedure::MIN_SPEEDS,
        };
        out.push(few.into());
    }
    if !found.rejected.is_empty() {
        let first = found.rejected.iter().take(3).map(|r| Unsteady {
            log: path_of(sources, r.log),
            seconds: [r.time.0, r.time.1],
            speed: speed(r.velocity, motion),
            reason: r.reason.name(),
        });
        let unsteady = Notice::UnsteadyStretches {
            first: first.collect(),
            all: found.rejected.len(),
        };
        out.push(unsteady.into());
    }
    let outlying = map.outlying().map(|p| speed(p.velocity, motion));
    let speeds: Vec<Value> = outlying.collect();
    if !speeds.is_empty() {
        out.push(Notice::OutlyingPoints { speeds }.into());
    }
    out
}

fn entry(map: &StaticMap, found: &Stretches, sources: &[Source], motion: Motion) -> StaticMapEntry {
    StaticMapEntry {
        velocity_unit: symbols::speed_unit(motion).into(),
        force_unit: sources[0].log.force_unit.clone(),
        scatter: map.scatter,
        points: map
            .points
            .iter()
            .zip(map.model.iter().zip(&map.weights))
            .map(|(p, (model, weight))| StaticPointEntry {
                path: path_of(sources, p.log),
                start_s: p.time.0,
                end_s: p.time.1,
                velocity: p.velocity,
                force: p.force,
                force_std: p.error,
                model: *model,
                weight: *weight,
                samples: p.samples,
                effective_samples: p.effective,
                dropped_s: p.dropped,
                pitches: p.pitches,
            })
            .collect(),
        rejected: found
            .rejected
            .iter()
            .map(|r| RejectedEntry {
                path: path_of(sources, r.log),
                start_s: r.time.0,
                end_s: r.time.1,
                velocity: r.velocity,
                reason: r.reason.name().into(),
            })
            .collect(),
        searched: None,
    }
}
