//! The grid of a study, run in parallel, and what is kept of each run.

use super::contour::{self, ContourPlan, ContourTrace, Plan};
use super::result::{
    AxisParameter, MetricEntry, PathEntry, ResultRow, SCHEMA, SimulatedAxis, StudyFile,
};
use super::wrong::{Belief, Family};
use super::{Machine, ModelKind, ModelScheme, PathPlan, Scheme, Study, StudyOutcome};
use super::{course, doubt};
use crate::symbols;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use stiction_friction::compensator::{
    Compensator, DisturbanceObserver, Friction, Settings, Source,
};
use stiction_friction::{CoulombViscous, Damping, LuGre, ParamError};
use stiction_identify::Control;
use stiction_log::Motion;
use stiction_servo::axis::{Axis, AxisSettings, Sample};
use stiction_servo::controller::Controller;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::integrator::Quick;
use stiction_servo::metrics::{Tracking, reversals, ripple_at_constant_velocity, share_at_limit};
use stiction_servo::run::{follow, follow_sampled, sample_count};
use stiction_servo::sampled::Sampled;

/// Points of a trace that are kept: more than a figure can show.
const KEPT: usize = 2000;

/// Samples of references that are kept for all runs, of all paths together: a hundred megabytes.
const MOST_SHARED: usize = 4_000_000;

/// A run of the grid, by the places in the lists of the study.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Job {
    /// Contours count on from the paths.
    path: usize,
    controller: usize,
    compensator: usize,
    coupled: bool,
    family: usize,
    belief: usize,
}

impl Job {
    /// The cell of the grid that the run belongs to.
    fn cell(self) -> Job {
        Job { belief: 0, ..self }
    }
}

/// The course of the run with exact parameters, for figures.
pub(crate) struct Trace {
    pub path: String,
    pub controller: String,
    pub compensator: String,
    /// All that counts.
    pub whole: Course,
    /// About the last reversal but one; empty without.
    pub reversal: Course,
}

/// Signals over time, thinned to what a figure can show.
#[derive(Default)]
pub(crate) struct Course {
    /// s
    pub time: Vec<f64>,
    /// m (rad)
    pub reference: Vec<f64>,
    /// m (rad)
    pub error: Vec<f64>,
    /// N (N m)
    pub compensation: Vec<f64>,
}

/// What is kept of a run.
struct Done {
    job: Job,
    metrics: Vec<f64>,
    switched_off: bool,
    still_learning: bool,
    trace: Option<Trace>,
    contour: Option<ContourTrace>,
    /// Rows of `trajectories.csv` or `contours.csv`.
    course: String,
}

/// Names of the metrics; what they measure is in `docs/study.md`.
const METRICS: [&str; 7] = [
    "rms_error",
    "peak_error",
    "reversal_peak",
    "command_change",
    "stick_time",
    "saturation",
    "velocity_ripple",
];

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

