//! Nearest physically consistent parameters to an estimate.
//!
//! Minimises `½ (pi - estimate)ᵀ H (pi - estimate) + w Σ D(pi_i, nominal_i)` over positive definite pseudo-inertias, with the
//! entropic divergence `D = tr(J0⁻¹ J) - log det(J0⁻¹ J) - 4` (Lee, Wensing and Park 2020, *Geometric robot dynamic
//! identification: a convex programming approach*, doi:10.1109/TRO.2019.2926491). The problem is convex and its cost
//! self-concordant, so that damped Newton steps reach its one minimum from anywhere (Boyd and Vandenberghe 2004, section 9.6);
//! the weight is lowered in stages.

use crate::Error;
use crate::consistency::{
    Matrix4, made_consistent, of_pseudo_inertia, pseudo_inertia, times_transposed, upper_factor,
};
use crate::inertia::Parameters;
use crate::linear::solve;
use std::array::from_fn;

/// Factor between the weights of two stages.
const STAGE: f64 = 0.1;
/// Most Newton steps.
const MOST_STEPS: usize = 1000;
/// Squared Newton decrement, of the weight, at which a stage ends, and the last: a full step follows, with the square of that.
const NEAR: f64 = 1e-2;
const CLOSE: f64 = 1e-10;
/// Part of the decrease that a step promises which it has to bring.
const ARMIJO: f64 = 0.1;

/// Parameters found by [`project`].
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// Consistent parameters, ten a body.
    pub parameters: Vec<f64>,
    /// `(parameters - estimate)ᵀ H (parameters - estimate)`: with H an inverse covariance, chi-squared of the change.
    pub misfit: f64,
    /// Weight of the prior at which they are the minimum: the one asked for, or a larger one where rounding hides a smaller
    /// one, below about 1e-13 of the information.
    pub weight: f64,
    /// Newton steps taken.
    pub steps: usize,
    /// Whether the minimum at that weight was reached.
    pub converged: bool,
}

/// Finds the physically consistent parameters nearest to an estimate (ten a body) in the metric of an information matrix
/// (10N x 10N, symmetric, at least semidefinite; an inverse covariance), with nominal parameters as a weak prior of a weight
/// in the same units: what the estimate does not determine comes from there. A nominal body that is not consistent is
/// made so first ([`made_consistent`]). Take what is attached to a body and known out of estimate and nominal before: the rest has
/// to be consistent on its own.
///
/// # Errors
/// If lengths differ, a value is not finite, the weight is not positive or the information has a negative direction.
pub fn project(
    estimate: &[f64],
    information: &[f64],
    nominal: &[f64],
    weight: f64,
) -> Result<Projection, Error> {
    let n = estimate.len();
    let length = |what, found, wanted| {
        Err(Error::Length {
            what,
            found,
            wanted,
        })
    };
    if n == 0 || !n.is_multiple_of(10) {
        return length("estimate", n, 10 * n.div_ceil(10).max(1));
    }
    if nominal.len() != n {
        return length("nominal parameters", nominal.len(), n);
    }
    if information.len() != n * n {
        return length("information", information.len(), n * n);
    }
    let value = |what, found, allowed| Error::Value {
        what,
        found,
        allowed,
    };
    let mut all = estimate.iter().chain(nominal).chain(information);
    if let Some(x) = all.find(|x| !x.is_finite()) {
        return Err(value(
            "a parameter or element of the information",
            *x,
            "finite",
        ));
    }
    if !(weight > 0.0 && weight.is_finite()) {
        return Err(value("weight of the prior", weight, "positive, finite"));
    }
    let problem = Problem::new(estimate, information, nominal);
    problem.solve(weight).ok_or_else(|| {
        value(
            "an eigenvalue of the information",
            -1.0,
            "0 or more, and all values of a size that can be computed",
        )
    })
}

/// Places of ten coordinates of a symmetric 4 x 4 matrix; off the diagonal with 1/√2, so that lengths are kept.
const PLACES: [(usize, usize); 10] = [
    (0, 0),
    (1, 1),
    (2, 2),
    (3, 3),
    (0, 1),
    (0, 2),
    (0, 3),
    (1, 2),
    (1, 3),
    (2, 3),
];

fn share(k: usize) -> f64 {
    if k < 4 {
        1.0
    } else {
        std::f64::consts::FRAC_1_SQRT_2
    }
}

