//! When a law is refused for compensation.

thresholds! {
    MIN_R2: f64 = 0.5, "1", "Least explained part of the variance.", "choice: a law that leaves more than it explains is not the law of the axis";
    MAX_FIT_ERROR: f64 = 0.25, "1", "Relative error of a fit above which a wrong axis file is looked for.", "choice";
    MAX_OUTLYING_SHARE: f64 = 1.0 / 3.0, "1", "Largest part of the points that lie off a static map.", "choice: what two thirds agree on may be the curve";
    MAX_SATURATED_SHARE: f64 = 0.2, "1", "Largest part of the samples with saturated force.", "choice: they are left out, and with them the accelerations that determine the mass";
    MAX_BETTER_ERROR: f64 = 0.5, "1", "Ratio of the held-out error of another law below which this one is refused.", "choice: half of the error";
    MIN_SAMPLES_PER_UNKNOWN: f64 = 5.0, "1", "Independent samples of the residual for each unknown of an open loop.", "choice: with fewer, the parameters fit the drift that a force error integrates to";
    MAX_ENCODER_RESIDUAL: f64 = 2.0, "1", "Ratio of the residual to that of encoder steps alone below which the encoder explains it.", "choice";
    MAX_POSITION_ERROR: f64 = 3.0, "1", "Ratio of the position error on unseen data to that of the fit.", "choice";
    MAX_HELD_OUT_ERROR: f64 = 1.0 / 3.0, "1", "Part of the friction that a law may leave on held-out samples.", "choice: with a third left, what is wrong in the compensation is half of what is right";
    MAX_VALIDATION_ERROR: f64 = 2.0, "1", "Ratio of the error of a validation to that of the fit above which the law does not hold there.", "choice";
    MIN_HELD_OUT_ERROR: f64 = 0.1, "1", "Part of the friction that a validation may leave in any case.", "choice: a tenth is little for a compensator";
    MIN_REVERSALS: f64 = 3.0, "1", "Reversals from which a law may be used that leaves its Coulomb level open.", "choice: the third may confirm what the first two suggest";
    MAX_EXTRAPOLATION: f64 = 1.25, "1", "Ratio of a level of friction to the largest force of the log above which it is an extrapolation.", "choice";
    MIN_AXES_DIFFERENCE: f64 = 0.5, "1", "Difference of a level or a mass between two logs from which they are not of one axis.", "choice: warmth and lubricant change friction by tens of percent";
}
