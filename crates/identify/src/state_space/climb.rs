//! The maximum of the likelihood, by Fisher scoring with damping.

use crate::exponential::exp;
use crate::state_space::axis::Axis;
use crate::state_space::filter::{Start, Stretch, Sums, likelihood};
use crate::state_space::unknowns::{
    COULOMB, DISTURBANCE, EACH_SIDE, MEMORY, OFFSET, RATIO, UNKNOWNS, WHITE,
};
use nalgebra::{DMatrix, DVector};
use stiction_dispatch::InstructionSet;

/// Most that an unknown moves in one step, as a logarithm; the constant force in parts of Coulomb friction.
const LONGEST_STEP: f64 = 0.5;
/// First damping, and by what it changes.
const DAMPING: f64 = 1e-3;
const DAMPING_FACTOR: f64 = 6.0;
const LEAST_DAMPING: f64 = 1e-7;
/// Climbs on from where one sticks, and by what factor, a logarithm, the errors of the force are then larger.
const MOST_RESTARTS: usize = 2;
const LARGER: f64 = 1.0;
/// Difference of the log likelihood of two ends that are one.
const SAME_HEIGHT: f64 = 1.0;
/// Tries of a step, each damped more.
const MOST_TRIES: usize = 7;
/// Ends of the logarithm of the correlation time of the disturbance, in samples.
const MEMORY_RANGE: [f64; 2] = [0.0, 7.0];
/// Least deviation of each part of the force error, in parts of the noise of the logged force.
const FAINTEST: f64 = 0.02;

/// What is compared with what.
pub(super) struct Problem<'a> {
    pub stretches: &'a [Stretch],
    pub start: Start,
    /// Sample time, s.
    pub step: f64,
    pub substeps: u32,
    /// Whether each direction of motion has unknowns of its own.
    pub directed: bool,
    /// Stribeck exponent.
    pub exponent: f64,
    /// Standard deviation of the noise of the logged force, N (N m).
    pub noise: f64,
    /// Parts that sums are kept of.
    pub blocks: usize,
}

/// Where a climb ended.
#[derive(Clone, Debug)]
pub(super) struct Top {
    pub at: [f64; UNKNOWNS],
    /// Sums of each block there.
    pub blocks: Vec<Sums>,
    /// Of all blocks.
    pub whole: Sums,
    pub converged: bool,
    /// Evaluations of the filter.
    pub evaluations: usize,
}

