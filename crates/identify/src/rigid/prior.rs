//! What is known of the inertial parameters before a log: those of the URDF, within the scatter of such numbers.

use nalgebra::{DMatrix, DVector, Matrix4};
use std::array::from_fn;
use stiction_rigid::{Robot, consistency};

/// Standard deviation of what a URDF has, as a distance of mass distributions: about the part by which a mass or an extent is
/// off. Source: chosen on the UR10 and the Panda, flat from .3 to 2.
const DEVIATION: f64 = 0.5;
/// Least mass of a body, as a part of the robot's, where its URDF has less: a placeholder that nobody measured. Source: choice.
const LEAST_MASS: f64 = 0.01;
/// Least extent of a body, as a part of the length of its link. Source: choice.
const LEAST_EXTENT: f64 = 0.1;
/// Least length of a link, as a part of the mean of those that have one. Source: choice.
const LEAST_LENGTH: f64 = 0.2;

/// Inertial parameters with the inverse of their covariance.
///
/// The distance is that of mass distributions, invariant of units and frames: the affine-invariant metric of the pseudo-inertia at the
/// parameters of the URDF (Lee, Wensing and Park 2020, doi 10.1109/TRO.2019.2950721).
#[derive(Clone, Debug)]
pub struct Prior {
    /// The parameters, ten for each body.
    pub parameters: DVector<f64>,
    /// The inverse of their covariance.
    pub information: DMatrix<f64>,
}

impl Prior {
    /// That of the URDF of a robot.
    pub fn of(robot: &Robot) -> Self {
        let parameters = robot.parameters();
        let (ten, _) = parameters.as_chunks::<10>();
        let total: f64 = ten.iter().map(|p| p[0]).sum();
        let lengths = lengths(robot);
        let size = parameters.len();
        let mut information = DMatrix::zeros(size, size);
        for (body, p) in ten.iter().enumerate() {
            let mass = p[0].max(LEAST_MASS * total);
            let extent = mass * (LEAST_EXTENT * lengths[body]).powi(2);
            let mut pseudo = pseudo_inertia(p);
            for i in 0..3 {
                pseudo[(i, i)] += extent;
            }
            pseudo[(3, 3)] += mass - p[0];
            let metric = metric(&pseudo);
            for (i, row) in metric.iter().enumerate() {
                for (j, x) in row.iter().enumerate() {
                    information[(10 * body + i, 10 * body + j)] = x / (DEVIATION * DEVIATION);
                }
            }
        }
        Self {
            parameters: DVector::from_vec(parameters),
            information,
        }
    }
}

/// Lengths of the links from joint to joint, m.
fn lengths(robot: &Robot) -> Vec<f64> {
    let mut lengths = vec![0.0_f64; robot.len()];
    for joint in robot.joints() {
        let [x, y, z] = joint.frame.translation;
        if let Some(parent) = joint.parent {
            lengths[parent] = lengths[parent].max((x * x + y * y + z * z).sqrt());
        }
    }
    let known: Vec<f64> = lengths.iter().copied().filter(|x| *x > 0.0).collect();
    let mean = match known.len() {
        0 => 1.0,
        count => known.iter().sum::<f64>() / count as f64,
    };
    lengths.iter().map(|x| x.max(LEAST_LENGTH * mean)).collect()
}

/// The pseudo-inertia of ten parameters.
fn pseudo_inertia(p: &[f64; 10]) -> Matrix4<f64> {
    let rows = consistency::pseudo_inertia(p);
    Matrix4::from_fn(|i, j| rows[i][j])
}

/// The metric at a pseudo-inertia by the ten parameters: half the trace of the product of relative changes. Where the inertia is
/// none of a body, of the nearest one.
fn metric(pseudo: &Matrix4<f64>) -> [[f64; 10]; 10] {
    /// Eigenvalues at least, as a part of the largest.
    const LEAST: f64 = 1e-6;
    let eigen = pseudo.symmetric_eigen();
    let most = eigen.eigenvalues.max().max(f64::MIN_POSITIVE);
    let inverse = eigen.eigenvalues.map(|x| 1.0 / x.max(LEAST * most));
    let inverse =
        eigen.eigenvectors * Matrix4::from_diagonal(&inverse) * eigen.eigenvectors.transpose();
    let changes: [Matrix4<f64>; 10] = from_fn(|k| {
        let unit: [f64; 10] = from_fn(|i| f64::from(u8::from(i == k)));
        inverse * pseudo_inertia(&unit)
    });
    from_fn(|i| from_fn(|j| 0.5 * (changes[i] * changes[j]).trace()))
}
