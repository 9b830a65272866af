//! The damped Gauss-Newton step inside a box.

use crate::linear::{cholesky_solve, dot};
use crate::problem::Derivatives;

/// A box in the unknowns of a descent.
#[derive(Clone, Copy, Debug)]
pub struct Region<'a> {
    /// Lower bounds; they may be infinite.
    pub low: &'a [f64],
    /// Upper bounds, likewise.
    pub high: &'a [f64],
}

impl Region<'_> {
    /// The nearest point inside.
    pub fn clamp(&self, point: &[f64]) -> Vec<f64> {
        let bounds = self.low.iter().zip(self.high);
        let inside = |(&x, (&low, &high)): (&f64, (&f64, &f64))| match x {
            x if x < low => low,
            x if x > high => high,
            x => x,
        };
        point.iter().zip(bounds).map(inside).collect()
    }

    /// A point after a step, inside.
    pub fn moved(&self, point: &[f64], step: &[f64]) -> Vec<f64> {
        let to: Vec<f64> = point.iter().zip(step).map(|(x, d)| x + d).collect();
        self.clamp(&to)
    }
}

/// The step from one point to another.
pub fn difference(to: &[f64], from: &[f64]) -> Vec<f64> {
    to.iter().zip(from).map(|(a, b)| a - b).collect()
}

/// Largest distance of two points in any unknown.
pub fn largest(a: &[f64], b: &[f64]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max)
}

/// Fall of the cost that the quadratic model predicts for a step.
pub fn predicted_gain(now: &Derivatives, step: &[f64]) -> f64 {
    let pulled = times(now, step);
    -2.0 * dot(&now.gradient, step) - dot(&pulled, step)
}

/// `J^T J` times a step.
fn times(now: &Derivatives, step: &[f64]) -> Vec<f64> {
    let rows = now.normal.chunks(step.len().max(1));
    rows.map(|row| row.iter().zip(step).map(|(a, d)| a * d).sum())
        .collect()
}

/// The damped Gauss-Newton step inside the box, no unknown further than `longest`; `None` if none is free
/// to move, the gradient vanishes, or the equations of those that are free cannot be solved.
pub fn damped_step(
    now: &Derivatives,
    scale: Option<&[f64]>,
    point: &[f64],
    region: Region,
    damping: f64,
    longest: f64,
) -> Option<Vec<f64>> {
    let n = point.len();
    let Region { low, high } = region;
    let mut free: Vec<usize> = (0..n)
        .filter(|&i| {
            let down = -now.gradient[i];
            let outward = (down > 0.0 && point[i] >= high[i]) || (down < 0.0 && point[i] <= low[i]);
            !outward && scale.map_or(now.normal[i * n + i], |s| s[i]) > 0.0 && down.is_finite()
        })
        .collect();
    let mut step = vec![0.0; n];
    while !free.is_empty() {
        let solved = solve_free(now, scale, &free, &step, damping, longest)?;
        let before = free.len();
        let mut kept = Vec::new();
        for (&i, &d) in free.iter().zip(&solved) {
            let to = point[i] + d;
            if to > high[i] {
                step[i] = high[i] - point[i];
            } else if to < low[i] {
                step[i] = low[i] - point[i];
            } else {
                kept.push((i, d));
            }
        }
        if kept.len() == before {
            for (i, d) in kept {
                step[i] = d;
            }
            return Some(step);
        }
        free = kept.into_iter().map(|(i, _)| i).collect();
    }
    step.iter().any(|d| *d != 0.0).then_some(step)
}

/// Steps of the free unknowns when the others take the given steps.
fn solve_free(
    now: &Derivatives,
    relative_to: Option<&[f64]>,
    free: &[usize],
    others: &[f64],
    damping: f64,
    longest: f64,
) -> Option<Vec<f64>> {
    let (n, m) = (others.len(), free.len());
    // Scaled to a unit diagonal: the effects of the unknowns differ by many decades.
    let scale: Vec<f64> = free
        .iter()
        .map(|&i| {
            let own = now.normal[i * n + i];
            let damped = match relative_to {
                None => own * (1.0 + damping),
                Some(scale) => own + damping * scale[i],
            };
            1.0 / damped.sqrt()
        })
        .collect();
    let mut matrix = vec![0.0; m * m];
    let mut rhs = vec![0.0; m];
    let pulled = times(now, others);
    for (a, &i) in free.iter().enumerate() {
        for (b, &j) in free.iter().enumerate() {
            matrix[a * m + b] = now.normal[i * n + j] * scale[a] * scale[b];
        }
        matrix[a * m + a] = 1.0;
        rhs[a] = (-now.gradient[i] - pulled[i]) * scale[a];
    }
    let solved = cholesky_solve(matrix, rhs)?;
    let steps = solved.iter().zip(&scale);
    Some(
        steps
            .map(|(x, s)| (x * s).clamp(-longest, longest))
            .collect(),
    )
}
