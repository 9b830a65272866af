//! A force step below break-away: reading the step response off a log, and the published inversion.
//!
//! In presliding the bristle is a spring and the axis a second-order system (Zhang et al. 2025,
//! doi 10.1371/journal.pone.0322844, eqs. 26-34):
//!
//! ```text
//! sigma0 = u/x_ss,   zeta = -ln Mp / sqrt(pi^2 + ln^2 Mp),   sigma1 = 2 zeta sqrt(sigma0 M) - sigma2
//! ```
//! with the step u, the displacement x_ss it settles at and the overshoot Mp. It assumes linear bristles,
//! but they already slip: see `step_fit` for the resulting error and how it is avoided.

use super::level::{BLOCK, Level};
use super::stretch::Run;
use crate::error::Error;
use std::f64::consts::PI;
use std::ops::Range;

/// Fewest samples before the step.
const FEWEST_BEFORE: usize = 5;
/// And after it.
const FEWEST_AFTER: usize = 30;
/// How much higher than the scatter of the force a step must be.
const CLEAR_STEP: f64 = 6.0;
/// How far the position may still move over the last tenth of the record, relative to the step.
const SETTLED_MOTION: f64 = 0.05;

/// A step response, read off the log.
#[derive(Clone, Debug, PartialEq)]
pub struct StepResponse {
    /// Samples from the first before the step to the last before the force changes again.
    pub range: Range<usize>,
    /// First sample at the new force.
    pub onset: usize,
    /// Force before the step, and by how much it steps.
    pub before: f64,
    /// Height of the step, with its sign.
    pub height: f64,
    /// Standard errors of the force before the step and after it.
    pub errors: [f64; 2],
    /// Position before the step, m or rad.
    pub rest: f64,
    /// Displacement at which it settles, in the direction of the step, m or rad.
    pub settled: f64,
    /// Time of the largest displacement after the step, s, and the overshoot there as a part of
    /// `settled`; `None` where the axis does not overshoot.
    pub overshoot: Option<(f64, f64)>,
}

/// What the published inversion makes of a step response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inversion {
    /// `u/x_ss`.
    pub sigma0: f64,
    /// `2 zeta sqrt(sigma0 M) - sigma2`; `None` without overshoot, from which zeta cannot be had.
    pub sigma1: Option<f64>,
    /// Damping ratio, 0 to 1.
    pub damping_ratio: Option<f64>,
    /// The mass used: as given, else from the time of the peak.
    pub mass: Option<f64>,
}

impl StepResponse {
    /// Reads a step response off a log: the first jump of the force that is at least half as high as
    /// the highest.
    ///
    /// # Errors
    /// [`Error::NoStep`] where the force does not step from one constant level to another, or the axis
    /// does not come to rest after it.
    pub fn read(run: &Run, log: usize) -> Result<Self, Error> {
        crate::conditioning::check(log + 1, run.samples)?;
        let none = |reason: &'static str| Error::NoStep {
            log: log + 1,
            reason,
        };
        let force = &run.samples.force;
        let position = run.samples.position.as_ref().ok_or(none(
            "the log has no position, which the inversion is made from",
        ))?;
        let time = &run.samples.time;
        let n = force.len();
        if n < FEWEST_BEFORE + FEWEST_AFTER {
            return Err(none(
                "too few samples: 5 before the step and 30 after it are needed",
            ));
        }
        let onset = onset(force).ok_or(none("the force has no step above its noise"))?;
        if onset < FEWEST_BEFORE {
            return Err(none(
                "fewer than 5 samples before the step: its level at rest is not known",
            ));
        }
        let level = mean(&force[onset..(onset + FEWEST_BEFORE).min(n)]);
        let base = Level::held(force, 0..onset, onset);
        let end = (onset..n)
            .find(|&i| (force[i] - level).abs() > 0.5 * (level - base.mean).abs())
            .unwrap_or(n);
        if end - onset < FEWEST_AFTER {
            return Err(none("fewer than 30 samples before the force changes again"));
        }
        let start = onset.saturating_sub(BLOCK);
        // From the middle: the samples at either end may belong to the transition from or to another level.
        let middle = (onset + BLOCK).max((onset + end) / 2).min(end);
        let after = Level::held(force, onset..end, middle);
        let height = after.mean - base.mean;
        let rest = mean(&position[start..onset]);
        let moved: Vec<f64> = position[onset..end]
            .iter()
            .map(|x| (x - rest) * height.signum())
            .collect();
        let tenth = moved.len() / 10;
        let last = mean(&moved[moved.len() - tenth..]);
        let previous = mean(&moved[moved.len() - 2 * tenth..moved.len() - tenth]);
        let settled = mean(&moved[moved.len() - 2 * tenth..]);
        let step = run.resolution.unwrap_or(0.0);
        if !(settled > 3.0 * step && settled > 0.0) {
            return Err(none("the position hardly moves with the force"));
        }
        if (last - previous).abs() > SETTLED_MOTION * settled + step {
            return Err(none(
                "the axis is still moving at its end: the step exceeds break-away, or the record is \
                 too short",
            ));
        }
        let seconds: Vec<f64> = time[onset..end].iter().map(|t| t - time[onset]).collect();
        let scatter = deviation(&moved[moved.len() - 2 * tenth..]).max(0.5 * step);
        Ok(Self {
            range: start..end,
            onset,
            before: base.mean,
            height,
            errors: [base.error, after.error],
            rest,
            settled,
            overshoot: peak(&seconds, &moved, settled)
                .map(|(t, x)| (t, x / settled - 1.0))
                .filter(|(_, mp)| mp * settled > 3.0 * scatter),
        })
    }

    /// The published inversion; `mass` in kg (kg m^2) where known, `viscous` sigma2, which the method
    /// cannot tell from sigma1.
    pub fn invert(&self, mass: Option<f64>, viscous: f64) -> Inversion {
        let sigma0 = self.height.abs() / self.settled;
        let Some((time, mp)) = self.overshoot else {
            return Inversion {
                sigma0,
                sigma1: None,
                damping_ratio: None,
                mass,
            };
        };
        let log = libm::log(mp);
        let zeta = -log / libm::sqrt(PI * PI + log * log);
        // An overshoot of more than the whole step belongs to no linear system.
        let zeta = (zeta > 0.0).then_some(zeta);
        let mass = mass.or_else(|| {
            let omega = PI / (time * libm::sqrt(1.0 - zeta? * zeta?));
            Some(sigma0 / (omega * omega))
        });
        let sigma1 = zeta
            .zip(mass)
            .map(|(z, m)| 2.0 * z * libm::sqrt(sigma0 * m) - viscous);
        Inversion {
            sigma0,
            sigma1,
            damping_ratio: zeta,
            mass,
        }
    }
}

