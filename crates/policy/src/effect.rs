//! What a residual shows beside the law.

thresholds! {
    MIN_EXPLAINED: f64 = 0.25, "1", "Part of the held-out variance of the residual that a named effect explains.", "tuned: of 22 on the tuning axes with .15 to .25, two were right";
    MIN_STROKE_DEVIATIONS: f64 = 1.4, "deviations", "Gain of an effect over its deviation between pieces of strokes.", "choice: one piece alone gains 1, two alike 1.4";
    MAX_RELATIVE_DEVIATION: f64 = 0.12, "1", "Relative deviation of a pitch, frequency, width or factor that is known.", "tuned: four less known ones on the tuning axes were wrong";
    MIN_INDEPENDENT_PART: f64 = 0.05, "1", "Part of a column's squares that the columns of the law leave.", "choice: errors of a few percent in an acceleration leave as much";
    MIN_SPECIAL_PART: f64 = 0.5, "1", "Part of what a general effect explains from which a special one is the cause.", "tuned: a gap and a resonance more on the tuning axes, none wrong";
    MIN_OVER_REPLICAS: f64 = 2.0, "1", "What an effect explains over what it explains in replicas.", "choice";
    MAX_REPORTED: usize = 3, "1", "Most effects that are reported.", "choice";
    MIN_BRISTLE_LENGTHS: f64 = 50.0, "bristle lengths", "Stroke along which friction may be said to change.", "choice: on shorter ones friction itself goes with the position";
    MIN_SUSPECTED_GAP: f64 = 0.06, "1", "Part of the fitted samples' residual from which a gap is looked at closely.", "choice";
    GAP_OVER_FOUND: std::ops::Range<f64> = 0.45..1.1, "1", "Free travel of a gap over the width found.", "simulated: 0.48 to 1.09 on 24 axes whose teeth are springs (2026-11-30)";
    MIN_DRIFT_TIME: f64 = 2.0, "s", "Shortest log over which friction may change with time.", "choice";
    MIN_LINEAR_PART: f64 = 0.8, "1", "Part of a change along the stroke from which a line describes it.", "choice";
    LIMIT_FACTORS: std::ops::Range<f64> = 0.8..1.2, "1", "Factors of what exceeds a force limit that make it one.", "choice: other laws leave only a part of a large force";
    MAX_LIMITED_SHARE: f64 = 0.2, "1", "Part of the samples beyond a force limit.", "choice: beyond, the axis does not move as asked";
    MIN_CONSECUTIVE_SHARE: f64 = 0.8, "1", "Part of the samples beyond a force limit that lie together.", "choice: a drive stays at its limit, spikes come and go";
    MIN_CONSECUTIVE_SAMPLES: usize = 5, "samples", "Samples beyond a force limit in a row that lie together.", "choice";
    LOAD_SHARE: std::ops::Range<f64> = 0.1..0.9, "1", "Part of the moving mass that a load on a spring has.", "choice: behind more, other friction laws look alike";
    LOAD_SHARE_AT_ENCODER: std::ops::Range<f64> = 0.1..0.75, "1", "Part of the moving mass that a load on a spring with the encoder on it has.", "choice";
    MIN_DELAY_GROWTH: f64 = 0.1, "samples", "Growth of a delay over the log.", "choice";
    MIN_DELAY_REVERSALS: usize = 4, "1", "Reversals from which a growing delay shows.", "choice";
    MIN_MASS_ERROR: f64 = 0.02, "1", "Part of a stated mass from which another one is named.", "choice: less leaves the constants within their intervals";
    MIN_DELAY_ERROR: f64 = 0.1, "samples", "Difference from a stated delay from which another one is named.", "choice";
    MIN_PITCH_COUNTS: f64 = 2.0, "counts", "Encoder counts in the shortest pitch.", "choice";
    MIN_WAVES: f64 = 2.0, "1", "Waves over the stroke from which on a force repeats.", "choice";
    MIN_PITCH_SHIFT: f64 = 1e-3, "waves", "Shift over the stroke of a pitch that is another one.", "choice";
    MAX_PITCH: f64 = 4.0, "strokes", "Pitch from which on a wave is a line.", "choice";
    MIN_EXPONENT_ERROR: f64 = 0.22, "1", "Difference of the logarithms of two Stribeck exponents that filters and encoder do not make.", "simulated: up to 0.14 (decision 0064)";
    MIN_LEVEL_SHARE: f64 = 0.02, "1", "Part of the samples from which a level is worth asking for.", "choice";
    MIN_REVERSAL: f64 = 1e-4, "strokes", "Way back that is a reversal.", "choice";
    RIGID_CUTOFF: f64 = 1.0 / 3.0, "1", "Cut-off over a resonance below which an axis is rigid.", "choice: but for a ninth";
    MAX_ROUNDED_PITCH_SHIFT: f64 = 0.002, "waves", "Shift over the stroke of a pitch that is rounded to fewer digits.", "choice";
    SPRING_PITCH: f64 = 200.0, "strokes", "Pitch of a wave whose middle is as straight as a spring.", "choice";
    MIN_BENT_PITCH: f64 = 2.0, "strokes", "Pitch from which a wave that is there already is long enough.", "choice";
    MAX_UNSETTLED_CHANGE: f64 = 0.25, "1", "Part of the whole change of the level that is left in what counts as settled.", "choice";
    MIN_SETTLED_SHARE: f64 = 0.5, "1", "Part of the log that has to be settled.", "choice: a steady change never leaves a quarter in half";
    MIN_CROP: f64 = 3.0, "s", "Shortest part of a log that is worth a fit.", "choice";
    MAX_CROP_DELAY_GROWTH: f64 = 1.0, "samples", "Growth of a delay over a part of the log that hardly matters.", "choice";
}
