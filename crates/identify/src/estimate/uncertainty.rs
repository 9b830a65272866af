//! Uncertainty of the unknowns, with the correlation of the residuals counted.
//!
//! The covariance is the sandwich `B S B`: `B` inverts `J^T J`, `S` is the covariance of the sum of
//! the scores `J_t r_t`. Two estimates of `S` are made, and each unknown gets the larger variance:
//!
//! - `J^T G J`, with `G` the covariance of the residual as an autoregression ([`Autoregression`]):
//!   sharp where the noise does not depend on the motion.
//! - the long-run covariance of the scores, right also where it does: whitened by a first-order
//!   autoregression each (Andrews and Monahan 1992, doi 10.2307/2951574), summed with Bartlett weights
//!   over a lag chosen from the data (Andrews 1991, doi 10.2307/2938229) in the form of overlapping
//!   batch sums, which costs one pass whatever the lag, and the whitening undone.
//!
//! Why these two: decision 0014.

use crate::conditioning::record::Record;
use crate::effects;
use crate::estimate::autoregression::{Autoregression, segments};
use crate::law::prior::Prior;
use crate::law::terms::Terms;
use crate::scatter::strokes::Strokes;
use crate::scatter::{Fitted, Scatter};
use crate::separable::linear::dot;
use crate::separable::logs::Logs;
use crate::separable::objective::{Evaluation, Objective};
use crate::separable::optimum::Optimum;
use nalgebra::{DMatrix, SymmetricEigen};

/// Eigenvalue of a normal matrix scaled to a unit diagonal, relative to the largest, that is only
/// rounding error.
pub(crate) const ROUNDED_EIGENVALUE: f64 = 1e-15;

/// Covariance of some unknowns from the correlation of the residual alone.
#[derive(Clone, Debug)]
pub(crate) struct Unknowns {
    /// Covariance.
    pub covariance: DMatrix<f64>,
    /// Inverse of `J^T J`: the covariance for white residuals of variance 1.
    pub bread: DMatrix<f64>,
}

/// How surely the unknowns `(p, c)` are known; coefficients held at zero or left out have zero rows.
///
/// A nonlinear unknown at the bound of its search range counts as free here: the bound is a choice of the
/// program, no physical limit, and holding the unknown would make the others look better known than they
/// are.
pub(crate) fn unknowns(objective: &Objective, at: &Evaluation) -> Scatter {
    let strokes = Strokes::of(objective.record());
    beside(objective, at, (&strokes, false), |j| at.solution.active[j])
}

/// The same with what another motion changes.
pub(crate) fn with_transfer(objective: &Objective, at: &Evaluation) -> Scatter {
    let strokes = Strokes::of(objective.record());
    beside(objective, at, (&strokes, true), |j| at.solution.active[j])
}

/// What is known before a log of the law of a fit; `None` for a law of which nothing is.
pub(crate) fn prior(record: &Record, optimum: &Optimum, terms: &Terms) -> Option<Prior> {
    let objective = Objective::new(record, optimum.law, terms);
    let strokes = Strokes::of(record);
    let at = &optimum.evaluation;
    let variance = beside(&objective, at, (&strokes, false), |j| at.solution.active[j]).variance;
    let prior = Prior::of(record, &strokes, variance);
    let counts = prior.is_of(&optimum.law) && variance.is_finite();
    counts.then_some(prior)
}

/// With the coefficients of which that is said beside the nonlinear unknowns, and with what another motion changes where it is asked
/// for.
pub(crate) fn beside(
    objective: &Objective,
    at: &Evaluation,
    (strokes, transfer): (&Strokes, bool),
    is_free: impl Fn(usize) -> bool,
) -> Scatter {
    let free = Free::of(at, is_free);
    let friction = effects::friction(objective, at);
    let logs = Logs::of(objective.record());
    let logs = logs.as_ref().map_or(&[][..], |logs| logs.ranges());
    let fit = Fitted {
        residual: at.residual(),
        logs,
        friction: &friction,
        prior: prior_information(objective, &free),
        jacobian: free.jacobian,
    };
    let small = Scatter::from_strokes(&fit, strokes).map(|small| match transfer {
        true => small.with_transfer(&fit, strokes),
        false => small,
    });
    match small {
        Some(small) => small.among(&free.index, free.all),
        None => Scatter::unknown(free.index.len()).among(&free.index, free.all),
    }
}

