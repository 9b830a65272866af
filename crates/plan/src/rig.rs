//! What moves the axis and what reads it.

use stiction_friction::ParamError;
use stiction_servo::cascade::Cascade;

/// Drive, controller and encoder as far as a plan has to know them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rig {
    /// Rate of the log, > 0, Hz.
    pub rate: f64,
    /// One encoder step, >= 0, m (rad).
    pub encoder_step: f64,
    /// Standard deviation of the noise of a logged force, > 0, N (N m).
    pub force_noise: f64,
    /// The controller.
    pub loop_: Loop,
}

/// A cascade of P in position around PI in speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loop {
    /// Tuned to a bandwidth of its speed loop, > 0, Hz, on whatever the mass is.
    Tuned(f64),
    /// With these gains, and a part of the reference velocity, 0 to 1, that is fed forward; `force_limit` is one more limit.
    Gains(Cascade, f64),
}

/// Control periods in the period of the bandwidth, at least.
const CONTROL_PER_PERIOD: f64 = 20.0;
/// Most control periods in one of the log.
const MOST_PERIODS: f64 = 64.0;

impl Rig {
    /// Refuses numbers out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        ParamError::positive("rate", self.rate)?;
        ParamError::not_negative("resolution", self.encoder_step)?;
        ParamError::positive("force_noise", self.force_noise)?;
        match self.loop_ {
            Loop::Tuned(bandwidth) => ParamError::positive("bandwidth", bandwidth)?,
            Loop::Gains(cascade, _) => cascade.validate()?,
        }
        if CONTROL_PER_PERIOD * self.bandwidth() > MOST_PERIODS * self.rate {
            let allowed = "at most 3.2 times the rate of the log";
            return Err(ParamError::new("bandwidth", self.bandwidth(), allowed));
        }
        Ok(())
    }

    /// Bandwidth of the speed loop, Hz; with gains that of the position loop times four, as a cascade is usually tuned.
    pub fn bandwidth(&self) -> f64 {
        match self.loop_ {
            Loop::Tuned(bandwidth) => bandwidth,
            Loop::Gains(cascade, _) => 4.0 * cascade.position_gain / std::f64::consts::TAU,
        }
    }

    /// The controller on an axis of this mass, kg (kg m^2), with the largest force, N (N m).
    pub(crate) fn cascade(&self, mass: f64, force_limit: f64) -> Result<Cascade, ParamError> {
        match self.loop_ {
            Loop::Tuned(bandwidth) => Cascade::tuned(mass, bandwidth, force_limit),
            Loop::Gains(cascade, _) => Ok(Cascade {
                force_limit: force_limit.min(cascade.force_limit),
                ..cascade
            }),
        }
    }

    /// Part of the reference velocity that is fed forward.
    pub(crate) fn velocity_feedforward(&self) -> f64 {
        match self.loop_ {
            Loop::Tuned(_) => 1.0,
            Loop::Gains(_, part) => part,
        }
    }

    /// Whether it follows with all of velocity and acceleration fed forward, as gains that are tuned are taken to.
    pub fn has_full_feedforward(&self) -> bool {
        matches!(self.loop_, Loop::Tuned(_))
    }

    /// Control periods in one of the log: a log may be slower than the loop.
    pub fn periods(&self) -> usize {
        libm::ceil(CONTROL_PER_PERIOD * self.bandwidth() / self.rate).clamp(1.0, MOST_PERIODS)
            as usize
    }
}
