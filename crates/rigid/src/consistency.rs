//! Physical consistency: whether any distribution of mass has ten given parameters.
//!
//! It is so exactly if the pseudo-inertia matrix is positive definite (Wensing, Kim and Slotine 2018, *Linear matrix
//! inequalities for physically-consistent inertial parameter identification*, doi:10.1109/LRA.2017.2729659). The log-Cholesky
//! coordinates reach all such parameters and no others (Rucker and Wensing 2022, *Smooth parameterization of rigid-body
//! inertia*, doi:10.1109/LRA.2022.3144517).

use crate::inertia::Parameters;
use crate::symmetric::{eigen, eigenvalues};
use std::array::from_fn;

/// Length by which moments are compared with masses, m.
const SIZE: f64 = 0.1;
/// Least eigenvalue given to a pseudo-inertia that has none or a negative one: part of the mass, and kg, with [`SIZE`] as the
/// unit of length.
const LEAST_PART: f64 = 1e-3;
const LEAST_MASS: f64 = 1e-4;

/// A symmetric matrix of 4 x 4, by rows.
pub type Matrix4 = [[f64; 4]; 4];

/// Pseudo-inertia of parameters: second moments of the mass distribution (kg m²), first moments (kg m) and mass (kg).
pub fn pseudo_inertia(parameters: &Parameters) -> Matrix4 {
    let [m, x, y, z, xx, xy, yy, xz, yz, zz] = *parameters;
    let half = 0.5 * (xx + yy + zz);
    [
        [half - xx, -xy, -xz, x],
        [-xy, half - yy, -yz, y],
        [-xz, -yz, half - zz, z],
        [x, y, z, m],
    ]
}

/// Parameters of a pseudo-inertia.
pub fn of_pseudo_inertia(j: &Matrix4) -> Parameters {
    let (xx, yy, zz) = (j[0][0], j[1][1], j[2][2]);
    [
        j[3][3],
        j[0][3],
        j[1][3],
        j[2][3],
        yy + zz,
        -j[0][1],
        xx + zz,
        -j[0][2],
        -j[1][2],
        xx + yy,
    ]
}

/// Smallest eigenvalue of the pseudo-inertia with lengths in units of 0.1 m, kg: positive exactly for consistent parameters.
pub fn smallest_eigenvalue(parameters: &Parameters) -> f64 {
    eigenvalues(scaled(parameters))[0]
}

/// Whether a body can have the parameters.
pub fn is_consistent(parameters: &Parameters) -> bool {
    upper_factor(&pseudo_inertia(parameters)).is_some()
}

/// The parameters if they are consistent; else such of a body near them: eigenvalues of the pseudo-inertia that are too small
/// are raised to a thousandth of the mass, or 0.1 g if that is more, with 0.1 m as unit of length.
pub fn made_consistent(parameters: &Parameters) -> Parameters {
    if is_consistent(parameters) {
        return *parameters;
    }
    let (values, vectors) = eigen(scaled(parameters));
    let least = (LEAST_PART * parameters[0]).max(LEAST_MASS);
    let raised = values.map(|x| x.max(least));
    let element = |i: usize, j: usize| -> f64 {
        let sum = (0..4).map(|k| vectors[i][k] * raised[k] * vectors[j][k]);
        sum.sum::<f64>() * length(i) * length(j)
    };
    of_pseudo_inertia(&from_fn(|i| from_fn(|j| element(i.min(j), i.max(j)))))
}

/// Unit of a row of the pseudo-inertia.
fn length(row: usize) -> f64 {
    if row < 3 { SIZE } else { 1.0 }
}

fn scaled(parameters: &Parameters) -> Matrix4 {
    let j = pseudo_inertia(parameters);
    from_fn(|r| from_fn(|c| j[r][c] / (length(r) * length(c))))
}

/// The upper triangular U with `j = U Uᵀ` and a positive diagonal, if j is positive definite.
pub(crate) fn upper_factor(j: &Matrix4) -> Option<Matrix4> {
    let mut u = [[0.0; 4]; 4];
    for c in (0..4).rev() {
        for r in (0..=c).rev() {
            let sum: f64 = (c + 1..4).map(|k| u[r][k] * u[c][k]).sum();
            let rest = j[r][c] - sum;
            if r < c {
                u[r][c] = rest / u[c][c];
            } else if rest > 0.0 && rest < f64::INFINITY {
                u[c][c] = libm::sqrt(rest);
            } else {
                return None;
            }
        }
    }
    Some(u)
}

/// Where each log-Cholesky coordinate after the first is in the factor: d1, d2, d3, s12, s23, s13, t1, t2, t3.
const PLACES: [(usize, usize); 9] = [
    (0, 0),
    (1, 1),
    (2, 2),
    (0, 1),
    (1, 2),
    (0, 2),
    (0, 3),
    (1, 3),
    (2, 3),
];

/// The factor of log-Cholesky coordinates.
fn factor(theta: &[f64; 10]) -> Matrix4 {
    let whole = libm::exp(theta[0]);
    let mut u = [[0.0; 4]; 4];
    u[3][3] = whole;
    for ((r, c), x) in PLACES.into_iter().zip(&theta[1..]) {
        u[r][c] = whole * if r == c { libm::exp(*x) } else { *x };
    }
    u
}

/// `a bᵀ`.
pub(crate) fn times_transposed(a: &Matrix4, b: &Matrix4) -> Matrix4 {
    from_fn(|i| from_fn(|j| (0..4).map(|k| a[i][k] * b[j][k]).sum()))
}

/// Consistent parameters of log-Cholesky coordinates (alpha, d1, d2, d3, s12, s23, s13, t1, t2, t3), which may be any numbers.
pub fn of_log_cholesky(theta: &[f64; 10]) -> Parameters {
    let u = factor(theta);
    of_pseudo_inertia(&times_transposed(&u, &u))
}

/// Log-Cholesky coordinates of parameters, if these are consistent.
pub fn log_cholesky(parameters: &Parameters) -> Option<[f64; 10]> {
    let u = upper_factor(&pseudo_inertia(parameters))?;
    let whole = u[3][3];
    let mut theta = [libm::log(whole); 10];
    for ((r, c), x) in PLACES.into_iter().zip(&mut theta[1..]) {
        let ratio = u[r][c] / whole;
        *x = if r == c { libm::log(ratio) } else { ratio };
    }
    Some(theta)
}

/// Derivatives of the parameters (rows) with respect to log-Cholesky coordinates (columns).
pub fn log_cholesky_jacobian(theta: &[f64; 10]) -> [[f64; 10]; 10] {
    let u = factor(theta);
    let mut jacobian = [[0.0; 10]; 10];
    for column in 0..10 {
        let mut change = [[0.0; 4]; 4];
        if column == 0 {
            change = u;
        } else {
            let (r, c) = PLACES[column - 1];
            change[r][c] = if r == c { u[r][c] } else { u[3][3] };
        }
        let half = times_transposed(&change, &u);
        let parameters = of_pseudo_inertia(&from_fn(|i| from_fn(|j| half[i][j] + half[j][i])));
        for (row, x) in jacobian.iter_mut().zip(parameters) {
            row[column] = x;
        }
    }
    jacobian
}
