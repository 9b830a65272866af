//! The position sensor.

use stiction_friction::ParamError;

/// An incremental encoder without error other than its steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    resolution: f64,
    phase: f64,
}

impl Encoder {
    /// `resolution` in m (rad) per count after interpolation, finite and >= 0; 0 reads exactly.
    pub fn new(resolution: f64) -> Result<Self, ParamError> {
        ParamError::not_negative("resolution", resolution)?;
        Ok(Encoder {
            resolution,
            phase: 0.0,
        })
    }

    /// The same encoder with its counts moved by `phase` of a step, so that the origin of the axis no
    /// longer stands in the middle of one: any finite number, 0 to 1 covers all there is.
    pub fn with_phase(self, phase: f64) -> Result<Self, ParamError> {
        if !phase.is_finite() {
            return Err(ParamError::new("phase", phase, "finite"));
        }
        Ok(Encoder { phase, ..self })
    }

    /// m (rad) per count; 0 if it reads exactly.
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// The position read at the true `position`, m (rad): that of the nearest count.
    #[inline]
    pub fn read(&self, position: f64) -> f64 {
        if self.resolution == 0.0 {
            return position;
        }
        let count = libm::floor(position / self.resolution + self.phase + 0.5);
        self.resolution * (count - self.phase)
    }
}