/// A controller that feeds the mass that is believed forward: the part of it is the controller's.
pub(super) fn believing(controller: Controller, machine: &Machine, belief: Belief) -> Controller {
    let fed = controller.mass_feedforward() / machine.mass * belief.mass;
    controller.with_mass_feedforward(fed)
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
    fn metrics(&self, job: Job) -> &'static [&'static str] {
        match job.path < self.paths.len() {
            true => &METRICS,
            false => &contour::METRICS,
        }
    }

    /// The name of a path or contour.
    fn path_name(&self, job: Job) -> &str {
        match self.paths.get(job.path) {
            Some(path) => &path.name,
            None => &self.contours[job.path - self.paths.len()].name,
        }
    }

    fn names(&self, job: Job) -> course::Names<'_> {
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

    /// The reference of each path at the control rate, for all runs along it; `None` where that would be too much to keep.
    fn sampled(&self) -> Vec<Option<Sampled>> {
        let mut left = MOST_SHARED;
        let sampled = self.paths.iter().map(|path| {
            let count = sample_count(path.trajectory.duration(), self.machine.rate).ok()?;
            left = left.checked_sub(count)?;
            Sampled::new(path.trajectory.as_ref(), self.machine.rate).ok()
        });
        sampled.collect()
    }

    /// Along `sampled`, if it is there, which is the path's own reference.
    fn on_path(
        &self,
        job: Job,
        sampled: Option<&Sampled>,
        go_on: &dyn Fn() -> bool,
    ) -> Result<Option<Done>, ParamError> {
        let path = &self.paths[job.path];
        let follow = |axis: &mut Axis<_, _>| match sampled {
            Some(sampled) => follow_sampled(axis, sampled),
            None => follow(axis, path.trajectory.as_ref()),
        };
        let family = &self.families[job.family];
        let belief = family.beliefs[job.belief];
        let controller = self.controllers[job.controller].it;
        let controller = believing(controller, &self.machine, belief);
        let scheme = &self.compensators[job.compensator].it;
        let mut settings = self.machine.settings(controller, self.seed);
        settings.feedforward = scheme.feedforward(&self.machine, &controller, belief)?;
        let mut axis = Axis::new(settings.clone(), Quick::new(1)?)?;
        let mut samples = follow(&mut axis)?;
        if let Scheme::Learning(learning, passes) = scheme {
            for _ in 1..*passes {
                if !go_on() {
                    return Ok(None);
                }
                let force = &settings.feedforward.learned;
                let next = learning.learn(
                    force,
                    &samples,
                    controller.mass_feedforward(),
                    self.machine.rate,
                )?;
                settings.feedforward.learned = next;
                axis = Axis::new(settings.clone(), Quick::new(1)?)?;
                samples = follow(&mut axis)?;
            }
        }
        let exact = family.kind == "exact";
        let learnt = scheme.learnt(&samples, self.machine.rate);
        let from = samples.partition_point(|s| s.time < path.skip);
        let counted = &samples[from.min(samples.len())..];
        let tracking = Tracking::of(counted);
        let compensator = axis.feedforward().compensator();
        Ok(Some(Done {
            job,
            metrics: vec![
                tracking.rms,
                tracking.peak,
                tracking.reversal_peak,
                tracking.command_change,
                tracking.stick_time,
                share_at_limit(counted, self.machine.largest_force(&controller)),
                ripple_at_constant_velocity(counted).unwrap_or(f64::NAN),
            ],
            switched_off: compensator.is_some_and(|c| c.state().watch.tripped),
            still_learning: learnt.is_some_and(|t| t > path.skip),
            trace: exact.then(|| Trace::of(self, job, counted)),
            contour: None,
            course: match exact {
                true => course::rows(self.names(job), &samples, self.rows_of_a_run()),
                false => String::new(),
            },
        }))
    }

    /// Rows in the order of the grid, of what is done.
    fn rows(&self, done: &[Done]) -> Vec<ResultRow> {
        let mut rows: Vec<ResultRow> = Vec::new();
        for cell in done.chunk_by(|a, b| a.job.cell() == b.job.cell()) {
            let job = cell[0].job;
            let family = &self.families[job.family];
            let names = self.metrics(job);
            let name = |i: usize| (names[i].to_string(), self.machine.unit(names[i]));
            let metrics = (0..names.len()).filter_map(|i| {
                let values: Vec<f64> = cell.iter().map(|d| d.metrics[i]).collect();
                if values.iter().any(|x| x.is_nan()) {
                    return None;
                }
                let (name, unit) = name(i);
                Some(MetricEntry::of(name, unit, values, family.kind))
            });
            let mut row = ResultRow {
                path: self.path_name(job).into(),
                controller: self.controllers[job.controller].name.clone(),
                compensator: self.compensators[job.compensator].name.clone(),
                coupled: job.coupled,
                parameters: family.name.clone(),
                runs: cell.len(),
                switched_off: cell.iter().filter(|d| d.switched_off).count(),
                still_learning: cell.iter().filter(|d| d.still_learning).count(),
                metrics: metrics.collect(),
            };
            let without = rows
                .iter()
                .find(|r| r.path == row.path && r.controller == row.controller)
                .filter(|r| r.compensator == "none" && r.parameters == "exact" && !r.coupled);
            if let Some(without) = without {
                row.compare(without);
            }
            rows.push(row);
        }
        rows
    }

    fn not_run(&self, job: Job, e: &ParamError) -> crate::error::Warning {
        crate::error::Warning::new(
            "not-run",
            format!(
                "{}, {}, {} was not run: {} = {}; allowed: {}",
                self.path_name(job),
                self.controllers[job.controller].name,
                self.compensators[job.compensator].name,
                e.name,
                crate::check::short(e.value),
                e.allowed
            ),
        )
    }
}

