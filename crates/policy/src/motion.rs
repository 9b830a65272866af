//! What a motion can show.

thresholds! {
    MIN_TURN: f64 = 0.02, "ranges", "Way back that is a turning point.", "choice";
    MAX_STROKE_DISTANCE: f64 = 0.35, "1", "Distance of the logarithms of length and peak speed of strokes of one kind.", "choice";
    TOP_SPEED_QUANTILE: f64 = 0.97, "1", "Part of the speeds that the top speed is above.", "choice: an overshoot is no speed that was seen";
    MAX_REST_SPEED: f64 = 0.02, "largest speeds", "Speed that counts as rest.", "choice";
    MIN_LONG_STROKE: f64 = 1.5, "1", "Ratio of the longest to the shortest stroke from which there are both.", "choice";
    MAX_SPEED_ERROR: f64 = 1e-3, "top speeds", "Error of a speed that needs no longer window.", "choice";
    SHARE_ABOVE_TOP: f64 = 0.005, "1", "Part of the samples above the top speed.", "choice: single samples may be noise";
    MIN_FORCE_TURN: f64 = 0.75, "1", "Part of the way between its levels after which the force has turned.", "choice";
    MIN_SHARE_EACH_WAY: f64 = 0.05, "1", "Samples that move each way.", "choice";
    MIN_SPEED_RATIO: f64 = 2.0, "1", "Middling over slow speed from which viscous friction shows.", "choice";
    MIN_SHARE_SLOW: f64 = 0.02, "1", "Samples at a tenth to a hundredth of the top speed, each way.", "choice: a sine has 3 %, a triangle less";
    MIN_SHARE_SLOWER: f64 = 0.005, "1", "Samples at a hundredth to a thousandth of the top speed, each way.", "choice: a sine has 0.3 %";
    MIN_REVERSALS: usize = 4, "1", "Reversals for presliding.", "choice";
    MIN_STIFFNESS_SAMPLES: f64 = 5.0, "samples", "Samples in which the force turns at a reversal, for sigma0.", "choice";
    MIN_DAMPING_SAMPLES: f64 = 20.0, "samples", "Samples in which the force turns at a reversal, for sigma1.", "choice: it shows only in how fast presliding changes";
    MIN_ACCELERATION: f64 = 5.0, "errors", "Rms acceleration, for the mass.", "choice";
    MIN_GRAVITY_ANGLE: f64 = 1.0, "rad", "Angle over which sin q and cos q are no straight lines.", "choice";
    MIN_DIRECTION_BALANCE: f64 = 0.3, "1", "Samples of the rarer direction over those of the other, for levels of their own.", "choice";
    MAX_FITTED_REST_SPEED: f64 = 0.01, "top speeds", "Speed of a record that counts as rest of an axis that is compensated.", "choice";
    MIN_FITTED_SHARE: f64 = 0.05, "1", "Samples that move, each way, of an axis that is compensated.", "choice";
    TURN_OVER: f64 = 8.0, "deflections", "Way after a reversal on which the bristles have turned over.", "choice";
}
