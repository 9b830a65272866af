//! `--method static`: constant velocities to Fc, Fs, vs, sigma2.

use super::{Beside, path_of, refused, run_of, samples, speed};
use crate::error::Error;
use crate::identify::{Options, Outcome, assemble, log_warnings, trust};
use crate::source::Source;
use std::time::Instant;
use stiction_codes::Code;
use stiction_files::Axis;
use stiction_files::Warning;
use stiction_files::result::{
    RejectedEntry, ResolvedAxis, StaticMapEntry, StaticPointEntry, Trust,
};
use stiction_files::symbols;
use stiction_identify::LawKind;
use stiction_identify::procedure::{
    Exponent, Run, StaticMap, StaticSettings, Stretches, static_map, stretches,
};
use stiction_log::Motion;

/// Speeds in each direction that a map should have.
const ADVISED: usize = 12;
/// Two speeds closer than this, relative, count as one.
const SAME_SPEED: f64 = 0.02;
/// A point with less weight than this lies off the curve.
const OUTLYING: f64 = 0.1;

/// A map with what goes into the result.
pub(super) struct Mapped {
    pub map: StaticMap,
    pub entry: StaticMapEntry,
    pub warnings: Vec<Warning>,
}

/// Finds the stretches in logs and fits the map.
pub(super) fn map(options: &Options, axis: &Axis, sources: &[Source]) -> Result<Mapped, Error> {
    let motion = sources[0].log.motion;
    let terms = axis.terms_for(&sources[0].log, options.asymmetric)?;
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
        exponent: Exponent::Given(axis.stribeck_exponent),
    };
    let map = static_map(&found.points, &settings).map_err(|e| refused(sources, e))?;
    let warnings = warnings(&map, &found, sources, motion);
    let entry = entry(&map, &found, sources, motion);
    Ok(Mapped {
        map,
        entry,
        warnings,
    })
}

/// The whole workflow.
pub(super) fn run(
    options: &Options,
    axis: &Axis,
    sources: Vec<Source>,
    beside: &Beside,
    clock: Instant,
) -> Result<Outcome, Error> {
    super::require(
        options,
        &[LawKind::CoulombViscous, LawKind::Stribeck, LawKind::LuGre],
        "a static map has no stiffness: coulomb-viscous, or stribeck (also meant by lugre)",
    )?;
    let motion = sources[0].log.motion;
    let force_unit = sources[0].log.force_unit.clone();
    let mut found = map(options, axis, &sources)?;
    let estimate = found.map.fitted_law();
    let mut warnings = log_warnings(&sources);
    // A log of constant velocities moves at few speeds on purpose.
    warnings.retain(|w| w.code != Code::ConstantVelocity);
    warnings.append(&mut found.warnings);
    let mut reasons = Vec::new();
    trust::saturation(&sources, &mut reasons);
    trust::unidentifiable(&estimate, motion, &mut warnings, &mut reasons);
    if estimate.fit.r2.is_nan() || estimate.fit.r2 < 0.5 {
        let text = "the curve explains less than half of the variance of the forces";
        warnings.push(Warning::new(Code::PoorFit, text));
        reasons.push(text.into());
    }
    let break_away = super::break_away(beside, &estimate, motion)?;
    let mut result = assemble::result(assemble::Parts {
        options,
        law_chosen_by: "user",
        sources: &sources,
        axis: ResolvedAxis {
            name: axis.name.clone(),
            kind: motion.to_string(),
            force_unit: force_unit.clone(),
            columns: sources[0].log.detected.clone(),
            conditioning: notes(&found, &sources, axis),
            terms: assemble::term_names(&estimate, motion),
        },
        motion,
        force_unit: &force_unit,
        estimate: &estimate,
        validation: &[],
        laws: Vec::new(),
        trust: Trust {
            trustworthy: reasons.is_empty(),
            reasons,
        },
        warnings,
        wall_s: clock.elapsed().as_secs_f64(),
    });
    result.static_map = Some(found.entry);
    result.break_away = break_away;
    Ok(Outcome {
        result,
        estimate,
        simulation: None,
        validation: Vec::new(),
        sources,
        motion,
        force_unit,
        truth: Vec::new(),
    })
}

fn notes(found: &Mapped, sources: &[Source], axis: &Axis) -> Vec<String> {
    let mut notes = vec![
        "force and position as logged, nothing filtered".to_string(),
        format!(
            "{} constant-velocity stretches, sought in the {}; ends and transients dropped (marginal \
             standard error rule)",
            found.map.points.len(),
            if sources.iter().all(|s| s.log.reference.is_some()) {
                "reference"
            } else {
                "position"
            }
        ),
    ];
    if !axis.terms.cogging.is_empty() {
        let whole = found.map.points.iter().filter(|p| p.pitches > 0).count();
        notes.push(format!(
            "{whole} of them averaged over whole cogging pitches"
        ));
    }
    notes.push("robust loss: Tukey's, its scale from the points".into());
    notes
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
        speeds.dedup_by(|b, a| *b <= *a * (1.0 + SAME_SPEED));
        speeds.len()
    };
    let (pos, neg) = (distinct(1.0), distinct(-1.0));
    if pos.min(neg) < ADVISED {
        out.push(Warning::new(
            Code::FewSpeeds,
            format!(
                "{pos} different speeds in the positive direction and {neg} in the negative one; a \
                 static map should have {ADVISED} each way, evenly spaced in their logarithm, from \
                 well below the Stribeck velocity to the top speed"
            ),
        ));
    }
    if !found.rejected.is_empty() {
        let list: Vec<String> = found
            .rejected
            .iter()
            .take(3)
            .map(|r| {
                format!(
                    "{} at {:.3} to {:.3} s, {}: {}",
                    path_of(sources, r.log),
                    r.time.0,
                    r.time.1,
                    speed(r.velocity, motion),
                    r.reason.name()
                )
            })
            .collect();
        let more = found.rejected.len().saturating_sub(list.len());
        let more = if more > 0 {
            format!("; and {more} more")
        } else {
            String::new()
        };
        out.push(Warning::new(
            Code::UnsteadyStretches,
            format!(
                "{} left out: {}{more}",
                plural(found.rejected.len(), "stretch", "stretches"),
                list.join("; ")
            ),
        ));
    }
    let outlying: Vec<String> = map
        .points
        .iter()
        .zip(&map.weights)
        .filter(|(_, w)| **w < OUTLYING)
        .map(|(p, _)| speed(p.velocity, motion))
        .collect();
    if !outlying.is_empty() {
        out.push(Warning::new(
            Code::OutlyingPoints,
            format!(
                "{} far off the curve of the others and hardly counted: {}",
                plural(outlying.len(), "point lies", "points lie"),
                outlying.join(", ")
            ),
        ));
    }
    out
}

fn plural(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
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
    }
}
