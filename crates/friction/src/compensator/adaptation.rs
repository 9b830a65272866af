//! Levels of friction that are found while the axis runs.

use super::friction::Friction;
use super::input::Input;
use crate::error::require;
use crate::{ParamError, Real};

/// Inertial force over that of friction at standstill below which the mass is held at its given value.
const HELD_MASS: f64 = 0.02;
/// Largest mass that is found, in given masses.
const MOST_MASSES: f64 = 5.0;
/// Weight of what was identified before anything is learnt, in memories.
const INITIAL_WEIGHT: f64 = 0.1;
/// Largest forces and accelerations that are learnt from, in their units: no product of them overflows in single precision.
const LARGEST: f64 = 1e8;
/// Least force of the law that is learnt from, relative to its scale.
const LEAST: f64 = 0.1;
/// Least integral of the squared acceleration that a mass is found from, m^2/s^3 (rad^2/s^3).
const LEAST_SQUARE: f64 = 1e-15;

/// A factor on the law's force for each direction of motion, found from the force of the drive.
///
/// While the axis slides the drive gives `u = offset + level F + M a`, with the law's force F less its offset, and the
/// acceleration a of the reference. Levels and mass follow by recursive least squares with exponential forgetting (Astrom,
/// Wittenmark 1995, Adaptive Control, chapter 2), in the form of sums, which cannot wind up: nothing is forgotten while nothing
/// is learnt. The sums are of what is beyond the identified law and the given mass, so that digits are not lost where inertial
/// forces are large. The mass is found beside the levels so that a load does not pass for friction; the compensator does not
/// feed it forward. A constant force that the law does not know raises one level and lowers the other, and is so compensated
/// while the axis moves.
///
/// Nothing is learnt until the axis itself has moved on by more than its presliding after the reference has turned, at
/// standstill, while the force is at its limit, while the watchdog has switched off, or where [`Input::learn`] is false. One
/// sample moves the levels by no more than if the whole friction were missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptation<T> {
    /// Time constant of the forgetting, counted in time that is learnt from, > 0, s.
    pub memory: T,
    /// How far from 1 the levels may go, > 0 and < 1.
    pub range: T,
    /// Moving mass, >= 0, kg (kg m^2): what the drive accelerates beside friction. 0: none, or unknown.
    pub mass: T,
}

/// What an adaptation has learnt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Learnt<T> {
    /// Factors on the law's force, less its offset, for motion forward and back.
    pub levels: [T; 2],
    /// Mass, kg (kg m^2).
    pub mass: T,
    /// For each direction the sums of F^2, F a, a^2, F r and a r over what is remembered, with r what `u` is beyond the law and
    /// the given mass.
    sums: [[T; 5]; 2],
    /// The sample before, once there is one.
    before: Option<Before<T>>,
    /// The reference moves forward.
    forward: bool,
    /// How far the axis has moved since the reference turned, m (rad).
    moved: T,
}

/// A sample that the force of the drive at the next one was commanded for.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Before<T> {
    /// Reference velocity, and its change from the sample before, m/s and m/s^2 (rad/s, rad/s^2).
    velocity: T,
    change: T,
    /// Tracking error, m (rad).
    error: T,
    /// The law's force without the offset, N (N m).
    dry: T,
}

impl<T: Real> Default for Adaptation<T> {
    /// A memory of 1 s, levels from 0.5 to 1.5, no mass.
    fn default() -> Self {
        Adaptation {
            memory: T::ONE,
            range: T::from_f64(0.5),
            mass: T::ZERO,
        }
    }
}

impl<T: Real> Learnt<T> {
    pub(super) fn nothing() -> Self {
        Learnt {
            levels: [T::ONE; 2],
            mass: T::ZERO,
            sums: [[T::ZERO; 5]; 2],
            before: None,
            forward: true,
            moved: T::ZERO,
        }
    }

    /// Begins anew, with these levels.
    pub(super) fn recall(&mut self, levels: [T; 2]) {
        *self = Learnt {
            levels,
            ..Learnt::nothing()
        };
    }

    /// The factor between the two directions: `side` is 1 where friction opposes motion forward, -1 for motion back.
    #[inline]
    pub(super) fn level(&self, side: T) -> T {
        let half = T::from_f64(0.5);
        let [forward, back] = self.levels;
        half * (forward + back) + half * (forward - back) * side
    }
}

