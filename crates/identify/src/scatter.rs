//! Scatter of what a fit states: from one run of a test to the next, and from one motion to another.
//!
//! A stroke pulls at the parameters by the sum of its scores `J_i r_i`. The mean pull of the strokes of a kind is misfit that comes
//! back: the next run has it too. What strokes of a kind pull differently is what scatters, whatever its colour. So the covariance
//! of an immediate repeat is the sandwich `A^-1 M A^-1` with the pulls as clusters, stratified by kind (Abadie, Imbens, Zheng 2014,
//! doi 10.1080/01621459.2014.928218).

pub(crate) mod strokes;

use crate::estimate::uncertainty::{inverse, inverse_in_parts};
use crate::parameter::physical::Physical;
use crate::separable::linear::dot;
use crate::student;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;
use strokes::{PIECES, Strokes};

/// What friction changes between two runs of a test, in parts of itself: its level, half of the difference of the directions, and
/// its tilt over the speed. A prior: repeats on five machines (two stages, two servo axes, a robot joint) scatter by 1.3 to 3 %.
const WANDER: [f64; 3] = [0.02, 0.015, 0.015];
/// Logs of one machine that what is known of any machine counts as.
const MACHINES: f64 = 4.0;
/// Ends of the ratio of whole strokes to their pieces that is believed where strokes are few.
const SIZE: (f64, f64) = (0.5, 6.0);
/// Added to the diagonal of the scaled covariance of pieces before it is inverted: what they say of no direction is no ratio.
const RIDGE: f64 = 0.05;
/// A column smaller than this part of its prior is scaled by the prior. It keeps the ratio of scaled information below 1e8, so that an
/// inverse in double precision does not lose the other directions.
const MIN_RELATIVE_SIZE: f64 = 1e-4;
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
    /// Changes of the parameters where one half of the motion counts for more, in pairs; empty until they are asked for.
    moved: Vec<DVector<f64>>,
    /// Inverse of the information: the covariance for independent residuals of variance 1.
    pub bread: DMatrix<f64>,
    /// The same without what is known before the log.
    alone: DMatrix<f64>,
    /// Square of the residual that counts as an independent sample, in the square of the unit of the force.
    pub variance: f64,
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

/// Variances of a parameter, by what it is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Variances {
    /// Of the same test again, now.
    pub at_once: f64,
    /// Of the same test on another day.
    pub repeat: f64,
    /// Of another motion of the same kind.
    pub transfer: f64,
    /// Degrees of freedom of the first.
    pub freedom: f64,
}

/// A fit, as its scatter sees it.
pub(crate) struct Fitted<'a> {
    /// Derivatives of the model by each parameter at the kept samples.
    pub jacobian: Vec<&'a [f64]>,
    pub residual: &'a [f64],
    /// Force of friction, without a constant part.
    pub friction: &'a [f64],
    /// The samples of each log; empty for a single one.
    pub logs: &'a [Range<usize>],
    /// Inverse of the variance that each parameter has before the log.
    pub prior: Vec<f64>,
}

impl Scatter {
    /// Of a fit with these strokes; `None` where there are no more samples than parameters.
    pub fn from_strokes(fit: &Fitted, strokes: &Strokes) -> Option<Self> {
        let (p, n) = (fit.jacobian.len(), fit.residual.len());
        if p == 0 || n <= p {
            return None;
        }
        let scale = scales(fit);
        let pulls = Pulls::of(fit, &scale, strokes);
        let all = gram(fit, &scale, None);
        let variance = pulls.variance(&all, fit.residual);
        let known = prior(fit, &scale, variance);
        let (own, lost) = inverse_in_parts(&all + known);
        let alone = inverse(all).0;
        let (meat, freedom) = pulls.meat(strokes);
        let back = DMatrix::from_fn(p, p, |i, j| scale[i] * scale[j]);
        // No residual has a component in a direction lost to rounding, so the pulls give no variance for it.
        let at_once = (&own * meat * &own + &lost * variance).component_mul(&back);
        let sources = wander(fit, strokes);
        let reached = sources.map(|source| &own * products(fit, &scale, &source));
        let wander: DMatrix<f64> = reached.iter().map(|w| w * w.transpose()).sum();
        Some(Self {
            at_once,
            freedom,
            wander: wander.component_mul(&back),
            moved: Vec::new(),
            bread: (own + lost).component_mul(&back),
            alone: alone.component_mul(&back),
            variance,
        })
    }