/// Inverse of the variance that each of some unknowns has before the log, in parts of what a sample counts.
fn prior_information(objective: &Objective, free: &Free) -> Vec<f64> {
    let mut out = vec![0.0; free.jacobian.len()];
    for (i, information) in objective.prior().information() {
        out[i] = information;
    }
    out
}

/// The unknowns that count as free: the nonlinear ones, and some of the coefficients.
struct Free<'a> {
    /// Their places among all.
    index: Vec<usize>,
    /// Number of all.
    all: usize,
    /// Derivatives of the model by them.
    jacobian: Vec<&'a [f64]>,
}

impl<'a> Free<'a> {
    fn of(at: &'a Evaluation, is_free: impl Fn(usize) -> bool) -> Self {
        let k = at.slopes.len();
        let columns: Vec<usize> = (0..at.columns.len()).filter(|&j| is_free(j)).collect();
        let of_columns = columns.iter().map(|&j| at.columns[j].as_slice());
        let slopes = at.slopes.iter().map(|s| s.as_slice());
        Self {
            index: (0..k).chain(columns.iter().map(|j| k + j)).collect(),
            all: k + at.columns.len(),
            jacobian: slopes.chain(of_columns).collect(),
        }
    }
}

/// What each column is divided by, the inverse of the normal matrix of the divided columns, and the part of it that belongs to
/// directions lost to rounding.
fn normal(jacobian: &[&[f64]]) -> (Vec<f64>, DMatrix<f64>, DMatrix<f64>) {
    let scale: Vec<f64> = jacobian
        .iter()
        .map(|c| {
            let norm = dot(c, c).sqrt();
            if norm > 0.0 { 1.0 / norm } else { 1.0 }
        })
        .collect();
    let gram = symmetric(jacobian.len(), |i, j| {
        dot(jacobian[i], jacobian[j]) * scale[i] * scale[j]
    });
    let (bread, lost) = inverse(gram);
    (scale, bread, lost)
}

/// `B S B` for Jacobian columns and residual; `breaks` are the indices at which a new segment starts.
pub(crate) fn sandwich(jacobian: &[&[f64]], residual: &[f64], breaks: &[usize]) -> Unknowns {
    let q = jacobian.len();
    let n = residual.len();
    if q == 0 || n <= q {
        return Unknowns {
            covariance: DMatrix::from_element(q, q, f64::INFINITY),
            bread: DMatrix::from_element(q, q, f64::INFINITY),
        };
    }
    let (scale, bread, lost) = normal(jacobian);
    let weights = weights(jacobian, &scale, &bread);
    let stationary = Autoregression::fit(residual, breaks).covariance(&weights, breaks);
    let mut scores = weights;
    for score in &mut scores {
        score.iter_mut().zip(residual).for_each(|(w, r)| *w *= r);
    }
    let long_run = long_run_variances(scores, breaks);
    let correction = n as f64 / (n - q) as f64;
    let widen: Vec<f64> = (0..q)
        .map(|i| {
            if stationary[(i, i)] > 0.0 {
                (long_run[i] / stationary[(i, i)]).max(1.0).sqrt()
            } else {
                1.0
            }
        })
        .collect();
    let white = dot(residual, residual) / (n - q) as f64;
    Unknowns {
        covariance: DMatrix::from_fn(q, q, |i, j| {
            let known = correction * stationary[(i, j)] * widen[i] * widen[j];
            // No residual has a component in a direction lost to rounding, so the scores give no variance
            // for it.
            (known + white * lost[(i, j)]) * scale[i] * scale[j]
        }),
        bread: DMatrix::from_fn(q, q, |i, j| bread[(i, j)] * scale[i] * scale[j]),
    }
}

