//! The place between logs from which each pulls on the unknowns, whatever the others weigh.
//!
//! At the optimum of two logs their pulls are opposite, so that their scatter shows nothing where the logs differ in one unknown
//! and weigh it against another differently: with levels a fifth apart, one log slower than the other, the Stribeck velocity
//! moves, and both logs pull it the same way. So they are also seen from a centre that no weighing of one unknown against another
//! has moved: the linear unknowns of each log by itself, the nonlinear ones where all logs agree on them with those, and of each
//! linear unknown the mean over the logs by how well each determines it.

use super::Pulls;
use crate::estimate::uncertainty::inverse;
use crate::separable::linear::dot;
use crate::separable::logs::Logs;
use crate::separable::objective::Evaluation;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// What one log says of the linear unknowns, and then of the others.
struct OneLog {
    /// Inverse of the normal matrix of its linear unknowns.
    inverse: DMatrix<f64>,
    /// Its scores of them.
    scores: DVector<f64>,
    /// Products of their columns with the slopes.
    cross: DMatrix<f64>,
    /// Normal matrix and scores of the nonlinear unknowns where the linear ones follow them.
    normal: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl OneLog {
    fn of(range: &Range<usize>, slopes: &[&[f64]], columns: &[&[f64]], residual: &[f64]) -> Self {
        let product = |a: &[f64], b: &[f64]| dot(&a[range.clone()], &b[range.clone()]);
        let (k, m) = (slopes.len(), columns.len());
        let of = |a: &[&[f64]], b: &[&[f64]]| {
            DMatrix::from_fn(a.len(), b.len(), |i, j| product(a[i], b[j]))
        };
        let inverse = scaled_inverse(&of(columns, columns));
        let scores = DVector::from_fn(m, |i, _| product(columns[i], residual));
        let cross = of(columns, slopes);
        let taken = cross.transpose() * &inverse;
        Self {
            normal: of(slopes, slopes) - &taken * &cross,
            gradient: DVector::from_fn(k, |i, _| product(slopes[i], residual)) - taken * &scores,
            inverse,
            scores,
            cross,
        }
    }
}

/// The inverse of a normal matrix whose unknowns have units of their own.
fn scaled_inverse(normal: &DMatrix<f64>) -> DMatrix<f64> {
    let scale: Vec<f64> = normal
        .diagonal()
        .iter()
        .map(|x| if *x > 0.0 { 1.0 / x.sqrt() } else { 1.0 })
        .collect();
    let n = normal.nrows();
    if n == 0 {
        return DMatrix::zeros(0, 0);
    }
    let unit = DMatrix::from_fn(n, n, |i, j| normal[(i, j)] * scale[i] * scale[j]);
    let (inverse, _) = inverse(unit);
    DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * scale[i] * scale[j])
}

impl Logs {
    /// How each log pulls on the unknowns `(p, c)` away from their centre, where the inverse of `J^T J` is given. The pulls add
    /// up to how far the optimum lies beside it.
    pub(super) fn pulls_from_centre(&self, at: &Evaluation, inverse: &DMatrix<f64>) -> Pulls {
        let centre = self.centre(at);
        let jacobian: Vec<&[f64]> = at
            .slopes
            .iter()
            .chain(at.columns.iter().map(|column| &**column))
            .map(Vec::as_slice)
            .collect();
        let moved = |range: &Range<usize>| {
            let mut residual = at.residual()[range.clone()].to_vec();
            for (column, step) in jacobian.iter().zip(&centre) {
                let own = column[range.clone()].iter();
                residual
                    .iter_mut()
                    .zip(own)
                    .for_each(|(r, x)| *r -= step * x);
            }
            let scores = DVector::from_iterator(
                jacobian.len(),
                jacobian
                    .iter()
                    .map(|column| dot(&column[range.clone()], &residual)),
            );
            (inverse * scores).iter().copied().collect()
        };
        self.ranges().iter().map(moved).collect()
    }

    /// The step of the unknowns `(p, c)` from the optimum of all logs to their centre; zero for coefficients that are held.
    fn centre(&self, at: &Evaluation) -> Vec<f64> {
        let active: Vec<usize> = (0..at.columns.len())
            .filter(|&j| at.solution.active[j])
            .collect();
        let slopes: Vec<&[f64]> = at.slopes.iter().map(Vec::as_slice).collect();
        let columns: Vec<&[f64]> = active.iter().map(|&j| at.columns[j].as_slice()).collect();
        let logs: Vec<OneLog> = self
            .ranges()
            .iter()
            .map(|range| OneLog::of(range, &slopes, &columns, at.residual()))
            .collect();
        let k = slopes.len();
        let normal = logs.iter().map(|log| &log.normal);
        let normal = normal.fold(DMatrix::zeros(k, k), |sum, own| sum + own);
        let gradient = logs.iter().map(|log| &log.gradient);
        let gradient = gradient.fold(DVector::zeros(k), |sum, own| sum + own);
        let step = scaled_inverse(&normal) * gradient;
        let mut out = vec![0.0; k + at.columns.len()];
        out[..k].copy_from_slice(step.as_slice());
        let own: Vec<DVector<f64>> = logs
            .iter()
            .map(|log| &log.inverse * (&log.scores - &log.cross * &step))
            .collect();
        for (i, &j) in active.iter().enumerate() {
            let (mut sum, mut weights) = (0.0, 0.0);
            for (log, own) in logs.iter().zip(&own) {
                let weight = 1.0 / log.inverse[(i, i)];
                if weight.is_finite() && weight > 0.0 {
                    sum += weight * own[i];
                    weights += weight;
                }
            }
            out[k + j] = if weights > 0.0 { sum / weights } else { 0.0 };
        }
        out
    }
}
