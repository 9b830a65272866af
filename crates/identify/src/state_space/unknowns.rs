//! The unknowns of the likelihood, each with its lane: logarithms, but for the constant force.

use stiction_parameters::{Name, Quantity, Side};

/// sigma0.
pub(super) const STIFFNESS: usize = 0;
/// sigma1.
pub(super) const DAMPING: usize = 1;
/// Mass or inertia.
pub(super) const MASS: usize = 2;
/// Constant force, N (N m), no logarithm.
pub(super) const OFFSET: usize = 3;
/// Standard deviation of the white error of the force.
pub(super) const WHITE: usize = 4;
/// Standard deviation of the disturbance.
pub(super) const DISTURBANCE: usize = 5;
/// Correlation time of the disturbance, samples.
pub(super) const MEMORY: usize = 6;
/// Coulomb friction of the first direction.
pub(super) const COULOMB: usize = 7;
/// Static over Coulomb friction.
pub(super) const RATIO: usize = 8;
/// Stribeck velocity.
pub(super) const VELOCITY: usize = 9;
/// sigma2.
pub(super) const VISCOUS: usize = 10;
/// Unknowns of each direction, those of the second after those of the first.
pub(super) const EACH_SIDE: usize = 4;
/// How many there are, those of both directions counted.
pub(super) const UNKNOWNS: usize = VISCOUS + 1 + EACH_SIDE;

/// The lanes whose sum is the logarithm of a parameter (the constant force itself), the last one its own; `None` for one that
/// the likelihood does not know.
pub(super) fn lanes(name: Name) -> Option<Vec<usize>> {
    let shift = match name.side {
        Side::Negative => EACH_SIDE,
        Side::Both | Side::Positive => 0,
    };
    let lanes = match name.quantity {
        Quantity::Sigma0 => vec![STIFFNESS],
        Quantity::Sigma1 => vec![DAMPING],
        Quantity::Mass => vec![MASS],
        Quantity::Offset => vec![OFFSET],
        Quantity::Coulomb => vec![COULOMB + shift],
        Quantity::Static => vec![COULOMB + shift, RATIO + shift],
        Quantity::StribeckVelocity => vec![VELOCITY + shift],
        Quantity::Sigma2 => vec![VISCOUS + shift],
        _ => return None,
    };
    Some(lanes)
}
