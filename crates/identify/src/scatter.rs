//! Scatter of what a fit states: from one run of a test to the next, and from one motion to another.
//!
//! A stroke pulls at the parameters by the sum of its scores `J_i r_i`. The mean pull of the strokes of a kind is misfit that comes
//! back: the next run has it too. What strokes of a kind pull differently is what scatters, whatever its colour. So the covariance
//! of an immediate repeat is the sandwich `A^-1 M A^-1` with the pulls as clusters, stratified by kind (Abadie, Imbens, Zheng 2014,
//! doi 10.1080/01621459.2014.928218).

pub(crate) mod strokes;

use crate::estimate::uncertainty::inverse;
use crate::student;
use nalgebra::{DMatrix, DVector};
use strokes::{PIECES, Strokes};

/// What friction changes between two runs of a test, in parts of itself: its level, half of the difference of the directions, and
/// its tilt over the speed. A prior: repeats on five machines (two stages, two servo axes, a robot joint) scatter by 1.3 to 3 %.
const WANDER: [f64; 3] = [0.02, 0.015, 0.015];
/// Ends of the ratio of whole strokes to their pieces that is believed where strokes are few.
const SIZE: (f64, f64) = (0.5, 6.0);
/// Added to the diagonal of the scaled covariance of pieces before it is inverted: what they say of no direction is no ratio.
const RIDGE: f64 = 0.05;
/// Weight of one half of the motion over that of the other.
const REWEIGHTED: f64 = 0.25;

/// Covariance of the parameters of a fit, by what they are asked for.
#[derive(Clone, Debug)]
pub(crate) struct Scatter {
    /// Of the same test again, now.
    at_once: DMatrix<f64>,
    /// Its degrees of freedom.
    freedom: f64,
    /// What friction that is another one in the next run adds.
    wander: DMatrix<f64>,
    /// Changes of the parameters where one half of the motion counts for more, in pairs.
    moved: Vec<DVector<f64>>,
}

/// Half widths of a 95 % interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HalfWidths {
    /// The same test again, now.
    pub at_once: f64,
    /// The same test on another day.
    pub repeat: f64,
    /// Another motion of the same kind.
    pub transfer: f64,
}

/// A fit, as its scatter sees it.
pub(crate) struct Fitted<'a> {
    /// Derivatives of the model by each parameter at the kept samples.
    pub jacobian: Vec<&'a [f64]>,
    pub residual: &'a [f64],
    /// Force of friction, without a constant part.
    pub friction: &'a [f64],
    /// Inverse of the variance that each parameter has before the log.
    pub prior: Vec<f64>,
}

impl Scatter {
    /// Of a fit with these strokes; `None` where there are no more samples than parameters.
    pub fn of(fit: &Fitted, strokes: &Strokes) -> Option<Self> {
        let (p, n) = (fit.jacobian.len(), fit.residual.len());
        if p == 0 || n <= p {
            return None;
        }
        // Columns of any unit to about one size.
        let scale: Vec<f64> = fit
            .jacobian
            .iter()
            .map(|column| 1.0 / size(column))
            .collect();
        let pulls = Pulls::of(fit, &scale, strokes);
        let variance = pulls.variance(&gram(fit, &scale, None), fit.residual);
        let prior = DVector::from_fn(p, |i, _| variance * fit.prior[i] * scale[i] * scale[i]);
        let bread = |weight: Option<&[f64]>| {
            let information = gram(fit, &scale, weight) + DMatrix::from_diagonal(&prior);
            inverse(information).0
        };
        let own = bread(None);
        let (meat, freedom) = pulls.meat(strokes);
        let back = DMatrix::from_fn(p, p, |i, j| scale[i] * scale[j]);
        let at_once = (&own * meat * &own).component_mul(&back);
        let sources = wander(fit.friction, strokes);
        let reached = sources.map(|source| &own * products(fit, &scale, &source));
        let wander: DMatrix<f64> = reached.iter().map(|w| w * w.transpose()).sum();
        let mut moved = Vec::new();
        for half in &strokes.halves {
            for side in [true, false] {
                let weight = |half: &bool| if *half == side { 1.0 } else { REWEIGHTED };
                let weight: Vec<f64> = half.iter().map(weight).collect();
                let weighted: Vec<f64> = weight
                    .iter()
                    .zip(fit.residual)
                    .map(|(w, r)| w * r)
                    .collect();
                let step = bread(Some(&weight)) * products(fit, &scale, &weighted);
                moved.push(DVector::from_fn(p, |i, _| step[i] * scale[i]));
            }
        }
        Some(Self {
            at_once,
            freedom,
            wander: wander.component_mul(&back),
            moved,
        })
    }

