//! The box that is searched.

use crate::bits;
use crate::error::Error;
use serde::{Deserialize, Serialize};

/// Most dimensions of a box.
pub const MOST_DIMENSIONS: usize = 64;

/// Lower and upper bounds, in whatever coordinates the problem chose; a logarithmic scale is left
/// to the problem. Internally every search works in the unit cube.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    #[serde(with = "bits")]
    low: Vec<f64>,
    #[serde(with = "bits")]
    high: Vec<f64>,
}

impl Bounds {
    /// A box of 1 to [`MOST_DIMENSIONS`] dimensions, each finite with `low <= high`.
    ///
    /// ```
    /// use stiction_search::Bounds;
    ///
    /// let bounds = Bounds::new(vec![0.0, -1.0], vec![1.0, 1.0])?;
    /// assert_eq!(bounds.dimensions(), 2);
    /// let wrong = Bounds::new(vec![2.0], vec![1.0]).unwrap_err();
    /// assert!(wrong.to_string().starts_with("box, dimension 0: 2.0 to 1.0; allowed"));
    /// # Ok::<(), stiction_search::Error>(())
    /// ```
    pub fn new(low: Vec<f64>, high: Vec<f64>) -> Result<Self, Error> {
        if low.len() != high.len() || low.is_empty() || low.len() > MOST_DIMENSIONS {
            return Err(Error::Dimensions {
                low: low.len(),
                high: high.len(),
                most: MOST_DIMENSIONS,
            });
        }
        for (dimension, (&low, &high)) in low.iter().zip(&high).enumerate() {
            if !(low.is_finite() && high.is_finite() && low <= high && (high - low).is_finite()) {
                return Err(Error::Bounds {
                    dimension,
                    low,
                    high,
                });
            }
        }
        Ok(Self { low, high })
    }

    /// How many dimensions.
    pub fn dimensions(&self) -> usize {
        self.low.len()
    }

    /// Lower bounds.
    pub fn low(&self) -> &[f64] {
        &self.low
    }

    /// Upper bounds.
    pub fn high(&self) -> &[f64] {
        &self.high
    }

    /// Width of one dimension.
    pub fn width(&self, i: usize) -> f64 {
        self.high[i] - self.low[i]
    }

    /// Whether a point lies inside, bounds included.
    pub fn contains(&self, point: &[f64]) -> bool {
        point.len() == self.low.len()
            && point
                .iter()
                .enumerate()
                .all(|(i, &x)| x >= self.low[i] && x <= self.high[i])
    }

    /// The point at a place in the unit cube.
    pub fn at(&self, unit: &[f64]) -> Vec<f64> {
        unit.iter()
            .enumerate()
            // The sum may round to beyond the bound.
            .map(|(i, u)| (self.low[i] + u * self.width(i)).clamp(self.low[i], self.high[i]))
            .collect()
    }
}