impl Machine {
    pub(super) fn settings(&self, controller: Controller, seed: u64) -> AxisSettings {
        AxisSettings {
            plant: self.plant,
            drive: self.drive,
            encoder: self.encoder,
            position_noise: self.position_noise,
            cogging: self.cogging,
            disturbance: None,
            controller,
            feedforward: Feedforward::default(),
            rate: self.rate,
            substeps: self.substeps,
            seed,
        }
    }

    /// What the controller may ask for and the drive can give, N (N m).
    pub(super) fn largest_force(&self, controller: &Controller) -> f64 {
        controller.force_limit().min(self.drive.peak_force())
    }

    fn unit(&self, metric: &str) -> String {
        match (metric, self.motion) {
            ("stick_time", _) => "s",
            ("velocity_ripple", _) => "1",
            (name, _) if name.starts_with("saturation") => "1",
            (name, Motion::Linear) if name.starts_with("command_change") => "N",
            (name, Motion::Rotary) if name.starts_with("command_change") => "N*m",
            (_, motion) => symbols::length_unit(motion),
        }
        .into()
    }

    fn entry(&self) -> SimulatedAxis {
        let parameters = self.model.parameters.iter().map(|p| AxisParameter {
            name: p.name.clone(),
            value: p.value,
            unit: p.unit.clone(),
        });
        let sigma1 = match self.law.damping() {
            Damping::Constant(_) => "constant",
            _ => "capped",
        };
        SimulatedAxis {
            kind: match self.motion {
                Motion::Linear => "linear",
                Motion::Rotary => "rotary",
            }
            .into(),
            origin: self.model.origin.clone(),
            parameters: parameters.collect(),
            sigma1: sigma1.into(),
            mass: self.mass,
            rate_hz: self.rate,
            substeps: self.substeps,
            delay_s: self.drive.delay,
            current_lag_s: self.drive.current_lag,
            peak_force: Some(self.drive.peak_force()).filter(|f| f.is_finite()),
            encoder: self.encoder.resolution(),
            position_noise: self.position_noise,
        }
    }
}

impl PathPlan {
    fn entry(&self) -> PathEntry {
        PathEntry {
            name: self.name.clone(),
            kind: self.kind.into(),
            duration_s: self.trajectory.duration(),
            skip_s: self.skip,
        }
    }
}

impl ContourPlan {
    fn entry(&self) -> PathEntry {
        PathEntry {
            name: self.name.clone(),
            kind: self.kind.into(),
            duration_s: self.motion.duration(),
            skip_s: self.skip,
        }
    }
}

impl Scheme {
    /// The compensation of an axis of which `belief` is believed.
    pub(super) fn feedforward(
        &self,
        machine: &Machine,
        controller: &Controller,
        belief: Belief,
    ) -> Result<Feedforward, ParamError> {
        let limit = controller.force_limit();
        let observer = |bandwidth: f64| {
            DisturbanceObserver::new(belief.mass, bandwidth, 1.0 / machine.rate, limit)
        };
        match self {
            Scheme::None | Scheme::Learning(..) => Ok(Feedforward::default()),
            Scheme::Observer(bandwidth) => Ok(Feedforward::observer(observer(*bandwidth)?)),
            Scheme::Model(model) => Ok(Feedforward {
                observer: model.observer.map(observer).transpose()?,
                ..model.feedforward(machine, limit, &belief.law)?
            }),
        }
    }
}

