//! Simulated logs of axes that are, or are not, what an identification assumes.
//!
//! A [`World`] is one thing that differs from a rigid mass with LuGre friction, a force without delay and an encoder that is
//! read at every sample. Everything is simulated here by a fine step of its own (Runge-Kutta of fourth order, at most 10 us),
//! with laws written out from their publications, so that no error of the engines can hide in the log that tests them.
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
mod random;
mod running;

pub use logged::{Recording, record};
pub use machine::Machine;
pub use motion::Motion;
pub use running::Running;

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
}

impl World {
    /// All of them, one of each kind but for the delay.
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
            World::HiddenForce => "hidden force".into(),
            World::Exponent => "exponent 1".into(),
            World::MaxwellSlip => "Maxwell-slip".into(),
            World::Late(samples) => format!("force {samples} late"),
            World::Held => "held position".into(),
            World::LaggedVelocity => "lagged velocity".into(),
            World::Saturation => "saturation".into(),
            World::CoarseForce => "coarse force".into(),
            World::Dropped => "dropped, jitter".into(),
        }
    }
}
