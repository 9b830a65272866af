//! The grid of a study, run in parallel, and what is kept of each run.

use super::done::Done;
use super::learnt::Learnt;
use super::metrics::{may_be_absent, metrics};
use super::outcome::StudyOutcome;
use super::rows::rows;
use super::{contour, course, doubt, machine, path};
use rayon::prelude::*;
use stiction_codes::Code;
use stiction_files::Warning;
use stiction_files::study::result::{SCHEMA, StudyFile};
use stiction_files::study::{Job, Study};
use stiction_friction::ParamError;
use stiction_number::four_digits as short;
use stiction_search::{Observer, Shared};
use stiction_servo::sampled::Sampled;

/// Runs the whole grid on all threads. The observer is told the number of runs done and their total, also between the
/// passes of learning, and may stop the work: what is done then is kept. Results do not depend on the number of
/// threads.
pub fn simulate(study: &Study, observer: &mut dyn Observer) -> StudyOutcome {
    let jobs = study.jobs();
    let watch = Shared::new(observer, jobs.len());
    let mut warnings = study.warnings.clone();
    let sampled = path::sampled(study);
    let learnt = Learnt::of(study);
    let done: Vec<Option<Result<Done, (Job, ParamError)>>> = jobs
        .par_iter()
        .map(|&job| {
            if watch.is_stopped() {
                return None;
            }
            let done = one(study, job, &sampled, &learnt, &|| watch.go_on()).transpose()?;
            watch.one_more();
            watch.go_on();
            Some(done.map_err(|e| (job, e)))
        })
        .collect();
    let complete = done.iter().all(Option::is_some);
    let (mut kept, mut failed) = (Vec::new(), Vec::new());
    for result in done.into_iter().flatten() {
        match result {
            Ok(done) => kept.push(done),
            Err(e) => failed.push(e),
        }
    }
    // The same fault in every member of a cell is said once.
    failed.dedup_by_key(|(job, _)| job.cell());
    warnings.extend(failed.iter().map(|(job, e)| not_run(study, *job, e)));
    let results = rows(study, &kept);
    warnings.extend(doubt::warnings(study, &results));
    let (mut traces, mut contours) = (Vec::new(), Vec::new());
    let mut courses = headers(study);
    for done in kept {
        courses[usize::from(done.job.path >= study.paths.len())].push_str(&done.course);
        traces.extend(done.trace);
        contours.extend(done.contour);
    }
    StudyOutcome {
        file: StudyFile {
            schema: SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            name: study.name.clone(),
            seed: study.seed,
            status: if complete { "complete" } else { "interrupted" }.into(),
            inputs: study.inputs.clone(),
            axis: machine::entry(&study.machine),
            second_axis: study.second.as_ref().map(|s| machine::entry(&s.machine)),
            paths: (study.paths.iter().map(path::entry))
                .chain(study.contours.iter().map(contour::entry))
                .collect(),
            results,
            warnings,
        },
        traces,
        contours,
        courses,
    }
}

/// One run, whose metrics must be finite numbers; `None` where the work was stopped.
fn one(
    study: &Study,
    job: Job,
    sampled: &[Option<Sampled>],
    before: &Learnt,
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Done>, ParamError> {
    let done = match study.contours.get(job.path.wrapping_sub(study.paths.len())) {
        Some(contour) => Some(contour::on_contour(study, job, contour, before)?),
        None => path::on_path(study, job, sampled[job.path].as_ref(), before, go_on)?,
    };
    for (&name, &value) in metrics(study, job)
        .iter()
        .zip(done.iter().flat_map(|d| &d.metrics))
    {
        let absent = may_be_absent(name) && value.is_nan();
        if !(value.is_finite() || absent) {
            let allowed =
                "a finite number: a smaller motion, slower, with smaller gains and forces";
            return Err(ParamError::new(name, value, allowed));
        }
    }
    Ok(done)
}

/// Headers of the courses on paths and on contours, where there are any.
fn headers(study: &Study) -> [String; 2] {
    let motion = study.machine.motion;
    [
        match study.paths.is_empty() {
            true => String::new(),
            false => course::header(motion),
        },
        match study.contours.is_empty() {
            true => String::new(),
            false => course::contour_header(motion),
        },
    ]
}

fn not_run(study: &Study, job: Job, e: &ParamError) -> Warning {
    Warning::new(
        Code::NotRun,
        format!(
            "{}, {}, {} was not run: {} = {}; allowed: {}",
            study.path_name(job),
            study.controllers[job.controller].name,
            study.compensators[job.compensator].name,
            e.name,
            short(e.value),
            e.allowed
        ),
    )
}
