//! Motions to record.

thresholds! {
    MAX_DETERMINED_DEVIATION: f64 = 0.5, "1", "Relative deviation of a determined parameter.", "choice";
    MIN_STROKE_STEPS: f64 = 2.0, "steps", "Encoder steps of the stroke.", "choice";
    MIN_STRIBECK: f64 = 0.003, "top speeds", "Speed at which the least Stribeck velocity of the nameplate is.", "choice";
    MIN_ACCELERATION: f64 = 0.01, "1", "Acceleration by the peak force over the largest allowed.", "choice";
    MIN_AXES_SHARE: f64 = 0.9, "1", "Axes for which a wish is to hold.", "choice";
    MAX_SIZE_DIFFERENCE: f64 = 0.1, "1", "Relative difference of the way of a log from the planned one.", "choice";
    MIN_AMPLITUDE_STEPS: f64 = 2.0, "steps", "Amplitude of a piece.", "choice: less is seldom seen";
    MIN_SPEED_PART: f64 = 0.6, "1", "Part of the asked speed below which a piece is another one.", "choice";
    MIN_CORRELATION: f64 = 0.8, "1", "Correlation of a piece with what is taken for it.", "choice";
    MIN_CORRELATION_ELSEWHERE: f64 = 0.95, "1", "Correlation of a piece that is found where it is not due.", "choice";
    MIN_FOLLOWED: f64 = 0.1, "1", "Part of a piece that an axis moves for it to have run.", "choice";
    MAX_FOLLOWED: f64 = 2.0, "1", "Amplitude of an axis over that of its piece.", "choice: it may overshoot";
    MAX_OVERLAP: f64 = 0.05, "s", "Time by which a piece may overlap its neighbour.", "choice";
    MIN_CERTAIN_CORRELATION: f64 = 0.995, "1", "Correlation from which a piece is not sought elsewhere.", "choice";
    MIN_MOTION_CORRELATION: f64 = 0.98, "1", "Correlation from which a motion ran at its own pace.", "choice";
    MIN_COMMON_PART: f64 = 0.3, "1", "Part of the squares that lies where both motions are.", "choice";
    MIN_FREE_DURATION: f64 = 0.7, "1", "Part of a duration that is free for a piece that does not show itself.", "choice: neighbours are found a tenth of a second off";
    MAX_PACE_ERROR: f64 = 0.01, "1", "Relative error of its own pace.", "choice: as by another clock";
    MAX_PACE_RESIDUAL: f64 = 0.3, "1", "Unlike part at another pace over that at its own.", "choice";
}
