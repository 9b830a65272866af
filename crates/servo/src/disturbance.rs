//! Forces on the axis that are neither friction nor the drive's.

use stiction_friction::ParamError;

/// Cogging, the force between a motor's teeth and magnets: a sine in position, `amplitude sin(2 pi x/pitch + phase)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cogging {
    /// >= 0, N (N m).
    pub amplitude: f64,
    /// > 0, m (rad).
    pub pitch: f64,
    /// rad
    pub phase: f64,
}

impl Cogging {
    /// Refuses numbers out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        ParamError::not_negative("cogging", self.amplitude)?;
        ParamError::positive("cogging_pitch", self.pitch)?;
        ParamError::finite("cogging_phase", self.phase)
    }

    /// The force on the axis at position `x`, m (rad), N (N m).
    pub fn force(&self, x: f64) -> f64 {
        let angle = 2.0 * std::f64::consts::PI * x / self.pitch + self.phase;
        self.amplitude * libm::sin(angle)
    }
}

/// A disturbing force on the axis: a constant from an instant on, and a sine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disturbance {
    /// N (N m), acting from `from` on: a cutting force, a weight.
    pub step: f64,
    /// s
    pub from: f64,
    /// >= 0, N (N m).
    pub amplitude: f64,
    /// >= 0, Hz.
    pub frequency: f64,
}

impl Disturbance {
    /// Refuses numbers out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        ParamError::finite("disturbance_step", self.step)?;
        ParamError::finite("disturbance_from", self.from)?;
        ParamError::not_negative("disturbance_amplitude", self.amplitude)?;
        ParamError::not_negative("disturbance_frequency", self.frequency)
    }

    /// The force on the axis at the instant `t`, s, N (N m).
    pub fn force(&self, t: f64) -> f64 {
        let step = if t >= self.from { self.step } else { 0.0 };
        let angle = 2.0 * std::f64::consts::PI * self.frequency * t;
        step + self.amplitude * libm::sin(angle)
    }
}
