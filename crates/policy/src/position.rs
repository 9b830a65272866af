//! Encoder steps, wraps and faults of a position.

thresholds! {
    MIN_TRAVEL_STEPS: f64 = 50.0, "steps", "Encoder steps of the whole travel.", "choice: with fewer presliding is hardly resolved";
    MIN_JUMP: f64 = 0.5, "ranges", "Size of a jump of the position.", "choice";
    MIN_JUMP_IN_MEAN_STEPS: f64 = 50.0, "mean steps", "Size of a jump in steps between the other samples.", "choice";
    MIN_ORDINARY_STEPS: usize = 20, "1", "Other samples that give a mean step.", "choice";
    MAX_SMALL_DIFFERENCE: f64 = 20.5, "smallest differences", "Difference of neighbours that shows the encoder step.", "choice: the half keeps whole multiples clear";
    MIN_SMALL_DIFFERENCES: usize = 30, "1", "Differences that show the encoder step.", "choice";
    MAX_RMS_OFF_WHOLE: f64 = 0.1, "steps", "Rms distance of these from whole numbers.", "choice";
    MAX_BITS_ERROR: f64 = 1e-3, "1", "Relative distance of an encoder step from that by its bits.", "choice";
    MIN_STRAY_OF_NEIGHBOURS: f64 = 10.0, "1", "Distance of a stray step from its neighbours over their second largest.", "choice: under a finite force the speed changes little";
    MIN_STRAY_COUNTS: f64 = 20.0, "steps", "Distance of a stray step, or in deviations of the noise.", "choice";
    MIN_STRAY_OF_USUAL: f64 = 2.0, "usual steps", "Distance of a stray step.", "choice: a lost row doubles a step";
    MIN_STRAY_MOTION: f64 = 2.0, "steps", "Usual step of an axis in motion.", "choice: an axis that slips may well move in one sample";
    MAX_STRAYS: usize = 20, "1", "Stray steps of a record; more are how it moves.", "choice";
    MIN_FROZEN_SAMPLES: usize = 10, "samples", "Stretch of equal positions that is checked.", "choice";
    MIN_FROZEN_TRAVEL_STEPS: f64 = 10.0, "steps", "Travel by the velocity that contradicts a frozen position.", "choice";
    MIN_FROZEN_TRAVEL: f64 = 0.01, "ranges", "Travel by the velocity that contradicts a frozen position.", "choice";
    MIN_FROZEN_SPEED: f64 = 0.05, "rms speeds", "Mean speed of such travel.", "choice";
    MAX_CONSTANT_VARIANCE: f64 = 1e-12, "1", "Relative variance of a velocity that is held.", "rounding";
    MIN_FROZEN_JUMP: f64 = 3.0, "largest steps", "Jump at the end of a frozen stretch.", "choice";
    MIN_FROZEN_REFERENCE: f64 = 0.5, "ranges", "Range of the reference during a final frozen stretch.", "choice";
    MIN_HELD_CHANGES: usize = 100, "1", "Changes of a position that is renewed every few rows.", "choice";
    MIN_HELD_SHARE: f64 = 0.995, "1", "Part of them that falls on the same rows.", "choice";
    MIN_COVERED: f64 = 0.8, "periods", "Part of its period that a counter has covered.", "choice";
    MAX_STEP_CHANGE: f64 = 0.1, "periods", "Change of the step at a jump without the period.", "choice: the speed is that of the sample before";
    MIN_STEADY_JUMPS: f64 = 0.9, "1", "Part of the jumps that go on so.", "choice";
    MIN_WHOLE_SHARE: f64 = 0.99, "1", "Part of the numbers that are whole.", "choice: some may have been interpolated";
    MIN_PERIODS: f64 = 1.5, "periods", "Periods of a counter of no power of two.", "choice: anything else that jumps covers its range too";
    MAX_HIDDEN_COUNTS: f64 = 2e-3, "1", "Part of its counts that a round counter has not shown.", "choice";
    MIN_WRAP_STEPS: f64 = 2.0, "steps", "Encoder steps of a wrap.", "choice: a step forward is none back";
    MAX_OVERFLOW_MOTION: f64 = 0.1, "periods", "Motion in a sample where a jump is an overflow.", "choice";
    MAX_UNWRAPPED_STEP: f64 = 3.0, "1", "Steps at wraps over all others.", "choice";
}
