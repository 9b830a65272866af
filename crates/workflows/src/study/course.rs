//! `trajectories.csv` and `contours.csv`: the course of every run with exact parameters, from its beginning.

use std::fmt::Write;
use stiction_files::study::Study;
use stiction_files::symbols::{force_unit, length_unit};
use stiction_log::Motion;
use stiction_servo::axis::Sample;
use stiction_servo::two_axes::PlaneSample;

/// Most rows of one run: of more samples every n-th is written.
const MOST_ROWS_OF_A_RUN: usize = 5_000;
/// Most rows of all runs together.
const MOST_ROWS: usize = 200_000;

/// How many rows a run may have.
pub(super) fn rows_of_a_run(study: &Study) -> usize {
    let paths = study.paths.len() + study.contours.len();
    let runs = paths * study.controllers.len() * study.compensators.len();
    (MOST_ROWS / runs.max(1)).clamp(10, MOST_ROWS_OF_A_RUN)
}

/// The header for paths.
pub(super) fn header(motion: Motion) -> String {
    let (length, force) = (units(motion).0, units(motion).1);
    format!(
        "path,controller,compensator,time [s],reference [{length}],position [{length}],error [{length}],\
         force [{force}],compensation [{force}]\n"
    )
}

/// The header for contours.
pub(super) fn contour_header(motion: Motion) -> String {
    let (length, force) = units(motion);
    let pair = |what: &str, unit: &str| format!("{what} x [{unit}],{what} y [{unit}]");
    format!(
        "contour,controller,compensator,coupling,time [s],{},{},{},deviation [{length}],{},{}\n",
        pair("reference", length),
        pair("position", length),
        pair("error", length),
        pair("force", force),
        pair("compensation", force),
    )
}

fn units(motion: Motion) -> (&'static str, &'static str) {
    (length_unit(motion), force_unit(motion))
}

/// The rows of a run on a path, at most `most`.
pub(super) fn rows(names: [&str; 3], samples: &[Sample], most: usize) -> String {
    let keys = keys(names);
    let mut out = String::new();
    for s in samples.iter().step_by(samples.len().div_ceil(most).max(1)) {
        let _ = write!(out, "{keys},{}", s.time);
        let values = [
            s.reference.position,
            s.position,
            s.error(),
            s.command,
            s.compensation,
        ];
        end(&mut out, &values);
    }
    out
}

/// The rows of a run on a contour, at most `most`.
pub(super) fn contour_rows(
    names: [&str; 3],
    coupled: bool,
    samples: &[PlaneSample],
    most: usize,
) -> String {
    let keys = keys(names);
    let mut out = String::new();
    for s in samples.iter().step_by(samples.len().div_ceil(most).max(1)) {
        let _ = write!(out, "{keys},{},{}", u8::from(coupled), s.axes[0].time);
        let of = |value: fn(&Sample) -> f64| s.axes.each_ref().map(value);
        let [reference, position, error] = [
            of(|a| a.reference.position),
            of(|a| a.position),
            of(Sample::error),
        ];
        let [force, compensation] = [of(|a| a.command), of(|a| a.compensation)];
        let before = [reference, position, error].concat();
        let after = [force, compensation].concat();
        end(&mut out, &[before, vec![s.deviation], after].concat());
    }
    out
}

/// Names in quotes: they may hold commas.
fn keys(names: [&str; 3]) -> String {
    let quoted = names.map(|name| format!("\"{}\"", name.replace('"', "\"\"")));
    quoted.join(",")
}

/// Seven digits of each value.
fn end(out: &mut String, values: &[f64]) {
    for value in values {
        let _ = write!(out, ",{value:.6e}");
    }
    out.push('\n');
}
