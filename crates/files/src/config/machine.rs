//! How large the numbers of a machine may be, in SI units: from the smallest stage to the largest press, and no unit mistaken by
//! many powers of ten.

use std::ops::RangeInclusive;

/// Positions that an axis may go to from where it stands, m (rad).
pub(crate) const STROKES: RangeInclusive<f64> = -1e6..=1e6;
/// m/s (rad/s)
pub(crate) const SPEEDS: RangeInclusive<f64> = 1e-9..=1e6;
/// m/s^2 (rad/s^2)
pub(crate) const ACCELERATIONS: RangeInclusive<f64> = 1e-9..=1e9;
/// m/s^3 (rad/s^3); who knows no limit of it gives a large one.
pub(crate) const JERKS: RangeInclusive<f64> = 1e-9..=1e15;
/// N (N m)
pub(crate) const FORCES: RangeInclusive<f64> = 1e-9..=1e9;
/// Bandwidths of a loop, Hz, of which the largest follows from its control rate.
pub(crate) const LEAST_BANDWIDTH: f64 = 0.01;
/// kg (kg m^2): the rotor of the smallest motor to a ship.
pub(crate) const MASSES: RangeInclusive<f64> = 1e-12..=1e9;
