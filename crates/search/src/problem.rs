//! What is searched: a cost over a box, and what least squares needs of it.

use crate::bits;
use crate::bounds::Bounds;
use crate::points::Points;
use serde::{Deserialize, Serialize};

/// What is asked of each point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// The cost.
    Costs,
    /// The cost with `J^T r` and `J^T J`.
    Derivatives,
}

/// The record on which it is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fidelity {
    /// The whole record.
    Full,
    /// A shorter or thinner stand-in for it.
    Coarse,
}

/// A cost with what a Gauss-Newton step needs: for residuals `r` with Jacobian `J`, and any common
/// factor `c`, the cost `c r^T r`, the gradient `c J^T r` (half the slope of the cost) and the normal
/// matrix `c J^T J`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Derivatives {
    /// `c r^T r`.
    #[serde(with = "bits")]
    pub cost: f64,
    /// `c J^T r`, one number a dimension.
    #[serde(with = "bits")]
    pub gradient: Vec<f64>,
    /// `c J^T J`, row after row.
    #[serde(with = "bits")]
    pub normal: Vec<f64>,
}

impl Derivatives {
    /// Zeros, to be filled.
    pub fn zeros(dimensions: usize) -> Self {
        Self {
            cost: 0.0,
            gradient: vec![0.0; dimensions],
            normal: vec![0.0; dimensions * dimensions],
        }
    }
}

/// The problem offers costs only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CostsOnly;

/// A cost over a box. The answer to one point must not depend on which others are asked with it: a
/// run is split into batches by the caller's budget. A cost that is not finite counts as the worst.
pub trait Problem {
    /// The box.
    fn bounds(&self) -> &Bounds;

    /// The cost of each point.
    fn costs(&self, points: &Points, fidelity: Fidelity, costs: &mut [f64]);

    /// The cost of each point with its derivatives in the problem's own coordinates; `out` comes as
    /// zeros of the right size.
    fn derivatives(
        &self,
        points: &Points,
        fidelity: Fidelity,
        out: &mut [Derivatives],
    ) -> Result<(), CostsOnly> {
        let _ = (points, fidelity, out);
        Err(CostsOnly)
    }

    /// What a coarse evaluation costs in full ones, above 0 to 1. Without a coarse stand-in, 1: both
    /// fidelities are then the same.
    fn coarse_share(&self) -> f64 {
        1.0
    }
}
