//! Time stamps.

thresholds! {
    MIN_GAP: f64 = 1.5, "median steps", "Time step from which on samples are missing in it.", "choice";
    MAX_UNNOTED_JITTER: f64 = 0.01, "1", "Relative rms deviation of the time step above which there is a note.", "choice";
    MAX_JITTER: f64 = 0.05, "1", "Relative rms deviation of the time step above which there is a warning.", "choice";
    MAX_ROUNDED_STEP: f64 = 0.1, "1", "Part of a step that rounding moves it by; beyond, the rows are not at one rate.", "choice";
    MIN_MISSING_STEP: f64 = 1.5, "median steps", "Time step of an even clock from which on samples are missing.", "choice";
    MAX_DROPPED_SHARE: f64 = 0.05, "1", "Part of the rows that may be dropped for their time stamps; above, the log is refused.", "choice";
    MAX_OVERFLOW_STEP: f64 = 10.0, "median steps", "Time step across an overflow of the counter.", "choice";
    MAX_DURATION: f64 = 1e9, "s", "Longest plausible recording; longer ones have a wrong unit of time.", "choice: thirty years";
    MAX_RATE_ROUNDING: f64 = 0.01, "ticks", "What the digits of a rate leave of a step.", "choice";
    MIN_PATTERN_STEPS: usize = 20, "steps", "Steps that show a pattern.", "choice";
    MIN_STEPS_OF_A_LENGTH: usize = 10, "steps", "Steps of either length of a coarse clock.", "choice: a few long ones are missing rows";
    MIN_TICK: f64 = 0.01, "steps", "Tick that is worth a word.", "choice";
    MAX_DOUBLE_STEPS: f64 = 0.15, "1", "Part of the steps that are twice as long since a row is lost in each.", "choice";
    MIN_FULL_STAMPS: f64 = 0.02, "1", "Part of the stamps that have all of their rows.", "choice";
    MAX_CUT_SHARE: f64 = 0.01, "1", "Part of the samples by which columns of one base may differ in length.", "choice";
    MAX_BASE_DRIFT: f64 = 0.01, "1", "Part of the duration by which two time columns of the same rows may drift apart.", "choice";
    PLAUSIBLE_SPACING: std::ops::RangeInclusive<f64> = 1e-6..=0.2, "s", "Median spacing with which a time column without a unit is in seconds.", "choice: 5 Hz to 1 MHz";
    MAX_RATE_ERROR: f64 = 0.01, "1", "Relative difference of a given rate and that of the time stamps.", "choice";
    MIN_REPEATED_SHARE: f64 = 0.05, "1", "Part of the rows from which on repeated stamps are those of a coarse clock.", "choice";
    MIN_REPEATED_ROWS: usize = 3, "rows", "Rows that repeat the one before from which on they were sent again.", "choice: fewer move no clock";
    MAX_REPEATED_SHARE: f64 = 0.2, "1", "Part of the rows that may be such repeats; more are an axis at rest or a held reading.", "choice";
    MAX_REPEATED_SLIP: f64 = 0.25, "1", "Mean square of logged velocity less slope of the position without the repeats over that with them.", "choice: half of the difference; the Panda of the tests has a fortieth";
    MIN_LOST_ROW: f64 = 0.6, "rows", "How much later stamps go on from which on a row is missing.", "choice";
}
