//! Sine and chirp, both from a reversal at the origin.

use crate::path::Reference;
use crate::trajectory::Trajectory;
use stiction_friction::ParamError;

/// A whole turn, rad.
const TURN: f64 = 2.0 * std::f64::consts::PI;

/// `amplitude (1 - cos(2 pi frequency t))`: a sine that begins and ends at rest, at a reversal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine {
    amplitude: f64,
    omega: f64,
    duration: f64,
}

impl Sine {
    /// Amplitude >= 0, m (rad); frequency > 0, Hz; a number of cycles > 0.
    pub fn new(amplitude: f64, frequency: f64, cycles: f64) -> Result<Self, ParamError> {
        ParamError::not_negative("amplitude", amplitude)?;
        ParamError::positive("frequency", frequency)?;
        ParamError::positive("cycles", cycles)?;
        Ok(Sine {
            amplitude,
            omega: TURN * frequency,
            duration: cycles / frequency,
        })
    }
}

impl Trajectory for Sine {
    fn duration(&self) -> f64 {
        self.duration
    }

    #[inline]
    fn at(&self, t: f64) -> Reference {
        let omega = self.omega;
        let inside = t.clamp(0.0, self.duration);
        let (s, c) = libm::sincos(omega * inside);
        let moves = if inside == t { 1.0 } else { 0.0 };
        Reference {
            position: self.amplitude * (1.0 - c),
            velocity: moves * self.amplitude * omega * s,
            acceleration: moves * self.amplitude * omega * omega * c,
        }
    }
}

/// `amplitude (1 - cos phase(t))` with a frequency that rises linearly in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chirp {
    amplitude: f64,
    from: f64,
    to: f64,
    duration: f64,
}

impl Chirp {
    /// Amplitude >= 0, m (rad); frequencies > 0, Hz; duration > 0, s.
    pub fn new(amplitude: f64, from: f64, to: f64, duration: f64) -> Result<Self, ParamError> {
        ParamError::not_negative("amplitude", amplitude)?;
        ParamError::positive("from", from)?;
        ParamError::positive("to", to)?;
        ParamError::positive("duration", duration)?;
        Ok(Chirp {
            amplitude,
            from,
            to,
            duration,
        })
    }
}

impl Trajectory for Chirp {
    fn duration(&self) -> f64 {
        self.duration
    }

    fn at(&self, t: f64) -> Reference {
        let inside = t.clamp(0.0, self.duration);
        let rise = (self.to - self.from) / self.duration;
        let phase = TURN * (self.from + 0.5 * rise * inside) * inside;
        let omega = TURN * (self.from + rise * inside);
        let (s, c) = libm::sincos(phase);
        let moves = if inside == t { self.amplitude } else { 0.0 };
        Reference {
            position: self.amplitude * (1.0 - c),
            velocity: moves * omega * s,
            acceleration: moves * (omega * omega * c + TURN * rise * s),
        }
    }
}
