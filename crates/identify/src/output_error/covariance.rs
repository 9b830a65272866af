//! How far the noise of the logs lets the shared unknowns lie from the truth.

use crate::estimate::uncertainty;
use crate::output_error::problem::{Point, Problem};
use crate::output_error::simulate::simulate_with_slopes;
use crate::watch::Watch;
use nalgebra::DMatrix;
use stiction_search::{Silent, Stage};

/// Covariance of the shared unknowns with the starts of the runs unknown too, and which of them have no
/// effect at all.
///
/// The influence of a sample on an unknown is summed over its channels, so that the errors of position
/// and force at one instant, which are correlated, are not counted as two independent ones.
pub(crate) fn covariance(
    problem: &Problem,
    at: &Point,
    held: &[bool],
) -> (DMatrix<f64>, Vec<bool>) {
    let count = problem.layout.len();
    let mut silent = Silent;
    let equations = problem.equations(at, &mut Watch::new(&mut silent, Stage::Fine));
    let (reduced, _) = equations.reduced(0.0);
    let without: Vec<bool> = (0..count)
        .map(|i| equations.shared[(i, i)] <= 0.0)
        .collect();
    let free: Vec<usize> = (0..count).filter(|&i| !held[i] && !without[i]).collect();
    let q = free.len();
    let mut out = DMatrix::zeros(count, count);
    let scale: Vec<f64> = free
        .iter()
        .map(|&i| 1.0 / equations.shared[(i, i)].sqrt())
        .collect();
    let scaled = DMatrix::from_fn(q, q, |a, b| {
        reduced.normal[free[a] * count + free[b]] * scale[a] * scale[b]
    });
    if q == 0 || scaled.iter().any(|x| !x.is_finite()) {
        out.fill(f64::INFINITY);
        return (out, without);
    }
    let bread = uncertainty::inverse(scaled).0;

    let axis = problem.layout.write(&problem.base, &at.q);
    let mut influence: Vec<Vec<f64>> = vec![Vec::new(); q];
    let mut breaks = Vec::new();
    let mut samples = 0;
    for ((run, initial), part) in problem.runs.iter().zip(&at.starts).zip(&equations.runs) {
        if samples > 0 {
            breaks.push(samples);
        }
        // The remaining effect of a shared unknown after the start of its run has been adjusted to it.
        let own = &part.mixed * part.inverse(0.0);
        simulate_with_slopes(
            &axis,
            &problem.layout,
            &problem.drive,
            run,
            initial,
            |k, now| {
                if !run.keep[k] {
                    return true;
                }
                samples += 1;
                let mut score = vec![0.0; q];
                let mut add = |weight: f64, residual: f64, slopes: &[f64]| {
                    for (s, &i) in score.iter_mut().zip(&free) {
                        let mut slope = slopes[i];
                        for (a, local) in slopes[count..].iter().enumerate() {
                            slope -= own[(i, a)] * local;
                        }
                        *s += weight * weight * slope * residual;
                    }
                };
                add(
                    problem.weights[0],
                    run.position[k] - now.state.x,
                    now.position_slopes,
                );
                if problem.drive.controller.is_some() {
                    add(
                        problem.weights[1],
                        run.force[k] - now.force,
                        now.force_slopes,
                    );
                }
                for (a, series) in influence.iter_mut().enumerate() {
                    series.push((0..q).map(|b| bread[(a, b)] * scale[b] * score[b]).sum());
                }
                true
            },
        );
    }
    let channels = if problem.drive.controller.is_some() {
        2
    } else {
        1
    };
    let spent = q + problem.runs.len() * problem.drive.locals();
    let (n, spent) = (samples as f64, spent as f64 / f64::from(channels));
    if n <= spent + 1.0 {
        out.fill(f64::INFINITY);
        return (out, without);
    }
    let variance = equations.cost / (f64::from(channels) * (n - spent));
    let small =
        uncertainty::of_influence(&influence, &breaks, n / (n - spent), &(&bread * variance));
    for (a, &i) in free.iter().enumerate() {
        for (b, &j) in free.iter().enumerate() {
            out[(i, j)] = small[(a, b)] * scale[a] * scale[b];
        }
    }
    (out, without)
}
