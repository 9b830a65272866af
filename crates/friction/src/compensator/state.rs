//! What a compensator keeps from step to step.

use super::adaptation::Learnt;
use super::beside::Beside;
use super::friction::Friction;
use super::watchdog::Watch;
use crate::{Elements, MOST_ELEMENTS, Real};

/// The state of a running compensator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<T> {
    /// The law's state.
    pub law: LawState<T>,
    /// Correction of the bristles by an observer, m (rad), beside the law's own deflection.
    pub correction: T,
    /// The force of that correction, N (N m).
    pub corrected: T,
    /// The viscous part of the law's force, N (N m).
    pub viscous: T,
    /// Share of the friction force that is passed on: 0 when off, at most the gain.
    pub share: T,
    /// Factor on the law's force, 1 unless set from outside.
    pub level: T,
    /// What an adaptation has learnt.
    pub learnt: Learnt<T>,
    /// What friction depends on, and what is fed forward beside it.
    pub beside: Beside<T>,
    /// The watchdog.
    pub watch: Watch<T>,
    /// The force last returned, N (N m).
    pub output: T,
}

/// The state of a law, whichever it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawState<T> {
    /// Bristle deflection, m (rad); 0 for a law without one.
    pub z: T,
    /// Maxwell-slip elements; at rest for a law without them.
    pub elements: Elements<T, MOST_ELEMENTS>,
    /// The law's force, N (N m).
    pub force: T,
}

impl<T: Real> State<T> {
    pub(super) fn rest(friction: &Friction<T>) -> Self {
        State {
            law: friction.rest(),
            correction: T::ZERO,
            corrected: T::ZERO,
            viscous: T::ZERO,
            share: T::ZERO,
            level: T::ONE,
            learnt: Learnt::nothing(),
            beside: Beside::default(),
            watch: Watch::default(),
            output: T::ZERO,
        }
    }
}
