//! What is common in practice around an axis, each apart from the others.

use super::{Machine, World};
use std::f64::consts::TAU;

/// A world, and what else the machine has: any of these together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// The one thing that an identification should name, or [`World::Faithful`].
    pub world: World,
    /// The loops around the axis.
    pub controller: Controller,
    /// Time constant of the current loop behind the logged force, s; 0 for none.
    pub current_loop: f64,
    /// A force that repeats with the position of the motor.
    pub cogging: Option<Cogging>,
    /// A spring between motor and load.
    pub compliance: Option<Compliance>,
    /// A level of friction that changes along the stroke.
    pub level: Option<Level>,
}

/// Loops of a servo drive; all of them read the counts of the encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Controller {
    /// P position loop and PI speed loop, with feedforward of speed and acceleration.
    Feedforward,
    /// The same without feedforward.
    PPi,
    /// One PID loop of the position, with all three poles of a free mass at a third of the bandwidth.
    Pid,
}

/// A force that repeats with the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cogging {
    /// Amplitude, N.
    pub amplitude: f64,
    /// Distance after which it repeats, m.
    pub pitch: f64,
}

/// How the level of friction goes along the stroke, by how large a part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// One wave over the stroke, from the middle of its rise.
    Wave(f64),
    /// A straight line, from below at its beginning to above at its end.
    Ramp(f64),
    /// A Gaussian whose deviation is a tenth of the stroke, at six tenths of it.
    Bump(f64),
}

impl Level {
    /// The factor on the level at this part of the stroke, 0 to 1.
    pub fn at(self, part: f64) -> f64 {
        let part = part.clamp(0.0, 1.0);
        match self {
            Level::Wave(size) => 1.0 + size * (TAU * part).sin(),
            Level::Ramp(size) => 1.0 + size * (2.0 * part - 1.0),
            Level::Bump(size) => 1.0 + size * (-0.5 * ((part - 0.6) / 0.1).powi(2)).exp(),
        }
    }
}

/// A load on a spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compliance {
    /// Frequency of the load while the motor stands still, Hz.
    pub frequency: f64,
    /// Damping ratio of that.
    pub damping: f64,
    /// Part of the mass that is the load's.
    pub load: f64,
    /// Part of the friction that is the load's own.
    pub friction: f64,
    /// Whether the encoder is on the load.
    pub is_read_at_load: bool,
}

impl From<World> for Setup {
    fn from(world: World) -> Self {
        Setup {
            world,
            controller: Controller::Feedforward,
            current_loop: 0.0,
            cogging: None,
            compliance: None,
            level: None,
        }
    }
}

impl Setup {
    /// Time constant of the current loop, s; 0 for none.
    pub(super) fn lag(&self) -> f64 {
        match self.world {
            World::Driven(drive) if drive.lag > 0.0 => drive.lag,
            _ => self.current_loop,
        }
    }

    /// What lies between motor and load: a frequency, Hz, or a lost motion, m; `None` where they are one.
    pub fn coupling(&self, machine: &Machine) -> Option<f64> {
        let compliance = self.compliance.map(|spring| spring.frequency);
        compliance.or_else(|| self.world.coupling(machine))
    }

    /// The parameters that an identification looks for, by name, as the encoder shows them. Where the load has friction of its
    /// own, its bristles are in series with the spring, and no one number is the damping of both.
    pub fn truth(&self, machine: &Machine) -> Vec<(&'static str, f64)> {
        let mut truth = machine.truth().to_vec();
        if let Some(spring) = self.compliance.filter(|spring| spring.friction > 0.0) {
            let beyond = spring.friction * machine.sigma0;
            let (stiffness, _) = spring.of(machine.mass);
            let in_series = beyond * stiffness / (beyond + stiffness);
            truth.retain(|t| t.0 != "sigma1");
            truth[0].1 = machine.sigma0 - beyond + in_series;
        }
        truth
    }
}

impl Compliance {
    /// Stiffness, N/m, and damping, N s/m, with that whole mass, kg.
    pub(super) fn of(self, mass: f64) -> (f64, f64) {
        let omega = TAU * self.frequency;
        let load = self.load * mass;
        (load * omega * omega, 2.0 * self.damping * load * omega)
    }
}
