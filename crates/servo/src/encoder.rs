//! The position sensor.

use stiction_friction::ParamError;

/// An incremental encoder with no error but its quantisation.
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

    /// The same encoder with its counts shifted by `phase` of a step, so that the origin of the axis is no
    /// longer in the middle of a step: any finite number, 0 to 1 covers all cases.
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
