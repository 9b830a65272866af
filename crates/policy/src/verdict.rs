//! When a law is refused for compensation.

use crate::Row;

/// A table as a struct of numbers, the values that are used, and rows to print.
macro_rules! table {
    ($(#[$about:meta])* $table:ident, $used:ident: $($(#[doc = $doc:literal])+ $name:ident = $value:expr, $unit:literal, $source:literal;)*) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $table {
            $($(#[doc = $doc])+ #[doc = concat!("\n\nUnit: ", $unit, ". Source: ", $source, ".")] pub $name: f64,)*
        }

        /// The values that are used.
        pub const $used: $table = $table { $($name: $value,)* };

        pub(crate) const ROWS: &[Row] = &[$(Row {
            name: stringify!($name),
            value: stringify!($value),
            unit: $unit,
            meaning: concat!($($doc),+),
            source: $source,
        },)*];
    };
}

table! {
    /// When a law is refused for compensation.
    Verdict, VERDICT:

    /// Least explained part of the variance.
    least_r2 = 0.5, "1", "choice: a law that leaves more than it explains is not the law of the axis";
    /// Relative error of a fit above which a wrong axis file is looked for.
    poor_fit = 0.25, "1", "choice";
    /// Largest part of the points that lie off a static map.
    most_outlying = 1.0 / 3.0, "1", "choice: what two thirds agree on may be the curve";
    /// Largest part of the samples with saturated force.
    most_saturated = 0.2, "1", "choice: they are left out, and with them the accelerations that determine the mass";
    /// Ratio of the held-out error of another law below which this one is refused.
    better_law = 0.5, "1", "choice: half of the error";
    /// Independent samples of the residual for each unknown of an open loop.
    least_samples_per_unknown = 5.0, "1", "choice: with fewer, the parameters fit the drift that a force error integrates to";
    /// Ratio of the residual to that of encoder steps alone below which the encoder explains it.
    encoder_residual = 2.0, "1", "choice";
    /// Ratio of the position error on unseen data to that of the fit.
    most_position_error = 3.0, "1", "choice";
    /// Part of the friction that a law may leave on held-out samples.
    most_friction_left = 1.0 / 3.0, "1", "with a third left, what is wrong in the compensation is half of what is right";
    /// Ratio of the error of a validation to that of the fit above which the law does not hold there.
    validation_error = 2.0, "1", "choice";
    /// Part of the friction that a validation may leave in any case.
    little_friction_left = 0.1, "1", "choice: a tenth is little for a compensator";
    /// Reversals from which a law may be used that leaves its Coulomb level open.
    least_reversals = 3.0, "1", "the third may confirm what the first two suggest";
    /// Ratio of a level of friction to the largest force of the log above which it is an extrapolation.
    extrapolated_level = 1.25, "1", "choice";
    /// Difference of a level or a mass between two logs from which they are not of one axis.
    several_axes = 0.5, "1", "choice: warmth and lubricant change friction by tens of percent";
}
