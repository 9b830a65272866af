//! How friction changes from sample to sample with what it depends on, and the forces beside it.

use super::friction::Friction;
use super::input::Input;
use super::settings::Settings;
use super::state::LawState;
use super::terms::{Place, Terms, sum};
use crate::Real;

/// What is known of the forces beside the law.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Beside<T> {
    /// Load, temperature, position (where whole turns do not count, in its turn) and what is transmitted as they came in last.
    pub seen: [T; 4],
    /// What these add to the force of the law, N (N m).
    pub changed: T,
    /// The viscous part of that, N (N m).
    pub viscous: T,
    /// Share of mass and cogging that is passed on: 0 when off, else 1.
    pub rest: T,
    /// Share of the weight that is passed on: 0 when not enabled, else 1. No watchdog switches it off.
    pub held: T,
    /// Size of what was returned last beside the weight, N (N m): what the watchdog judges.
    pub added: T,
    /// The parts of the force that was returned last, before limit and slew limit.
    pub parts: Parts<T>,
    /// Mass times acceleration at the last sample that counted, N (N m).
    inertia: T,
    /// Weight and cogging, N (N m), at the last place; and at the last sample that was learnt from.
    weight: T,
    cogging: T,
    before: T,
}

/// Parts of a force, N (N m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parts<T> {
    /// Friction, by gain and ramp.
    pub friction: T,
    /// Mass times acceleration, by the ramp.
    pub mass: T,
    /// The weight, by its ramp.
    pub gravity: T,
    /// Cogging, by the ramp.
    pub cogging: T,
}

impl<T: Real> Beside<T> {
    /// At the references, with nothing passed on.
    pub(super) fn rest(terms: &Terms<T>) -> Self {
        let c = &terms.channels;
        let seen = [
            c.load.reference,
            c.temperature.reference,
            c.position.reference,
            c.transmitted.reference,
        ];
        Beside {
            seen,
            ..Beside::default()
        }
    }

    /// What a reset leaves: what came in last, and the weight, which must not fall.
    pub(super) fn kept(&self) -> Self {
        Beside {
            seen: self.seen,
            held: self.held,
            weight: self.weight,
            cogging: self.cogging,
            parts: Parts {
                gravity: self.parts.gravity,
                ..Parts::default()
            },
            ..Beside::default()
        }
    }

    /// The force of the drive at this sample without what is known of it beside friction and inertia.
    #[inline]
    pub(super) fn without_known(&self, force: T) -> T {
        force - self.before
    }
}

impl<T: Real> Terms<T> {
    /// Whether a sample has what is fed forward from it.
    #[inline]
    pub(super) fn accepts(&self, input: &Input<T>) -> bool {
        self.mass == T::ZERO || input.reference_acceleration.is_finite()
    }

    /// Takes load, temperature, position and what is transmitted; what is not finite counts as what came in last.
    #[inline]
    pub(super) fn look(&self, beside: &mut Beside<T>, input: &Input<T>) {
        let came = [
            input.load,
            input.temperature,
            self.channels.position.turned(input.position),
            input.transmitted,
        ];
        for (seen, came) in beside.seen.iter_mut().zip(came) {
            if came.is_finite() {
                *seen = came;
            }
        }
        let place = self.place(beside);
        if let Some(weight) = &self.weight {
            let force = weight.constant + weight.wave.at(place);
            beside.weight = if force.is_finite() {
                force
            } else {
                beside.weight
            };
        }
        let force = sum(&self.cogging, place);
        beside.cogging = if force.is_finite() {
            force
        } else {
            beside.cogging
        };
    }

    #[inline]
    fn place(&self, beside: &Beside<T>) -> Place<T> {
        self.channels.place(beside.seen[2])
    }

    /// Takes a sample that counts, after the law: with the state of that and the velocity `v` that it was stepped with.
    #[inline]
    pub(super) fn step(
        &self,
        beside: &mut Beside<T>,
        friction: &Friction<T>,
        (law, v): (&LawState<T>, T),
        acceleration: T,
    ) {
        if let Some(levels) = &self.levels {
            let away = self.channels.away(beside.seen);
            let place = self.place(beside);
            let dry = friction.dry(law, v);
            // The sign of the deflection, unlike that of the velocity, does not make the force jump at a reversal.
            let factor = levels.factor(usize::from(dry <= T::ZERO), &away, place);
            let side = usize::from(v < T::ZERO);
            let viscous = levels.thicker(side, &away, friction.viscous(), v.abs());
            let viscous = viscous * v;
            let changed = (factor - T::ONE) * dry + viscous;
            if changed.is_finite() {
                (beside.changed, beside.viscous) = (changed, viscous);
            }
        }
        let inertia = self.mass * acceleration;
        if self.mass > T::ZERO && inertia.is_finite() {
            beside.inertia = inertia;
        }
    }

    /// Keeps what is known beside friction and inertia for the force of the drive that comes in with the next sample.
    #[inline]
    pub(super) fn keep(&self, beside: &mut Beside<T>) {
        beside.before = beside.weight + beside.cogging;
    }

    /// Adds what is fed forward to the part of friction: mass and cogging where the compensation is `on`, the weight while
    /// it is `enabled`.
    #[inline]
    pub(super) fn feed(
        &self,
        beside: &mut Beside<T>,
        settings: &Settings<T>,
        h: T,
        (on, enabled): (bool, bool),
        friction: T,
    ) -> T {
        let whole = |on: bool| if on { T::ONE } else { T::ZERO };
        let on = on && settings.gain > T::ZERO;
        beside.rest = settings.ramped(beside.rest, h, whole(on));
        beside.held = settings.ramped(beside.held, h, whole(enabled));
        let parts = Parts {
            friction,
            mass: beside.rest * beside.inertia,
            gravity: beside.held * beside.weight,
            cogging: beside.rest * beside.cogging,
        };
        beside.parts = parts;
        parts.friction + parts.mass + parts.cogging + parts.gravity
    }
}
