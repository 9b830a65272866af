//! What the counts of an encoder leave open about a step response.
//!
//! An axis that has settled shows one count for the rest of the record: its rounding is one error, however many
//! samples repeat it. The residual does not show it, since the fit moves sigma0 until the model settles at that
//! count, and sigma1 and the mass follow.

use super::step_fit::Problem;
use super::step_given::scaled;
use nalgebra::{DMatrix, DVector};

/// Variance of a rounding that is equally likely everywhere in a count, as a share of the count's square.
const UNIFORM: f64 = 1.0 / 12.0;

/// What rounding adds to the covariance of the unknowns, `J` being `slopes`: `K R K^T` with
/// `K = -(J^T J)^-1 J^T`, `R` being the mean squares of the rounding in each run of equal counts.
///
/// Within a run the rounding changes by what the axis moves, and all of it is uncertain by what is left of the count:
/// uniform where the axis stands, and nothing where it crosses the whole count. An axis that comes to rest has most of its
/// samples at one side of its last count.
pub(super) fn rounding(problem: &Problem, residual: &[f64], slopes: &[Vec<f64>]) -> DMatrix<f64> {
    let n = slopes.len();
    let (scale, gram) = scaled(slopes);
    let mut scores = DMatrix::zeros(n, n);
    let mut start = 0;
    for response in &problem.responses {
        let own = start..start + response.position.len();
        start = own.end;
        let Some(count) = response.resolution else {
            continue;
        };
        // The level of each response is solved for, so that only what differs from its mean moves the unknowns.
        let means: Vec<f64> = slopes
            .iter()
            .map(|s| s[own.clone()].iter().sum::<f64>() / own.len() as f64)
            .collect();
        let mut at = own.start;
        for run in response
            .position
            .chunk_by(|a, b| (a - b).abs() < 0.5 * count)
        {
            let samples = at..at + run.len();
            at = samples.end;
            let left = &residual[samples.clone()];
            let (low, high) = left
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), r| {
                    (a.min(*r), b.max(*r))
                });
            let open = (count - (high - low)).max(0.0);
            let score = |error: &dyn Fn(f64) -> f64| {
                DVector::from_fn(n, |i, _| {
                    let of = slopes[i][samples.clone()].iter().zip(left);
                    let sum: f64 = of.map(|(s, r)| (s - means[i]) * error(*r)).sum();
                    sum * scale[i]
                })
            };
            let middle = 0.5 * (low + high);
            let (all, within) = (score(&|_| 1.0), score(&|r| r - middle));
            scores += UNIFORM * open * open * &all * all.transpose();
            scores += &within * within.transpose();
        }
    }
    let Some(factor) = gram.cholesky() else {
        return scores * 0.0;
    };
    let half = factor.solve(&scores);
    let whole = factor.solve(&half.transpose());
    DMatrix::from_fn(n, n, |i, j| whole[(i, j)] * scale[i] * scale[j])
}
