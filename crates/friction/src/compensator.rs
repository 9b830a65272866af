//! The compensator that runs on the drive: a friction force, limited and supervised, to be added to the controller's.
//!
//! One call a sample, plain arithmetic, no allocation. [`Settings`] and the law are checked once and, except for the
//! gain, never change; everything that changes is in [`State`].
//!
//! ```text
//! velocity --dead zone--> law --level--> x gain, by its ramp --> saturation --slew limit--> force
//! ```
//!
//! ```
//! use stiction_friction::compensator::{Compensator, Friction, Input, Settings, Source};
//! # use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
//! # let both = Direction { coulomb: 12.0, static_friction: 18.0, stribeck_velocity: 3e-3, viscous: 30.0 };
//! # let law = LuGre::new(2e6, Damping::Capped(1.5e3), Stribeck::symmetric(Shape::Gaussian, both, 0.0)?)?;
//! let settings = Settings { watchdog: None, ..Settings::new(250e-6, 40.0) }; // 4 kHz, at most 40 N
//! let mut compensator = Compensator::new(Friction::LuGre(law), Source::Reference, settings)?;
//! let mut force = 0.0;
//! for _ in 0..4000 {
//!     force = compensator.step(Input { reference_velocity: 0.1, enable: true, ..Input::default() });
//! }
//! assert!((force - settings.gain * 15.0_f64).abs() < 1e-9); // of Fc + sigma2 v
//! # Ok::<(), stiction_friction::ParamError>(())
//! ```

mod adaptation;
mod disturbance;
mod friction;
mod preview;
mod safety;
mod settings;
mod watchdog;

pub use adaptation::Adaptation;
pub use disturbance::{DisturbanceObserver, DisturbanceState};
pub use friction::{Friction, Source};
pub use preview::ahead;
pub use settings::Settings;
pub use watchdog::{Watch, Watchdog};

use crate::{ParamError, Real};

/// What the drive knows in a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Input<T> {
    /// Reference velocity, m/s (rad/s); where it is known, that of the instant at which the force will act
    /// ([`ahead`]).
    pub reference_velocity: T,
    /// Measured velocity, m/s (rad/s).
    pub measured_velocity: T,
    /// Reference position less measured position, m (rad).
    pub tracking_error: T,
    /// Whether to compensate.
    pub enable: bool,
}

/// The state of a running compensator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<T> {
    /// The law's state; only `force` is used by laws without memory.
    pub law: crate::State<T>,
    /// Correction of the bristles by an observer, m (rad), beside the law's own deflection.
    pub correction: T,
    /// The force of that correction, N (N m).
    pub corrected: T,
    /// Share of the friction that is let through, 0 off, up to the gain.
    pub share: T,
    /// Factor on the law's force, 1 unless adapted or set.
    pub level: T,
    /// The watchdog.
    pub watch: Watch<T>,
    /// The force last returned, N (N m).
    pub output: T,
}

/// A friction law as a feedforward force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensator<T> {
    friction: Friction<T>,
    source: Source<T>,
    settings: Settings<T>,
    state: State<T>,
}

impl<T: Real> Compensator<T> {
    /// A compensator, off and at rest. [`Source::Observer`] needs a law with bristles.
    pub fn new(
        friction: Friction<T>,
        source: Source<T>,
        settings: Settings<T>,
    ) -> Result<Self, ParamError> {
        source.validate(&friction)?;
        settings.validate()?;
        Ok(Compensator {
            friction,
            source,
            settings,
            state: State::rest(&friction),
        })
    }

    /// The law.
    pub fn friction(&self) -> &Friction<T> {
        &self.friction
    }

    /// The velocity that drives the law.
    pub fn source(&self) -> Source<T> {
        self.source
    }

    /// The settings.
    pub fn settings(&self) -> &Settings<T> {
        &self.settings
    }

    /// Its state.
    pub fn state(&self) -> &State<T> {
        &self.state
    }

    /// Off, at rest, with nothing learnt; a tripped watchdog is armed again.
    pub fn reset(&mut self) {
        self.state = State::rest(&self.friction);
    }

    /// Sets the factor on the law's force from outside, as from an estimate of the load; 0 to 2. One that is not a number
    /// changes nothing.
    pub fn set_level(&mut self, level: T) {
        if level.is_finite() {
            self.state.level = level.max(T::ZERO).min(T::from_f64(2.0));
        }
    }

    /// Sets the gain, 0 to 1; the force follows within the ramp.
    ///
    /// # Errors
    /// Where it is out of range; the gain then stays.
    pub fn set_gain(&mut self, gain: T) -> Result<(), ParamError> {
        Settings::check_gain(gain)?;
        self.settings.gain = gain;
        Ok(())
    }

    /// The compensating force, N (N m), to be added to the controller's from now on for one cycle time.
    #[inline]
    pub fn step(&mut self, input: Input<T>) -> T {
        self.advance(self.settings.cycle_time, input)
    }

    /// [`step`](Self::step) where the cycle time varies: `h` seconds since the call before.
    ///
    /// The force is finite and within the limit for any input. A sample with an input that is not finite moves no
    /// state of the law and counts as not enabled: the force fades while such samples last and comes back with good
    /// ones. An `h` that is negative or not finite repeats the force.
    #[inline]
    pub fn step_in(&mut self, h: T, input: Input<T>) -> T {
        if h >= T::ZERO && h <= T::MAX {
            self.advance(h, input)
        } else {
            self.state.output
        }
    }

    /// `h` is finite and not negative.
    #[inline]
    fn advance(&mut self, h: T, input: Input<T>) -> T {
        let good = input.is_finite();
        if good {
            let at = self
                .settings
                .outside_dead_zone(self.source.velocity(&input));
            self.friction.step(&mut self.state.law, h, at);
            if let Source::Observer(gain) = self.source {
                let pull = gain * input.tracking_error;
                let correction = &mut self.state.correction;
                self.state.corrected =
                    self.friction
                        .correct(correction, h, at, pull, self.settings.limit);
            }
            if let Some(adaptation) = &self.settings.adaptation {
                let error = input.tracking_error;
                self.state.level =
                    adaptation.step(self.state.level, h, error, self.state.law.force);
            }
            if let Some(watchdog) = &self.settings.watchdog {
                let through = (self.state.share, self.settings.gain, self.state.output);
                watchdog.step(&mut self.state.watch, h, &input, through);
            }
        }
        let allowed = self.settings.watchdog.is_none() || self.state.watch.allows();
        let on = good && input.enable && allowed;
        let wanted = self.state.level * self.state.law.force + self.state.corrected;
        self.settings.limit(&mut self.state, h, on, wanted)
    }
}

impl<T: Real> State<T> {
    fn rest(friction: &Friction<T>) -> Self {
        State {
            law: friction.rest(),
            correction: T::ZERO,
            corrected: T::ZERO,
            share: T::ZERO,
            level: T::ONE,
            watch: Watch::default(),
            output: T::ZERO,
        }
    }
}

impl<T: Real> Input<T> {
    fn is_finite(&self) -> bool {
        self.reference_velocity.is_finite()
            && self.measured_velocity.is_finite()
            && self.tracking_error.is_finite()
    }
}
