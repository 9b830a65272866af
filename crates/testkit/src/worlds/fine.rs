//! The axis in continuous time, by a fine step.

use super::motion::SetPoint;
use super::{Machine, World};
use std::f64::consts::TAU;

/// Longest step, s.
const LONGEST: f64 = 1e-5;
/// Part of the mass that is the motor's where there are two.
const MOTOR: f64 = 0.5;
/// Resonance of motor and load, in bandwidths of the speed loop, and its damping ratio; with the encoder on the load a loop
/// of that bandwidth bears a higher one only; behind a gap.
const RESONANCE: (f64, f64) = (2.0, 0.03);
const RESONANCE_OF_LOAD: (f64, f64) = (5.0, 0.1);
const RESONANCE_OF_GAP: (f64, f64) = (4.0, 0.03);
/// Width of the gap, in deflections at which friction breaks away, Fs/sigma0.
const GAP: f64 = 0.5;
/// Part of the viscous friction of the axis that is the load's own behind a gap, where it would float for ever without.
const OF_LOAD: f64 = 0.1;
/// Periods of the cogging in the distance that the top speed covers in a second.
const PITCHES: f64 = 13.0;
/// A weight, in parts of the Coulomb level.
const WEIGHT: f64 = 0.8;
/// Waves of a level along the stroke.
const WAVES: f64 = 1.6;
/// Share of each Maxwell-slip element in force and in stiffness.
const ELEMENT_FORCE: [f64; 4] = [0.1, 0.2, 0.3, 0.4];
const ELEMENT_STIFFNESS: [f64; 4] = [0.4, 0.3, 0.2, 0.1];
/// How fast a slipping element attains its level: rate C over Fc, 1/s.
const ATTRACTION: f64 = 50.0;

/// Motor position and velocity, load position and velocity, bristle deflection or element forces.
type State = [f64; 8];

/// Lost motion between motor and load, m.
fn gap(machine: &Machine) -> f64 {
    GAP * machine.static_friction / machine.sigma0
}

impl World {
    /// What lies between motor and load: the frequency of the load while the motor stands still, Hz, or the lost motion, m;
    /// `None` where they are one.
    pub fn coupling(self, machine: &Machine) -> Option<f64> {
        // The whole is that of both masses against each other.
        let held = |(bandwidths, _): (f64, f64)| bandwidths * machine.bandwidth * MOTOR.sqrt();
        match self {
            World::ResonanceAtMotor => Some(held(RESONANCE)),
            World::ResonanceAtLoad => Some(held(RESONANCE_OF_LOAD)),
            World::Backlash => Some(gap(machine)),
            _ => None,
        }
    }
}

/// An axis that moves.
pub(super) struct Fine {
    machine: Machine,
    world: World,
    state: State,
    /// Whether each Maxwell-slip element slips.
    slips: [bool; 4],
    /// Stroke to one side, to which the dependence on position refers, and the duration of the log.
    reach: f64,
    duration: f64,
    time: f64,
    /// Force behind the current loop, N.
    felt: f64,
}

impl Fine {
    /// At rest at the beginning of a log along that path.
    pub fn of(machine: &Machine, path: &[SetPoint], world: World) -> Self {
        Fine {
            machine: *machine,
            world,
            state: [0.0; 8],
            slips: [false; 4],
            reach: path.iter().fold(0.0_f64, |m, p| m.max(p.position.abs())),
            duration: path.len() as f64 / machine.rate,
            time: 0.0,
            felt: 0.0,
        }
    }

    /// As warm as at the end of the log.
    pub fn has_run(&mut self) {
        self.time = self.duration;
    }

    /// Where the encoder is, m.
    pub fn position(&self) -> f64 {
        match self.world {
            World::ResonanceAtLoad => self.state[2],
            _ => self.state[0],
        }
    }

    /// Velocity there, m/s.
    pub fn velocity(&self) -> f64 {
        match self.world {
            World::ResonanceAtLoad => self.state[3],
            _ => self.state[1],
        }
    }

    /// Advances by `duration` (s) under a constant force (N), which passes the current loop where the world has one.
    pub fn advance(&mut self, force: f64, duration: f64) {
        let steps = (duration / LONGEST).ceil().max(1.0);
        let h = duration / steps;
        let lag = match self.world {
            World::Driven(drive) => drive.lag,
            _ => 0.0,
        };
        for _ in 0..steps as usize {
            let left = |time: f64| match lag > 0.0 {
                true => (self.felt - force) * (-time / lag).exp(),
                false => 0.0,
            };
            let forces = [0.0, 0.5 * h, h].map(|time| force + left(time));
            self.step(forces, h);
            self.felt = forces[2];
        }
    }

    /// Passes that time (s) under a brake.
    pub fn hold(&mut self, duration: f64) {
        self.state[1] = 0.0;
        self.state[3] = 0.0;
        self.time += duration;
    }

