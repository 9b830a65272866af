//! Motions that users record.

use super::Machine;
use std::f64::consts::TAU;

/// A motion of some eight seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Three velocity sines, fast, slow and shaking, as the README asks for: no rests.
    Commissioning,
    /// A velocity sine of 1 Hz.
    Sine,
    /// Moves there and back, all at one speed, with dwells of .2 s: what a machine does anyway.
    Trapezoid,
}

/// Set point at a sample.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SetPoint {
    pub position: f64,
    pub velocity: f64,
    pub acceleration: f64,
}

/// Velocity sines of the commissioning motion: part of the top speed, frequency (Hz; 0 for that of the axis), duration (s).
const SEGMENTS: [(f64, f64, f64); 3] = [(1.0, 1.0, 3.0), (0.02, 1.25, 4.0), (0.125, 0.0, 2.0)];
/// Speed of the moves, in parts of the top speed, how long they keep it, s, and how many there are.
const CRUISE: f64 = 0.5;
const CRUISING: f64 = 0.3;
const MOVES: usize = 15;
const DWELL: f64 = 0.2;
/// Time over which the velocity of a move is averaged: its jerk is the acceleration over this.
const SMOOTHED: f64 = 0.02;
/// Time in which a sine grows to its height, and fades at its end.
const FADE: f64 = 0.25;

impl Motion {
    /// All of them.
    pub const ALL: [Motion; 3] = [Motion::Commissioning, Motion::Sine, Motion::Trapezoid];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Motion::Commissioning => "commissioning",
            Motion::Sine => "sine",
            Motion::Trapezoid => "trapezoid",
        }
    }

    /// Set points at the rate of the machine.
    pub(super) fn of(self, machine: &Machine) -> Vec<SetPoint> {
        let velocity = match self {
            Motion::Commissioning => SEGMENTS
                .iter()
                .flat_map(|&(part, hertz, duration)| {
                    let hertz = if hertz == 0.0 { machine.fast } else { hertz };
                    sine(machine, part, hertz, duration)
                })
                .collect(),
            Motion::Sine => sine(machine, 0.5, 1.0, 8.0),
            Motion::Trapezoid => moves(machine),
        };
        integrated(&velocity, 1.0 / machine.rate)
    }
}

/// A velocity sine that grows from rest and fades to it.
fn sine(machine: &Machine, part: f64, hertz: f64, duration: f64) -> Vec<f64> {
    let samples = (duration * machine.rate) as usize;
    let smooth = |share: f64| {
        let s = share.clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    };
    (0..samples)
        .map(|k| {
            let t = k as f64 / machine.rate;
            let height = smooth(t / FADE) * smooth((duration - t) / FADE);
            part * machine.top_speed * height * (TAU * hertz * t).sin()
        })
        .collect()
}

/// Moves there and back, each with a dwell after it.
fn moves(machine: &Machine) -> Vec<f64> {
    let h = 1.0 / machine.rate;
    let dwell = || (0..(DWELL * machine.rate) as usize).map(|_| 0.0);
    let speed = CRUISE * machine.top_speed;
    let ramp = speed / machine.acceleration;
    let whole = CRUISING + 2.0 * ramp;
    let mut velocity: Vec<f64> = dwell().collect();
    for i in 0..MOVES {
        let direction = if i % 2 == 0 { 1.0 } else { -1.0 };
        velocity.extend((0..(whole / h) as usize).map(|k| {
            let t = k as f64 * h;
            direction * speed * (t / ramp).min((whole - t) / ramp).clamp(0.0, 1.0)
        }));
        velocity.extend(dwell());
    }
    averaged(&velocity, ((SMOOTHED * machine.rate) as usize).max(1))
}

/// Mean of the last `n` values at every one, 0 before the first.
fn averaged(values: &[f64], n: usize) -> Vec<f64> {
    let mut sum = 0.0;
    (0..values.len())
        .map(|k| {
            sum += values[k];
            if k >= n {
                sum -= values[k - n];
            }
            sum / n as f64
        })
        .collect()
}

/// Position by the trapezoidal rule and acceleration by differences over two samples.
fn integrated(velocity: &[f64], h: f64) -> Vec<SetPoint> {
    let mut position = 0.0;
    (0..velocity.len())
        .map(|k| {
            let before = velocity[k.saturating_sub(1)];
            let after = velocity[(k + 1).min(velocity.len() - 1)];
            position += if k > 0 {
                0.5 * h * (before + velocity[k])
            } else {
                0.0
            };
            SetPoint {
                position,
                velocity: velocity[k],
                acceleration: (after - before) / (2.0 * h),
            }
        })
        .collect()
}
