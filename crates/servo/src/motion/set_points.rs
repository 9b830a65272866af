//! Recorded set points as a reference.

use crate::path::Reference;
use crate::trajectory::Trajectory;
use stiction_friction::ParamError;

/// Positions at a fixed rate with a cubic spline through them (Catmull and Rom: the slope at a point is that of the chord
/// of its neighbours), so that the velocity is continuous. Starts and ends at rest; positions count from the first.
#[derive(Clone, Debug, PartialEq)]
pub struct SetPoints {
    rate: f64,
    positions: Vec<f64>,
}

impl SetPoints {
    /// At least two positions, m (rad), all finite, at `rate` > 0, Hz.
    pub fn new(rate: f64, positions: Vec<f64>) -> Result<Self, ParamError> {
        ParamError::positive("rate", rate)?;
        if positions.len() < 2 {
            let found = positions.len() as f64;
            return Err(ParamError::new("set_points", found, "at least two"));
        }
        for &position in &positions {
            ParamError::finite("set_point", position)?;
        }
        Ok(SetPoints { rate, positions })
    }

    /// Slope at a point, m (rad) a sample.
    fn slope(&self, i: usize) -> f64 {
        let last = self.positions.len() - 1;
        if i == 0 || i == last {
            return 0.0;
        }
        0.5 * (self.positions[i + 1] - self.positions[i - 1])
    }
}

impl Trajectory for SetPoints {
    fn duration(&self) -> f64 {
        (self.positions.len() - 1) as f64 / self.rate
    }

    fn at(&self, t: f64) -> Reference {
        let origin = self.positions[0];
        let last = self.positions.len() - 1;
        let at = t * self.rate;
        if at.is_nan() || at <= 0.0 {
            return Reference::default();
        }
        if at >= last as f64 {
            return Reference {
                position: self.positions[last] - origin,
                ..Reference::default()
            };
        }
        let i = (at as usize).min(last - 1);
        let x = at - i as f64;
        let (p, q) = (self.positions[i], self.positions[i + 1]);
        let (m, n) = (self.slope(i), self.slope(i + 1));
        // Hermite: p + m x + c x^2 + d x^3.
        let c = 3.0 * (q - p) - 2.0 * m - n;
        let d = 2.0 * (p - q) + m + n;
        Reference {
            position: p - origin + x * (m + x * (c + x * d)),
            velocity: self.rate * (m + x * (2.0 * c + x * 3.0 * d)),
            acceleration: self.rate * self.rate * (2.0 * c + x * 6.0 * d),
        }
    }
}
