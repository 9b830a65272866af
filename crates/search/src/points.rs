//! Points of a box, one a row.

use crate::bits;
use serde::{Deserialize, Serialize};

/// Points, stored one after the other.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Points {
    dimensions: usize,
    #[serde(with = "bits")]
    values: Vec<f64>,
}

impl Points {
    /// No points yet, of a box with `dimensions` dimensions.
    pub fn new(dimensions: usize) -> Self {
        Self {
            dimensions,
            values: Vec::new(),
        }
    }

    /// Numbers a point has.
    pub fn dimensions(&self) -> usize {
        self.dimensions
    }

    /// How many points.
    pub fn len(&self) -> usize {
        self.values.len() / self.dimensions.max(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// One point.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.dimensions..(i + 1) * self.dimensions]
    }

    /// All points, in order.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.dimensions.max(1))
    }

    /// Adds a point, which must have as many numbers as there are dimensions.
    pub fn push(&mut self, point: &[f64]) {
        debug_assert_eq!(point.len(), self.dimensions);
        self.values.extend_from_slice(point);
    }

    /// One point, to be moved.
    pub(crate) fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.values[i * self.dimensions..(i + 1) * self.dimensions]
    }
}
