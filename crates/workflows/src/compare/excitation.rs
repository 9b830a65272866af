//! Motions that problems are compared on, in multiples of the Stribeck velocity of the axis.

use libm::sin;
use std::f64::consts::TAU;

/// Duration of every motion, s.
pub(super) const DURATION: f64 = 3.0;

/// How the axis moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Excitation {
    /// One sine.
    #[default]
    Sine,
    /// Three sines together.
    MultiSine,
    /// Fast, slow, and fast with a small stroke, one after the other.
    ThreeSegments,
    /// Force ramps until the axis breaks away, in turn to each side.
    BreakAway,
}

impl Excitation {
    /// All of them.
    pub const ALL: [Excitation; 4] = [
        Excitation::Sine,
        Excitation::MultiSine,
        Excitation::ThreeSegments,
        Excitation::BreakAway,
    ];

    /// Name as typed and as written to files.
    pub fn name(self) -> &'static str {
        match self {
            Excitation::Sine => "sine",
            Excitation::MultiSine => "multi-sine",
            Excitation::ThreeSegments => "three-segments",
            Excitation::BreakAway => "break-away",
        }
    }

    /// What it is, in words; vs is the Stribeck velocity.
    pub fn description(self) -> &'static str {
        match self {
            Excitation::Sine => "velocity sine of 10 vs and 1 Hz",
            Excitation::MultiSine => "velocity sines of 6, 3, 1.5 vs and 1, 2.7, 7.1 Hz together",
            Excitation::ThreeSegments => {
                "velocity sines one after the other: 40 vs 1 Hz, 0.75 vs 1.2 Hz, 5 vs 28 Hz"
            }
            Excitation::BreakAway => {
                "force ramps of 0.45 s to 1.2 Fs, in turn to each side, each followed by 0.05 s without force"
            }
        }
    }

    /// Velocity over vs at a time in s; `None` for a motion that a force makes.
    pub(super) fn velocity(self, t: f64) -> Option<f64> {
        let wave = |size: f64, hertz: f64, t: f64| size * sin(TAU * hertz * t);
        Some(match self {
            Excitation::Sine => wave(10.0, 1.0, t),
            Excitation::MultiSine => wave(6.0, 1.0, t) + wave(3.0, 2.7, t) + wave(1.5, 7.1, t),
            // Each ends after whole periods.
            Excitation::ThreeSegments if t < 1.0 => wave(40.0, 1.0, t),
            Excitation::ThreeSegments if t < 1.0 + 1.0 / 1.2 => wave(0.75, 1.2, t - 1.0),
            Excitation::ThreeSegments => wave(5.0, 28.0, t - 1.0 - 1.0 / 1.2),
            Excitation::BreakAway => return None,
        })
    }

    /// Force over Fs at a time in s, where a force makes the motion.
    pub(super) fn force(t: f64) -> f64 {
        let turn = (t / 0.5) as u64;
        let since = t - 0.5 * turn as f64;
        let side = if turn.is_multiple_of(2) { 1.0 } else { -1.0 };
        if since < 0.45 {
            side * 1.2 * since / 0.45
        } else {
            0.0
        }
    }
}
