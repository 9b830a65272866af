//! The position sensor.

use stiction_friction::ParamError;

/// An incremental encoder without error other than its steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    resolution: f64,
}

impl Encoder {
    /// `resolution` in m (rad) per count after interpolation, finite and >= 0; 0 reads exactly.
    pub fn new(resolution: f64) -> Result<Self, ParamError> {
        ParamError::not_negative("resolution", resolution)?;
        Ok(Encoder { resolution })
    }

    /// m (rad) per count; 0 if it reads exactly.
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// The position read at the true `position`, m (rad): the nearest count.
    pub fn read(&self, position: f64) -> f64 {
        if self.resolution == 0.0 {
            return position;
        }
        self.resolution * libm::floor(position / self.resolution + 0.5)
    }
}