/// The problem in coordinates x in which each nominal body is 1: `J = L (1 + X) Lᵀ`, with `J0 = L Lᵀ`.
struct Problem {
    bodies: usize,
    nominal: Vec<Parameters>,
    /// Parameters of the unit coordinates of each body, a row each.
    units: Vec<[Parameters; 10]>,
    /// `Tᵀ H T` and `Tᵀ H (nominal - estimate)`.
    curvature: Vec<f64>,
    slope: Vec<f64>,
    /// `(nominal - estimate)ᵀ H (nominal - estimate)`.
    offset: f64,
}

impl Problem {
    fn new(estimate: &[f64], information: &[f64], nominal: &[f64]) -> Self {
        let n = estimate.len();
        let nominal: Vec<Parameters> = nominal.as_chunks().0.iter().map(made_consistent).collect();
        let unit = |body: &Parameters| {
            let l = upper_factor(&pseudo_inertia(body)).unwrap_or_default();
            from_fn(|k| {
                let mut e = [[0.0; 4]; 4];
                let (r, c) = PLACES[k];
                (e[r][c], e[c][r]) = (share(k), share(k));
                // L e Lᵀ, e symmetric.
                let half: Matrix4 = times_transposed(&l, &e);
                of_pseudo_inertia(&times_transposed(&half, &l))
            })
        };
        let units: Vec<[Parameters; 10]> = nominal.iter().map(unit).collect();
        let gap: Vec<f64> = nominal
            .iter()
            .flatten()
            .zip(estimate)
            .map(|(a, b)| a - b)
            .collect();
        // H T, a column at a time; the symmetric part of H.
        let h = |i: usize, j: usize| 0.5 * (information[i * n + j] + information[j * n + i]);
        let mut product = vec![0.0; n * n];
        let mut force = vec![0.0; n];
        for i in 0..n {
            force[i] = (0..n).map(|j| h(i, j) * gap[j]).sum();
            for (body, units) in units.iter().enumerate() {
                for (k, unit) in units.iter().enumerate() {
                    let terms = unit
                        .iter()
                        .enumerate()
                        .map(|(j, u)| h(i, 10 * body + j) * u);
                    product[i * n + 10 * body + k] = terms.sum();
                }
            }
        }
        let (mut curvature, mut slope) = (vec![0.0; n * n], vec![0.0; n]);
        for (body, units) in units.iter().enumerate() {
            for (k, unit) in units.iter().enumerate() {
                let row = 10 * body + k;
                for (i, u) in unit.iter().enumerate() {
                    let from = 10 * body + i;
                    slope[row] += u * force[from];
                    for j in 0..n {
                        curvature[row * n + j] += u * product[from * n + j];
                    }
                }
            }
        }
        Self {
            bodies: units.len(),
            nominal,
            units,
            curvature,
            slope,
            offset: gap.iter().zip(&force).map(|(a, b)| a * b).sum(),
        }
    }

    /// The minimum at a weight; `None` if the curvature is not positive.
    fn solve(&self, weight: f64) -> Option<Projection> {
        let n = 10 * self.bodies;
        let trace: f64 = (0..n).map(|i| self.curvature[i * n + i]).sum();
        let mut stage = weight.max(trace);
        let mut steps = 0;
        let (mut x, mut converged) =
            self.minimum(vec![0.0; n], stage, stage <= weight, &mut steps)?;
        while stage > weight && steps < MOST_STEPS {
            let next = (stage * STAGE).max(weight);
            let Some(found) = self.minimum(x.clone(), next, next <= weight, &mut steps) else {
                break;
            };
            (x, converged) = found;
            stage = next;
        }
        Some(Projection {
            parameters: self.parameters(&x),
            misfit: self.misfit(&x).max(0.0),
            weight: stage,
            steps,
            converged,
        })
    }

    /// The minimum of a stage, near or close, and whether it was reached; `None` if rounding leaves no curvature.
    fn minimum(
        &self,
        mut x: Vec<f64>,
        weight: f64,
        last: bool,
        steps: &mut usize,
    ) -> Option<(Vec<f64>, bool)> {
        while *steps < MOST_STEPS {
            let (step, decrement) = self.newton(&x, weight)?;
            let reach = self.reach(&x, &step, decrement, weight);
            x.iter_mut()
                .zip(&step)
                .for_each(|(x, step)| *x += reach * step);
            *steps += 1;
            if decrement <= if last { CLOSE } else { NEAR } {
                return Some((x, true));
            }
        }
        Some((x, false))
    }