    /// Of a linear function of the parameters, by its derivatives.
    pub fn half_widths(&self, gradient: &DVector<f64>) -> HalfWidths {
        let along = |matrix: &DMatrix<f64>| (gradient.transpose() * matrix * gradient)[0].max(0.0);
        let at_once = along(&self.at_once).max(f64::MIN_POSITIVE);
        let repeat = at_once + along(&self.wander);
        let moved = self.moved.iter().map(|change| change.dot(gradient).powi(2));
        let transfer = repeat + 0.5 * moved.sum::<f64>();
        // What wanders has a variance that is given.
        let part = repeat / at_once;
        let quantile = student::quantile(self.freedom * part * part);
        HalfWidths {
            at_once: student::quantile(self.freedom) * at_once.sqrt(),
            repeat: quantile * repeat.sqrt(),
            transfer: quantile * transfer.sqrt(),
        }
    }
}

/// Root of the sum of squares, or 1 where that is 0.
fn size(column: &[f64]) -> f64 {
    let square = column.iter().map(|x| x * x).sum::<f64>();
    if square > 0.0 { square.sqrt() } else { 1.0 }
}

/// `J' W J` of the scaled columns.
fn gram(fit: &Fitted, scale: &[f64], weight: Option<&[f64]>) -> DMatrix<f64> {
    let p = scale.len();
    let mut out = DMatrix::zeros(p, p);
    for i in 0..p {
        let weighted: Vec<f64> = match weight {
            Some(weight) => fit.jacobian[i]
                .iter()
                .zip(weight)
                .map(|(x, w)| x * w)
                .collect(),
            None => fit.jacobian[i].to_vec(),
        };
        for j in 0..=i {
            let sum: f64 = weighted
                .iter()
                .zip(fit.jacobian[j])
                .map(|(x, y)| x * y)
                .sum();
            out[(i, j)] = sum * scale[i] * scale[j];
            out[(j, i)] = out[(i, j)];
        }
    }
    out
}

/// `J' y` of the scaled columns.
fn products(fit: &Fitted, scale: &[f64], y: &[f64]) -> DVector<f64> {
    let each = fit.jacobian.iter().zip(scale);
    let sums = each.map(|(column, s)| s * column.iter().zip(y).map(|(x, y)| x * y).sum::<f64>());
    DVector::from_iterator(scale.len(), sums)
}

/// Forces by which friction differs in the next run: level, directions, tilt.
fn wander(friction: &[f64], strokes: &Strokes) -> [Vec<f64>; 3] {
    let [level, side, tilt] = WANDER;
    let factor = |k: usize, i: usize| match k {
        0 => level,
        1 => side * strokes.sense[i],
        _ => tilt * (2.0 * (strokes.speed[i] / strokes.top).min(1.0) - 1.0),
    };
    [0, 1, 2].map(|k| {
        friction
            .iter()
            .enumerate()
            .map(|(i, f)| factor(k, i) * f)
            .collect()
    })
}

/// Sums of the scores of each piece of each stroke.
struct Pulls {
    /// By stroke, then piece.
    pieces: Vec<DVector<f64>>,
}

