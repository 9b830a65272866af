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
use stiction_policy::procedure;

/// The longest stretch is this part of the log, so that the usual jump is not that of the step.
const LARGEST_STRETCH: usize = 16;

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
    /// [`Error::FaintStep`] where no jump of the force rises above its noise, [`Error::NoStep`] where it does not step from one constant level to another, or the axis
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
        if n < procedure::MIN_SAMPLES_BEFORE_STEP + procedure::MIN_SAMPLES_AFTER_STEP {
            return Err(none(
                "too few samples: 5 before the step and 30 after it are needed",
            ));
        }
        let Jump { onset, stretch } = jump(force).map_err(|highest| Error::FaintStep {
            log: log + 1,
            highest: highest.height,
            needed: highest.needed,
            stretch: highest.stretch,
        })?;
        if onset < procedure::MIN_SAMPLES_BEFORE_STEP {
            return Err(none(
                "fewer than 5 samples before the step: its level at rest is not known",
            ));
        }
        let level = mean(&force[onset..(onset + stretch).min(n)]);
        let base = Level::held(force, 0..onset, onset);
        let half = 0.5 * (level - base.mean).abs();
        let telling = telling(force, onset, half).min(n - onset);
        let level = mean(&force[onset..(onset + stretch.max(telling)).min(n)]);
        let sums = sums(&force[onset..]);
        let over = level - mean(&force[onset..]);
        let off = |i: usize| (sums[i + telling] - sums[i]) / telling as f64 - over;
        let end = (0..=n - onset - telling)
            .find(|&i| off(i).abs() > half)
            .map_or(n, |i| onset + i);
        if end - onset < procedure::MIN_SAMPLES_AFTER_STEP {
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
        if (last - previous).abs() > procedure::MAX_FINAL_MOTION * settled + step {
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

/// The step of a force, and over how many samples on either side means have to be taken to see it.
struct Jump {
    /// First sample at the new force.
    onset: usize,
    stretch: usize,
}

/// The highest jump of a force without a clear one, and how high it would have to be.
struct Highest {
    height: f64,
    needed: f64,
    stretch: usize,
}

/// The first jump that is at least half as high as the highest: of the means of 5 samples on either side, and where
/// that does not rise above the noise of the force, of means over more and more.
fn jump(force: &[f64]) -> Result<Jump, Highest> {
    let n = force.len();
    let sums = sums(force);
    let mut stretch = procedure::MIN_SAMPLES_BEFORE_STEP;
    let mut faint: Option<Highest> = None;
    while stretch == procedure::MIN_SAMPLES_BEFORE_STEP || stretch <= n / LARGEST_STRETCH {
        let jumps = jumps(force, &sums, stretch);
        let height = jumps.iter().copied().fold(0.0, f64::max);
        // The usual jump is that of the noise, slow noise and ramps included.
        let mut needed = procedure::MIN_STEP_JUMP * median(jumps.clone());
        if stretch == procedure::MIN_SAMPLES_BEFORE_STEP {
            needed = needed.max(procedure::MIN_STEP_HEIGHT * usual_difference(force));
        }
        if height > needed && height > 0.0 {
            return Ok(Jump {
                onset: onset(force, stretch, &jumps, needed.max(0.5 * height)),
                stretch,
            });
        }
        let nearer = |f: &Highest| height * f.needed > f.height * needed;
        if faint.as_ref().is_none_or(nearer) {
            faint = Some(Highest {
                height,
                needed,
                stretch,
            });
        }
        stretch *= 2;
    }
    Err(faint.expect("one stretch is always tried"))
}

/// By how much the means of so many samples before and after each sample differ.
fn jumps(force: &[f64], sums: &[f64], stretch: usize) -> Vec<f64> {
    let w = stretch;
    let of = |k: usize| {
        if w == procedure::MIN_SAMPLES_BEFORE_STEP {
            mean(&force[k..k + w]) - mean(&force[k - w..k])
        } else {
            (sums[k + w] - 2.0 * sums[k] + sums[k - w]) / w as f64
        }
    };
    (w..=force.len() - w).map(|k| of(k).abs()).collect()
}

/// Sums of the samples before each, less the mean of all, so that long means cost no more than short ones.
fn sums(force: &[f64]) -> Vec<f64> {
    let level = mean(force);
    let mut sum = 0.0;
    let add = |f: &f64| {
        sum += f - level;
        sum
    };
    std::iter::once(0.0).chain(force.iter().map(add)).collect()
}

/// Median difference between neighbouring samples.
fn usual_difference(force: &[f64]) -> f64 {
    median(force.windows(2).map(|f| (f[1] - f[0]).abs()).collect())
}

fn median(mut of: Vec<f64>) -> f64 {
    let middle = of.len() / 2;
    let (_, median, _) = of.select_nth_unstable_by(middle, f64::total_cmp);
    *median
}

/// First sample after the first jump that is at least so high.
fn onset(force: &[f64], stretch: usize, jumps: &[f64], least: f64) -> usize {
    let first = jumps.iter().position(|j| *j >= least).unwrap_or(0);
    let among = first..(first + 2 * stretch).min(jumps.len());
    let best = among
        .max_by(|&a, &b| jumps[a].total_cmp(&jumps[b]))
        .unwrap_or(first);
    // Of several equally high jumps the first is the step.
    let at = (first..=best)
        .find(|&i| jumps[i] >= jumps[best] * (1.0 - 1e-9))
        .unwrap_or(best);
    let at = at + stretch;
    if stretch == procedure::MIN_SAMPLES_BEFORE_STEP {
        return at;
    }
    // The top of a jump of long means is flat. Where the two levels are, the samples beside it tell: the step is
    // where the squares about the two means are least.
    let around = at - stretch..at + stretch;
    let (mut left, total) = (0.0, force[around.clone()].iter().sum::<f64>());
    let mut best = (0.0, at);
    for (k, i) in around.clone().enumerate() {
        let (before, after) = (k as f64, (2 * stretch - k) as f64);
        if k > 0 {
            let apart = left / before - (total - left) / after;
            let between = apart * apart * before * after;
            if between > best.0 {
                best = (between, i);
            }
        }
        left += force[i];
    }
    best.1
}

/// Over how many samples from `onset` on a mean has to be taken so that noise does not move it by `by`.
fn telling(force: &[f64], onset: usize, by: f64) -> usize {
    // The median difference of independent normal samples is 0.954 of their deviation.
    let scatter = deviation(&force[onset.saturating_sub(BLOCK)..onset]);
    let noise = scatter.max(usual_difference(force) / 0.954);
    let share = procedure::MIN_LEVEL_ERROR * noise / by;
    (share * share).ceil().clamp(1.0, force.len() as f64) as usize
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
