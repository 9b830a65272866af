//! What a misfit is most likely to come from, and which parameters it makes doubtful.

use super::{Between, Divided, Misfit, Repeats};

/// Part of the variance of the residual from which a misfit is named. Replicas and chance leave up to about half of it where
/// the law is right.
pub(super) const NAMED_SHARE: f64 = 0.1;
/// Part that a ripple over the position explains where it is the cause; a wrong law comes back at the same places too, less
/// sharply.
const RIPPLE_SHARE: f64 = 0.6;
/// Part of the largest share that a level over position, load or temperature has where it is the cause, and the largest share
/// that forces over the position then have beside a level over the position.
const LEVEL_PART: f64 = 0.8;
const LEVEL_BESIDE: f64 = 0.3;

/// Where the systematic part of a residual comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The level of friction changes during the log.
    Drift,
    /// The level of friction changes along the stroke.
    Position,
    /// The level of friction changes with the load that the log has.
    Load,
    /// The level of friction changes with the temperature that the log has.
    Temperature,
    /// A force that repeats with the position.
    Ripple,
    /// A force that grows with the position.
    SpringForce,
    /// A load on a spring.
    Resonance,
    /// A load behind a gap.
    Backlash,
    /// Dynamics between force and motion that a rigid mass and a delay do not have.
    Dynamics,
    /// Force and motion stamped by two clocks that run apart.
    Clocks,
    /// A drive that gave less than was logged.
    Limit,
    /// Something else than friction that holds the axis where it rests.
    Held,
    /// Friction or inertia of another shape than that of the law.
    Shape,
}

impl Misfit {
    /// The most likely cause; `None` where the misfit is too small a part of the residual to be named, or the log is too short for
    /// what it seems to be.
    pub fn cause(&self) -> Option<Cause> {
        if self.limit.is_some() {
            return Some(Cause::Limit);
        }
        // What two clocks leave is told by how the delay grows, however small it is beside the noise.
        if self.clocks.is_some() {
            return Some(Cause::Clocks);
        }
        if self.share < NAMED_SHARE {
            return None;
        }
        if self.held.is_some() {
            return Some(Cause::Held);
        }
        if let Some(coupling) = &self.coupling {
            return Some(match coupling.between {
                Between::Spring { .. } => Cause::Resonance,
                Between::Gap { .. } => Cause::Backlash,
            });
        }
        if let Some(ripple) = self.ripple.filter(|ripple| ripple.replaces.is_some()) {
            return Some(match ripple.what {
                Repeats::Force => Cause::Ripple,
                Repeats::Level => Cause::Position,
            });
        }
        if self
            .ripple
            .is_some_and(|ripple| ripple.what == Repeats::Force)
        {
            return Some(Cause::Ripple);
        }
        if self.spring_force.is_some() {
            return Some(Cause::SpringForce);
        }
        if self.dynamics.is_some() {
            return Some(Cause::Dynamics);
        }
        let share = |by| self.share_by(by);
        let explains = |by| share(by) >= LEVEL_PART * self.share;
        // What is measured beside the motion says more than time or place, with which it changes.
        Some(if explains(Divided::LevelOverLoad) {
            Cause::Load
        } else if explains(Divided::LevelOverTemperature) {
            Cause::Temperature
        } else if self.by == Divided::LevelOverTime {
            return self.is_long.then_some(Cause::Drift);
        } else if share(Divided::Position) >= RIPPLE_SHARE && self.by == Divided::Position {
            Cause::Ripple
        } else if explains(Divided::LevelOverPosition) && share(Divided::Position) < LEVEL_BESIDE {
            Cause::Position
        } else {
            Cause::Shape
        })
    }

    /// Part of the variance of the residual that comes back in a way of dividing the motion.
    pub fn share_by(&self, by: Divided) -> f64 {
        let own = self.shares.iter().find(|(own, _)| *own == by);
        own.map_or(0.0, |(_, share)| *share)
    }
}

impl Cause {
    /// By what the motion is divided where a level of friction changes.
    pub(super) fn level(self) -> Option<Divided> {
        match self {
            Cause::Drift => Some(Divided::LevelOverTime),
            Cause::Position => Some(Divided::LevelOverPosition),
            Cause::Load => Some(Divided::LevelOverLoad),
            Cause::Temperature => Some(Divided::LevelOverTemperature),
            Cause::Ripple
            | Cause::SpringForce
            | Cause::Resonance
            | Cause::Backlash
            | Cause::Dynamics
            | Cause::Clocks
            | Cause::Limit
            | Cause::Held
            | Cause::Shape => None,
        }
    }
}
