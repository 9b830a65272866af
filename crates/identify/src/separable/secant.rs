//! What the Gauss-Newton matrix leaves out of the curvature of a cost, learnt from the gradients along a descent.
//!
//! `J^T J` is the curvature where the residual is noise. Where a law leaves motion unexplained, the residual has a part
//! that changes with the unknowns, and `J^T J` can be too small by a factor of fifty in one of them: a bristle that is
//! too stiff for its record, say. Steps are then far too long in that one, and damping makes them too short in all
//! others. The difference of two gradients shows the true curvature along the step between them (a structured secant
//! update: Dennis, Gay and Welsch 1981, doi 10.1145/355958.355965).

use nalgebra::{DMatrix, DVector};
use stiction_search::Derivatives;
use stiction_search::descent::predicted_gain;

/// Difference of a gain from that which the Gauss-Newton matrix predicted, relative to the latter, up to which nothing needs
/// to be learnt.
const GOOD_PREDICTION: f64 = 0.25;
/// Least curvature of the corrected matrix, relative to the Gauss-Newton one of the same unknown.
const LEAST_CURVATURE: f64 = 1e-3;
/// Parts of the correction that are tried, the largest first, until the matrix is positive definite.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];

/// The part of half the second derivative of the cost that `J^T J` lacks; nothing at first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Secant {
    rest: Option<DMatrix<f64>>,
    /// Whether it predicted the last trial better than the Gauss-Newton matrix alone.
    counts: bool,
}

impl Secant {
    /// Judges by the gain of a trial whether what was learnt before is of use.
    pub fn judge(&mut self, at: &Derivatives, step: &[f64], gained: f64) {
        let off = |model: &Derivatives| (gained - predicted_gain(model, step)).abs();
        let plain = off(at);
        let good = plain <= GOOD_PREDICTION * predicted_gain(at, step).abs();
        self.counts = !good && off(&self.full(at, 1.0)) < plain;
    }

    /// Learns from a step and the change of the gradient along it, `normal` being `J^T J` where the descent stands.
    pub fn learn(&mut self, step: &[f64], change: &[f64], normal: &[f64]) {
        let n = step.len();
        let (s, y) = (
            DVector::from_row_slice(step),
            DVector::from_row_slice(change),
        );
        let explained = DMatrix::from_row_slice(n, n, normal) * &s;
        let along = s.dot(&y);
        // Along a step on which the slope falls no curvature can be learnt.
        if !(along > LEAST_CURVATURE * s.dot(&explained) && along.is_finite()) {
            return;
        }
        let left = &y - explained;
        let old = self.rest.take().unwrap_or_else(|| DMatrix::zeros(n, n));
        // What was learnt far from here counts only as far as this step shows it too.
        let known = s.dot(&(&old * &s)).abs();
        let part = if known > 0.0 {
            (s.dot(&left).abs() / known).min(1.0)
        } else {
            1.0
        };
        let old = old * part;
        let gap = left - &old * &s;
        let cross = &gap * y.transpose();
        let twice = s.dot(&gap) / (along * along);
        let new = old + (&cross + cross.transpose()) / along - (&y * y.transpose()) * twice;
        self.rest = new.iter().all(|x| x.is_finite()).then_some(new);
    }

    /// Of a cost that is the sum over a share of the samples.
    pub fn times(&self, share: f64) -> Self {
        Self {
            rest: self.rest.as_ref().map(|rest| rest * share),
            ..*self
        }
    }

    /// The sums with `share` of it added to their curvature where it is of use.
    pub fn corrected(&self, at: &Derivatives, share: f64) -> Derivatives {
        match self.counts {
            true => self.full(at, share),
            false => at.clone(),
        }
    }

    /// The sums with it added as far as that stays positive definite.
    fn full(&self, at: &Derivatives, share: f64) -> Derivatives {
        let mut out = at.clone();
        let n = at.gradient.len();
        let Some(rest) = self.rest.as_ref().filter(|rest| rest.nrows() == n) else {
            return out;
        };
        let normal = DMatrix::from_row_slice(n, n, &at.normal);
        let least = DMatrix::from_diagonal(&(normal.diagonal() * LEAST_CURVATURE));
        let corrected = PARTS.map(|part| &normal + rest * (part * share));
        let positive = |m: &&DMatrix<f64>| (*m - &least).cholesky().is_some();
        if let Some(found) = corrected.iter().find(positive) {
            // Symmetric, so columns are rows.
            out.normal.copy_from_slice(found.as_slice());
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Along the steps that it has seen, the corrected matrix is the curvature of the cost.
    #[test]
    fn the_curvature_of_a_parabola_is_learnt() {
        let curvature = DMatrix::from_row_slice(2, 2, &[50.0, 3.0, 3.0, 2.0]);
        let at = Derivatives {
            cost: 1.0,
            gradient: vec![1.0, 1.0],
            normal: vec![1.0, 0.5, 0.5, 2.0],
        };
        let mut secant = Secant::default();
        assert_eq!(secant.full(&at, 1.0), at);
        for step in [[1.0, 0.0], [0.2, 1.0], [1.0, -0.3]] {
            let change = &curvature * DVector::from_row_slice(&step);
            secant.learn(&step, change.as_slice(), &at.normal);
            let found = DMatrix::from_row_slice(2, 2, &secant.full(&at, 1.0).normal);
            let along = found * DVector::from_row_slice(&step);
            assert!((along - change).amax() < 1e-9);
        }
        let found = secant.full(&at, 1.0).normal;
        assert!((found[0] - 50.0).abs() < 5.0, "{found:?}");
    }

    /// A cost that curves down along a step teaches nothing, and what is learnt never makes the matrix indefinite.
    #[test]
    fn the_matrix_stays_positive_definite() {
        let at = Derivatives {
            cost: 1.0,
            gradient: vec![1.0, 1.0],
            normal: vec![4.0, 1.0, 1.0, 2.0],
        };
        let mut secant = Secant::default();
        secant.learn(&[1.0, 0.0], &[-3.0, 0.0], &at.normal);
        assert_eq!(secant.full(&at, 1.0), at);
        secant.learn(&[1.0, 0.0], &[0.1, -2.0], &at.normal);
        let found = secant.full(&at, 1.0).normal;
        assert!(
            found[0] > 0.0 && found[0] * found[3] - found[1] * found[2] > 0.0,
            "{found:?}"
        );
    }

    /// What was learnt is left aside as long as the Gauss-Newton matrix alone predicts what comes.
    #[test]
    fn a_good_prediction_is_left_as_it_is() {
        let at = Derivatives {
            cost: 1.0,
            gradient: vec![-0.5],
            normal: vec![1.0],
        };
        let mut secant = Secant::default();
        secant.learn(&[0.1], &[5.0], &at.normal);
        // A gain of 2 g s - s^2 = 0.09 is predicted.
        secant.judge(&at, &[0.1], 0.08);
        assert_eq!(secant.corrected(&at, 1.0), at);
        secant.judge(&at, &[0.1], -0.4);
        assert!(secant.corrected(&at, 1.0).normal[0] > 40.0);
    }
}
