//! Which samples count, which cut-offs are taken.

thresholds! {
    MAX_BRIDGED_SAMPLES: f64 = 5.0, "samples", "Missing samples in a row that are bridged; longer gaps split the log.", "choice";
    MAX_ACCELEROMETER_GAIN_ERROR: f64 = 0.05, "1", "Deviation of the gain of a measured acceleration from 1.", "choice";
    ACCELEROMETER_GAIN: std::ops::Range<f64> = 0.1..10.0, "1", "Gain of a sensor that shows the motion at all.", "choice: whatever its unit is taken for";
    SAMPLES_PER_UNKNOWN: usize = 10, "samples", "Samples that a fit needs for each unknown.", "choice";
    MAX_STEP_SPREAD: f64 = 1e-3, "1", "Relative spread of the sample times of a uniform log.", "choice";
    MIN_FORCE_SHARE: f64 = 0.2, "1", "Part of the samples with a usable force for a simulation under it.", "choice";
    SETTLING_DEFLECTIONS: f64 = 6.0, "deflections", "Sliding distance after which the initial bristle state no longer matters.", "choice: exp(-6) is left";
    MAX_SETTLING_SHARE: f64 = 0.5, "1", "Part of the samples that may be skipped until the axis has slid.", "choice: an axis that hardly slides is fitted from rest";
    MIN_SETTLED_SAMPLES: usize = 60, "samples", "Samples of the regression that must be left.", "choice: several for each parameter";
    MIN_TRAVERSED_SHARE: f64 = 0.95, "1", "Part of the range of a stretch after which its elements are settled.", "choice";
    MAX_TRAVERSING_SHARE: f64 = 0.5, "1", "Part of a stretch that may be skipped until its elements are settled.", "choice";
    MAX_OTHER_VALLEY_ERROR: f64 = 0.7, "1", "Error of a pair of cut-offs over that of the start from which it is another valley.", "choice";
    MAX_BETTER_ERROR: f64 = 0.95, "1", "Error of a pair of cut-offs over that of the best from which it is better.", "choice: chance would lead along a flat valley";
    MIN_SAMPLES: usize = 300, "samples", "Thinned samples that cut-offs must leave.", "choice: ten for each unknown of many elements";
    MIN_START_ERROR: f64 = 2.0, "1", "Mean square before sliding over that of the rest from which on the start is skipped.", "choice";
    MIN_R2: f64 = 0.99, "1", "Explained part of the variance from which a fit represents the axis.", "choice: the rest is taken as noise of the force";
    MIN_REPORTED_SHARE: f64 = 0.1, "1", "Part of the logs from which on it is told that it is skipped.", "choice";
    MIN_HELD_OUT_SAMPLES: usize = 20, "samples", "Samples that a split leaves to validate on.", "choice";
    SPEED_LIMIT: f64 = 0.1, "1", "Speed limit that is advised, as a part of the fastest sample.", "choice: most samples are faster";
    MIN_DECIMATED_SAMPLES: usize = 300, "samples", "Samples that another decimation leaves.", "choice: ten for each of thirty unknowns";
    MAX_STEP: f64 = 1.5, "steps", "Time step up to which a log goes on.", "choice";
}
