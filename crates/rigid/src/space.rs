//! Vectors, rotations and frames in three dimensions.

use crate::scalar::Scalar;
use crate::urdf::Pose;
use std::array::from_fn;

/// A vector.
pub(crate) type Vector<T> = [T; 3];
/// A matrix of 3 x 3, by rows.
pub(crate) type Matrix<T> = [[T; 3]; 3];

pub(crate) const IDENTITY: Matrix<f64> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

#[inline]
pub(crate) fn add<T: Scalar>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline]
pub(crate) fn scale<T: Scalar>(a: Vector<T>, s: T) -> Vector<T> {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline]
pub(crate) fn dot<T: Scalar>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub(crate) fn cross<T: Scalar>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `m v`.
#[inline]
pub(crate) fn apply<T: Scalar>(m: &Matrix<T>, v: Vector<T>) -> Vector<T> {
    [dot(m[0], v), dot(m[1], v), dot(m[2], v)]
}

/// `mᵀ v`.
#[inline]
pub(crate) fn apply_transposed<T: Scalar>(m: &Matrix<T>, v: Vector<T>) -> Vector<T> {
    add(add(scale(m[0], v[0]), scale(m[1], v[1])), scale(m[2], v[2]))
}

pub(crate) fn transposed(m: &Matrix<f64>) -> Matrix<f64> {
    from_fn(|i| from_fn(|j| m[j][i]))
}

pub(crate) fn product(a: &Matrix<f64>, b: &Matrix<f64>) -> Matrix<f64> {
    from_fn(|i| apply_transposed(b, a[i]))
}

/// A frame in another one: a point `p` of it is `rotation p + translation` there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Its directions x, y and z as columns.
    pub rotation: [[f64; 3]; 3],
    /// Its origin, m.
    pub translation: [f64; 3],
}

impl Frame {
    /// The frame itself.
    pub const IDENTITY: Self = Self {
        rotation: IDENTITY,
        translation: [0.0; 3],
    };

    /// The frame of a pose: turned about fixed x by roll, then y by pitch, then z by yaw.
    pub fn of(pose: &Pose) -> Self {
        let [(sr, cr), (sp, cp), (sy, cy)] = pose.rpy.map(libm::sincos);
        Self {
            rotation: [
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ],
            translation: pose.xyz,
        }
    }

    /// A frame that is in this one, in the frame that this one is in.
    pub fn of_inner(&self, inner: &Self) -> Self {
        Self {
            rotation: product(&self.rotation, &inner.rotation),
            translation: self.point(inner.translation),
        }
    }

    /// A point of this frame in the frame that this one is in.
    pub fn point(&self, p: [f64; 3]) -> [f64; 3] {
        add(apply(&self.rotation, p), self.translation)
    }

    /// The outer frame in this one.
    pub fn inverse(&self) -> Self {
        let back = apply_transposed(&self.rotation, self.translation);
        Self {
            rotation: transposed(&self.rotation),
            translation: scale(back, -1.0),
        }
    }
}
