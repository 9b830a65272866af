//! What encoder steps, filters and derivatives do to an estimate.
//!
//! The law is driven by a velocity that came from a rounded position through a low-pass. Its error
//! stands in the regressors, so it shifts the parameters, and more samples do not help. A rehearsal
//! shows by how much: a smoothed motion is taken for the true one, the fitted law gives its force, the
//! encoder and the filters of the log read it, and the law is fitted to that. What comes out beside the
//! parameters that went in is the shift (a parametric bootstrap of the bias, Efron and Tibshirani 1993,
//! chapter 10).

use crate::conditioning::record::Record;
use crate::estimate::uncertainty::Unknowns;
use crate::law::Law;
use crate::law::physical::{Physical, physical, propagate};
use crate::law::terms::Terms;
use crate::observe::{Counts, Silent, Stage};
use crate::separable::Optimum;
use crate::separable::levenberg::{Watch, descend};
use crate::separable::objective::Objective;

/// Readings of the record, with counts that lie differently.
const READINGS: usize = 4;
/// Steps of each descent: the start is the optimum, and the shift is small.
const STEPS: usize = 2;
/// Shift of the first reading, in standard deviations, below which the others are not made.
const NOTHING: f64 = 0.1;

/// Shift of each parameter, SI, and its variance from one reading to the next.
#[derive(Clone, Debug)]
pub(super) struct Shift {
    pub bias: Vec<f64>,
    pub variance: Vec<f64>,
}

impl Shift {
    /// Variance of a parameter from which the shift was taken off: that of the residual or that of
    /// the readings, whichever is larger (the residual sees the readings too), and that of the mean
    /// shift.
    pub fn total(&self, i: usize, residual: f64) -> f64 {
        residual.max(self.variance[i]) + self.variance[i] / READINGS as f64
    }
}

/// Estimates what the conditioning added to the parameters `raw`; `None` where the motion does not
/// come from a position with a known resolution, or where it does not matter.
pub(super) fn shift(
    record: &Record,
    law: Law,
    terms: &Terms,
    optimum: &Optimum,
    raw: &[Physical],
    unknowns: &Unknowns,
    counts: &mut Counts,
) -> Option<Shift> {
    let mut rehearsed = record.smoothed()?;
    let c = &optimum.evaluation.solution.coefficients;
    let force = Objective::new(&rehearsed, law, terms).model(&optimum.p, c);
    counts.cost += 1;
    rehearsed.set_force(&force);
    let variance = propagate(raw, &unknowns.covariance);
    let mut shifts: Vec<Vec<f64>> = Vec::with_capacity(READINGS);
    for reading in 0..READINGS {
        let phase = (reading as f64 + 0.5) / READINGS as f64;
        let again = rehearsed.read_again(phase)?;
        let objective = Objective::new(&again, law, terms);
        let mut watch = Watch {
            observer: &mut Silent,
            stage: Stage::Fine,
            fraction: 1.0,
            counts: *counts,
            best: f64::INFINITY,
            stopped: false,
        };
        let found = descend(&objective, &optimum.bounds, &optimum.p, STEPS, &mut watch);
        *counts = watch.counts;
        let coefficients = &found.evaluation.solution.coefficients;
        let there = physical(&law, objective.linear(), &found.p, coefficients);
        let moved: Vec<f64> = raw.iter().zip(&there).map(|(a, b)| step(a, b)).collect();
        let nothing = moved
            .iter()
            .enumerate()
            .all(|(i, d)| d.abs() <= NOTHING * variance[(i, i)].max(0.0).sqrt());
        if reading == 0 && nothing {
            return None;
        }
        shifts.push(moved);
    }
    let n = READINGS as f64;
    let bias: Vec<f64> = (0..raw.len())
        .map(|i| shifts.iter().map(|s| s[i]).sum::<f64>() / n)
        .collect();
    let variance = (0..raw.len())
        .map(|i| {
            let spread: f64 = shifts.iter().map(|s| (s[i] - bias[i]).powi(2)).sum();
            spread / (n - 1.0)
        })
        .collect();
    Some(Shift { bias, variance })
}

/// From one value to another, in the logarithm where both are positive by nature.
fn step(from: &Physical, to: &Physical) -> f64 {
    if from.positive && from.value > 0.0 && to.value > 0.0 {
        from.value * libm::log(to.value / from.value)
    } else {
        to.value - from.value
    }
}
