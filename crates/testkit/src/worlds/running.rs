//! The axis of a world after its log, moved by any force.

use super::fine::Fine;
use super::logged::Hidden;
use super::{Machine, Motion, Setup};
use crate::random::Random;

/// An axis at rest at the origin of its motion, as warm as the log has left it.
pub struct Running {
    axis: Fine,
    hidden: Hidden,
    random: Random,
}

impl Running {
    /// The axis of a log; `seed` is that of a force which no log shows.
    pub fn after(machine: &Machine, motion: Motion, setup: impl Into<Setup>, seed: u64) -> Self {
        let setup = setup.into();
        let path = motion.of(machine);
        let mut axis = Fine::of(machine, &path, setup);
        axis.has_run();
        Running {
            axis,
            hidden: Hidden::of(machine, setup.world),
            random: Random::new(seed ^ 0x7275_6e73),
        }
    }

    /// Moves it by `duration` (s) under a constant force (N) and gives position and velocity where the encoder is.
    pub fn advance(&mut self, force: f64, duration: f64) -> (f64, f64) {
        let unseen = self.hidden.next(duration, &mut self.random);
        self.axis.advance(force + unseen, duration);
        (self.axis.position(), self.axis.velocity())
    }
}