    /// The same with what another motion changes.
    pub fn with_transfer(mut self, fit: &Fitted, strokes: &Strokes) -> Self {
        let scale = scales(fit);
        let all = gram(fit, &scale, None);
        let pull = products(fit, &scale, fit.residual);
        let variance = Pulls::of(fit, &scale, strokes).variance(&all, fit.residual);
        let prior = prior(fit, &scale, variance);
        for half in &strokes.halves {
            let inside: Vec<f64> = (half.iter().zip(fit.residual))
                .map(|(half, r)| if *half { *r } else { 0.0 })
                .collect();
            let inside = (
                gram(fit, &scale, Some(half)),
                products(fit, &scale, &inside),
            );
            let outside = (&all - &inside.0, &pull - &inside.1);
            for (own, other) in [(&inside, &outside), (&outside, &inside)] {
                let information = &own.0 + &other.0 * REWEIGHTED + &prior;
                let step = inverse(information).0 * (&own.1 + &other.1 * REWEIGHTED);
                self.moved
                    .push(DVector::from_fn(step.len(), |i, _| step[i] * scale[i]));
            }
        }
        self
    }

    /// The variances of a linear function of the parameters, by its derivatives.
    pub fn variances(&self, gradient: &DVector<f64>) -> Variances {
        let along = |matrix: &DMatrix<f64>| (gradient.transpose() * matrix * gradient)[0].max(0.0);
        let at_once = along(&self.at_once);
        let repeat = at_once + along(&self.wander);
        let moved = self.moved.iter().map(|change| change.dot(gradient).powi(2));
        Variances {
            at_once,
            repeat,
            transfer: repeat + 0.5 * moved.sum::<f64>(),
            freedom: self.freedom,
        }
    }

    /// Correlation of two linear functions of the parameters from day to day; 0 where one of them does not scatter.
    pub fn correlation(&self, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
        let repeat = self.repeat();
        let along = |x: &DVector<f64>, y: &DVector<f64>| (x.transpose() * &repeat * y)[0];
        let size = along(a, a).sqrt() * along(b, b).sqrt();
        let found = along(a, b) / size;
        if found.is_finite() {
            found.clamp(-1.0, 1.0)
        } else {
            0.0
        }
    }

    /// The variances of a parameter of a law.
    pub fn of(&self, parameter: &Physical) -> Variances {
        // Where less was evaluated, nothing is stated of the rest.
        let known = parameter.slope.len().min(self.at_once.nrows());
        let mut gradient = DVector::zeros(self.at_once.nrows());
        gradient
            .rows_mut(0, known)
            .copy_from_slice(&parameter.slope[..known]);
        self.variances(&gradient)
    }

    /// Variance of a parameter from the log alone.
    pub fn alone(&self, parameter: &Physical) -> f64 {
        self.variance * parameter.variance(&self.alone)
    }

    /// The same beside what is known before it.
    pub fn beside_prior(&self, parameter: &Physical) -> f64 {
        self.variance * parameter.variance(&self.bread)
    }

    /// Covariance of the same test again, now.
    pub fn at_once(&self) -> &DMatrix<f64> {
        &self.at_once
    }

    /// Covariance of the same test on another day.
    pub fn repeat(&self) -> DMatrix<f64> {
        &self.at_once + &self.wander
    }

    /// The same among `all` parameters, of which these are at the places `index`; nothing is known of the others.
    pub fn among(&self, index: &[usize], all: usize) -> Self {
        let spread = |small: &DMatrix<f64>| {
            let mut out = DMatrix::zeros(all, all);
            for (a, &i) in index.iter().enumerate() {
                for (b, &j) in index.iter().enumerate() {
                    out[(i, j)] = small[(a, b)];
                }
            }
            out
        };
        let each = |small: &DVector<f64>| {
            let mut out = DVector::zeros(all);
            (index.iter().zip(small.iter())).for_each(|(i, x)| out[*i] = *x);
            out
        };
        Self {
            at_once: spread(&self.at_once),
            freedom: self.freedom,
            wander: spread(&self.wander),
            moved: self.moved.iter().map(each).collect(),
            bread: spread(&self.bread),
            alone: spread(&self.alone),
            variance: self.variance,
        }
    }

    /// Where nothing is known of `all` parameters.
    pub fn unknown(all: usize) -> Self {
        let unbounded = DMatrix::from_element(all, all, f64::INFINITY);
        Self {
            at_once: unbounded.clone(),
            freedom: 1.0,
            wander: DMatrix::zeros(all, all),
            moved: Vec::new(),
            bread: unbounded.clone(),
            alone: unbounded,
            variance: f64::INFINITY,
        }
    }
}

