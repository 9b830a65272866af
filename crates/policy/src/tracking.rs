//! Tracking errors before and after.

thresholds! {
    MAX_MOTION_DIFFERENCE: f64 = 0.05, "1", "Relative difference in range, top speed and duration of equal motions.", "choice";
    MIN_PEAK_GROWTH: f64 = 0.1, "1", "Relative growth of a peak that has grown.", "choice";
    MIN_PEAK_GROWTH_STEPS: f64 = 3.0, "steps", "Growth of a peak that has grown.", "choice";
    MAX_RATE_DIFFERENCE: f64 = 0.1, "1", "Relative difference of equal rates.", "choice";
    MIN_RATE: f64 = 100.0, "Hz", "Rate of a log that is compared with a finer one.", "choice: a peak comes and goes in some ten milliseconds";
    MIN_REFERENCE_JUMP: f64 = 0.3, "ranges", "Step of a reference that jumps.", "choice";
}
