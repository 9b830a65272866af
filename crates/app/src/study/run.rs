//! The grid of a study, run in parallel, and what is kept of each run.

use super::contour::{self, ContourPlan, ContourTrace, Plan};
use super::result::{SCHEMA, StudyFile};
use super::trace::Trace;
use super::wrong::{Belief, Family};
use super::{PathPlan, Scheme, Study, StudyOutcome};
use super::{course, doubt, path};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use stiction_codes::Code;
use stiction_friction::ParamError;
use stiction_identify::Control;
use stiction_servo::sampled::Sampled;

/// A run of the grid, by the places in the lists of the study.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Job {
    /// Contours count on from the paths.
    pub path: usize,
    pub controller: usize,
    pub compensator: usize,
    pub coupled: bool,
    pub family: usize,
    pub belief: usize,
}

impl Job {
    /// The cell of the grid that the run belongs to.
    pub fn cell(self) -> Job {
        Job { belief: 0, ..self }
    }
}

/// What is kept of a run.
pub(super) struct Done {
    pub job: Job,
    pub metrics: Vec<f64>,
    pub switched_off: bool,
    pub still_learning: bool,
    pub trace: Option<Trace>,
    pub contour: Option<ContourTrace>,
    /// Rows of `trajectories.csv` or `contours.csv`.
    pub course: String,
}

impl Study {
    /// Every run of the grid, in the order of the result.
    pub(super) fn jobs(&self) -> Vec<Job> {
        let mut jobs = Vec::new();
        for path in 0..self.paths.len() + self.contours.len() {
            for controller in 0..self.controllers.len() {
                for compensator in 0..self.compensators.len() {
                    for &coupled in self.couplings(path, compensator) {
                        for (family, beliefs) in self.families.iter().enumerate() {
                            if !self.matters(compensator, beliefs) {
                                continue;
                            }
                            jobs.extend((0..beliefs.beliefs.len()).map(|belief| Job {
                                path,
                                controller,
                                compensator,
                                coupled,
                                family,
                                belief,
                            }));
                        }
                    }
                }
            }
        }
        jobs
    }

    /// Without and with control of the contour, where there is one. Learning is of one axis.
    fn couplings(&self, path: usize, compensator: usize) -> &'static [bool] {
        let learns = matches!(self.compensators[compensator].it, Scheme::Learning(..));
        let coupling = self.second.as_ref().and_then(|s| s.coupling);
        match (path < self.paths.len(), coupling) {
            (true, _) => &[false],
            (false, _) if learns => &[],
            (false, None) => &[false],
            (false, Some(_)) => &[false, true],
        }
    }

    /// Whether wrong parameters change anything: those of the law where there is a model, the mass everywhere, as it is
    /// fed forward.
    fn matters(&self, compensator: usize, family: &Family) -> bool {
        let model = matches!(self.compensators[compensator].it, Scheme::Model(_));
        let mass = |b: &Belief| b.mass != self.machine.mass;
        family.kind == "exact" || model || family.beliefs.iter().any(mass)
    }
}

pub(super) fn run(
    study: &Study,
    watch: &mut (dyn FnMut(usize, usize) -> Control + Send),
) -> StudyOutcome {
    let jobs = study.jobs();
    let stopped = AtomicBool::new(false);
    let count = Mutex::new((0, watch));
    // Tells of `more` runs that are done, and notes whether the work is to stop.
    let go_on = |more: usize| {
        let mut count = count.lock().unwrap_or_else(PoisonError::into_inner);
        count.0 += more;
        let so_far = count.0;
        if (count.1)(so_far, jobs.len()) == Control::Stop {
            stopped.store(true, Ordering::SeqCst);
        }
        !stopped.load(Ordering::SeqCst)
    };
    let mut warnings = study.warnings.clone();
    let sampled = study.sampled();
    let done: Vec<Option<Result<Done, (Job, ParamError)>>> = jobs
        .par_iter()
        .map(|&job| {
            if stopped.load(Ordering::SeqCst) {
                return None;
            }
            let done = study.one(job, &sampled, &|| go_on(0)).transpose()?;
            go_on(1);
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
    warnings.extend(failed.iter().map(|(job, e)| study.not_run(*job, e)));
    let results = study.rows(&kept);
    warnings.extend(doubt::warnings(study, &results));
    let (mut traces, mut contours) = (Vec::new(), Vec::new());
    let mut courses = study.headers();
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
            axis: study.machine.entry(),
            second_axis: study.second.as_ref().map(|s| s.machine.entry()),
            paths: (study.paths.iter().map(PathPlan::entry))
                .chain(study.contours.iter().map(ContourPlan::entry))
                .collect(),
            results,
            warnings,
        },
        traces,
        contours,
        courses,
    }
}