impl Variances {
    /// One that is known, whatever it is asked for.
    pub fn known(variance: f64) -> Self {
        Self {
            at_once: variance,
            repeat: variance,
            transfer: variance,
            freedom: f64::INFINITY,
        }
    }

    /// With more that is known.
    pub fn and(self, variance: f64) -> Self {
        Self {
            at_once: self.at_once + variance,
            repeat: self.repeat + variance,
            transfer: self.transfer + variance,
            ..self
        }
    }

    /// Half widths of 95 % intervals.
    pub fn half_widths(&self) -> HalfWidths {
        // What wanders has a variance that is given.
        let part = self.repeat / self.at_once.max(f64::MIN_POSITIVE);
        let quantile = student::quantile(self.freedom * part * part);
        HalfWidths {
            at_once: student::quantile(self.freedom) * self.at_once.sqrt(),
            repeat: quantile * self.repeat.sqrt(),
            transfer: quantile * self.transfer.sqrt(),
        }
    }
}

/// What is known before the log, as information of the scaled parameters.
fn prior(fit: &Fitted, scale: &[f64], variance: f64) -> DMatrix<f64> {
    DMatrix::from_diagonal(&DVector::from_fn(scale.len(), |i, _| {
        variance * fit.prior[i] * scale[i] * scale[i]
    }))
}

/// Scales columns of any unit to about one size. Scaled to one, a column that the log says next to nothing of would let its prior
/// outweigh all other information.
fn scales(fit: &Fitted) -> Vec<f64> {
    let square: f64 = fit.residual.iter().map(|r| r * r).sum();
    let rms = (square / fit.residual.len() as f64).sqrt();
    let columns = fit.jacobian.iter().zip(&fit.prior);
    let scale = |(column, prior): (&&[f64], &f64)| {
        1.0 / size(column).max(MIN_RELATIVE_SIZE * rms * prior.sqrt())
    };
    columns.map(scale).collect()
}

/// Root of the sum of squares, or 1 where that is 0.
fn size(column: &[f64]) -> f64 {
    let square = column.iter().map(|x| x * x).sum::<f64>();
    if square > 0.0 { square.sqrt() } else { 1.0 }
}

/// `J' J` of the scaled columns, over a part of the samples.
fn gram(fit: &Fitted, scale: &[f64], part: Option<&[bool]>) -> DMatrix<f64> {
    let p = scale.len();
    let mut out = DMatrix::zeros(p, p);
    let mut kept = Vec::new();
    for i in 0..p {
        let column = match part {
            Some(part) => {
                kept.clear();
                let each = fit.jacobian[i].iter().zip(part);
                kept.extend(each.map(|(x, inside)| if *inside { *x } else { 0.0 }));
                &kept
            }
            None => fit.jacobian[i],
        };
        for j in 0..=i {
            out[(i, j)] = dot(column, fit.jacobian[j]) * scale[i] * scale[j];
            out[(j, i)] = out[(i, j)];
        }
    }
    out
}

/// `J' y` of the scaled columns.
fn products(fit: &Fitted, scale: &[f64], y: &[f64]) -> DVector<f64> {
    let sums = fit.jacobian.iter().zip(scale).map(|(x, s)| s * dot(x, y));
    DVector::from_iterator(scale.len(), sums)
}

/// Forces by which friction differs in the next run: level, directions, tilt.
fn wander(fit: &Fitted, strokes: &Strokes) -> [Vec<f64>; 3] {
    let [_, side, tilt] = WANDER;
    let level = level(fit);
    let factor = |k: usize, i: usize| match k {
        0 => level,
        1 => side * strokes.sense[i],
        _ => tilt * (2.0 * (strokes.speed[i] / strokes.top).min(1.0) - 1.0),
    };
    [0, 1, 2].map(|k| {
        fit.friction
            .iter()
            .enumerate()
            .map(|(i, f)| factor(k, i) * f)
            .collect()
    })
}

/// By what part of itself the level of friction differs from one log to the next: as it does in these, with what is known of any
/// machine as [`MACHINES`] more of them.
fn level(fit: &Fitted) -> f64 {
    let [machines, ..] = WANDER;
    let apart = |range: &Range<usize>| {
        let friction = &fit.friction[range.clone()];
        dot(friction, &fit.residual[range.clone()]) / dot(friction, friction)
    };
    let apart = fit.logs.iter().map(apart).filter(|part| part.is_finite());
    let squares: f64 = apart.map(|part| part * part).sum();
    let freedom = MACHINES + fit.logs.len().saturating_sub(1) as f64;
    ((MACHINES * machines * machines + squares) / freedom).sqrt()
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
