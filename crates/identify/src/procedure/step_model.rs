//! The position of a mass with LuGre friction under a recorded force.

use super::level::Level;
use super::step::StepResponse;
use super::stretch::Run;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_servo::plant::{Load, Motion, Plant};

/// Most samples that are simulated.
const MOST_SAMPLES: usize = 4000;
/// Most steps within one.
const MOST_STEPS: u32 = 64;
/// Phase of the axis' own oscillation in one step, at most, rad: the relative error of its frequency is a
/// twelfth of the square.
const PHASE_STEP: f64 = 0.03;

/// What a trial gives the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    pub sigma0: f64,
    pub sigma1: f64,
    pub mass: f64,
    pub curve: Direction<f64>,
    pub exponent: f64,
    /// Constant force beside friction.
    pub offset: f64,
    /// How much later the position is logged than the force, s.
    pub delay: f64,
}

/// One step response, ready to be simulated.
#[derive(Clone, Debug)]
pub(super) struct Response {
    pub time: Vec<f64>,
    pub force: Vec<f64>,
    pub position: Vec<f64>,
    pub before: f64,
    /// First sample at the new force.
    onset: usize,
    /// Standard errors of the force before the step and after it.
    pub errors: [f64; 2],
    /// Step of the position's counts, where it has them.
    pub resolution: Option<f64>,
}

impl Response {
    pub fn new(run: &Run, step: &StepResponse) -> Self {
        let samples = run.samples;
        let end = step.range.end.min(step.onset + MOST_SAMPLES);
        let start = step.onset.saturating_sub(10).max(step.range.start);
        let cut = |x: &[f64]| x[start..end].to_vec();
        let first = samples.time[start];
        let mut force = cut(&samples.force);
        quieten(
            &mut force,
            step.onset - start,
            step.before,
            step.before + step.height,
        );
        Self {
            force,
            time: samples.time[start..end].iter().map(|t| t - first).collect(),
            // The displacements are micrometres, on positions that may be metres: the rest position is
            // subtracted.
            position: samples
                .position
                .as_deref()
                .map(|x| x[start..end].iter().map(|x| x - step.rest).collect())
                .unwrap_or_default(),
            before: step.before,
            onset: step.onset - start,
            errors: step.errors,
            resolution: run.resolution,
        }
    }

    /// Moves the force before the step (0) or after it (1).
    pub fn lift(&mut self, side: usize, by: f64) {
        let (before, after) = self.force.split_at_mut(self.onset);
        if side == 0 {
            self.before += by;
        }
        for force in if side == 0 { before } else { after } {
            *force += by;
        }
    }

    /// Steps in a sample that an axis of this frequency (rad/s) needs.
    pub fn steps(&self, omega: f64) -> u32 {
        let longest = self
            .time
            .windows(2)
            .map(|t| t[1] - t[0])
            .fold(0.0, f64::max);
        (longest * omega / PHASE_STEP)
            .ceil()
            .clamp(1.0, f64::from(MOST_STEPS)) as u32
    }

    /// Positions at the samples, starting at rest under the force before the step, each force held until
    /// the next sample; `None` where the parameters are invalid for a law.
    pub fn simulate(&self, trial: &Trial, steps: u32) -> Option<Vec<f64>> {
        let shape = Shape::with_exponent(trial.exponent);
        let curve = Stribeck::symmetric(shape, trial.curve, 0.0).ok()?;
        let law = LuGre::new(trial.sigma0, Damping::Constant(trial.sigma1), curve).ok()?;
        let plant = Plant::new(trial.mass, law).ok()?;
        let bound = 0.999 * law.bound();
        let mut motion = Motion {
            deflection: ((self.before - trial.offset) / trial.sigma0).clamp(-bound, bound),
            ..Motion::default()
        };
        let n = self.time.len();
        let mut path = Vec::with_capacity(n);
        path.push(motion);
        for k in 1..n {
            let h = (self.time[k] - self.time[k - 1]) / f64::from(steps);
            let force = self.force[k - 1] - trial.offset;
            for _ in 0..steps {
                motion = plant.step(motion, h, Load::force(force)).motion;
            }
            path.push(motion);
        }
        let at = |t: f64| interpolate(&self.time, &path, t);
        Some(self.time.iter().map(|t| at(t - trial.delay)).collect())
    }
}

/// Removes the noise of a force that is constant except for it: each swing of the noise would make the
/// simulated bristles slip further than the real ones did. The rise itself stays as it was measured.
fn quieten(force: &mut [f64], onset: usize, before: f64, after: f64) {
    let rest = &force[onset..];
    let half = rest.len() / 2;
    let scatter = {
        let squares: f64 = rest[half..].iter().map(|f| (f - after) * (f - after)).sum();
        (squares / rest[half..].len().max(1) as f64).sqrt()
    };
    let close = |f: f64| (f - after).abs() <= 3.0 * scatter;
    let Some(settled) = rest.iter().position(|f| close(*f)) else {
        return;
    };
    // Block means of a constant with noise scatter only as much as the correlation of the noise allows.
    let block = (rest.len() / 10).max(2);
    let wander = rest[settled..].chunks_exact(block).any(|c| {
        let own = Level::of(c);
        let error = own.error.max(scatter / (block as f64).sqrt());
        (own.mean - after).abs() > 5.0 * error
    });
    if wander {
        return;
    }
    force[onset + settled..].fill(after);
    force[..onset].fill(before);
}

/// Position at an instant, by the cubic through positions and velocities of the samples around it.
fn interpolate(time: &[f64], path: &[Motion], t: f64) -> f64 {
    let k = time.partition_point(|x| *x <= t);
    if k == 0 {
        return path[0].position;
    }
    let (Some(t1), Some(b)) = (time.get(k), path.get(k)) else {
        let last = path[path.len() - 1];
        return last.position + last.velocity * (t - time[time.len() - 1]);
    };
    let a = path[k - 1];
    let h = t1 - time[k - 1];
    let s = (t - time[k - 1]) / h;
    let (s2, s3) = (s * s, s * s * s);
    (2.0 * s3 - 3.0 * s2 + 1.0) * a.position
        + (s3 - 2.0 * s2 + s) * h * a.velocity
        + (3.0 * s2 - 2.0 * s3) * b.position
        + (s3 - s2) * h * b.velocity
}