    /// Newton's step, and its decrement squared in units of the weight.
    fn newton(&self, x: &[f64], weight: f64) -> Option<(Vec<f64>, f64)> {
        let n = x.len();
        let mut hessian = self.curvature.clone();
        let mut step: Vec<f64> = (0..n)
            .map(|i| -self.slope[i] - product(&self.curvature[i * n..(i + 1) * n], x))
            .collect();
        for (body, x) in x.as_chunks::<10>().0.iter().enumerate() {
            let inverse = inverse(&matrix(x))?;
            for k in 0..10 {
                let (r, c) = PLACES[k];
                let trace = if k < 4 { 1.0 } else { 0.0 };
                step[10 * body + k] -= weight * (trace - 2.0 * half(k) * inverse[r][c]);
                for l in 0..10 {
                    let (p, q) = PLACES[l];
                    let both = inverse[r][p] * inverse[c][q] + inverse[r][q] * inverse[c][p];
                    let second = 2.0 * half(k) * half(l) * both;
                    hessian[(10 * body + k) * n + 10 * body + l] += weight * second;
                }
            }
        }
        let slope = step.clone();
        if !solve(&mut hessian, &mut step) {
            return None;
        }
        let decrement = product(&slope, &step) / weight;
        decrement.is_finite().then_some((step, decrement))
    }

    /// How much of a step is taken: it has to lower the cost, or be as short as is safe for any self-concordant cost.
    fn reach(&self, x: &[f64], step: &[f64], decrement: f64, weight: f64) -> f64 {
        let safe = 1.0 / (1.0 + libm::sqrt(decrement.max(0.0)));
        let before = self.cost(x, weight).unwrap_or(f64::INFINITY);
        let mut reach = 1.0;
        while reach > safe && decrement > CLOSE {
            let ahead: Vec<f64> = x
                .iter()
                .zip(step)
                .map(|(x, step)| x + reach * step)
                .collect();
            let promised = ARMIJO * reach * decrement * weight;
            if self
                .cost(&ahead, weight)
                .is_some_and(|cost| cost <= before - promised)
            {
                return reach;
            }
            reach = (0.5 * reach).max(safe);
        }
        reach
    }

    fn misfit(&self, x: &[f64]) -> f64 {
        let n = x.len();
        let rows = x.iter().enumerate();
        let quadratic: f64 = rows
            .map(|(i, xi)| xi * product(&self.curvature[i * n..(i + 1) * n], x))
            .sum();
        quadratic + 2.0 * product(&self.slope, x) + self.offset
    }

    /// The cost; `None` where a body is not consistent.
    fn cost(&self, x: &[f64], weight: f64) -> Option<f64> {
        let mut divergence = 0.0;
        for x in x.as_chunks::<10>().0 {
            let u = upper_factor(&matrix(x))?;
            let trace: f64 = x[..4].iter().sum();
            divergence += trace - 2.0 * (0..4).map(|i| libm::log(u[i][i])).sum::<f64>();
        }
        Some(0.5 * self.misfit(x) + weight * divergence)
    }

    fn parameters(&self, x: &[f64]) -> Vec<f64> {
        let bodies = self
            .nominal
            .iter()
            .zip(&self.units)
            .zip(x.as_chunks::<10>().0);
        bodies
            .flat_map(|((nominal, units), x)| -> Parameters {
                from_fn(|p| nominal[p] + units.iter().zip(x).map(|(u, x)| u[p] * x).sum::<f64>())
            })
            .collect()
    }
}

/// A unit coordinate is this times the sum of its element and the mirrored one.
fn half(k: usize) -> f64 {
    if k < 4 { 0.5 } else { share(k) }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `1 + X`.
fn matrix(x: &[f64; 10]) -> Matrix4 {
    let mut m = [[0.0; 4]; 4];
    for (k, (r, c)) in PLACES.into_iter().enumerate() {
        let element = share(k) * x[k] + if r == c { 1.0 } else { 0.0 };
        (m[r][c], m[c][r]) = (element, element);
    }
    m
}

/// Inverse of a positive definite matrix.
fn inverse(m: &Matrix4) -> Option<Matrix4> {
    let u = upper_factor(m)?;
    // Rows: columns of U⁻¹, by back substitution; M⁻¹ = U⁻ᵀ U⁻¹.
    let mut v = [[0.0; 4]; 4];
    for (c, v) in v.iter_mut().enumerate() {
        for r in (0..=c).rev() {
            let unit = if r == c { 1.0 } else { 0.0 };
            v[r] = (unit - product(&u[r][r + 1..], &v[r + 1..])) / u[r][r];
        }
    }
    Some(times_transposed(&v, &v))
}
