//! Factors on friction that are found while the axis runs.

use super::friction::Friction;
use super::input::Input;
use crate::error::require;
use crate::{ParamError, Real};

/// Time in which the integrator of a controller takes up a force, s: that of the slowest loop that is simulated (0.2 of a
/// bandwidth of 20 Hz, 40 ms), and some more.
const TAKEN_UP: f64 = 0.05;
/// Time over which all that is learnt from is smoothed, s: a tenth of that. An acceleration is a difference of two velocities,
/// which may be differences of counts.
const SMOOTHED: f64 = 0.005;
/// Share of what is taken up that is learnt from, so that a level is also found where reversals say little.
const CONSTANT: f64 = 0.1;
/// Force over friction at standstill below which viscous friction and inertia are held at their given values.
const HELD: f64 = 0.02;
/// Largest mass that is found, in given masses.
const MOST_MASSES: f64 = 5.0;
/// Weight of what was identified before anything is learnt, in memories.
const INITIAL_WEIGHT: f64 = 0.4;
/// Largest forces and accelerations that are learnt from, in their units: no product of them overflows in single precision.
const LARGEST: f64 = 1e8;
/// Least force of the law that is learnt from, relative to its scale.
const LEAST: f64 = 0.1;
/// Least weight that a mass is found with, m^2/s^3 (rad^2/s^3).
const LEAST_WEIGHT: f64 = 1e-15;

/// Factors on the dry part of the law's force and on its viscous part, found from the force of the drive. What changes friction
/// changes it in both directions alike, so one level stands for both.
///
/// While the axis slides the drive gives `u = offset + level D + factor V + M a`, with the dry part D and the viscous part V of the
/// law's force, and the acceleration a of the reference. The unknowns follow by recursive least squares with exponential forgetting
/// (Astrom, Wittenmark 1995, Adaptive Control, chapter 2), in the form of sums, which cannot wind up. The sums are of what is
/// beyond the identified law and the given mass, so that digits are not lost where inertial forces are large. The mass is found
/// beside the factors so that a load does not pass for friction; the compensator does not feed it forward.
///
/// What makes an error is not a force that the law lacks but a change of it: the integrator of the controller takes up what is
/// slow. So all signals pass a high-pass of its time, and a low-pass of a tenth of it, as do signals of a fit that is meant for control (Ljung 1999, System
/// Identification, section 14.4), and forgetting is counted in what is new: a long stroke does not push out the reversals before.
/// What is learnt acts only as far as it explains the force of the drive better than the identified law does: by the share
/// `1 - (R/E)^2`, not below 0, with what is explained E and what is left R (decision 0115).
///
/// Nothing is learnt until the axis itself has moved on by more than its presliding after the reference has turned, at
/// standstill, while the force or that of the law is at its limit, while the watchdog has switched off, or where
/// [`Input::learn`] is false. One sample counts for no more than if the whole friction were missing, and for no longer than the
/// memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptation<T> {
    /// Time constant of the forgetting, counted in time in which the force is new, > 0, s: some 0.06 s after each reversal.
    pub memory: T,
    /// How far from 1 the factors may go, > 0 and < 1.
    pub range: T,
    /// Moving mass, >= 0, kg (kg m^2): what the drive accelerates beside friction. 0: none, or unknown.
    pub mass: T,
}

/// What an adaptation has learnt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Learnt<T> {
    /// Factor on the dry part of the law's force.
    pub level: T,
    /// Factor on its viscous part.
    pub viscous: T,
    /// Mass, kg (kg m^2).
    pub mass: T,
    /// What least squares find of level, viscous factor and mass beyond 1 and the given mass.
    found: [T; 3],
    /// Sums over what is remembered: products of D, V, a and what the force is beyond the law and the given mass.
    sums: [[T; 4]; 4],
    /// These smoothed, and what an integrator has taken up of them.
    smooth: [T; 4],
    slow: [T; 4],
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
    /// Dry and viscous part of the law's force, N (N m).
    parts: [T; 2],
}

impl<T: Real> Default for Adaptation<T> {
    /// A memory of 0.25 s, some four reversals; factors from 0.5 to 1.5; no mass.
    fn default() -> Self {
        Adaptation {
            memory: T::from_f64(0.25),
            range: T::from_f64(0.5),
            mass: T::ZERO,
        }
    }
}

impl<T: Real> Learnt<T> {
    pub(super) fn nothing() -> Self {
        Learnt {
            level: T::ONE,
            viscous: T::ONE,
            mass: T::ZERO,
            found: [T::ZERO; 3],
            sums: [[T::ZERO; 4]; 4],
            smooth: [T::ZERO; 4],
            slow: [T::ZERO; 4],
            before: None,
            forward: true,
            moved: T::ZERO,
        }
    }

    /// Begins anew, with these factors.
    pub(super) fn recall(&mut self, level: T, viscous: T) {
        *self = Learnt {
            level,
            viscous,
            ..Learnt::nothing()
        };
    }

