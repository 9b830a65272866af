//! Two axes along a contour: one run of the grid, and what is kept of it.

use super::compensation::{believing, feedforward};
use super::contour_trace::ContourTrace;
use super::course;
use super::diverged::{Fault, stayed};
use super::done::Done;
use super::learnt::Learnt;
use super::machine::{self, largest_force};
use super::metrics::feed;
use stiction_files::study::result::PathEntry;
use stiction_files::study::{Belief, ContourPlan, Drawn, Job, Scheme, Second, Study};
use stiction_friction::{LuGre, ParamError};
use stiction_servo::axis::{Axis, AxisSettings, Sample};
use stiction_servo::controller::Controller;
use stiction_servo::cross_coupling::CrossCoupling;
use stiction_servo::integrator::{Integrator, Mid, Quick};
use stiction_servo::law::OfAxis;
use stiction_servo::levelled::{Depending, Levelled};
use stiction_servo::metrics::{Contour, Feed, Tracking, circular_deviation, share_at_limit};
use stiction_servo::two_axes::{PlaneSample, follow};
use stiction_servo::unmodelled::Beside;

/// What is asked of one run.
struct Plan<'a> {
    pub contour: &'a ContourPlan,
    pub controllers: [Controller; 2],
    pub scheme: &'a Scheme,
    pub beliefs: [Belief; 2],
    /// The axes themselves.
    pub axes: [Belief; 2],
    pub coupling: Option<CrossCoupling>,
}

/// What a run gives.
struct Ran {
    pub metrics: Vec<f64>,
    /// Whether a watchdog switched off.
    pub switched_off: bool,
    /// All samples, and from which on they count.
    pub samples: Vec<PlaneSample>,
    pub counted: usize,
}

fn along<L: OfAxis, I: Integrator<L>>(
    study: &Study,
    second: &Second,
    plan: &Plan,
    job: Job,
    before: &Learnt,
    integrator: &dyn Fn(usize) -> Result<I, ParamError>,
) -> Result<Ran, Fault> {
    let contour = plan.contour;
    let machines = [&study.machine, &second.machine];
    // Without compensation.
    let settings = |i: usize| {
        let controller = believing(plan.controllers[i], machines[i], plan.beliefs[i]);
        // Noise of its own on each axis.
        let seed = study.seed.wrapping_add(i as u64);
        machine::settings::<L>(machines[i], plan.axes[i], controller, seed)
    };
    let settings = [settings(0)?, settings(1)?];
    let follow = |[x, y]: [AxisSettings<L>; 2]| -> Result<_, ParamError> {
        let mut axes = [Axis::new(x, integrator(0)?)?, Axis::new(y, integrator(1)?)?];
        let samples = follow(&mut axes, plan.coupling.as_ref(), contour.motion.as_ref())?;
        Ok((axes, samples))
    };
    let watches = before.before(study, job, || {
        let (_, samples) = follow(settings.clone())?;
        Ok(sides(&samples).to_vec())
    })?;
    let mut with = settings.clone();
    for i in [0, 1] {
        let controller = &with[i].controller;
        with[i].feedforward = feedforward(
            plan.scheme,
            machines[i],
            controller,
            plan.beliefs[i],
            &watches[i],
        )?;
    }
    let (axes, samples) = follow(with)?;
    stayed(samples.iter().map(|s| s.axes.each_ref()))?;
    let sides = sides(&samples);
    let from = samples.partition_point(|s| s.axes[0].time < contour.skip);
    let counted = &samples[from..];
    let switched_off = axes.iter().any(|axis| {
        let compensator = axis.feedforward().compensator();
        compensator.is_some_and(|c| c.state().watch.tripped())
    });
    let limits = [
        largest_force(&study.machine, &plan.controllers[0]),
        largest_force(&second.machine, &plan.controllers[1]),
    ];
    Ok(Ran {
        metrics: metrics(
            contour,
            counted,
            sides.each_ref().map(|s| &s[from..]),
            limits,
        ),
        switched_off,
        counted: from,
        samples,
    })
}

/// The samples of each axis.
fn sides(samples: &[PlaneSample]) -> [Vec<Sample>; 2] {
    [0, 1].map(|i| samples.iter().map(|s| s.axes[i]).collect())
}

