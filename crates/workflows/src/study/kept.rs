//! Runs of a study that are kept as they are done, so that a later call of the same study takes them.

use super::done::Done;
use super::exported::{self, ExportedC};
use super::metrics::metrics;
use std::path::Path;
use stiction_files::study::{Job, Study};
use stiction_files::{Error, Runs, Work, sha256_of};

/// Keeps the runs of a study, and those with exported C, in the folder that its outcome goes to; `resume` takes those that an
/// earlier call has left there, of exported C those that were made with the same.
///
/// # Errors
/// Where the folder cannot be written, another call is at work in it, or the runs in it are of another study or version.
pub fn keep(
    study: &Study,
    exported: Option<&ExportedC>,
    dir: &Path,
    resume: bool,
) -> Result<Runs, Error> {
    let work = Work {
        beside: exported.map_or(0, |_| exported::runs(study)),
        ..work(study)
    };
    match resume {
        true => Runs::resume(dir, &work),
        false => Runs::begin(dir, &work),
    }
}

/// What the runs of a study depend on: the files that it was read from, whose contents say everything.
fn work(study: &Study) -> Work {
    let inputs: Vec<&str> = study.inputs.iter().map(|i| i.sha256.as_str()).collect();
    Work {
        kind: "study".into(),
        version: env!("CARGO_PKG_VERSION").into(),
        of: sha256_of(inputs.join("\n").as_bytes()),
        runs: first_beside(study),
        beside: 0,
    }
}

/// The place of the first run with exported C, behind those of the study.
pub(super) fn first_beside(study: &Study) -> usize {
    study.grids().map(|grid| grid.jobs().len()).sum()
}

/// A run that was kept, if it is one of `job`.
pub(super) fn taken(study: &Study, job: Job, text: &str) -> Option<Done> {
    let done: Done = serde_json::from_str(text).ok()?;
    let trace = done.trace.as_ref().is_none_or(|trace| {
        let load = trace.load.as_ref();
        trace.whole.is_whole()
            && trace.reversal.is_whole()
            && load.is_none_or(|load| load.is_whole())
    });
    let contour = done.contour.as_ref().is_none_or(|trace| trace.is_whole());
    let whole = trace && contour && done.metrics.len() == metrics(study, job).len();
    (whole && done.job == job).then_some(done)
}

/// Keeps a run.
pub(super) fn add(runs: &Runs, place: usize, done: &Done) {
    let text = serde_json::to_string(done).expect("plain data");
    runs.add(place, &text);
}