    /// The force is given at the beginning, in the middle and at the end.
    fn step(&mut self, force: [f64; 3], h: f64) {
        let at = |s: &State, k: &State, h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
        let s = self.state;
        let k1 = self.rate(&s, force[0]);
        let k2 = self.rate(&at(&s, &k1, 0.5 * h), force[1]);
        let k3 = self.rate(&at(&s, &k2, 0.5 * h), force[1]);
        let k4 = self.rate(&at(&s, &k3, h), force[2]);
        self.state =
            std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        self.time += h;
        if self.world == World::MaxwellSlip {
            self.settle(s[1]);
        }
    }

    /// Which elements slip after a step, `before` being the velocity at its beginning: one that reaches its level slips,
    /// until the motion turns back.
    fn settle(&mut self, before: f64) {
        let v = self.state[1];
        let level = self.machine.level(v.abs(), 2.0);
        let elements = self.state[4..].iter_mut().zip(&mut self.slips);
        for ((force, slips), share) in elements.zip(ELEMENT_FORCE) {
            *slips &= before * v > 0.0;
            let most = share * level;
            if !*slips && force.abs() >= most {
                *slips = true;
                *force = most.copysign(*force);
            }
        }
    }

    fn rate(&self, s: &State, force: f64) -> State {
        let m = &self.machine;
        let [x, v, xl, vl, ..] = *s;
        let mut out = [0.0; 8];
        let friction = self.friction(s, &mut out);
        let outside = match self.world {
            World::Cogging => 0.2 * m.coulomb * (TAU * PITCHES * x / m.top_speed).sin(),
            World::Weight if m.kind == "rotary" => WEIGHT * m.coulomb * (x + 0.3).cos(),
            World::Weight => WEIGHT * m.coulomb,
            World::Spring => m.coulomb * x / self.reach,
            _ => 0.0,
        };
        let (mass, coupling) = match self.world {
            World::Backlash => {
                let k = self.spring(RESONANCE_OF_GAP);
                let half = 0.5 * gap(m);
                let apart = x - xl;
                let squeezed = apart - apart.clamp(-half, half);
                let damped = if squeezed == 0.0 { 0.0 } else { v - vl };
                (MOTOR * m.mass, k.0 * squeezed + k.1 * damped)
            }
            World::ResonanceAtMotor | World::ResonanceAtLoad => {
                let k = self.spring(match self.world {
                    World::ResonanceAtLoad => RESONANCE_OF_LOAD,
                    _ => RESONANCE,
                });
                (MOTOR * m.mass, k.0 * (x - xl) + k.1 * (v - vl))
            }
            _ => (m.mass, 0.0),
        };
        out[0] = v;
        out[1] = (force - friction - outside - coupling) / mass;
        if mass < m.mass {
            out[2] = vl;
            out[3] = (coupling - self.of_load() * vl) / (m.mass - mass);
        }
        out
    }

    /// Friction at the motor, N, and the rates of its states.
    fn friction(&self, s: &State, out: &mut State) -> f64 {
        let m = &self.machine;
        let (x, v) = (s[0], s[1]);
        if self.world == World::MaxwellSlip {
            let level = m.level(v.abs(), 2.0);
            let mut sum = m.sigma2 * v;
            for i in 0..4 {
                sum += s[4 + i];
                out[4 + i] = if self.slips[i] {
                    let attained = s[4 + i] / level;
                    ATTRACTION * m.coulomb * (ELEMENT_FORCE[i] * v.signum() - attained)
                } else {
                    ELEMENT_STIFFNESS[i] * m.sigma0 * v
                };
            }
            return sum;
        }
        let exponent = if self.world == World::Exponent {
            1.0
        } else {
            2.0
        };
        let changed = match self.world {
            World::PositionWave => 1.0 + 0.15 * (0.5 * TAU * WAVES * x / self.reach).sin(),
            World::Position => 1.0 + 0.15 * x / self.reach,
            World::WarmUp => 1.0 - 0.2 * (self.time / self.duration).min(1.0),
            _ => 1.0,
        };
        let z = s[4];
        let rate = v - m.sigma0 * v.abs() * z / (changed * m.level(v.abs(), exponent));
        out[4] = rate;
        m.sigma0 * z + m.sigma1 * rate + (m.sigma2 - self.of_load()) * v
    }

    /// Viscous friction of the load itself, N s/m.
    fn of_load(&self) -> f64 {
        match self.world {
            World::Backlash => OF_LOAD * self.machine.sigma2,
            _ => 0.0,
        }
    }

    /// Stiffness and damping between motor and load for a resonance in bandwidths of the speed loop, and its damping ratio.
    fn spring(&self, (bandwidths, damping): (f64, f64)) -> (f64, f64) {
        let m = &self.machine;
        let reduced = MOTOR * (1.0 - MOTOR) * m.mass;
        let omega = TAU * bandwidths * m.bandwidth;
        (reduced * omega * omega, 2.0 * damping * reduced * omega)
    }
}