impl ModelScheme {
    fn feedforward(
        &self,
        machine: &Machine,
        limit: f64,
        law: &LuGre<f64>,
    ) -> Result<Feedforward, ParamError> {
        let curve = law.curve();
        let sides = [curve.positive(), curve.negative()];
        let friction = match self.kind {
            ModelKind::Coulomb => Friction::Coulomb(CoulombViscous::new(
                sides.map(|s| s.coulomb),
                sides.map(|s| s.viscous),
                curve.offset(),
            )?),
            ModelKind::Stribeck => Friction::Stribeck(*curve),
            ModelKind::LuGre => Friction::LuGre(*law),
        };
        let period = 1.0 / machine.rate;
        let limit = self.limit.unwrap_or(limit);
        let settings = Settings {
            gain: self.gain,
            dead_zone: self.dead_zone,
            slew: self.slew.unwrap_or(f64::MAX),
            ramp: self.ramp,
            adaptation: self.adaptation,
            watchdog: self.watchdog,
            ..Settings::new(period, limit)
        };
        let preview = self.preview.unwrap_or(match self.source {
            Source::Reference => machine.drive.preview(period),
            _ => 0.0,
        });
        let compensator = Compensator::new(friction, self.source, settings)?;
        Ok(Feedforward::compensator(compensator, preview))
    }
}

impl Trace {
    fn of(study: &Study, job: Job, samples: &[Sample]) -> Self {
        let instants = reversals(samples);
        let about = match instants[..] {
            [.., t, next] => {
                let way = next - t;
                let place = |time: f64| samples.partition_point(|s| s.time < time);
                &samples[place(t - 0.05 * way)..place(t + 0.4 * way)]
            }
            _ => &[],
        };
        Trace {
            path: study.path_name(job).into(),
            controller: study.controllers[job.controller].name.clone(),
            compensator: study.compensators[job.compensator].name.clone(),
            whole: Course::of(samples),
            reversal: Course::of(about),
        }
    }
}

impl Course {
    /// Of each stretch the least and the largest error.
    fn of(samples: &[Sample]) -> Self {
        let mut course = Course::default();
        for stretch in samples.chunks(samples.len().div_ceil(KEPT / 2).max(1)) {
            let (mut low, mut high) = (0, 0);
            for (i, sample) in stretch.iter().enumerate() {
                if sample.error() < stretch[low].error() {
                    low = i;
                }
                if sample.error() > stretch[high].error() {
                    high = i;
                }
            }
            let ends = [low.min(high), low.max(high)];
            for &i in &ends[usize::from(low == high)..] {
                course.time.push(stretch[i].time);
                course.reference.push(stretch[i].reference.position);
                course.error.push(stretch[i].error());
                course.compensation.push(stretch[i].compensation);
            }
        }
        course
    }
}

impl MetricEntry {
    fn of(name: String, unit: String, mut values: Vec<f64>, family: &str) -> Self {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = share * (values.len() - 1) as f64;
            let i = (place as usize).min(values.len().saturating_sub(2));
            let next = values.get(i + 1).unwrap_or(&values[i]);
            values[i] + (place - i as f64) * (next - values[i])
        };
        MetricEntry {
            name,
            unit,
            mean,
            least: values[0],
            largest: values[values.len() - 1],
            interval95: (family == "covariance").then(|| [at(0.025), at(0.975)]),
            reduction_percent: None,
            worst_reduction_percent: None,
        }
    }
}

impl ResultRow {
    fn compare(&mut self, without: &ResultRow) {
        for metric in &mut self.metrics {
            let Some(other) = without.metric(&metric.name).filter(|m| m.mean > 0.0) else {
                continue;
            };
            let reduction = |x: f64| Some(100.0 * (1.0 - x / other.mean));
            metric.reduction_percent = reduction(metric.mean);
            metric.worst_reduction_percent = reduction(metric.largest);
        }
    }
}
