//! What is believed of the axis before it has moved.

use crate::candidate::{Candidate, PARAMETERS};
use crate::limits::Limits;
use crate::rig::Rig;
use crate::subject::Subject;
use stiction_friction::ParamError;

/// What the nameplate of a servo axis leaves open: ranges in equal ratios, independent of each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nameplate {
    /// kg (kg m^2), with everything that moves.
    pub mass: f64,
    /// How many times larger or smaller the mass may be, above 1.
    pub mass_factor: f64,
    /// What the axis may do.
    pub limits: Limits,
    /// What moves and reads it.
    pub rig: Rig,
}

/// Coulomb friction over the rated force.
const COULOMB: [f64; 2] = [0.02, 0.2];
/// Fs/Fc - 1.
const EXCESS: [f64; 2] = [0.1, 3.0];
/// Stribeck velocity over the largest speed.
const STRIBECK: [f64; 2] = [0.003, 0.3];
/// Viscous friction at the largest speed over Coulomb friction.
const VISCOUS: [f64; 2] = [0.1, 2.0];
/// Presliding length Fc/sigma0, m (rad), and its least in encoder steps.
const PRESLIDING: [f64; 2] = [1e-6, 200e-6];
const PRESLIDING_STEPS: f64 = 4.0;
/// Damping ratio of the bristles, sigma1/(2 sqrt(sigma0 M)).
const DAMPING: [f64; 2] = [0.1, 1.5];

impl Nameplate {
    /// The ranges as text for people: name, least, largest and what they are a part of.
    pub fn ranges(&self) -> [(&'static str, [f64; 2]); PARAMETERS] {
        let rated = self.limits.rated_force;
        let short = PRESLIDING[0].max(PRESLIDING_STEPS * self.rig.encoder_step);
        let by = self.mass_factor;
        [
            ("mass", [self.mass / by, self.mass * by]),
            ("coulomb", COULOMB.map(|part| part * rated)),
            ("static over coulomb", EXCESS.map(|excess| 1.0 + excess)),
            (
                "stribeck_velocity",
                STRIBECK.map(|part| part * self.limits.speed),
            ),
            ("sigma2 times speed over coulomb", VISCOUS),
            ("presliding length", [short, PRESLIDING[1].max(2.0 * short)]),
            ("damping ratio of the bristles", DAMPING),
        ]
    }

    /// The axis at a place in the unit cube.
    pub fn at(&self, unit: [f64; PARAMETERS]) -> Candidate {
        let ranges = self.ranges();
        let value = |i: usize, [low, high]: [f64; 2]| low * libm::pow(high / low, unit[i]);
        let mass = value(0, ranges[0].1);
        let coulomb = value(1, ranges[1].1);
        let excess = value(2, EXCESS);
        let stribeck_velocity = value(3, ranges[3].1);
        let viscous = value(4, ranges[4].1);
        let sigma0 = coulomb / value(5, ranges[5].1);
        let damping = value(6, ranges[6].1);
        Candidate::from_values([
            sigma0,
            2.0 * damping * libm::sqrt(sigma0 * mass),
            viscous * coulomb / self.limits.speed,
            coulomb,
            coulomb * (1.0 + excess),
            stribeck_velocity,
            mass,
        ])
    }

    /// The axis of a first identification with the least that a nameplate allows where that found nothing: viscous friction and
    /// micro-damping that were held at zero, because the data ask for less, and static friction at the Coulomb level.
    #[must_use]
    pub fn at_least(&self, mut axis: Candidate) -> Candidate {
        let speed = self.limits.speed;
        let viscous = |sigma2: &mut f64, coulomb: f64| {
            if *sigma2 == 0.0 {
                *sigma2 = VISCOUS[0] * coulomb / speed;
            }
        };
        viscous(&mut axis.sigma2, axis.coulomb);
        if let Some(back) = &mut axis.back {
            viscous(&mut back.sigma2, back.coulomb);
        }
        // Maxwell-slip elements have no damping of their own, and static friction that is the sum of theirs.
        if axis.slip.is_some() {
            return axis;
        }
        if axis.sigma1 == 0.0 {
            axis.sigma1 = 2.0 * DAMPING[0] * libm::sqrt(axis.sigma0 * axis.mass);
        }
        let peaked = |level: &mut f64, coulomb: f64| {
            if *level <= coulomb {
                *level = coulomb * (1.0 + EXCESS[0]);
            }
        };
        peaked(&mut axis.static_friction, axis.coulomb);
        if let Some(back) = &mut axis.back {
            peaked(&mut back.static_friction, back.coulomb);
        }
        axis
    }

    /// Refuses numbers out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        ParamError::positive("mass", self.mass)?;
        if !(self.mass_factor > 1.0 && self.mass_factor.is_finite()) {
            return Err(ParamError::new("mass_factor", self.mass_factor, "above 1"));
        }
        self.limits.validate()?;
        self.rig.validate()
    }

    /// `count` axes, spread evenly by a scrambled Sobol sequence; other seeds are other axes.
    pub fn draw(&self, subject: &Subject, count: usize, seed: u32) -> Vec<Candidate> {
        let one = |i: usize| {
            let axis = self.at(std::array::from_fn(|d| unit(i, d, seed)));
            subject.dress(axis, &self.limits, |d| unit(i, d, seed))
        };
        (0..count).map(one).collect()
    }
}

/// A place of the sequence, 0 to 1.
pub(crate) fn unit(number: usize, dimension: usize, seed: u32) -> f64 {
    f64::from(sobol_burley::sample(number as u32, dimension as u32, seed))
}