impl Study {
    /// A run whose metrics are numbers; `None` where it was not to go on.
    fn one(
        &self,
        job: Job,
        sampled: &[Option<Sampled>],
        go_on: &dyn Fn() -> bool,
    ) -> Result<Option<Done>, ParamError> {
        let done = match self.contours.get(job.path.wrapping_sub(self.paths.len())) {
            Some(contour) => Some(self.on_contour(job, contour)?),
            None => self.on_path(job, sampled[job.path].as_ref(), go_on)?,
        };
        for (&name, &value) in self
            .metrics(job)
            .iter()
            .zip(done.iter().flat_map(|d| &d.metrics))
        {
            // Not every motion has these.
            let absent =
                ["velocity_ripple", "circular_deviation"].contains(&name) && value.is_nan();
            if !(value.is_finite() || absent) {
                let allowed =
                    "a finite number: a smaller motion, slower, with smaller gains and forces";
                return Err(ParamError::new(name, value, allowed));
            }
        }
        Ok(done)
    }

    /// Names of the metrics of a run.
    pub(super) fn metrics(&self, job: Job) -> &'static [&'static str] {
        match job.path < self.paths.len() {
            true => &path::METRICS,
            false => &contour::METRICS,
        }
    }

    /// The name of a path or contour.
    pub(super) fn path_name(&self, job: Job) -> &str {
        match self.paths.get(job.path) {
            Some(path) => &path.name,
            None => &self.contours[job.path - self.paths.len()].name,
        }
    }

    pub(super) fn names(&self, job: Job) -> course::Names<'_> {
        [
            self.path_name(job),
            &self.controllers[job.controller].name,
            &self.compensators[job.compensator].name,
        ]
    }

    /// Headers of the courses on paths and on contours, where there are any.
    fn headers(&self) -> [String; 2] {
        let motion = self.machine.motion;
        [
            match self.paths.is_empty() {
                true => String::new(),
                false => course::header(motion),
            },
            match self.contours.is_empty() {
                true => String::new(),
                false => course::contour_header(motion),
            },
        ]
    }

    fn on_contour(&self, job: Job, contour: &ContourPlan) -> Result<Done, ParamError> {
        let missing = ParamError::new("axes", 1.0, "two, for a contour");
        let second = self.second.as_ref().ok_or(missing)?;
        let family = &self.families[job.family];
        let controllers = [
            self.controllers[job.controller].it,
            second.controllers[job.controller],
        ];
        let coupling = second.coupling.filter(|_| job.coupled);
        let plan = Plan {
            contour,
            controllers,
            scheme: &self.compensators[job.compensator].it,
            beliefs: [
                family.beliefs[job.belief],
                second.families[job.family][job.belief],
            ],
            coupling: coupling.map(|c| c.above(controllers.each_ref())),
        };
        let ran = self.along(second, &plan)?;
        let names = self.names(job);
        let exact = family.kind == "exact";
        Ok(Done {
            job,
            metrics: ran.metrics,
            switched_off: ran.switched_off,
            still_learning: ran.still_learning,
            trace: None,
            course: match exact {
                true => {
                    course::contour_rows(names, job.coupled, &ran.samples, self.rows_of_a_run())
                }
                false => String::new(),
            },
            contour: exact
                .then(|| ContourTrace::of(names, job.coupled, &ran.samples[ran.counted..])),
        })
    }

    fn not_run(&self, job: Job, e: &ParamError) -> crate::error::Warning {
        crate::error::Warning::new(
            Code::NotRun,
            format!(
                "{}, {}, {} was not run: {} = {}; allowed: {}",
                self.path_name(job),
                self.controllers[job.controller].name,
                self.compensators[job.compensator].name,
                e.name,
                stiction_number::four_digits(e.value),
                e.allowed
            ),
        )
    }
}
