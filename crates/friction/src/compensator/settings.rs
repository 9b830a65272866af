//! Settings and limits of a compensator.

use super::{Adaptation, Friction, Watchdog};
use crate::error::require;
use crate::{ParamError, Real};

/// Time in which the force may go from 0 to the usual limit, s.
const SLEW_TIME: f64 = 2e-3;

/// Settings of a compensator, immutable while it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<T> {
    /// Time between two calls, > 0, s.
    pub cycle_time: T,
    /// Share of the friction that is compensated, 0 to 1.
    pub gain: T,
    /// Speeds up to this count as standstill, >= 0, m/s (rad/s): bristles keep their deflection, a law without them gives its
    /// force at rest. For measured velocities, which are never quite 0, half an encoder step per cycle is enough.
    pub dead_zone: T,
    /// Largest force either way, > 0, N (N m).
    pub limit: T,
    /// Fastest change of the force, > 0, N/s (N m/s); the largest finite number of the type means no limit.
    pub slew: T,
    /// Time in which the share of the friction force that is passed on goes from 0 to 1, >= 0, s. This ramp applies
    /// when the compensation is enabled, when it is disabled and when the gain changes.
    pub ramp: T,
    /// Correction of the friction level while running.
    pub adaptation: Option<Adaptation<T>>,
    /// Switches the compensation off where it makes tracking worse.
    pub watchdog: Option<Watchdog<T>>,
}

impl<T: Real> Settings<T> {
    /// Settings to start with, for a cycle time (s) and a largest force (N, N m): gain .75, no dead zone, no slew limit, a
    /// ramp of 50 ms, the watchdog on. On a machine: [`for_law`](Self::for_law).
    ///
    /// With a gain of .75 even parameters that are 30 % too large undercompensate. That is the safe side: a force above
    /// the actual friction sets an axis in motion that should stand, and where the loop is slow compared with the
    /// motion tracking is then worse than without. With parameters known to a few percent take 1 (decision 0020).
    pub fn new(cycle_time: T, limit: T) -> Self {
        Settings {
            cycle_time,
            gain: T::from_f64(0.75),
            dead_zone: T::ZERO,
            limit,
            slew: T::MAX,
            ramp: T::from_f64(0.05),
            adaptation: None,
            watchdog: Some(Watchdog::default()),
        }
    }

    /// Settings to start with on a machine (decision 0067): as [`new`](Self::new), with a limit of twice the largest force at
    /// standstill, which leaves room for the viscous part; a slew limit that reaches it within 2 ms; and for a law
    /// without bristles a dead zone.
    ///
    /// 2 ms is the time constant of a speed loop of 80 Hz: a jump of the reference becomes a force that the loop can follow,
    /// and the bristles of an axis bend no faster up to 10 m/s^2. The dead zone is a hundredth of the Stribeck velocity, at which
    /// the law still is at its static level; without a Stribeck velocity 1e-5 m/s (rad/s). Without it a set speed that is
    /// nothing but rounding would get the whole friction force, now this way and now that.
    pub fn for_law(friction: &Friction<T>, cycle_time: T) -> Self {
        let limit = friction.usual_limit();
        Settings {
            dead_zone: friction.usual_dead_zone(),
            ..Self::new(cycle_time, limit).reaching(limit)
        }
    }

    /// The same with another limit, and the slew limit that goes with it.
    #[must_use]
    pub fn reaching(self, limit: T) -> Self {
        let slew = limit / T::from_f64(SLEW_TIME);
        Settings {
            limit,
            slew: if slew > T::ZERO && slew.is_finite() {
                slew
            } else {
                T::MAX
            },
            ..self
        }
    }

    /// The full force at once, with no limit but `limit`: for studies with exact parameters.
    pub fn bare(cycle_time: T, limit: T) -> Self {
        Settings {
            gain: T::ONE,
            ramp: T::ZERO,
            watchdog: None,
            ..Self::new(cycle_time, limit)
        }
    }

    /// Refuses settings out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        ParamError::positive("cycle_time", self.cycle_time)?;
        Self::check_gain(self.gain)?;
        ParamError::not_negative("dead_zone", self.dead_zone)?;
        ParamError::positive("limit", self.limit)?;
        ParamError::positive("slew", self.slew)?;
        ParamError::not_negative("ramp", self.ramp)?;
        if let Some(adaptation) = &self.adaptation {
            adaptation.validate()?;
        }
        match &self.watchdog {
            Some(watchdog) => watchdog.validate(),
            None => Ok(()),
        }
    }

    pub(super) fn check_gain(gain: T) -> Result<(), ParamError> {
        require(gain >= T::ZERO && gain <= T::ONE, "gain", gain, "0 to 1")
    }

    #[inline]
    pub(super) fn outside_dead_zone(&self, v: T) -> T {
        if v.abs() > self.dead_zone { v } else { T::ZERO }
    }
}
