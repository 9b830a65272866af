//! Two axes along a contour: one run of the grid, and what is kept of it.

use super::result::PathEntry;
use super::wrong::Belief;
use super::{Machine, Scheme, Study};
use stiction_friction::ParamError;
use stiction_servo::axis::{Axis, Sample};
use stiction_servo::controller::Controller;
use stiction_servo::cross_coupling::CrossCoupling;
use stiction_servo::integrator::Quick;
use stiction_servo::metrics::{Contour, Tracking, circular_deviation, share_at_limit};
use stiction_servo::plane::PlaneMotion;
use stiction_servo::two_axes::{PlaneSample, follow};

/// Points of a trace that are kept.
const KEPT: usize = 3000;

/// The second axis of a study and what is above both.
pub(crate) struct Second {
    pub machine: Machine,
    /// One for each controller of the first axis, in its order.
    pub controllers: Vec<Controller>,
    /// What is believed of this axis: one for each belief of each family.
    pub families: Vec<Vec<Belief>>,
    pub coupling: Option<CrossCoupling>,
}

/// A contour and from when on it counts.
pub(crate) struct ContourPlan {
    pub name: String,
    pub kind: &'static str,
    pub motion: Box<dyn PlaneMotion + Send + Sync>,
    /// s
    pub skip: f64,
}

/// Names of the metrics of a contour, in the order in which a run gives them; what they measure is in `docs/study.md`.
pub(super) const METRICS: [&str; 9] = [
    "contour_rms",
    "contour_peak",
    "circular_deviation",
    "reversal_peak_x",
    "reversal_peak_y",
    "command_change_x",
    "command_change_y",
    "saturation_x",
    "saturation_y",
];

/// The course of a run on a contour with exact parameters, for figures.
pub(crate) struct ContourTrace {
    pub path: String,
    pub controller: String,
    pub compensator: String,
    pub coupled: bool,
    /// s
    pub time: Vec<f64>,
    /// The reference, m.
    pub reference: Vec<[f64; 2]>,
    /// Unit vector to the left of the motion; zero where it stands.
    pub left: Vec<[f64; 2]>,
    /// m, positive if the contour lies to the left.
    pub deviation: Vec<f64>,
}

/// What is asked of one run.
pub(super) struct Plan<'a> {
    pub contour: &'a ContourPlan,
    pub controllers: [Controller; 2],
    pub scheme: &'a Scheme,
    pub beliefs: [Belief; 2],
    pub coupling: Option<CrossCoupling>,
}

/// What a run gives.
pub(super) struct Ran {
    pub metrics: Vec<f64>,
    /// Whether a watchdog switched off, whether one still learnt when the run began to count.
    pub switched_off: bool,
    pub still_learning: bool,
    /// All samples, and from which on they count.
    pub samples: Vec<PlaneSample>,
    pub counted: usize,
}

impl Study {
    pub(super) fn along(&self, second: &Second, plan: &Plan) -> Result<Ran, ParamError> {
        let axis = |i: usize, machine: &Machine| {
            let belief = plan.beliefs[i];
            let controller = super::compensation::believing(plan.controllers[i], machine, belief);
            // Noise of its own on each axis.
            let mut settings = machine.settings(controller, self.seed.wrapping_add(i as u64));
            settings.feedforward = plan.scheme.feedforward(machine, &controller, belief)?;
            Axis::new(settings, Quick::new(1)?)
        };
        let mut axes = [axis(0, &self.machine)?, axis(1, &second.machine)?];
        let contour = plan.contour;
        let samples = follow(&mut axes, plan.coupling.as_ref(), contour.motion.as_ref())?;
        let sides: [Vec<Sample>; 2] = [0, 1].map(|i| samples.iter().map(|s| s.axes[i]).collect());
        let learnt = sides
            .iter()
            .filter_map(|side| plan.scheme.learnt(side, self.machine.rate));
        let still_learning = learnt.fold(0.0, f64::max) > contour.skip;
        let from = samples.partition_point(|s| s.axes[0].time < contour.skip);
        let counted = &samples[from..];
        let switched_off = axes.iter().any(|axis| {
            let compensator = axis.feedforward().compensator();
            compensator.is_some_and(|c| c.state().watch.tripped)
        });
        let limits = [
            self.machine.largest_force(&plan.controllers[0]),
            second.machine.largest_force(&plan.controllers[1]),
        ];
        Ok(Ran {
            metrics: metrics(
                contour,
                counted,
                sides.each_ref().map(|s| &s[from..]),
                limits,
            ),
            switched_off,
            still_learning,
            counted: from,
            samples,
        })
    }
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
    vec![
        deviation.rms,
        deviation.peak,
        circular,
        x.reversal_peak,
        y.reversal_peak,
        x.command_change,
        y.command_change,
        share_at_limit(sides[0], limits[0]),
        share_at_limit(sides[1], limits[1]),
    ]
}

impl ContourTrace {
    /// Of each stretch the sample that deviates most.
    pub fn of(names: [&str; 3], coupled: bool, samples: &[PlaneSample]) -> Self {
        let mut trace = ContourTrace {
            path: names[0].into(),
            controller: names[1].into(),
            compensator: names[2].into(),
            coupled,
            time: Vec::new(),
            reference: Vec::new(),
            left: Vec::new(),
            deviation: Vec::new(),
        };
        for stretch in samples.chunks(samples.len().div_ceil(KEPT).max(1)) {
            let most = stretch
                .iter()
                .max_by(|a, b| a.deviation.abs().total_cmp(&b.deviation.abs()));
            let Some(sample) = most else { continue };
            let [vx, vy] = sample.axes.map(|a| a.reference.velocity);
            let speed = libm::hypot(vx, vy);
            let left = match speed {
                0.0 => [0.0; 2],
                _ => [-vy / speed, vx / speed],
            };
            trace.time.push(sample.axes[0].time);
            trace
                .reference
                .push(sample.axes.map(|a| a.reference.position));
            trace.left.push(left);
            trace.deviation.push(sample.deviation);
        }
        trace
    }
}

impl ContourPlan {
    pub(super) fn entry(&self) -> PathEntry {
        PathEntry {
            name: self.name.clone(),
            kind: self.kind.into(),
            duration_s: self.motion.duration(),
            skip_s: self.skip,
        }
    }
}
