//! Motions that users record.

use super::Machine;
use crate::random::Random;
use std::f64::consts::TAU;

/// A motion of some eight seconds. Those with a number draw speeds, frequencies and dwells from it as a seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Three velocity sines, fast, slow and shaking, as the README asks for: no rests.
    Commissioning,
    /// A velocity sine of 1 Hz.
    Sine,
    /// Moves there and back, all at one speed, with dwells of .2 s: what a machine does anyway.
    Trapezoid,
    /// The commissioning motion with other speeds and frequencies.
    Commissioned(u64),
    /// Pick and place: moves of different length, speed and direction, with different dwells.
    Places(u64),
    /// A velocity sine whose frequency rises.
    Sweep(u64),
    /// Constant speeds there and back, each a part of the one before, as for a friction map.
    Speeds(u64),
    /// The sum of a slow and a faster velocity sine.
    Sines(u64),
    /// Moves there and back, all alike, with dwells.
    Moves(u64),
    /// Two to five of them only.
    Strokes(u64),
    /// From one end of a long stroke to the other and back, each time more slowly: as far as the top speed goes in a second, and a
    /// slow velocity sine before them.
    Crossings(u64),
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
/// How long a motion with a seed lasts, s.
const DRAWN: f64 = 9.0;

impl Motion {
    /// All of them.
    pub const ALL: [Motion; 3] = [Motion::Commissioning, Motion::Sine, Motion::Trapezoid];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Motion::Commissioning => "commissioning",
            Motion::Sine => "sine",
            Motion::Trapezoid => "trapezoid",
            Motion::Commissioned(_) => "commissioned",
            Motion::Places(_) => "places",
            Motion::Sweep(_) => "sweep",
            Motion::Speeds(_) => "speeds",
            Motion::Sines(_) => "sines",
            Motion::Moves(_) => "moves",
            Motion::Strokes(_) => "strokes",
            Motion::Crossings(_) => "crossings",
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
            Motion::Trapezoid => {
                let alike = |i| Move {
                    speed: alternate(i) * CRUISE * machine.top_speed,
                    cruising: CRUISING,
                    dwell: DWELL,
                };
                moves(machine, SMOOTHED, (0..MOVES).map(alike))
            }
            Motion::Commissioned(seed)
            | Motion::Places(seed)
            | Motion::Sweep(seed)
            | Motion::Speeds(seed)
            | Motion::Sines(seed)
            | Motion::Moves(seed)
            | Motion::Strokes(seed)
            | Motion::Crossings(seed) => self.drawn(machine, &mut Random::new(seed ^ 0x6d6f_7665)),
        };
        integrated(&velocity, 1.0 / machine.rate)
    }
    /// The velocity of one that has a seed, m/s.
    fn drawn(self, machine: &Machine, random: &mut Random) -> Vec<f64> {
        let top = machine.top_speed;
        // A part of the top speed, or less at a frequency at which the acceleration of moves allows no more.
        let able = |part: f64, hertz: f64| part.min(machine.acceleration / (TAU * hertz * top));
        match self {
            Motion::Commissioned(_) => {
                let segment =
                    |part, hertz, duration| sine(machine, able(part, hertz), hertz, duration);
                let mut velocity = segment(1.0, random.between(0.5, 1.5), 3.0);
                let part = random.between(0.01, 0.05);
                velocity.extend(segment(part, random.between(0.7, 2.0), 4.0));
                let fast = machine.fast * random.between(0.7, 1.4);
                velocity.extend(segment(random.between(0.08, 0.2), fast, 2.0));
                velocity
            }
            Motion::Sweep(_) => {
                let part = random.between(0.4, 1.0);
                let (slow, fast) = (random.between(0.3, 1.0), random.between(0.5, 1.0));
                let ratio = (fast * machine.fast / slow).max(2.0);
                faded(machine, DRAWN, |t, height| {
                    let hertz = slow * ratio.powf(t / DRAWN);
                    let turns = slow * DRAWN / ratio.ln() * (ratio.powf(t / DRAWN) - 1.0);
                    height * able(part, hertz) * top * (TAU * turns).sin()
                })
            }
            Motion::Sines(_) => {
                let (slow, fast) = (random.between(0.3, 1.0), random.between(2.0, 5.0));
                let large = able(random.between(0.2, 0.7), slow);
                let small = able(random.between(0.03, 0.25), fast);
                faded(machine, DRAWN, |t, height| {
                    let sum = large * (TAU * slow * t).sin() + small * (TAU * fast * t).sin();
                    height * top * sum
                })
            }
            Motion::Speeds(_) => {
                let (ratio, dwell) = (random.between(2.0, 4.0), random.between(0.02, 0.2));
                let first = top * random.between(0.6, 1.0);
                let speeds = (0..12).map(|i| Move {
                    speed: alternate(i) * first / ratio.powi(i as i32 / 2),
                    cruising: 0.5,
                    dwell,
                });
                moves(machine, SMOOTHED, speeds)
            }
            Motion::Crossings(_) => {
                let ratio = random.between(1.6, 2.2);
                let crossings = (0..8).map(|i| {
                    let speed = 0.9 * top / ratio.powi(i as i32 / 2);
                    Move {
                        speed: alternate(i) * speed,
                        cruising: top / speed - speed / machine.acceleration,
                        dwell: random.between(0.1, 0.4),
                    }
                });
                let crossings: Vec<Move> = crossings.collect();
                let mut velocity = sine(machine, random.between(0.01, 0.03), 1.0, 3.0);
                velocity.extend(moves(machine, SMOOTHED, crossings.into_iter()));
                velocity
            }
            Motion::Places(_) => {
                let smoothed = random.between(0.01, 0.05);
                let mut at = 0.0_f64;
                let placed = std::iter::repeat_with(|| {
                    let home = if random.uniform() < 0.75 { -1.0 } else { 1.0 };
                    let cruising = random.between(0.05, 0.5);
                    let speed = home * at.signum() * top * random.between(0.2, 1.0);
                    at += speed * cruising;
                    Move {
                        speed,
                        cruising,
                        dwell: random.between(0.05, 0.6),
                    }
                });
                moves(machine, smoothed, within(machine, placed))
            }
            _ => {
                let count = match self {
                    Motion::Strokes(_) => 2 + (4.0 * random.uniform()) as usize,
                    _ => usize::MAX,
                };
                let speed = top * random.between(0.2, 0.9);
                let (cruising, dwell) = (random.between(0.1, 0.6), random.between(0.1, 0.5));
                let alike = (0..count).map(|i| Move {
                    speed: alternate(i) * speed,
                    cruising,
                    dwell,
                });
                moves(machine, SMOOTHED, within(machine, alike))
            }
        }
    }
}