impl<T: Real> Adaptation<T> {
    pub(super) fn validate(&self) -> Result<(), ParamError> {
        ParamError::positive("adaptation_memory", self.memory)?;
        ParamError::not_negative("adaptation_mass", self.mass)?;
        require(
            self.range > T::ZERO && self.range < T::ONE,
            "adaptation_range",
            self.range,
            "above 0 and below 1",
        )
    }

    /// What is known at the start: the levels as they were identified, or as they were kept.
    fn begin(&self, levels: [T; 2], friction: &Friction<T>) -> [[T; 5]; 2] {
        let size = friction.scale();
        let weight = T::from_f64(INITIAL_WEIGHT) * self.memory * size * size;
        levels.map(|level| [weight, T::ZERO, T::ZERO, weight * (level - T::ONE), T::ZERO])
    }

    /// Takes a sample: the law's own `force` at the reference velocity, over `h` seconds. `frozen` learns nothing.
    pub(super) fn step(
        &self,
        learnt: &mut Learnt<T>,
        friction: &Friction<T>,
        h: T,
        input: &Input<T>,
        force: T,
        frozen: bool,
    ) {
        let v = input.reference_velocity;
        let error = input.tracking_error;
        if h <= T::ZERO {
            return;
        }
        let velocity = learnt.before.map_or(v, |before| before.velocity);
        let now = Before {
            velocity: v,
            change: (v - velocity) / h,
            error,
            dry: force - friction.offset(),
        };
        let Some(before) = learnt.before.replace(now) else {
            learnt.sums = self.begin(learnt.levels, friction);
            learnt.mass = self.mass;
            return;
        };
        let forward = v > T::ZERO;
        if v == T::ZERO || forward != learnt.forward {
            learnt.forward = forward;
            learnt.moved = T::ZERO;
            return;
        }
        learnt.moved = learnt.moved + h * v - (error - before.error);
        let along = if forward { learnt.moved } else { -learnt.moved };
        let dry = before.dry;
        let pushes = if forward { dry } else { -dry };
        let least = T::from_f64(LEAST) * friction.scale();
        let slides = along > friction.sliding() && pushes > least;
        if frozen || !slides {
            return;
        }
        let side = usize::from(!forward);
        let a = match self.mass > T::ZERO {
            true => T::from_f64(0.5) * (before.change + now.change),
            false => T::ZERO,
        };
        let known = learnt.levels[side] * dry + learnt.mass * a;
        let most = dry.abs();
        let left = (input.drive_force - friction.offset() - known)
            .max(-most)
            .min(most);
        let beyond = (learnt.levels[side] - T::ONE) * dry + (learnt.mass - self.mass) * a + left;
        let largest = T::from_f64(LARGEST);
        if !(most <= largest && a.abs() <= largest && beyond.abs() <= largest) {
            return;
        }
        let fade = T::ONE - (h / self.memory).min(T::ONE);
        let terms = [dry * dry, dry * a, a * a, dry * beyond, a * beyond];
        let mut sums = learnt.sums[side];
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum = *sum * fade + h * term;
        }
        // A time that overflows changes nothing.
        if !sums.iter().all(|sum| sum.is_finite()) {
            return;
        }
        learnt.sums[side] = sums;
        self.solve(learnt, friction);
    }

    /// Levels and mass of least squares.
    fn solve(&self, learnt: &mut Learnt<T>, friction: &Friction<T>) {
        // A law without force at low speed knows nothing at the start.
        let known = learnt.sums.into_iter().filter(|sums| sums[0] > T::ZERO);
        if self.mass > T::ZERO {
            let least = T::from_f64(HELD_MASS) * friction.scale() / self.mass;
            let held = least * least * self.memory;
            let (mut square, mut product) = (held, T::ZERO);
            for [ff, fa, aa, fr, ar] in known {
                square = square + (aa - fa * (fa / ff)).max(T::ZERO);
                product = product + (ar - fa * (fr / ff));
            }
            if square > T::from_f64(LEAST_SQUARE) {
                let most = T::from_f64(MOST_MASSES) * self.mass;
                learnt.mass = (self.mass + product / square).max(T::ZERO).min(most);
            }
        }
        for (level, [ff, fa, _, fr, _]) in learnt.levels.iter_mut().zip(learnt.sums) {
            if ff <= T::ZERO {
                continue;
            }
            let next = T::ONE + (fr - fa * (learnt.mass - self.mass)) / ff;
            *level = next.max(T::ONE - self.range).min(T::ONE + self.range);
        }
    }
}
