//! Forces on the axis that are neither friction nor the drive's.

use std::sync::Arc;
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

/// A disturbing force on the axis over time.
#[derive(Clone, Debug, PartialEq)]
pub enum Disturbance {
    /// Always the same, N (N m): a weight.
    Constant(f64),
    /// `amplitude sin(2 pi frequency t + phase)`: an imbalance.
    Sine {
        /// N (N m)
        amplitude: f64,
        /// >= 0, Hz.
        frequency: f64,
        /// rad
        phase: f64,
    },
    /// As it was recorded: a cutting force.
    Recorded(Recorded),
}

/// Forces at given times: straight lines between them, the first force before and the last one after them. A clone shares
/// the values.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    times: Arc<[f64]>,
    forces: Arc<[f64]>,
}

impl Recorded {
    /// At least one force, N (N m), finite, at as many ascending times, s.
    pub fn new(times: Vec<f64>, forces: Vec<f64>) -> Result<Self, ParamError> {
        if times.is_empty() || times.len() != forces.len() {
            let found = times.len() as f64;
            return Err(ParamError::new(
                "times",
                found,
                "one for each force, and at least one",
            ));
        }
        for (&time, &force) in times.iter().zip(&forces) {
            ParamError::finite("time", time)?;
            ParamError::finite("disturbance", force)?;
        }
        match times.windows(2).find(|pair| pair[1] <= pair[0]) {
            Some(pair) => Err(ParamError::new(
                "time",
                pair[1],
                "later than the one before",
            )),
            None => Ok(Recorded {
                times: times.into(),
                forces: forces.into(),
            }),
        }
    }

    fn force(&self, t: f64) -> f64 {
        let (times, forces) = (&self.times, &self.forces);
        match times.partition_point(|at| *at <= t) {
            0 => forces[0],
            n if n == times.len() => forces[n - 1],
            n => {
                let part = (t - times[n - 1]) / (times[n] - times[n - 1]);
                forces[n - 1] + part * (forces[n] - forces[n - 1])
            }
        }
    }
}

impl Disturbance {
    /// Refuses numbers out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        match *self {
            Disturbance::Constant(force) => ParamError::finite("disturbance", force),
            Disturbance::Sine {
                amplitude,
                frequency,
                phase,
            } => {
                ParamError::finite("disturbance_amplitude", amplitude)?;
                ParamError::not_negative("disturbance_frequency", frequency)?;
                ParamError::finite("disturbance_phase", phase)
            }
            Disturbance::Recorded(_) => Ok(()),
        }
    }

    /// The force on the axis at the instant `t`, s, N (N m).
    pub fn force(&self, t: f64) -> f64 {
        match self {
            Disturbance::Constant(force) => *force,
            Disturbance::Sine {
                amplitude,
                frequency,
                phase,
            } => amplitude * libm::sin(2.0 * std::f64::consts::PI * frequency * t + phase),
            Disturbance::Recorded(recorded) => recorded.force(t),
        }
    }
}
