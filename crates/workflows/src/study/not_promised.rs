//! Axes drawn for a promise that gave no figures: how many, with what, and what the first of them is.

use super::diverged::Fault;
use super::run::Failed;
use stiction_codes::Code;
use stiction_files::Warning;
use stiction_files::study::{Drawn, PROMISE_DRAWS, Study};
use stiction_files::symbols::{force_unit, length_unit};
use stiction_log::Motion;
use stiction_number::four_digits as short;

/// What is said of runs on drawn axes that could not be made, once for each path and controller. `others` are those on the axis
/// as modelled.
pub(super) fn warnings(study: &Study, drawn: &[Failed], others: &[Failed]) -> Vec<Warning> {
    let of = |(_, job, _): &Failed| (job.path, job.controller);
    let exact = |(grid, job, _): &&Failed| *grid == 0 && study.families[job.family].kind == "exact";
    let groups = drawn.chunk_by(|a, b| of(a) == of(b));
    let said = groups.map(|runs| {
        let modelled = others.iter().filter(exact).any(|e| of(e) == of(&runs[0]));
        Warning::new(Code::NotPromised, text(study, runs, modelled))
    });
    said.collect()
}

/// Why nothing at all is promised.
pub(super) fn reason(study: &Study, drawn: &[Failed]) -> String {
    let mut axes: Vec<usize> = drawn.iter().map(|(_, job, _)| job.belief).collect();
    axes.sort_unstable();
    axes.dedup();
    format!(
        "{}: {} of the {PROMISE_DRAWS} axes drawn from its covariance and [remaining] give no figures",
        study.machine.model.origin,
        axes.len()
    )
}

fn text(study: &Study, runs: &[Failed], modelled: bool) -> String {
    let (_, first, fault) = &runs[0];
    let [path, controller, _] = study.names(*first);
    let schemes = runs.chunk_by(|(_, a, _), (_, b, _)| a.cell() == b.cell());
    let schemes: Vec<String> = schemes
        .map(|runs| {
            let job = runs[0].1;
            let coupled = if job.coupled {
                " and the contour controlled"
            } else {
                ""
            };
            let with = match study.names(job)[2] {
                "none" => "without compensation".into(),
                name => format!("with {name}"),
            };
            format!("{} of {PROMISE_DRAWS} {with}{coupled}", runs.len())
        })
        .collect();
    let fault = match fault {
        Fault::Diverged(time) => {
            format!("left its path at {} s and did not come back", short(*time))
        }
        Fault::Refused(e) => format!(
            "has {} = {}, allowed: {}",
            e.name,
            short(e.value),
            e.allowed
        ),
    };
    let families = [
        Some(&study.families),
        study.second.as_ref().map(|s| &s.families),
    ];
    let motions = [
        Some(study.machine.motion),
        study.second.as_ref().map(|s| s.machine.motion),
    ];
    let axes = families
        .into_iter()
        .zip(motions)
        .filter_map(|(families, motion)| {
            let drawn = families?.get(first.family)?.axes.get(first.belief)?;
            Some(axis(drawn, motion?))
        });
    let axes: Vec<String> = axes.collect();
    let advice = match modelled {
        true => "The axis as modelled gives none either: mend that first, see not-run",
        false => {
            "The axis as modelled keeps to its path with these gains. Allowed: the covariance and [remaining] of an identification \
             of this axis"
        }
    };
    format!(
        "{path}, {controller}: nothing is promised, as axes drawn from the covariance and [remaining] of the model give no figures \
         ({}). The first {fault}, with {}. {advice}",
        schemes.join(", "),
        axes.join("; "),
    )
}

/// What was drawn, in words.
fn axis(drawn: &Drawn, motion: Motion) -> String {
    let (force, length) = (force_unit(motion), length_unit(motion));
    let curve = drawn.axis.law.curve();
    let shapes = drawn.beside.shapes.iter().map(|shape| shape.force.abs());
    let waves = drawn.beside.waves.iter().map(|wave| wave.force.abs());
    let wandering = drawn.beside.wandering.map(|w| w.force);
    format!(
        "mass {} {}, sigma0 {} {force}/{length}, coulomb {} and {} {force}, and beside the law {} {force} that come and go after \
         reversals, {} {force} that change with the place, {} {force} (rms) that change by themselves",
        short(drawn.axis.mass),
        match motion {
            Motion::Linear => "kg",
            Motion::Rotary => "kg*m^2",
        },
        short(drawn.axis.law.stiffness()),
        short(curve.positive().coulomb),
        short(curve.negative().coulomb),
        short(shapes.sum()),
        short(waves.sum()),
        short(wandering.unwrap_or(0.0)),
    )
}
