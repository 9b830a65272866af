//! What columns explain of strokes that were not fitted.

use crate::conditioning::record::Record;
use crate::scatter::strokes::{PIECES, Strokes};
use crate::separable::linear::dot;
use nalgebra::{DMatrix, DVector};
use std::rc::Rc;

/// Parts of the strokes, each of which is left out in turn.
const FOLDS: usize = 4;
/// Fewest strokes that are left out whole; of fewer, pieces are.
const FEWEST: usize = 2 * FOLDS;
/// Added to the diagonal of the scaled normal matrix: what the motion hardly shows is not fitted again.
const RIDGE: f64 = 1e-6;

/// A linearised fit, and what it leaves on strokes that were left out.
#[derive(Clone)]
pub(super) struct HeldOut {
    residual: Rc<Vec<f64>>,
    /// The piece of a stroke that each kept sample belongs to.
    piece: Rc<Vec<usize>>,
    /// The fold of each piece.
    fold: Vec<usize>,
    /// Fitted columns, each of size 1.
    columns: Vec<Rc<Vec<f64>>>,
    /// Their products, by fold.
    gram: Vec<DMatrix<f64>>,
    /// Products with the residual, by fold.
    pull: Vec<DVector<f64>>,
    /// Squared error of each piece.
    error: Vec<f64>,
}

/// What more columns explain.
pub(super) struct Score {
    /// Coefficients on all strokes.
    pub coefficients: Vec<f64>,
    /// Relative deviation of the first of them, by strokes.
    pub deviation: f64,
    /// Squares that what was not fitted has less, negative where it has more, and the deviation of that by pieces of strokes.
    pub gain: f64,
    pub gain_deviation: f64,
}

impl HeldOut {
    /// Of a fit with these columns; `None` where there are too few samples to leave some out.
    pub fn of(record: &Record, jacobian: &[&[f64]], residual: &[f64]) -> Option<Self> {
        let known = Strokes::of(record);
        if known.of.len() != residual.len() || residual.len() < FOLDS * (jacobian.len() + 2) {
            return None;
        }
        let whole = known.length.len() >= FEWEST;
        let pieces = known.length.len() * PIECES;
        // Every fold has strokes of every kind.
        let mut met = vec![0; known.length.len()];
        let mut of_stroke = vec![0; known.length.len()];
        for (stroke, &kind) in known.kind.iter().enumerate() {
            of_stroke[stroke] = (met[kind] + kind) % FOLDS;
            met[kind] += 1;
        }
        let fold = (0..pieces).map(|piece| match whole {
            true => of_stroke[piece / PIECES],
            false => (piece + piece / PIECES) % FOLDS,
        });
        let both = known.of.iter().zip(&known.piece);
        let piece: Vec<usize> = both
            .map(|(stroke, piece)| stroke * PIECES + piece)
            .collect();
        let empty = Self {
            residual: Rc::new(residual.to_vec()),
            piece: Rc::new(piece),
            fold: fold.collect(),
            columns: Vec::new(),
            gram: vec![DMatrix::zeros(0, 0); FOLDS],
            pull: vec![DVector::zeros(0); FOLDS],
            error: Vec::new(),
        };
        let columns: Vec<Vec<f64>> = jacobian.iter().map(|x| x.to_vec()).collect();
        Some(empty.with(&columns))
    }

    /// The same with more columns fitted.
    pub fn with(&self, columns: &[Vec<f64>]) -> Self {
        let mut more = self.clone();
        more.columns.extend(columns.iter().map(|column| {
            let norm = dot(column, column).sqrt();
            let scale = if norm > 0.0 && norm.is_finite() {
                1.0 / norm
            } else {
                0.0
            };
            Rc::new(column.iter().map(|x| x * scale).collect())
        }));
        let (old, all) = (self.columns.len(), more.columns.len());
        for (gram, pull) in more.gram.iter_mut().zip(&mut more.pull) {
            *gram = std::mem::take(gram).resize(all, all, 0.0);
            *pull = std::mem::take(pull).resize_vertically(all, 0.0);
        }
        for j in old..all {
            for i in 0..=j {
                let products = self.by_fold(&more.columns[i], &more.columns[j]);
                for (gram, x) in more.gram.iter_mut().zip(products) {
                    (gram[(i, j)], gram[(j, i)]) = (x, x);
                }
            }
            let pulls = self.by_fold(&more.columns[j], &self.residual);
            (more.pull.iter_mut().zip(pulls)).for_each(|(pull, x)| pull[j] = x);
        }
        more.error = more.errors();
        more
    }

    /// Sums of the products of two columns over the strokes of each fold.
    fn by_fold(&self, a: &[f64], b: &[f64]) -> [f64; FOLDS] {
        let mut out = [0.0; FOLDS];
        for ((a, b), piece) in a.iter().zip(b).zip(self.piece.iter()) {
            out[self.fold[*piece]] += a * b;
        }
        out
    }

