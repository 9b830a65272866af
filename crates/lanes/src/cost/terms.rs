//! The coefficients of a candidate from which the residual force of a sample is computed, and the integration
//! schemes.

use crate::Candidate;
use crate::curve::Curve;

/// How the bristle equation is integrated between the samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// EXPLIN, as [`stiction_friction::LuGre::step_record`]: second order, bounded for every candidate.
    #[default]
    Explin,
    /// Forward Euler from sample to sample, as in Zhang et al. 2025 (doi 10.1371/journal.pone.0322844,
    /// eq. 12); it diverges for a stiff candidate.
    Euler,
    /// Classical Runge-Kutta of order 4 from sample to sample, the velocity linear between; it diverges for a
    /// stiff candidate.
    RungeKutta,
}

/// One candidate as the cost needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms {
    pub(super) curve: Curve,
    /// `-Fc`.
    pub(super) level: f64,
    /// `-sigma1/kappa`, which multiplies `-kappa v/g`.
    pub(super) damping: f64,
    /// `-(sigma1 + sigma2)`.
    pub(super) speed: f64,
}

impl Terms {
    pub(super) fn new(c: &Candidate) -> Self {
        let kappa = c.stiffness / c.coulomb;
        let excess = (c.static_friction - c.coulomb) / c.coulomb;
        Terms {
            curve: Curve::new(kappa, excess, c.stribeck_velocity, c.exponent),
            level: -c.coulomb,
            damping: -c.micro_damping / kappa,
            speed: -(c.micro_damping + c.viscous),
        }
    }
}

/// Measured minus model force, in the direction of motion, at a node with deflection `y`.
#[inline(always)]
pub(super) fn residual(terms: &Terms, y: f64, q: f64, speed: f64, force: f64) -> f64 {
    let rest = crate::exp::fma(terms.speed, speed, force);
    let weight = crate::exp::fma(terms.damping, q, terms.level);
    crate::exp::fma(y, weight, rest)
}