impl Pulls {
    fn of(fit: &Fitted, scale: &[f64], strokes: &Strokes) -> Self {
        let p = scale.len();
        let mut pieces = vec![DVector::zeros(p); strokes.length.len() * PIECES];
        for (j, (column, scale)) in fit.jacobian.iter().zip(scale).enumerate() {
            for (i, (x, r)) in column.iter().zip(fit.residual).enumerate() {
                pieces[strokes.of[i] * PIECES + strokes.piece[i]][j] += x * r * scale;
            }
        }
        Self { pieces }
    }

    /// What the square of a residual counts as against a prior: its mean, and by how much more the pulls scatter than those of
    /// independent residuals (Ribatet, Cooley, Davison 2012, Statistica Sinica 22, 813).
    fn variance(&self, gram: &DMatrix<f64>, residual: &[f64]) -> f64 {
        let square = residual.iter().map(|r| r * r).sum::<f64>() / residual.len() as f64;
        let p = gram.nrows();
        let inverse = inverse(gram + DMatrix::identity(p, p) * 1e-6).0;
        let sum: f64 = self
            .pieces
            .iter()
            .map(|g| (g.transpose() * &inverse * g)[0])
            .sum();
        square.max(sum / p as f64)
    }

    /// Covariance of the sum of all pulls, and its degrees of freedom. Few strokes say little of its shape: then it goes half-way
    /// to the shape that the pieces have, in the size of whole strokes.
    fn meat(&self, strokes: &Strokes) -> (DMatrix<f64>, f64) {
        let p = self.pieces.first().map_or(0, DVector::nrows);
        let whole: Vec<DVector<f64>> = self
            .pieces
            .chunks(PIECES)
            .map(|all| all.iter().sum())
            .collect();
        let (between, free) = strata(&whole, &strokes.kind);
        let mut within = DMatrix::zeros(p, p);
        let mut more = 0.0;
        for piece in 0..PIECES {
            let one: Vec<DVector<f64>> = self
                .pieces
                .iter()
                .skip(piece)
                .step_by(PIECES)
                .cloned()
                .collect();
            let (own, free) = strata(&one, &strokes.kind);
            within += own;
            more += free;
        }
        let norm = DVector::from_fn(p, |i, _| within[(i, i)].max(f64::MIN_POSITIVE).sqrt());
        let scaled =
            |m: &DMatrix<f64>| DMatrix::from_fn(p, p, |i, j| m[(i, j)] / (norm[i] * norm[j]));
        let ridge = scaled(&within) + DMatrix::identity(p, p) * RIDGE;
        let ratio = (inverse(ridge).0 * scaled(&between)).trace() / p as f64;
        let (least, most) = SIZE;
        let part = 0.5 * p as f64 / (p as f64 + free);
        let meat = between * (1.0 - part) + within * (part * ratio.clamp(least, most));
        (meat, (free + part * more.min(free * p as f64)).max(1.0))
    }
}

/// Covariance of the sum of some pulls by what those of one kind differ, and its degrees of freedom.
fn strata(pulls: &[DVector<f64>], kind: &[usize]) -> (DMatrix<f64>, f64) {
    let p = pulls.first().map_or(0, DVector::nrows);
    let mut out = DMatrix::zeros(p, p);
    let mut freedom = 0.0;
    let mut kinds = kind.to_vec();
    kinds.sort_unstable();
    kinds.dedup();
    for own in kinds {
        let all: Vec<&DVector<f64>> = (kind.iter().zip(pulls))
            .filter(|(kind, _)| **kind == own)
            .map(|(_, g)| g)
            .collect();
        let n = all.len() as f64;
        // A stroke that is like no other counts whole.
        let (mean, factor) = match all.len() {
            1 => (DVector::zeros(p), 1.0),
            _ => (all.iter().copied().sum::<DVector<f64>>() / n, n / (n - 1.0)),
        };
        freedom += n - 1.0;
        for g in all {
            let own = g - &mean;
            out += &own * own.transpose() * factor;
        }
    }
    (out, freedom)
}
