//! Simulated logs of axes that are, or are not, what an identification assumes.
//!
//! A [`World`] is one thing that differs from a rigid mass with LuGre friction, a force without delay and an encoder that is
//! read at every sample; a [`Setup`] adds what is common in practice around any of them. A [`Set`] is where the logs come from:
//! constants are chosen on one, tests assert on another, documents show the third. Everything is simulated here by a fine step
//! of its own (Runge-Kutta of fourth order, at most 10 us), with laws written out from their publications, so that no error of
//! the engines can hide in the log that tests them.
//!
//! ```
//! use stiction_testkit::worlds::{Machine, Motion, World, record};
//!
//! let machine = Machine::stage(1);
//! let log = record(&machine, Motion::Trapezoid, World::Faithful, 1);
//! assert_eq!(log.time.len(), log.force.len());
//! assert!(machine.truth().iter().any(|&(name, value)| name == "coulomb" && value == machine.coulomb));
//! ```

mod fine;
mod logged;
mod machine;
mod motion;
mod running;
mod set;
mod setup;

pub use logged::{Recording, record};
pub use machine::Machine;
pub use motion::Motion;
pub use running::Running;
pub use set::{Case, Set};
pub use setup::{Cogging, Compliance, Controller, Level, Setup};

/// What differs from the world that an identification of LuGre assumes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum World {
    /// Nothing.
    Faithful,
    /// A force that repeats with the position, a fifth of the Coulomb level, not declared.
    Cogging,
    /// Friction that is 15 % higher at one end of the stroke, and as much lower at the other.
    Position,
    /// Friction that falls by 20 % during the log.
    WarmUp,
    /// Motor, with the friction and the encoder, and load with a gap of half the presliding length between them.
    Backlash,
    /// Motor, with the friction and the encoder, and load on a spring: a lightly damped resonance.
    ResonanceAtMotor,
    /// The same, with the encoder on the load.
    ResonanceAtLoad,
    /// Friction that rises and falls by 15 % along the stroke, with a pitch of its own.
    PositionWave,
    /// A random force on the axis that the log does not show, a tenth of the Coulomb level.
    HiddenForce,
    /// Friction falls off as exp(-|v/vs|) instead of exp(-(v/vs)^2).
    Exponent,
    /// Four Maxwell-slip elements in place of one bristle (Al-Bender, Lampaert, Swevers 2005, doi 10.1109/TAC.2005.858676).
    MaxwellSlip,
    /// The force is logged that many samples late.
    Late(usize),
    /// The position is renewed at every eighth sample only.
    Held,
    /// The log has no position, and a velocity behind a filter of first order of four samples.
    LaggedVelocity,
    /// The logged force is cut off at nine tenths of the static friction.
    Saturation,
    /// The logged force comes in steps of a fifth of the Coulomb level.
    CoarseForce,
    /// One row in two hundred is missing, and samples are taken up to a fifth of their distance beside their time stamp.
    Dropped,
    /// The axis feels the force behind the drive.
    Driven(Drive),
    /// The force is logged behind a low-pass of first order of that time constant, s; the axis feels the one before it.
    Filtered(f64),
    /// The force is logged as the mean over that many rows.
    Averaged(usize),
    /// A spring that holds the axis in the middle of its stroke, with the Coulomb level at either end, not declared.
    Spring,
    /// A weight on a lever, of eight tenths of the Coulomb level where it is level, not declared; on a linear axis a constant force.
    Weight,
    /// The log holds the force that the controller asks for, and the drive gives eight tenths of the largest at most.
    Limited,
    /// A brake holds the axis where it rests, and the controller lets go meanwhile.
    Brake,
}

/// What lies between the force that a controller asks for, which is logged, and the force that the axis feels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Whole periods of computing time.
    pub periods: usize,
    /// Time constant of the current loop, first order, s; 0 for none.
    pub lag: f64,
    /// Every how many periods a row is logged.
    pub every: usize,
}

impl World {
    /// All of the tables but the drives, the filters and some others, one of each kind but for the delay.
    pub const ALL: [World; 18] = [
        World::Faithful,
        World::Cogging,
        World::Position,
        World::WarmUp,
        World::Backlash,
        World::ResonanceAtMotor,
        World::ResonanceAtLoad,
        World::HiddenForce,
        World::Exponent,
        World::MaxwellSlip,
        World::Late(1),
        World::Late(10),
        World::Late(40),
        World::Held,
        World::LaggedVelocity,
        World::Saturation,
        World::CoarseForce,
        World::Dropped,
    ];

    /// Digital drives: current loops of 0.3 and 1 ms, one period of computing time, rows at every second and fourth period.
    pub const DRIVES: [World; 6] = [
        Drive::behind(0, 3e-4, 1),
        Drive::behind(0, 1e-3, 1),
        Drive::behind(1, 0.0, 1),
        Drive::behind(1, 3e-4, 1),
        Drive::behind(0, 3e-4, 2),
        Drive::behind(0, 3e-4, 4),
    ];

    /// Further ones, each named after what an identification should name.
    pub const OTHERS: [World; 4] = [World::Spring, World::Weight, World::Limited, World::Brake];

    /// Logged forces behind low-passes of 0.5 to 5 ms.
    pub const FILTERS: [World; 4] = [
        World::Filtered(5e-4),
        World::Filtered(1.7e-3),
        World::Filtered(3e-3),
        World::Filtered(5e-3),
    ];

    /// Its name in tables.
    pub fn name(self) -> String {
        match self {
            World::Faithful => "as assumed".into(),
            World::Cogging => "cogging".into(),
            World::Position => "position".into(),
            World::WarmUp => "warm-up".into(),
            World::Backlash => "backlash".into(),
            World::ResonanceAtMotor => "resonance, encoder on motor".into(),
            World::ResonanceAtLoad => "resonance, encoder on load".into(),
            World::PositionWave => "position wave".into(),
            World::HiddenForce => "hidden force".into(),
            World::Exponent => "exponent 1".into(),
            World::MaxwellSlip => "Maxwell-slip".into(),
            World::Late(samples) => format!("force {samples} late"),
            World::Held => "held position".into(),
            World::LaggedVelocity => "lagged velocity".into(),
            World::Saturation => "saturation".into(),
            World::CoarseForce => "coarse force".into(),
            World::Dropped => "dropped, jitter".into(),
            World::Driven(drive) => drive.name(),
            World::Averaged(rows) => format!("force over {rows} rows"),
            World::Spring => "spring".into(),
            World::Weight => "weight".into(),
            World::Limited => "limited drive".into(),
            World::Brake => "brake".into(),
            World::Filtered(time) => format!("force filtered {:.1} ms", 1e3 * time),
        }
    }
}

impl Drive {
    const fn behind(periods: usize, lag: f64, every: usize) -> World {
        World::Driven(Drive {
            periods,
            lag,
            every,
        })
    }

    fn name(self) -> String {
        let lag = format!("current loop {} us", 1e6 * self.lag);
        let periods = format!("{} computing", self.periods);
        let every = format!("1 row of {}", self.every);
        let said = [
            (self.periods > 0).then_some(periods),
            (self.lag > 0.0).then_some(lag),
            (self.every > 1).then_some(every),
        ];
        said.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}
