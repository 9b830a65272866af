//! Axes drawn for a promise that gave no figures: how many, with what, and what the first of them is.

use super::run::Failed;
use stiction_files::Warning;
use stiction_files::study::{Drawn, PROMISE_DRAWS, Study};
use stiction_files::symbols::{force_unit, length_unit};
use stiction_log::Motion;
use stiction_say::{DrawnAxis, Notice, Value};

/// What is said of runs on drawn axes that could not be made, once for each path and controller. `others` are those on the axis
/// as modelled.
pub(super) fn warnings(study: &Study, drawn: &[Failed], others: &[Failed]) -> Vec<Warning> {
    let of = |(_, job, _): &Failed| (job.path, job.controller);
    let exact = |(grid, job, _): &&Failed| *grid == 0 && study.families[job.family].kind == "exact";
    let groups = drawn.chunk_by(|a, b| of(a) == of(b));
    let said = groups.map(|runs| {
        let modelled = others.iter().filter(exact).any(|e| of(e) == of(&runs[0]));
        not_promised(study, runs, modelled).into()
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

fn not_promised(study: &Study, runs: &[Failed], modelled: bool) -> Notice {
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
    Notice::NotPromised {
        path: path.to_string(),
        controller: controller.to_string(),
        schemes,
        why: fault.no_run(),
        axes: axes.collect(),
        modelled,
    }
}

/// What was drawn.
fn axis(drawn: &Drawn, motion: Motion) -> DrawnAxis {
    let (force, length) = (force_unit(motion), length_unit(motion));
    let curve = drawn.axis.law.curve();
    let shapes = drawn.beside.shapes.iter().map(|shape| shape.force.abs());
    let waves = drawn.beside.waves.iter().map(|wave| wave.force.abs());
    let wandering = drawn.beside.wandering.map(|w| w.force);
    let mass = match motion {
        Motion::Linear => "kg",
        Motion::Rotary => "kg*m^2",
    };
    DrawnAxis {
        mass: Value::new(drawn.axis.mass, mass),
        stiffness: Value::new(drawn.axis.law.stiffness(), format!("{force}/{length}")),
        coulomb: [curve.positive().coulomb, curve.negative().coulomb],
        force_unit: force.to_string(),
        // No minus before nothing.
        beside: [shapes.sum(), waves.sum(), wandering.unwrap_or(0.0)].map(|force: f64| force + 0.0),
    }
}