fn metrics(
    contour: &ContourPlan,
    samples: &[PlaneSample],
    sides: [&[Sample]; 2],
    limits: [f64; 2],
) -> Vec<f64> {
    let deviation = Contour::of(samples);
    let circular = match contour.kind {
        "circle" => {
            let points: Vec<_> = samples.iter().map(|s| s.axes.map(|a| a.position)).collect();
            circular_deviation(&points)
        }
        _ => f64::NAN,
    };
    let [x, y] = sides.map(Tracking::of);
    let mut metrics = vec![
        deviation.rms,
        deviation.peak,
        circular,
        x.reversal_peak,
        y.reversal_peak,
        x.command_change,
        y.command_change,
        share_at_limit(sides[0], limits[0]),
        share_at_limit(sides[1], limits[1]),
    ];
    metrics.extend(feed(Feed::along(samples)));
    metrics
}

pub(super) fn on_contour(
    study: &Study,
    job: Job,
    contour: &ContourPlan,
    before: &Learnt,
) -> Result<Done, Fault> {
    let missing = ParamError::new("axes", 1.0, "two, for a contour");
    let second = study.second.as_ref().ok_or(missing)?;
    let family = &study.families[job.family];
    let families = [family, &second.families[job.family]];
    let drawn = families.map(|family| family.axes.get(job.belief));
    let controllers = [
        study.controllers[job.controller].value,
        second.controllers[job.controller],
    ];
    let coupling = second.coupling.filter(|_| job.coupled);
    let plan = Plan {
        contour,
        controllers,
        scheme: &study.compensators[job.compensator].value,
        beliefs: families.map(|family| family.beliefs[job.belief]),
        axes: match drawn {
            [Some(x), Some(y)] => [x.axis, y.axis],
            _ => [&study.machine, &second.machine].map(|machine| Belief {
                law: machine.law,
                mass: machine.mass,
            }),
        },
        coupling: coupling.map(|c| c.above(controllers.each_ref())),
    };
    let run = (study, second, &plan, job, before);
    let depends = [&study.machine, &second.machine].map(|machine| machine.depends.clone());
    let ran = match depends {
        [None, None] => moved::<LuGre<f64>, _>(run, drawn, &|_| Quick::new(1))?,
        depends => {
            let depends = depends.map(Option::unwrap_or_default);
            let axis = |i: usize| Ok(Depending::new(Mid::new(1)?, depends[i].clone()));
            moved::<Levelled<LuGre<f64>>, _>(run, drawn, &axis)?
        }
    };
    let names = study.names(job);
    let exact = family.kind == "exact" && study.keeps_courses;
    Ok(Done {
        job,
        metrics: ran.metrics,
        switched_off: ran.switched_off,
        trace: None,
        course: match exact {
            true => course::contour_rows(
                names,
                job.coupled,
                &ran.samples,
                course::rows_of_a_run(study),
            ),
            false => String::new(),
        },
        contour: (exact || family.kind == "moved")
            .then(|| ContourTrace::of(names, job.coupled, &ran.samples[ran.counted..])),
    })
}

/// One run, of the axes of the study or of those that are drawn.
fn moved<L: OfAxis, I: Integrator<L>>(
    (study, second, plan, job, before): (&Study, &Second, &Plan, Job, &Learnt),
    drawn: [Option<&Drawn>; 2],
    integrator: &dyn Fn(usize) -> Result<I, ParamError>,
) -> Result<Ran, Fault> {
    match drawn {
        [Some(x), Some(y)] => {
            let beside = [&x.beside, &y.beside];
            let integrator = |i: usize| Ok(Beside::new(integrator(i)?, beside[i].clone()));
            along(study, second, plan, job, before, &integrator)
        }
        _ => along(study, second, plan, job, before, integrator),
    }
}

/// A contour as it goes into `study.json`.
pub(super) fn entry(plan: &ContourPlan) -> PathEntry {
    PathEntry {
        name: plan.name.clone(),
        kind: plan.kind.into(),
        duration_s: plan.motion.duration(),
        skip_s: plan.skip,
    }
}
