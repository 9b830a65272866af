//! Other standard errors under correlated residuals, for comparison: what each covers of the unknowns
//! (ln kappa, ln (r - 1), ln vs, then the coefficients) with the normal quantile.

use crate::common::MACHINE;
use crate::common::trials::{Trial, local};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Name and variances of the estimates, from the weights (a column each) and the residual.
type Rival = (&'static str, fn(&DMatrix<f64>, &DVector<f64>) -> Vec<f64>);

pub const ALL: [Rival; 5] = [
    ("white", white),
    ("Newey-West, 4 (n/100)^(2/9)", |w, r| {
        let lag = 4.0 * (r.len() as f64 / 100.0).powf(2.0 / 9.0);
        newey_west(&scores(w, r), lag as usize)
    }),
    ("Newey-West, 60", |w, r| newey_west(&scores(w, r), 60)),
    ("moving blocks, 3 n^(1/3)", moving_blocks),
    ("VAR(1) prewhitened", prewhitened),
];

/// Prints the least and the mean coverage over the unknowns of each rival.
pub fn table(runs: Range<u64>, trial: impl Fn(u64) -> Trial) {
    let mut hits = vec![Vec::<usize>::new(); ALL.len()];
    for run in runs.clone() {
        let trial = trial(run);
        let (_, found) = local(&trial, &MACHINE);
        let columns = found.evaluation.jacobian();
        let n = columns[0].len();
        let jacobian = DMatrix::from_fn(n, columns.len(), |t, i| columns[i][t]);
        let residual = DVector::from_column_slice(found.evaluation.residual());
        let norms: Vec<f64> = (0..columns.len())
            .map(|i| jacobian.column(i).norm())
            .collect();
        let scaled = DMatrix::from_fn(n, columns.len(), |t, i| jacobian[(t, i)] / norms[i]);
        let inverse = (scaled.transpose() * &scaled).try_inverse().unwrap();
        let weights = &scaled * inverse;
        let error = errors(&trial, &found.p, found.evaluation.residual(), &jacobian);
        for ((_, rival), hits) in ALL.iter().zip(&mut hits) {
            hits.resize(columns.len(), 0);
            for (i, variance) in rival(&weights, &residual).into_iter().enumerate() {
                let deviation = variance.sqrt() / norms[i];
                hits[i] += usize::from(error[i].abs() <= 1.96 * deviation);
            }
        }
    }
    for ((name, _), hits) in ALL.iter().zip(&hits) {
        let part = |k: usize| 100.0 * k as f64 / (runs.end - runs.start) as f64;
        let least = part(*hits.iter().min().unwrap());
        let mean = part(hits.iter().sum()) / hits.len() as f64;
        println!("  {name:30} least {least:5.1} %, mean {mean:5.1} %");
    }
}

/// Estimate less truth of every unknown.
fn errors(trial: &Trial, p: &[f64], residual: &[f64], jacobian: &DMatrix<f64>) -> Vec<f64> {
    let truth = |name: &str| trial.truth.iter().find(|t| t.0 == name).unwrap().1;
    let mut out = vec![
        p[0] - (truth("sigma0") / truth("coulomb")).ln(),
        p[1] - (truth("static") / truth("coulomb") - 1.0).ln(),
        p[2] - truth("stribeck_velocity").ln(),
    ];
    // The coefficients: what the columns say of measured force, which is model and residual.
    let linear = jacobian.columns(3, jacobian.ncols() - 3);
    let force = trial.record.gather(|s| &s.force);
    let model = DVector::from_fn(force.len(), |t, _| force[t] - residual[t]);
    let c = (linear.transpose() * linear)
        .try_inverse()
        .map(|inverse| inverse * linear.transpose() * model)
        .unwrap();
    let names = ["coulomb", "sigma1", "sigma2", "mass", "offset"];
    let fitted = names
        .iter()
        .filter(|n| trial.truth.iter().any(|t| t.0 == **n));
    out.extend(fitted.zip(c.iter()).map(|(name, c)| c - truth(name)));
    out
}

fn scores(weights: &DMatrix<f64>, residual: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(weights.nrows(), weights.ncols(), |t, i| {
        weights[(t, i)] * residual[t]
    })
}

fn white(weights: &DMatrix<f64>, residual: &DVector<f64>) -> Vec<f64> {
    let variance = residual.norm_squared() / (residual.len() - weights.ncols()) as f64;
    weights
        .column_iter()
        .map(|w| variance * w.norm_squared())
        .collect()
}

fn newey_west(scores: &DMatrix<f64>, lag: usize) -> Vec<f64> {
    let n = scores.nrows();
    scores
        .column_iter()
        .map(|u| {
            let at = |k: usize| u.rows(k, n - k).dot(&u.rows(0, n - k));
            let tail: f64 = (1..=lag)
                .map(|k| 2.0 * (1.0 - k as f64 / (lag + 1) as f64) * at(k))
                .sum();
            at(0) + tail
        })
        .collect()
}

/// The variance that a moving-block bootstrap converges to.
fn moving_blocks(weights: &DMatrix<f64>, residual: &DVector<f64>) -> Vec<f64> {
    let scores = scores(weights, residual);
    let n = scores.nrows();
    let length = (3.0 * (n as f64).cbrt()) as usize;
    scores
        .column_iter()
        .map(|u| {
            let blocks = n - length + 1;
            let squares: f64 = (0..blocks).map(|t| u.rows(t, length).sum().powi(2)).sum();
            squares / blocks as f64 * n as f64 / length as f64
        })
        .collect()
}

/// A first-order vector autoregression of the scores, Bartlett weights on what it leaves.
fn prewhitened(weights: &DMatrix<f64>, residual: &DVector<f64>) -> Vec<f64> {
    let scores = scores(weights, residual);
    let (n, q) = scores.shape();
    let (before, after) = (scores.rows(0, n - 1), scores.rows(1, n - 1));
    let gram = before.transpose() * before;
    let a = (gram.try_inverse().unwrap() * before.transpose() * after).transpose();
    let left = after - before * a.transpose();
    let lag = (n as f64).cbrt() as usize;
    let mut sum = left.transpose() * &left;
    for k in 1..=lag {
        let part = left.rows(k, n - 1 - k).transpose() * left.rows(0, n - 1 - k);
        sum += (&part + part.transpose()) * (1.0 - k as f64 / (lag + 1) as f64);
    }
    let back = (DMatrix::identity(q, q) - a).try_inverse().unwrap();
    (&back * sum * back.transpose())
        .diagonal()
        .iter()
        .copied()
        .collect()
}
