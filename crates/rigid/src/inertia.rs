//! Ten inertial parameters of a body.
//!
//! In the order of Pinocchio's `toDynamicParameters`: mass m in kg; first moments m cx, m cy, m cz in kg m; inertia about the
//! origin of the frame (not the centre of mass) xx, xy, yy, xz, yz, zz in kg m².

use crate::space::{Frame, Matrix, apply, product, transposed};
use crate::symmetric::eigenvalues;
use crate::urdf::{Inertial, Pose};
use std::array::from_fn;

/// Inertial parameters of a body in a frame.
pub type Parameters = [f64; 10];

/// Names of the parameters, in their order.
pub const NAMES: [&str; 10] = [
    "m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz",
];

/// Part of the sum of the principal moments by which they may miss the triangle inequality: rounding.
const TRIANGLE_ROUNDING: f64 = 1e-9;

fn matrix(i: &[f64]) -> Matrix<f64> {
    [[i[0], i[1], i[3]], [i[1], i[2], i[4]], [i[3], i[4], i[5]]]
}

fn packed(m: &Matrix<f64>) -> [f64; 6] {
    [m[0][0], m[0][1], m[1][1], m[0][2], m[1][2], m[2][2]]
}

/// Sum of two bodies' parameters in one frame.
pub fn sum(a: &Parameters, b: &Parameters) -> Parameters {
    from_fn(|i| a[i] + b[i])
}

/// Difference of two bodies' parameters in one frame.
pub fn difference(a: &Parameters, b: &Parameters) -> Parameters {
    from_fn(|i| a[i] - b[i])
}

/// Parameters of a point mass, kg, at a place, m.
pub fn point_mass(mass: f64, at: [f64; 3]) -> Parameters {
    let [x, y, z] = at;
    let second = [
        y * y + z * z,
        -x * y,
        x * x + z * z,
        -x * z,
        -y * z,
        x * x + y * y,
    ];
    from_fn(|i| match i {
        0 => mass,
        1..4 => mass * at[i - 1],
        _ => mass * second[i - 4],
    })
}

/// Parameters of an `<inertial>` in the frame of its link.
pub fn of_inertial(inertial: &Inertial) -> Parameters {
    let r = Frame::of(&inertial.origin).rotation;
    let turned = product(&product(&r, &matrix(&inertial.inertia)), &transposed(&r));
    let mut p = point_mass(inertial.mass, inertial.origin.xyz);
    for (p, i) in p[4..].iter_mut().zip(packed(&turned)) {
        *p += i;
    }
    p
}

/// `<inertial>` of parameters in the frame of a link, with the directions of that frame; `None` without mass.
pub fn to_inertial(parameters: &Parameters, line: usize) -> Option<Inertial> {
    let mass = parameters[0];
    let xyz = from_fn(|i| parameters[1 + i] / mass);
    let point = point_mass(mass, xyz);
    (mass > 0.0).then(|| Inertial {
        mass,
        origin: Pose { xyz, rpy: [0.0; 3] },
        inertia: from_fn(|i| parameters[4 + i] - point[4 + i]),
        line,
    })
}

/// The same body in the frame that its frame is in.
pub fn moved(parameters: &Parameters, frame: &Frame) -> Parameters {
    let r = &frame.rotation;
    let d = frame.translation;
    let mass = parameters[0];
    let h = apply(r, [parameters[1], parameters[2], parameters[3]]);
    let about = product(&product(r, &matrix(&parameters[4..])), &transposed(r));
    // With c the centre of mass: |c + d|² 1 - (c + d)(c + d)ᵀ without the part of c alone.
    let hd = h[0] * d[0] + h[1] * d[1] + h[2] * d[2];
    let dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    let shifted: Matrix<f64> = from_fn(|i| {
        from_fn(|j| {
            let diagonal = if i == j { 2.0 * hd + mass * dd } else { 0.0 };
            about[i][j] + diagonal - h[i] * d[j] - d[i] * h[j] - mass * d[i] * d[j]
        })
    });
    let i = packed(&shifted);
    from_fn(|k| match k {
        0 => mass,
        1..4 => h[k - 1] + mass * d[k - 1],
        _ => i[k - 4],
    })
}

/// Principal moments of inertia of 6 moments (xx, xy, yy, xz, yz, zz), smallest first.
pub fn principal_moments(inertia: &[f64; 6]) -> [f64; 3] {
    eigenvalues(matrix(inertia))
}

/// Whether a body of some size can have these principal moments: all positive, none larger than the sum of the others.
pub(crate) fn possible(principal: [f64; 3]) -> bool {
    let [a, b, c] = principal;
    a > 0.0 && c - a - b <= TRIANGLE_ROUNDING * (a + b + c)
}