/// By how much the unknowns, nonlinear then linear, follow one of the last column of a Jacobian that was put beside theirs; zero for those
/// that are held. `bread` is that of all columns.
pub(crate) fn followed(at: &Evaluation, bread: &DMatrix<f64>) -> Option<Vec<f64>> {
    let own = bread.nrows() - 1;
    let k = at.slopes.len();
    let mut followed = vec![0.0; k + at.columns.len()];
    let active = (0..at.columns.len()).filter(|&j| at.solution.active[j]);
    for (a, i) in (0..k).chain(active.map(|j| k + j)).enumerate() {
        followed[i] = bread[(a, own)] / bread[(own, own)];
    }
    followed.iter().all(|x| x.is_finite()).then_some(followed)
}

/// Inverse of a scaled symmetric matrix. Directions that are lost to rounding keep a huge variance: they
/// must come out as unknown, not as zero. Also returns the part of the inverse that belongs to them.
pub(crate) fn inverse(matrix: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let (known, lost) = inverse_in_parts(matrix);
    (known + &lost, lost)
}

/// The same, what is not lost and what is.
pub(crate) fn inverse_in_parts(matrix: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let q = matrix.nrows();
    let eigen = SymmetricEigen::new(matrix);
    let most = eigen.eigenvalues.iter().fold(0.0_f64, |m, x| m.max(*x));
    let floor = ROUNDED_EIGENVALUE * most;
    let sum = |wanted: &dyn Fn(f64) -> bool| {
        DMatrix::from_fn(q, q, |i, j| {
            (0..q)
                .filter(|&l| wanted(eigen.eigenvalues[l]))
                .map(|l| {
                    let inverse = 1.0 / eigen.eigenvalues[l].max(floor);
                    eigen.eigenvectors[(i, l)] * inverse * eigen.eigenvectors[(j, l)]
                })
                .sum()
        })
    };
    (sum(&|x| x > floor), sum(&|x| x <= floor))
}

/// `B J_t`, one column of length n per unknown: the effect of a residual on the unknown.
fn weights(jacobian: &[&[f64]], scale: &[f64], bread: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let n = jacobian.first().map_or(0, |column| column.len());
    let mut out = vec![vec![0.0; n]; jacobian.len()];
    for start in (0..n).step_by(CHUNK) {
        let end = n.min(start + CHUNK);
        for (i, out) in out.iter_mut().enumerate() {
            for (j, column) in jacobian.iter().enumerate() {
                let weight = bread[(i, j)] * scale[j];
                for (x, d) in out[start..end].iter_mut().zip(&column[start..end]) {
                    *x += weight * d;
                }
            }
        }
    }
    out
}

/// Samples of all columns that stay in the fastest CPU caches.
const CHUNK: usize = 256;

/// A symmetric matrix, each element worked out once.
fn symmetric(q: usize, element: impl Fn(usize, usize) -> f64) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(q, q);
    for i in 0..q {
        for j in 0..=i {
            let x = element(i, j);
            out[(i, j)] = x;
            out[(j, i)] = x;
        }
    }
    out
}

/// Sum over all pairs of samples of the covariance of each score.
fn long_run_variances(scores: Vec<Vec<f64>>, breaks: &[usize]) -> Vec<f64> {
    let n = scores.first().map_or(0, Vec::len);
    let whitened: Vec<(f64, Vec<f64>)> = scores.into_iter().map(|w| whiten(w, breaks)).collect();
    let lag = bandwidth(&whitened, breaks).min(n / 4).max(1);
    whitened
        .iter()
        .map(|(a, e)| batch_energy(e, lag) / lag as f64 / ((1.0 - a) * (1.0 - a)))
        .collect()
}

