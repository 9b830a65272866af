//! Least squares with many coefficients that must not be negative, from the normal equations.
//!
//! The active-set method of Lawson and Hanson 1974 (Solving Least Squares Problems, ch. 23): one
//! coefficient at a time is freed, the one whose growth lowers the residual fastest, and a step that
//! would break a bound stops there and holds that coefficient. The problem is convex, so the end point is
//! the optimum whatever the order of the steps.

use super::linear::Factor;
use nalgebra::DMatrix;

/// Cosine between a column and the residual below which freeing the column gains nothing.
const LEAST_COSINE: f64 = 1e-10;

/// Which bounded columns are held at zero at the optimum. Free columns are never held.
pub(crate) fn held(
    gram: &DMatrix<f64>,
    rhs: &[f64],
    nonnegative: &[bool],
    energy: f64,
) -> Vec<bool> {
    let m = rhs.len();
    let mut held = nonnegative.to_vec();
    let mut x = vec![0.0; m];
    // A column that was freed and immediately held again is skipped until another has changed.
    let mut refused = vec![false; m];
    // Each round lowers the residual, so no set of held columns occurs twice; rounding could cause it, so
    // the rounds are limited.
    for _ in 0..10 * m {
        let fitted = solve(gram, rhs, &held);
        let Some(blocked) = step(&mut x, &fitted, &held, nonnegative) else {
            let residual: Vec<f64> = (0..m)
                .map(|i| rhs[i] - (0..m).map(|j| gram[(i, j)] * x[j]).sum::<f64>())
                .collect();
            let left = (energy - (0..m).map(|i| x[i] * (rhs[i] + residual[i])).sum::<f64>())
                .max(1e-20 * energy);
            let gain = |j: usize| residual[j] / (gram[(j, j)] * left).sqrt();
            let next = (0..m)
                .filter(|&j| held[j] && !refused[j] && gain(j) > LEAST_COSINE)
                .max_by(|&a, &b| gain(a).total_cmp(&gain(b)));
            let Some(next) = next else {
                break;
            };
            held[next] = false;
            refused[next] = true;
            continue;
        };
        for j in blocked {
            held[j] = true;
        }
        for (out, &is_held) in refused.iter_mut().zip(&held) {
            *out = *out && is_held;
        }
    }
    held
}

/// The least-squares coefficients of the columns that are not held; zero for the others and for
/// columns that depend on those before.
fn solve(gram: &DMatrix<f64>, rhs: &[f64], held: &[bool]) -> Vec<f64> {
    let wanted: Vec<usize> = (0..rhs.len()).filter(|&j| !held[j]).collect();
    let (factor, _) = Factor::new(gram, &wanted);
    let pick: Vec<f64> = factor.columns().iter().map(|&j| rhs[j]).collect();
    let mut out = vec![0.0; rhs.len()];
    for (&j, c) in factor.columns().iter().zip(factor.solve(&pick)) {
        out[j] = c;
    }
    out
}

/// Goes from `x` towards `to` as far as the bounds allow; returns the columns that stopped it, `None` if
/// none did.
fn step(x: &mut [f64], to: &[f64], held: &[bool], nonnegative: &[bool]) -> Option<Vec<usize>> {
    let broken = |j: usize| nonnegative[j] && !held[j] && to[j] <= 0.0;
    let part = (0..x.len())
        .filter(|&j| broken(j))
        .map(|j| {
            if x[j] > 0.0 {
                x[j] / (x[j] - to[j])
            } else {
                0.0
            }
        })
        .fold(f64::INFINITY, f64::min);
    if part == f64::INFINITY {
        x.copy_from_slice(to);
        return None;
    }
    let mut blocked = Vec::new();
    for j in 0..x.len() {
        let stops = broken(j) && x[j] <= part * (x[j] - to[j]);
        x[j] += part * (to[j] - x[j]);
        if stops {
            x[j] = 0.0;
            blocked.push(j);
        }
    }
    Some(blocked)
}

#[cfg(test)]
mod tests {
    use super::super::linear::{dot, solve};

    /// Columns that resemble each other, as those of neighbouring elements do.
    fn columns(many: usize, n: usize) -> Vec<Vec<f64>> {
        (0..many)
            .map(|k| {
                (0..n)
                    .map(|i| (3.0 * (i as f64 * 0.011 * (1.0 + 0.1 * k as f64)).sin()).tanh())
                    .collect()
            })
            .collect()
    }

    #[test]
    fn the_optimality_conditions_hold() {
        let columns = columns(24, 2000);
        let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        for seed in 0..8 {
            let force: Vec<f64> = (0..2000)
                .map(|i| {
                    let t = i as f64;
                    columns[3][i] + 0.4 * columns[11 + seed][i] - 0.3 * columns[7][i]
                        + 0.2 * (t * (0.7 + 0.01 * seed as f64)).sin()
                })
                .collect();
            let mut bounded = vec![true; 24];
            bounded[23] = false;
            let found = solve(&views, &bounded, &force);
            let size = dot(&force, &force);
            for (j, column) in columns.iter().enumerate() {
                let slope = dot(column, &found.residual) / (size * dot(column, column)).sqrt();
                if found.active[j] {
                    assert!(found.coefficients[j] >= 0.0 || !bounded[j], "column {j}");
                    assert!(
                        slope.abs() < 1e-9,
                        "column {j} is not orthogonal: {slope:e}"
                    );
                } else if !found.dependent[j] {
                    assert!(slope < 1e-8, "column {j} would help: {slope:e}");
                }
            }
        }
    }

    #[test]
    fn exact_forces_are_found_among_many_columns() {
        let columns = columns(24, 2000);
        let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let force: Vec<f64> = (0..2000)
            .map(|i| 2.0 * columns[5][i] + columns[17][i])
            .collect();
        let found = solve(&views, &[true; 24], &force);
        assert!(found.cost < 1e-16 * dot(&force, &force), "{:e}", found.cost);
        assert!(
            (found.coefficients[5] - 2.0).abs() < 1e-4,
            "{:?}",
            found.coefficients
        );
        assert!((found.coefficients[17] - 1.0).abs() < 1e-4);
    }
}