    /// The coefficients of the scaled columns without one of the folds.
    fn solved(&self, without: Option<usize>) -> DVector<f64> {
        let all = self.columns.len();
        let mut gram = DMatrix::identity(all, all) * RIDGE;
        let mut pull = DVector::zeros(all);
        for fold in (0..FOLDS).filter(|fold| Some(*fold) != without) {
            gram += &self.gram[fold];
            pull += &self.pull[fold];
        }
        match gram.cholesky() {
            Some(factor) => factor.solve(&pull),
            None => DVector::zeros(all),
        }
    }

    /// Squared error of each piece with a fit to those of the other folds.
    fn errors(&self) -> Vec<f64> {
        let solved: Vec<DVector<f64>> = (0..FOLDS).map(|fold| self.solved(Some(fold))).collect();
        let mut left = self.residual.to_vec();
        for (j, column) in self.columns.iter().enumerate() {
            for ((r, x), piece) in left.iter_mut().zip(column.iter()).zip(self.piece.iter()) {
                *r -= solved[self.fold[*piece]][j] * x;
            }
        }
        let mut out = vec![0.0; self.fold.len()];
        (left.iter().zip(self.piece.iter())).for_each(|(r, piece)| out[*piece] += r * r);
        out
    }

    /// Squared error of all strokes.
    pub fn left(&self) -> f64 {
        self.error.iter().sum()
    }

    /// What more columns explain.
    pub fn score(&self, columns: &[Vec<f64>]) -> Score {
        let more = self.with(columns);
        let gains = self.error.iter().zip(&more.error).map(|(a, b)| a - b);
        let gains: Vec<f64> = gains.collect();
        let used = self.error.iter().filter(|e| **e > 0.0).count() as f64;
        let gain: f64 = gains.iter().sum();
        let mean = gain / used;
        let squares: f64 = gains.iter().map(|g| (g - mean).powi(2)).sum();
        let first = self.columns.len();
        let solved = more.solved(None);
        // By leaving out folds: Efron and Tibshirani 1993, ISBN 0-412-04231-2, chapter 11.
        let parts: Vec<f64> = (0..FOLDS)
            .map(|fold| more.solved(Some(fold))[first])
            .collect();
        let middle = parts.iter().sum::<f64>() / FOLDS as f64;
        let spread: f64 = parts.iter().map(|x| (x - middle).powi(2)).sum();
        let factor = (FOLDS - 1) as f64 / FOLDS as f64;
        let coefficients = columns.iter().enumerate();
        Score {
            coefficients: coefficients
                .map(|(j, column)| solved[first + j] / dot(column, column).sqrt())
                .collect(),
            deviation: ((factor * spread).sqrt() / solved[first]).abs(),
            gain,
            gain_deviation: squares.sqrt(),
        }
    }

    /// Standard deviation of the coefficient of a column that all others leave, by strokes.
    pub fn deviation(&self, outside: &[f64], residual: &[f64]) -> f64 {
        let mut pulls = vec![0.0; self.fold.len()];
        for ((x, r), piece) in outside.iter().zip(residual).zip(self.piece.iter()) {
            pulls[*piece] += x * r;
        }
        pulls.iter().map(|x| x * x).sum::<f64>().sqrt() / dot(outside, outside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditioning::record::tests::of_velocities;

    /// A wave that a residual has is found with its factor on strokes that were left out; one that it has not makes them worse.
    #[test]
    fn what_a_residual_has_is_explained_where_it_was_not_fitted() {
        let velocity: Vec<f64> = (0..4000)
            .map(|i| if i / 200 % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let record = of_velocities(1e-3, &[&velocity]);
        let wave = |rate: f64| {
            (0..4000)
                .map(|i| libm::sin(rate * f64::from(i)))
                .collect::<Vec<f64>>()
        };
        let noise: Vec<f64> = (0..4000).map(|i| libm::sin(f64::from(i * i))).collect();
        let (own, other) = (wave(0.013), wave(0.031));
        let residual: Vec<f64> = own.iter().zip(&noise).map(|(x, e)| 2.0 * x + e).collect();
        let ones = vec![1.0; 4000];
        let held_out = HeldOut::of(&record, &[&ones], &residual).unwrap();
        let all = held_out.left();
        let found = held_out.score(std::slice::from_ref(&own));
        assert!(
            (found.coefficients[0] - 2.0).abs() < 0.05,
            "{:?}",
            found.coefficients
        );
        assert!(
            (found.gain / all - 0.8).abs() < 0.03,
            "{}",
            found.gain / all
        );
        assert!(found.deviation < 0.02 && found.gain > 5.0 * found.gain_deviation);
        let beside = held_out.with(&[own]);
        assert!(beside.score(&[other]).gain < 1e-3 * all);
        assert!((beside.left() / all - 0.2).abs() < 0.03);
    }
}