/// Long-run covariance of the influence `B J_t r_t` of each sample, one series for each unknown, times
/// `correction`; never below `white`, what white residuals would give.
pub(crate) fn of_influence(
    influence: &[Vec<f64>],
    breaks: &[usize],
    correction: f64,
    white: &DMatrix<f64>,
) -> DMatrix<f64> {
    let q = influence.len();
    let n = influence.first().map_or(0, Vec::len);
    let whitened: Vec<(f64, Vec<f64>)> = influence
        .iter()
        .map(|w| whiten(w.clone(), breaks))
        .collect();
    let lag = bandwidth(&whitened, breaks).min(n / 4).max(1);
    let sums: Vec<Vec<f64>> = whitened.iter().map(|(_, e)| batch_sums(e, lag)).collect();
    let long_run = DMatrix::from_fn(q, q, |i, j| {
        let sum = dot(&sums[i], &sums[j]) / lag as f64;
        correction * sum / ((1.0 - whitened[i].0) * (1.0 - whitened[j].0))
    });
    let widen: Vec<f64> = (0..q)
        .map(|i| {
            if long_run[(i, i)] > 0.0 {
                (white[(i, i)] / long_run[(i, i)]).max(1.0).sqrt()
            } else {
                0.0
            }
        })
        .collect();
    DMatrix::from_fn(q, q, |i, j| {
        if widen[i] == 0.0 || widen[j] == 0.0 {
            white[(i, j)]
        } else {
            long_run[(i, j)] * widen[i] * widen[j]
        }
    })
}

/// First-order autoregression: its coefficient and the remaining residual.
fn whiten(mut w: Vec<f64>, breaks: &[usize]) -> (f64, Vec<f64>) {
    // Beyond .97 undoing the whitening would amplify noise more than it removes bias.
    let a = lag_one(&w, breaks).clamp(-0.97, 0.97);
    for s in segments(w.len(), breaks) {
        let mut before = 0.0;
        for x in &mut w[s] {
            let now = *x;
            *x = now - a * before;
            before = now;
        }
    }
    (a, w)
}

fn lag_one(w: &[f64], breaks: &[usize]) -> f64 {
    let energy = dot(w, w);
    if energy <= 0.0 {
        return 0.0;
    }
    let product: f64 = segments(w.len(), breaks)
        .filter(|s| s.len() > 1)
        .map(|s| dot(&w[s.start + 1..s.end], &w[s.start..s.end - 1]))
        .sum();
    product / energy
}

/// Andrews' lag for the Bartlett kernel, from first-order autoregressions of the whitened scores.
fn bandwidth(whitened: &[(f64, Vec<f64>)], breaks: &[usize]) -> usize {
    let n = whitened.first().map_or(0, |(_, e)| e.len()) as f64;
    let (mut above, mut below) = (0.0, 0.0);
    for (_, e) in whitened {
        let energy = dot(e, e);
        if energy <= 0.0 {
            continue;
        }
        let b = lag_one(e, breaks).clamp(-0.97, 0.97);
        // Each unknown has its own unit, so all get the same weight.
        above += 4.0 * b * b / ((1.0 - b).powi(6) * (1.0 + b).powi(2));
        below += 1.0 / (1.0 - b).powi(4);
    }
    if below <= 0.0 {
        return 1;
    }
    (1.1447 * (above / below * n).cbrt()).ceil() as usize
}

/// Sums of all windows of `lag` samples, including those that extend beyond either end.
fn batch_sums(e: &[f64], lag: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(e.len() + lag);
    each_batch(e, lag, |sum| out.push(sum));
    out
}

/// Sum of squares of those window sums.
fn batch_energy(e: &[f64], lag: usize) -> f64 {
    let mut energy = 0.0;
    each_batch(e, lag, |sum| energy += sum * sum);
    energy
}

fn each_batch(e: &[f64], lag: usize, mut see: impl FnMut(f64)) {
    let mut sum = 0.0;
    let mut add = |x: f64| {
        sum += x;
        see(sum);
    };
    e.iter().take(lag).for_each(|x| add(*x));
    // The difference is computed first, so that each step of the running sum waits for one addition only.
    let both = e.iter().skip(lag).zip(e);
    both.for_each(|(x, gone)| add(x - gone));
    let last = e.iter().skip(e.len().saturating_sub(lag));
    last.take(lag - 1).for_each(|gone| add(-gone));
}
