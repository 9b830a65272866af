//! The compensator that runs on the drive: a friction force, limited and supervised, to be added to the controller's.
//!
//! One call a sample, plain arithmetic, no allocation. [`Settings`] and the law are checked once and, except for the
//! gain and the limit, never change; everything that changes is in [`State`].
//!
//! ```text
//! velocity --dead zone--> law --levels--> x gain, by its ramp --+--> saturation --slew limit--> force
//! position, acceleration --> mass, weight, cogging, by the ramp --+
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
mod beside;
mod disturbance;
mod friction;
mod input;
mod memory;
mod preview;
mod safety;
mod settings;
mod state;
mod terms;
mod watchdog;

pub use adaptation::{Adaptation, Learnt};
pub use beside::{Beside, Parts};
pub use disturbance::{DisturbanceObserver, DisturbanceState};
pub use friction::{Friction, Source};
pub use input::Input;
pub use memory::{ForeignMemory, MEMORY};
pub use preview::ahead;
pub use settings::Settings;
pub use state::{LawState, State};
pub use terms::{Changes, Channel, Channels, Levels, Terms, WAVES, Wave, Weight};
pub use watchdog::{Trip, Watch, Watchdog};

use crate::{ParamError, Real};

/// A friction law as a feedforward force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensator<T> {
    friction: Friction<T>,
    source: Source<T>,
    settings: Settings<T>,
    terms: Option<Terms<T>>,
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
            terms: None,
            state: State::rest(&friction),
        })
    }

    /// The same with what friction depends on beside the velocity, and what is fed forward beside it; off and at rest.
    ///
    /// The gain is that of friction; the others come in whole, by the same ramp. Limit, slew limit and ramp hold for the sum.
    /// Watchdog and [`Input::enable`] switch off all of it but the weight, which only the latter takes away: what holds the
    /// axis must not fall because friction was compensated badly.
    ///
    /// # Errors
    /// Where a number is out of range: a reference outside of its range, a level that changes and is 0 itself, an offset of the
    /// law beside a weight.
    pub fn with_terms(mut self, terms: Terms<T>) -> Result<Self, ParamError> {
        terms.validate(&self.friction)?;
        self.state = State {
            beside: Beside::rest(&terms),
            ..State::rest(&self.friction)
        };
        self.terms = Some(terms);
        Ok(self)
    }

    /// As it is after it has been enabled for a while at standstill: with the whole gain, and a watchdog that has learnt what
    /// `watch` has. Its first window is not judged.
    #[must_use]
    pub fn running(mut self, watch: &Watch<T>) -> Self {
        self.state.share = self.settings.gain;
        if self.terms.is_some() {
            (self.state.beside.rest, self.state.beside.held) = (T::ONE, T::ONE);
        }
        self.state.watch = watch.knowledge();
        self
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

    /// What it knows beside the law.
    pub fn terms(&self) -> Option<&Terms<T>> {
        self.terms.as_ref()
    }

    /// Its state.
    pub fn state(&self) -> &State<T> {
        &self.state
    }

    /// Off, at rest, with nothing learnt; a tripped watchdog is armed again. A weight that was passed on still is.
    pub fn reset(&mut self) {
        let kept = self.state.beside.kept();
        let limit = self.settings.limit;
        self.state = State {
            beside: kept,
            output: kept.parts.gravity.max(-limit).min(limit),
            ..State::rest(&self.friction)
        };
    }

    /// Sets the factor on the law's force from outside, for example from an estimate of the load; range 0 to 2. A
    /// value that is not finite is ignored.
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

    /// Sets the largest force either way, > 0, N (N m). The force is within it from the next step on, whatever the slew limit.
    ///
    /// # Errors
    /// Where it is out of range; the limit then stays.
    pub fn set_limit(&mut self, limit: T) -> Result<(), ParamError> {
        ParamError::positive("limit", limit)?;
        self.settings.limit = limit;
        Ok(())
    }

    /// The compensating force, N (N m), to be added to the controller's output for the next cycle.
    #[inline]
    pub fn step(&mut self, input: Input<T>) -> T {
        self.advance(self.settings.cycle_time, input)
    }

    /// [`step`](Self::step) where the cycle time varies: `h` seconds since the call before.
    ///
    /// The force is finite and within the limit for any input. A sample with an input that is not finite leaves the
    /// law's state unchanged and counts as not enabled: the force ramps down while such samples last and ramps up
    /// again afterwards. For an `h` that is negative or not finite the previous force is returned, within the limit.
    #[inline]
    pub fn step_in(&mut self, h: T, input: Input<T>) -> T {
        if h >= T::ZERO && h <= T::MAX {
            self.advance(h, input)
        } else {
            let limit = self.settings.limit;
            self.state.output = self.state.output.max(-limit).min(limit);
            self.state.output
        }
    }

    /// `h` is finite and not negative.
    #[inline]
    fn advance(&mut self, h: T, input: Input<T>) -> T {
        let adapts = self.settings.adaptation.is_some();
        let mut good = input.is_finite() && (!adapts || input.drive_force.is_finite());
        if let Some(terms) = &self.terms {
            good = good && terms.accepts(&input);
            terms.look(&mut self.state.beside, &input);
        }
        if good {
            let at = self
                .settings
                .outside_dead_zone(self.source.velocity(&input));
            self.friction.step(&mut self.state.law, h, at);
            self.state.viscous = self.friction.viscous()[usize::from(at < T::ZERO)] * at;
            if let Source::Observer(gain) = self.source {
                let pull = gain * input.tracking_error;
                let correction = &mut self.state.correction;
                self.state.corrected =
                    self.friction
                        .correct(correction, h, at, pull, self.settings.limit);
            }
            if let Some(terms) = &self.terms {
                let law = (&self.state.law, at);
                let acceleration = input.reference_acceleration;
                terms.step(&mut self.state.beside, &self.friction, law, acceleration);
            }
            if let Some(watchdog) = &self.settings.watchdog {
                let beside = &self.state.beside;
                let fed = self.terms.as_ref().is_some_and(Terms::feeds);
                let (output, whole) = match fed {
                    true => (beside.added, beside.rest == T::ONE),
                    false => (self.state.output, true),
                };
                let through = (self.state.share, self.settings.gain, output, whole);
                watchdog.step(&mut self.state.watch, h, &input, through);
            }
        }
        let allowed = self.settings.watchdog.is_none() || self.state.watch.allows();
        let on = good && input.enable && allowed;
        let (mut force, mut sound) = (self.state.law.force, true);
        if self.terms.is_some() {
            force = force + self.state.beside.changed;
            sound = force.is_finite();
        }
        if let Some(adaptation) = &self.settings.adaptation {
            let learnt = &mut self.state.learnt;
            let viscous = self.state.viscous + self.state.beside.viscous;
            let parts = [(force - self.friction.offset()) - viscous, viscous];
            if good {
                let limit = self.settings.limit;
                let limited = self.state.output.abs() >= limit;
                let frozen = limited || self.state.watch.tripped() || !input.learn;
                let most = if frozen { T::ZERO } else { limit };
                let mut input = input;
                if let Some(terms) = &self.terms {
                    let beside = &mut self.state.beside;
                    input.drive_force = beside.without_known(input.drive_force);
                    terms.keep(beside);
                }
                adaptation.step(learnt, &self.friction, h, &input, parts, most);
            }
            let [dry, viscous] = parts;
            force = (learnt.level * dry + learnt.viscous * viscous) + self.friction.offset();
            // A factor may take the force of a velocity that no machine has beyond the number type.
            sound = force.is_finite();
        }
        if !sound {
            force = T::ZERO;
        }
        let wanted = self.state.level * force + self.state.corrected;
        let fed = self.terms.as_ref().filter(|terms| terms.feeds());
        let fed = fed.map(|terms| (terms, input.enable));
        self.settings
            .limit(&mut self.state, h, on && sound, wanted, fed)
    }
}