    /// The force of what was found, from the parts of a sample.
    fn force(&self, sample: &[T; 4]) -> T {
        let parts = self.found.iter().zip(sample);
        parts.fold(T::ZERO, |sum, (x, part)| sum + *x * *part)
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

    /// What is known at the start: the factors as they were identified, or as they were kept.
    fn begin(&self, learnt: &mut Learnt<T>, friction: &Friction<T>) {
        let size = friction.scale();
        let weight = T::from_f64(INITIAL_WEIGHT) * self.memory * size * size;
        for (k, factor) in [learnt.level, learnt.viscous].into_iter().enumerate() {
            let beyond = factor - T::ONE;
            learnt.found[k] = beyond;
            learnt.sums[k][k] = weight;
            learnt.sums[k][3] = weight * beyond;
            learnt.sums[3][3] = learnt.sums[3][3] + weight * beyond * beyond;
        }
        learnt.mass = self.mass;
    }

    /// Takes a sample: dry and viscous part of the law's own force at the reference velocity, over `h` seconds. Learns while that
    /// force is below `most`.
    pub(super) fn step(
        &self,
        learnt: &mut Learnt<T>,
        friction: &Friction<T>,
        h: T,
        input: &Input<T>,
        parts: [T; 2],
        most: T,
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
            parts,
        };
        let Some(before) = learnt.before.replace(now) else {
            self.begin(learnt, friction);
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
        let [dry, viscous] = before.parts;
        let law = dry + viscous;
        let pushes = if forward { law } else { -law };
        let least = T::from_f64(LEAST) * friction.scale();
        let slides = along > friction.sliding() && pushes > least;
        if !slides || pushes >= most {
            return;
        }
        let a = match self.mass > T::ZERO {
            true => T::from_f64(0.5) * (before.change + now.change),
            false => T::ZERO,
        };
        let mut sample = [dry, viscous, a, T::ZERO];
        // Beside what was left before.
        let due = learnt.force(&sample) + (learnt.slow[3] - learnt.force(&learnt.slow));
        let beyond = (input.drive_force - friction.offset() - law) - self.mass * a;
        sample[3] = due + (beyond - due).max(-pushes).min(pushes);
        let largest = T::from_f64(LARGEST);
        if sample.iter().all(|x| x.abs() <= largest) {
            self.learn(learnt, friction, h, sample, law);
        }
    }

    /// Adds a sample, over `h` seconds, at which the law has this force.
    fn learn(&self, learnt: &mut Learnt<T>, friction: &Friction<T>, h: T, sample: [T; 4], law: T) {
        let h = h.min(self.memory);
        let follow = |states: &mut [T; 4], of: &[T; 4], time: f64| {
            let part = (h / T::from_f64(time)).min(T::ONE);
            for (state, x) in states.iter_mut().zip(of) {
                *state = *state + part * (*x - *state);
            }
        };
        let (mut smooth, mut slow) = (learnt.smooth, learnt.slow);
        follow(&mut smooth, &sample, SMOOTHED);
        let taken = T::ONE - T::from_f64(CONSTANT);
        let mut fresh = smooth;
        for (fresh, slow) in fresh.iter_mut().zip(slow) {
            *fresh = *fresh - taken * slow;
        }
        let share = (fresh[0] + fresh[1]) / law;
        let new = (share * share).min(T::ONE);
        let fade = T::ONE - h / self.memory * new;
        let mut sums = learnt.sums;
        for (row, x) in sums.iter_mut().zip(fresh) {
            for (sum, y) in row.iter_mut().zip(fresh) {
                *sum = *sum * fade + h * (x * y);
            }
        }
        // Sums that overflow change nothing.
        if !sums.iter().flatten().all(|sum| sum.is_finite()) {
            return;
        }
        learnt.sums = sums;
        follow(&mut slow, &smooth, TAKEN_UP);
        (learnt.smooth, learnt.slow) = (smooth, slow);
        self.solve(learnt, friction);
    }

    /// Least squares within their bounds, by a sweep of Gauss-Seidel, and how far they act.
    fn solve(&self, learnt: &mut Learnt<T>, friction: &Friction<T>) {
        let (sums, found) = (&learnt.sums, &mut learnt.found);
        let held = T::from_f64(HELD) * friction.scale();
        let given = T::from_f64(MOST_MASSES - 1.0) * self.mass;
        for k in 0..3 {
            let (held, least, low, high) = match k {
                0 => (T::ZERO, T::ZERO, -self.range, self.range),
                1 => (held, T::ZERO, -self.range, self.range),
                _ if self.mass > T::ZERO => (
                    held / self.mass,
                    T::from_f64(LEAST_WEIGHT),
                    -self.mass,
                    given,
                ),
                _ => break,
            };
            let weight = sums[k][k] + held * held * self.memory;
            // A law without force at low speed knows nothing at the start.
            if weight > least {
                let others = (0..3).filter(|j| *j != k);
                let left = others.fold(sums[k][3], |left, j| left - sums[k][j] * found[j]);
                found[k] = (left / weight).max(low).min(high);
            }
        }
        let [level, viscous, mass] = *found;
        learnt.mass = self.mass + mass;
        let two = T::from_f64(2.0);
        let mut explained = T::ZERO;
        for k in 0..2 {
            let mut own = two * (sums[k][3] - sums[k][2] * mass);
            for j in 0..2 {
                own = own - sums[k][j] * found[j];
            }
            explained = explained + found[k] * own;
        }
        let inertia = mass * (two * sums[2][3] - sums[2][2] * mass);
        let left = (sums[3][3] - inertia - explained).max(T::ZERO);
        let mut doubt = T::ONE;
        if explained > T::ZERO {
            doubt = (left / explained).min(T::ONE);
        }
        let share = T::ONE - doubt * doubt;
        learnt.level = T::ONE + share * level;
        learnt.viscous = T::ONE + share * viscous;
    }
}