/// First sample after the first jump that is at least half as high as the highest.
fn onset(force: &[f64]) -> Option<usize> {
    let w = FEWEST_BEFORE;
    let n = force.len();
    let jump = |k: usize| mean(&force[k..k + w]) - mean(&force[k - w..k]);
    let jumps: Vec<f64> = (w..=n - w).map(|k| jump(k).abs()).collect();
    let highest = jumps.iter().copied().fold(0.0, f64::max);
    let mut steps: Vec<f64> = force.windows(2).map(|f| (f[1] - f[0]).abs()).collect();
    let middle = steps.len() / 2;
    let (_, usual, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    if !(highest > CLEAR_STEP * *usual && highest > 0.0) {
        return None;
    }
    let first = jumps.iter().position(|j| *j >= 0.5 * highest)?;
    let best =
        (first..(first + 2 * w).min(jumps.len())).max_by(|&a, &b| jumps[a].total_cmp(&jumps[b]))?;
    // Of several equally high jumps the first is the step.
    let at = (first..=best).find(|&i| jumps[i] >= jumps[best] * (1.0 - 1e-9))?;
    Some(at + w)
}

/// Time and height of the largest displacement, by a parabola through its top.
fn peak(time: &[f64], moved: &[f64], settled: f64) -> Option<(f64, f64)> {
    let top = (0..moved.len()).max_by(|&a, &b| moved[a].total_cmp(&moved[b]))?;
    let bound = settled + 0.7 * (moved[top] - settled);
    let mut from = top;
    while from > 0 && moved[from - 1] > bound {
        from -= 1;
    }
    let mut to = top + 1;
    while to < moved.len() && moved[to] > bound {
        to += 1;
    }
    if to - from < 5 {
        return Some((time[top], moved[top]));
    }
    // Time in units of the width, so that the powers lose no digits.
    let width = time[to - 1] - time[from];
    let (mut gram, mut rhs) = (
        nalgebra::DMatrix::<f64>::zeros(3, 3),
        nalgebra::DVector::zeros(3),
    );
    for i in from..to {
        let s = (time[i] - time[top]) / width;
        let row = [1.0, s, s * s];
        for a in 0..3 {
            for b in 0..3 {
                gram[(a, b)] += row[a] * row[b];
            }
            rhs[a] += row[a] * moved[i];
        }
    }
    let c = gram.cholesky()?.solve(&rhs);
    if c[2] >= 0.0 {
        return Some((time[top], moved[top]));
    }
    let s = -0.5 * c[1] / c[2];
    Some((time[top] + s * width, c[0] + 0.5 * c[1] * s))
}

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len().max(1) as f64
}

fn deviation(x: &[f64]) -> f64 {
    let m = mean(x);
    (x.iter().map(|x| (x - m) * (x - m)).sum::<f64>() / x.len().max(1) as f64).sqrt()
}