impl Problem<'_> {
    /// Logarithm of the least deviation of each part of the force error.
    pub fn faintest(&self) -> f64 {
        libm::log(FAINTEST * self.noise)
    }

    pub fn evaluate(&self, at: &[f64; UNKNOWNS]) -> (Vec<Sums>, Sums) {
        let axis = Axis::at(at, self.exponent, self.directed, self.step, self.substeps);
        let blocks = likelihood(
            &axis,
            self.stretches,
            self.start,
            self.blocks,
            InstructionSet::best(),
        );
        let whole = blocks.iter().fold(Sums::NONE, Sums::and);
        (blocks, whole)
    }

    /// Climbs as [`climb`](Self::climb) does. Where it sticks before a top, which a likelihood of sharp counts is rough enough
    /// for, it climbs on with errors of the force that are held for larger.
    pub fn climb_on(&self, from: &[f64; UNKNOWNS], free: &[usize], most: usize, least: f64) -> Top {
        let mut best = self.climb(from, free, most, least);
        for _ in 0..MOST_RESTARTS {
            if best.converged {
                break;
            }
            let mut start = best.at;
            for lane in [WHITE, DISTURBANCE] {
                start[lane] = (start[lane] + LARGER).min(libm::log(self.noise));
            }
            let next = self.climb(&start, free, most, least);
            let evaluations = best.evaluations + next.evaluations;
            // From elsewhere to the same height: the top, but for the roughness.
            best.converged = (next.whole.value - best.whole.value).abs() < SAME_HEIGHT;
            if !best.converged && next.whole.value > best.whole.value {
                best = next;
            }
            best.evaluations = evaluations;
        }
        best
    }

    /// Climbs from a point, the unknowns `free` moving, in at most `most` steps, until one raises
    /// the log likelihood by less than `least`.
    pub fn climb(&self, from: &[f64; UNKNOWNS], free: &[usize], most: usize, least: f64) -> Top {
        let mut at = *from;
        let faintest = self.faintest();
        let low = |lane: usize| match lane {
            WHITE | DISTURBANCE => faintest,
            MEMORY => MEMORY_RANGE[0],
            _ if lane == RATIO || lane == RATIO + EACH_SIDE => 0.0,
            _ => f64::NEG_INFINITY,
        };
        let high = |lane: usize| match lane {
            MEMORY => MEMORY_RANGE[1],
            _ => f64::INFINITY,
        };
        let (mut blocks, mut whole) = self.evaluate(&at);
        let mut evaluations = 1;
        let mut damping = DAMPING;
        let mut converged = false;
        for _ in 0..most {
            let mut taken = None;
            // What is at its end and would go beyond stays there.
            let pushed = |lane: usize| {
                let score = whole.score.0[lane];
                (at[lane] <= low(lane) && score < 0.0) || (at[lane] >= high(lane) && score > 0.0)
            };
            let free: Vec<usize> = free.iter().copied().filter(|&lane| !pushed(lane)).collect();
            let free = &free[..];
            for _ in 0..MOST_TRIES {
                let Some(step) = step(&whole, free, damping) else {
                    break;
                };
                let mut next = at;
                for (&lane, step) in free.iter().zip(&step) {
                    let unit = if lane == OFFSET {
                        exp(at[COULOMB])
                    } else {
                        1.0
                    };
                    let longest = LONGEST_STEP * unit;
                    let moved = at[lane] + step.clamp(-longest, longest);
                    next[lane] = moved.clamp(low(lane), high(lane));
                }
                let found = self.evaluate(&next);
                evaluations += 1;
                if found.1.value > whole.value {
                    taken = Some((next, found));
                    break;
                }
                damping = (damping * DAMPING_FACTOR).max(DAMPING);
            }
            let Some((next, found)) = taken else {
                // No step leads up: this is the top if none was expected to.
                let left = step(&whole, free, 0.0);
                let expected = left.map(|s| {
                    let parts = free.iter().zip(&s);
                    0.5 * parts.map(|(&i, s)| whole.score.0[i] * s).sum::<f64>()
                });
                converged = expected.is_some_and(|e| e < 0.5);
                break;
            };
            let rise = found.1.value - whole.value;
            at = next;
            (blocks, whole) = found;
            damping = (damping / DAMPING_FACTOR).max(LEAST_DAMPING);
            if rise < least {
                converged = true;
                break;
            }
        }
        Top {
            at,
            blocks,
            whole,
            converged,
            evaluations,
        }
    }
}

/// Rows and columns of the information that belong to some unknowns.
pub(super) fn part(sums: &Sums, free: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(free.len(), free.len(), |i, j| {
        sums.information[free[i]].0[free[j]]
    })
}

/// The damped step of scoring; `None` without one.
fn step(sums: &Sums, free: &[usize], damping: f64) -> Option<DVector<f64>> {
    let information = part(sums, free);
    let scale: Vec<f64> = (0..free.len())
        .map(|i| {
            let size = information[(i, i)].sqrt();
            if size > 0.0 { 1.0 / size } else { 1.0 }
        })
        .collect();
    let scaled = DMatrix::from_fn(free.len(), free.len(), |i, j| {
        let element = information[(i, j)] * scale[i] * scale[j];
        if i == j {
            element + damping + 1e-12
        } else {
            element
        }
    });
    let score = DVector::from_fn(free.len(), |i, _| sums.score.0[free[i]] * scale[i]);
    let solved = scaled.cholesky()?.solve(&score);
    let step = DVector::from_fn(free.len(), |i, _| solved[i] * scale[i]);
    step.iter().all(|x| x.is_finite()).then_some(step)
}