/// A move at one speed (m/s, towards positive positions), how long it keeps it, s, and the dwell after it, s.
#[derive(Clone, Copy)]
struct Move {
    speed: f64,
    cruising: f64,
    dwell: f64,
}

impl Move {
    /// Duration without its dwell, s.
    fn duration(self, machine: &Machine) -> f64 {
        self.cruising + 2.0 * self.speed.abs() / machine.acceleration
    }
}

/// There, and back again.
fn alternate(i: usize) -> f64 {
    if i.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// As many as last as long as a drawn motion.
fn within(machine: &Machine, all: impl Iterator<Item = Move>) -> impl Iterator<Item = Move> {
    let mut left = DRAWN;
    all.take_while(move |one| {
        let begins = left > 0.0;
        left -= one.duration(machine) + one.dwell;
        begins
    })
}

/// A velocity of time (s) and of a height that grows from 0 to 1 and fades to 0.
fn faded(machine: &Machine, duration: f64, velocity: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let samples = (duration * machine.rate) as usize;
    let smooth = |share: f64| {
        let s = share.clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    };
    (0..samples)
        .map(|k| {
            let t = k as f64 / machine.rate;
            velocity(t, smooth(t / FADE) * smooth((duration - t) / FADE))
        })
        .collect()
}

/// A velocity sine that grows from rest and fades to it.
fn sine(machine: &Machine, part: f64, hertz: f64, duration: f64) -> Vec<f64> {
    faded(machine, duration, |t, height| {
        part * machine.top_speed * height * (TAU * hertz * t).sin()
    })
}

/// Moves one after another, each with a dwell after it.
fn moves(machine: &Machine, smoothed: f64, all: impl Iterator<Item = Move>) -> Vec<f64> {
    let h = 1.0 / machine.rate;
    let dwell = |time: f64| (0..(time * machine.rate) as usize).map(|_| 0.0);
    let mut velocity: Vec<f64> = dwell(DWELL).collect();
    for one in all {
        let (speed, whole) = (one.speed.abs(), one.duration(machine));
        let ramp = speed / machine.acceleration;
        velocity.extend((0..(whole / h) as usize).map(|k| {
            let t = k as f64 * h;
            one.speed.signum() * speed * (t / ramp).min((whole - t) / ramp).clamp(0.0, 1.0)
        }));
        velocity.extend(dwell(one.dwell));
    }
    averaged(&velocity, ((smoothed * machine.rate) as usize).max(1))
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
