//! The axis in continuous time, by a fine step.

use super::motion::SetPoint;
use super::{Machine, Setup, World};
use std::f64::consts::TAU;

/// Longest step, s, and longest in times in which the bristles follow the fastest motion: explicit steps of more than 2.8 of
/// those blow up.
const LONGEST: f64 = 1e-5;
const FOLLOWED: f64 = 0.7;
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

/// Motor position and velocity, load position and velocity, bristle deflection or element forces, bristle deflection of the
/// load.
type State = [f64; 9];

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
    setup: Setup,
    /// Longest step, s.
    longest: f64,
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
    pub fn of(machine: &Machine, path: &[SetPoint], setup: Setup) -> Self {
        let fastest = path.iter().fold(0.0_f64, |m, p| m.max(p.velocity.abs()));
        let followed = machine.coulomb / machine.sigma0 / fastest;
        Fine {
            machine: *machine,
            setup,
            longest: LONGEST.min(FOLLOWED * followed),
            state: [0.0; 9],
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
        match self.is_read_at_load() {
            true => self.state[2],
            false => self.state[0],
        }
    }

    /// Velocity there, m/s.
    pub fn velocity(&self) -> f64 {
        match self.is_read_at_load() {
            true => self.state[3],
            false => self.state[1],
        }
    }

    fn is_read_at_load(&self) -> bool {
        let spring = self.setup.compliance;
        self.setup.world == World::ResonanceAtLoad || spring.is_some_and(|c| c.is_read_at_load)
    }

    /// Advances by `duration` (s) under a constant force (N), which passes the current loop where the world has one.
    pub fn advance(&mut self, force: f64, duration: f64) {
        let steps = (duration / self.longest).ceil().max(1.0);
        let h = duration / steps;
        let lag = self.setup.lag();
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
        if self.setup.world == World::MaxwellSlip {
            self.settle(s[1]);
        }
    }

    /// Which elements slip after a step, `before` being the velocity at its beginning: one that reaches its level slips,
    /// until the motion turns back.
    fn settle(&mut self, before: f64) {
        let v = self.state[1];
        let level = self.machine.level(v.abs(), 2.0);
        let elements = self.state[4..8].iter_mut().zip(&mut self.slips);
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
        let mut out = [0.0; 9];
        let (friction, of_load) = self.friction(s, &mut out);
        let outside = match self.setup.world {
            World::Cogging => 0.2 * m.coulomb * (TAU * PITCHES * x / m.top_speed).sin(),
            World::Weight if m.kind == "rotary" => WEIGHT * m.coulomb * (x + 0.3).cos(),
            World::Weight => WEIGHT * m.coulomb,
            World::Spring => m.coulomb * x / self.reach,
            _ => 0.0,
        } + self
            .setup
            .cogging
            .map_or(0.0, |c| c.amplitude * (TAU * x / c.pitch).sin());
        let (mass, coupling) = match (self.setup.compliance, self.setup.world) {
            (Some(spring), _) => {
                let k = spring.of(m.mass);
                (
                    (1.0 - spring.load) * m.mass,
                    k.0 * (x - xl) + k.1 * (v - vl),
                )
            }
            (_, World::Backlash) => {
                let k = self.spring(RESONANCE_OF_GAP);
                let half = 0.5 * gap(m);
                let apart = x - xl;
                let squeezed = apart - apart.clamp(-half, half);
                let damped = if squeezed == 0.0 { 0.0 } else { v - vl };
                (MOTOR * m.mass, k.0 * squeezed + k.1 * damped)
            }
            (_, World::ResonanceAtMotor | World::ResonanceAtLoad) => {
                let k = self.spring(match self.setup.world {
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
            out[3] = (coupling - of_load) / (m.mass - mass);
        }
        out
    }

    /// Friction at the motor and of the load itself, N, and the rates of their states.
    fn friction(&self, s: &State, out: &mut State) -> (f64, f64) {
        let m = &self.machine;
        let (x, v) = (s[0], s[1]);
        if self.setup.world == World::MaxwellSlip {
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
            return (sum, 0.0);
        }
        let exponent = if self.setup.world == World::Exponent {
            1.0
        } else {
            2.0
        };
        let changed = match self.setup.world {
            World::PositionWave => 1.0 + 0.15 * (0.5 * TAU * WAVES * x / self.reach).sin(),
            World::Position => 1.0 + 0.15 * x / self.reach,
            World::WarmUp => 1.0 - 0.2 * (self.time / self.duration).min(1.0),
            _ => (self.setup.level).map_or(1.0, |level| level.at(x / self.reach)),
        };
        let bristle = |z: f64, v: f64| {
            let rate = v - m.sigma0 * v.abs() * z / (changed * m.level(v.abs(), exponent));
            (m.sigma0 * z + m.sigma1 * rate, rate)
        };
        let viscous = self.of_load();
        let (force, rate) = bristle(s[4], v);
        out[4] = rate;
        let at_motor = force + (m.sigma2 - viscous) * v;
        let share = self.setup.compliance.map_or(0.0, |c| c.friction);
        if share == 0.0 {
            return (at_motor, viscous * s[3]);
        }
        let (force, rate) = bristle(s[8], s[3]);
        out[8] = rate;
        let at_load = share * (force + m.sigma2 * s[3]);
        ((1.0 - share) * at_motor, at_load)
    }

    /// Viscous friction of the load itself, N s/m.
    fn of_load(&self) -> f64 {
        match self.setup.world {
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
