//! Numbers of a machine over time.

thresholds! {
    MIN_RELATIVE_LEVEL: f64 = 5.0, "deviations", "Median value over median deviation from which on changes are relative.", "choice";
    MIN_DIFFERENCES: usize = 12, "1", "Differences that say something of a lag.", "choice";
    MIN_STEP: f64 = 8.0, "mean distances", "Distance of two levels between which lies a step.", "simulated: wandering and heavy tails hardly ever reach it (decision 0093)";
    MAX_COPY_SPAN: f64 = 60.0, "s", "Span of times of files that were copied, not recorded.", "choice";
}
