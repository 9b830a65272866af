//! How large the numbers of a mapping may be: wide enough for any machine, narrow enough that no sum overflows.

use std::ops::RangeInclusive;

/// Sample rates that may be given, Hz.
pub const RATES: RangeInclusive<f64> = 1e-3..=1e9;
/// Travels after which a position may repeat, m or rad.
pub const WRAPS: RangeInclusive<f64> = 1e-9..=1e9;
/// Counts after which a counter may repeat.
pub const WRAP_COUNTS: RangeInclusive<f64> = 2.0..=9_007_199_254_740_992.0;
/// Encoder steps that may be given, m or rad.
pub const RESOLUTIONS: RangeInclusive<f64> = 1e-15..=1e9;
/// Force limits that may be given, in the SI unit of the force.
pub const FORCE_LIMITS: RangeInclusive<f64> = 1e-15..=1e15;
/// Sizes that the scale of a column may have, in SI units.
pub const SCALES: RangeInclusive<f64> = 1e-15..=1e15;
