//! Simulated motion: when it has diverged, when it moves.

thresholds! {
    DIVERGED_FIT_ERROR: f64 = 1000.0, "1", "Error of a simulated position over the measured range from which on it has diverged.", "choice";
    MIN_BEND: f64 = 3.0, "1", "Second difference over that of independent errors from which it is one of the motion.", "choice";
    MIN_MOVEMENT: f64 = 2.0, "rms residuals", "Movement that counts as motion.", "choice";
    DIVERGED_RUN_ERROR: f64 = 1000.0, "1", "Error over the length of the path from which on a run has diverged.", "choice: an axis that sticks or swings stays far below";
    MAX_SHARE_AT_LIMIT: f64 = 0.01, "1", "Part of the samples at the force limit above which a run gets a warning.", "choice";
    MAX_COMMAND_CHANGE: f64 = 0.1, "largest forces", "Rms change of the command per sample above which a run gets a warning.", "choice: a swing between the limits in 64 samples";
}
