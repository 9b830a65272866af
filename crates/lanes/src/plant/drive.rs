//! A mass under a given force: its parameters, the force and the measured motion, and the result of the simulation.

use crate::Candidate;

/// An axis that a search tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Mass, finite and > 0, kg (kg m^2).
    pub mass: f64,
    /// Its friction.
    pub friction: Candidate,
}

/// State of motion of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Position, m (rad).
    pub position: f64,
    /// Velocity, m/s (rad/s).
    pub velocity: f64,
    /// Bristle deflection, m (rad).
    pub deflection: f64,
}

/// What a simulated motion is compared with, at the end of each step.
#[derive(Clone, Copy, Debug)]
pub enum Measured<'a> {
    /// Position, m (rad).
    Position(&'a [f64]),
    /// Velocity, m/s (rad/s).
    Velocity(&'a [f64]),
}

/// A force that drives an axis from a known start, and the motion that was measured.
#[derive(Clone, Copy, Debug)]
pub struct Drive<'a> {
    /// Time step, finite and > 0, s.
    pub step: f64,
    /// Force in the middle of each step, finite, N (N m).
    pub force: &'a [f64],
    /// Where all axes start; finite.
    pub start: Motion,
    /// What was measured, finite, one value a step.
    pub measured: Measured<'a>,
}

/// Result of the simulation of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Sum of squares of measured minus simulated motion over all steps, m^2 or m^2/s^2 (rad^2, rad^2/s^2);
    /// infinite where it overflows, never NaN.
    pub cost: f64,
    /// State of the axis after the last step.
    pub end: Motion,
}

impl Outcome {
    pub(super) fn new(cost: f64, end: Motion) -> Self {
        let cost = if cost.is_nan() { f64::INFINITY } else { cost };
        Outcome { cost, end }
    }
}
