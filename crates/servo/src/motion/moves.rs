//! Moves one after the other, and the step.

use super::{Limits, Profile};
use crate::path::Reference;
use crate::trajectory::Trajectory;
use stiction_friction::ParamError;

/// One move from rest to rest and the time at rest after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// m (rad), of either sign.
    pub distance: f64,
    /// >= 0, s.
    pub dwell: f64,
}

/// Jerk-limited moves one after the other, from the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Moves {
    parts: Vec<(Profile, f64)>,
}

impl Moves {
    /// At least one move, all within the same limits.
    pub fn new(moves: &[Move], limits: Limits) -> Result<Self, ParamError> {
        if moves.is_empty() {
            return Err(ParamError::new("moves", 0.0, "at least one"));
        }
        let parts = moves.iter().map(|m| {
            ParamError::not_negative("dwell", m.dwell)?;
            Ok((Profile::new(m.distance, limits)?, m.dwell))
        });
        Ok(Moves {
            parts: parts.collect::<Result<_, ParamError>>()?,
        })
    }

    /// Point to point: there, and back, with a `dwell` (s) after each.
    pub fn there_and_back(distance: f64, dwell: f64, limits: Limits) -> Result<Self, ParamError> {
        let moves = [distance, -distance].map(|distance| Move { distance, dwell });
        Moves::new(&moves, limits)
    }

    /// `steps` >= 1 equal moves of `distance` up and as many down.
    pub fn staircase(
        distance: f64,
        steps: u32,
        dwell: f64,
        limits: Limits,
    ) -> Result<Self, ParamError> {
        let up = (0..steps).map(|_| distance);
        let down = (0..steps).map(|_| -distance);
        let moves: Vec<Move> = up
            .chain(down)
            .map(|distance| Move { distance, dwell })
            .collect();
        Moves::new(&moves, limits)
    }

    /// `limits.velocity` held for `hold` > 0 seconds, there and back.
    pub fn constant_velocity(hold: f64, limits: Limits) -> Result<Self, ParamError> {
        ParamError::positive("hold", hold)?;
        limits.validate()?;
        // The ramp does not depend on the distance at speed; it covers as much as half its time at full speed.
        let Limits {
            velocity,
            acceleration,
            jerk,
        } = limits;
        let longest =
            velocity / acceleration + acceleration / jerk + 2.0 * libm::sqrt(velocity / jerk);
        let ramp = Profile::new(2.0 * velocity * longest, limits)?.ramp();
        Moves::there_and_back(limits.velocity * (hold + ramp), 0.0, limits)
    }
}

impl Trajectory for Moves {
    fn duration(&self) -> f64 {
        self.parts
            .iter()
            .map(|(p, dwell)| p.duration() + dwell)
            .sum()
    }

    fn at(&self, t: f64) -> Reference {
        let (mut start, mut origin) = (0.0, 0.0);
        for (profile, dwell) in &self.parts {
            let whole = profile.duration() + dwell;
            if t - start < whole {
                let here = profile.at(t - start);
                return Reference {
                    position: origin + here.position,
                    ..here
                };
            }
            start += whole;
            origin += profile.distance();
        }
        Reference {
            position: origin,
            ..Reference::default()
        }
    }
}

/// A step of the position, with no velocity or acceleration to feed forward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    size: f64,
    from: f64,
    duration: f64,
}

impl Step {
    /// A step of `size` (m, rad) at the instant `from` within `duration` > 0, s.
    pub fn new(size: f64, from: f64, duration: f64) -> Result<Self, ParamError> {
        ParamError::finite("size", size)?;
        ParamError::finite("from", from)?;
        ParamError::positive("duration", duration)?;
        Ok(Step {
            size,
            from,
            duration,
        })
    }
}

impl Trajectory for Step {
    fn duration(&self) -> f64 {
        self.duration
    }

    fn at(&self, t: f64) -> Reference {
        Reference {
            position: if t >= self.from { self.size } else { 0.0 },
            ..Reference::default()
        }
    }
}
