//! Standard functions of optimisation, each with its minimum and, as sums of squares, with
//! derivatives.
#![allow(dead_code)]

use std::cell::Cell;
use stiction_search::{Bounds, CostsOnly, Derivatives, Fidelity, Points, Problem};

/// Residuals `r[k]` and, if asked for, their slopes `J[k][i]`.
type Residuals = fn(&[f64], bool) -> (Vec<f64>, Vec<Vec<f64>>);

/// A function as a sum of squares, and how it was asked.
pub struct Function {
    pub name: &'static str,
    bounds: Bounds,
    residuals: Residuals,
    /// Points asked so far.
    pub asked: Cell<u64>,
    /// Whether every point was inside the box.
    pub inside: Cell<bool>,
}

impl Function {
    fn new(name: &'static str, n: usize, low: f64, high: f64, residuals: Residuals) -> Self {
        Self {
            name,
            bounds: Bounds::new(vec![low; n], vec![high; n]).expect("a box"),
            residuals,
            asked: Cell::new(0),
            inside: Cell::new(true),
        }
    }

    pub fn cost(&self, x: &[f64]) -> f64 {
        (self.residuals)(x, false).0.iter().map(|r| r * r).sum()
    }

    fn note(&self, x: &[f64]) {
        self.asked.set(self.asked.get() + 1);
        self.inside
            .set(self.inside.get() && self.bounds.contains(x));
    }
}

impl Problem for Function {
    fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    fn costs(&self, points: &Points, _: Fidelity, costs: &mut [f64]) {
        for (x, cost) in points.rows().zip(costs) {
            self.note(x);
            *cost = self.cost(x);
        }
    }

    fn derivatives(
        &self,
        points: &Points,
        _: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        for (x, d) in points.rows().zip(out) {
            self.note(x);
            let (r, slopes) = (self.residuals)(x, true);
            d.cost = r.iter().map(|r| r * r).sum();
            for (r, slopes) in r.iter().zip(&slopes) {
                for (i, a) in slopes.iter().enumerate() {
                    d.gradient[i] += a * r;
                    for (j, b) in slopes.iter().enumerate() {
                        d.normal[i * x.len() + j] += a * b;
                    }
                }
            }
        }
        Ok(())
    }
}

/// A row of the identity times `a`.
fn unit(n: usize, i: usize, a: f64) -> Vec<f64> {
    let mut row = vec![0.0; n];
    row[i] = a;
    row
}

/// `sum x_i^2`, least 0 at the origin.
pub fn sphere(n: usize) -> Function {
    Function::new("sphere", n, -3.1, 5.3, |x, slopes| {
        let n = if slopes { x.len() } else { 0 };
        let slopes = (0..n).map(|i| unit(n, i, 1.0)).collect();
        (x.to_vec(), slopes)
    })
}

/// `sum 10^(6 i/(n-1)) x_i^2`, least 0 at the origin; condition 1e6.
pub fn ellipsoid(n: usize) -> Function {
    Function::new("ellipsoid", n, -3.1, 5.3, |x, slopes| {
        let n = x.len();
        let scale = |i: usize| libm::pow(10.0, 3.0 * i as f64 / (n - 1) as f64);
        let r = x.iter().enumerate().map(|(i, x)| scale(i) * x).collect();
        let rows = if slopes { n } else { 0 };
        (r, (0..rows).map(|i| unit(n, i, scale(i))).collect())
    })
}

/// `sum 100 (x_{i+1} - x_i^2)^2 + (1 - x_i)^2`, least 0 at (1, .., 1).
pub fn rosenbrock(n: usize) -> Function {
    Function::new("rosenbrock", n, -3.1, 5.3, |x, wanted| {
        let n = x.len();
        let (mut r, mut slopes) = (Vec::new(), Vec::new());
        for i in 0..n - 1 {
            r.push(10.0 * (x[i + 1] - x[i] * x[i]));
            r.push(1.0 - x[i]);
            if wanted {
                let mut row = unit(n, i + 1, 10.0);
                row[i] = -20.0 * x[i];
                slopes.push(row);
                slopes.push(unit(n, i, -1.0));
            }
        }
        (r, slopes)
    })
}

/// `sum x_i^2 + 10 (1 - cos(2 pi x_i))`, least 0 at the origin, a minimum near every integer.
pub fn rastrigin(n: usize) -> Function {
    Function::new("rastrigin", n, -3.1, 5.3, |x, wanted| {
        let n = x.len();
        let (mut r, mut slopes) = (Vec::new(), Vec::new());
        for (i, &x) in x.iter().enumerate() {
            r.push(x);
            // 10 (1 - cos 2a) = (sqrt(20) sin a)^2
            let (root, a) = (20f64.sqrt(), std::f64::consts::PI * x);
            r.push(root * libm::sin(a));
            if wanted {
                slopes.push(unit(n, i, 1.0));
                slopes.push(unit(n, i, root * std::f64::consts::PI * libm::cos(a)));
            }
        }
        (r, slopes)
    })
}

pub fn all(n: usize) -> [Function; 4] {
    [sphere(n), ellipsoid(n), rosenbrock(n), rastrigin(n)]
}
