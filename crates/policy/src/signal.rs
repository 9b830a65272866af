//! Missing samples, implausible values, signals that contradict each other.

thresholds! {
    MAX_BRIDGED_SAMPLES: usize = 5, "samples", "Missing samples in a row that are interpolated; more split the record.", "choice";
    MAX_MISSING_UNWARNED: f64 = 0.01, "1", "Part of the samples that are missing above which there is a warning.", "choice";
    MAX_MISSING_SHARE: f64 = 0.5, "1", "Part of the cells of a column that are missing; above, it has another rate or is empty.", "choice";
    MIN_HOLE: f64 = 0.125, "durations", "Stretch without a number of a slow channel that is not filled in.", "choice";
    MAX_HOLES: f64 = 0.5, "durations", "Part of the time in such stretches from which a channel is no use.", "choice";
    MIN_ZERO_DISTANCE: f64 = 3.0, "spreads", "Distance of a zero from its neighbours that is an outlier.", "choice";
    MIN_ZERO_RUNS: usize = 5, "1", "Short runs of zeros that are outliers.", "choice";
    MIN_ZERO_SHARE: f64 = 0.2, "1", "Their part of all short runs of zeros.", "choice: slow motion and reversals hide the rest";
    MIN_DROPOUT_STEPS: f64 = 40.0, "quartile steps", "Step into a dropout of a channel.", "choice";
    MIN_TEMPERATURE_DROPOUT: f64 = 5.0, "K", "Step into a dropout of a temperature.", "choice: no part of a machine changes so from row to row";
    MIN_LOAD_DROPOUT: f64 = 0.1, "medians", "Step into a dropout of a load.", "choice";
    MAX_RETURN_DISTANCE: f64 = 2.0, "least steps", "Distance from its course to which a channel comes back.", "choice";
    MIN_PAUSE_STEPS: f64 = 10.0, "median steps", "Pause after which a channel may be anywhere.", "choice";
    MIN_PAUSE: f64 = 1.0, "s", "Pause after which a channel may be anywhere.", "choice";
    MAX_LOAD_DROPOUT: f64 = 0.01, "1", "Part of the rows of a dropout of a load.", "choice";
    MAX_LOAD_DROPOUTS: f64 = 0.05, "1", "Part of the rows of all of them.", "choice: more is how it is loaded";
    MIN_ON_COURSE: f64 = 0.5, "1", "Part of a temperature on its course.", "choice: of two equal parts neither is known to be right";
    USUAL_RATES: std::ops::RangeInclusive<f64> = 2.0..=1e7, "Hz", "Rates of a log of friction.", "choice: slower ones have nothing of presliding";
    USUAL_TRAVELS: std::ops::RangeInclusive<f64> = 1e-9..=1e4, "m", "Travels of a position.", "choice: a wavelength of light to the longest crane";
    USUAL_ANGLES: std::ops::RangeInclusive<f64> = 1e-9..=1e12, "rad", "Angles of a position.", "choice";
    MAX_SPEED: f64 = 1e3, "m/s", "Largest speed.", "choice: a projectile";
    MAX_ANGULAR_SPEED: f64 = 1e5, "rad/s", "Largest angular speed.", "choice: an ultracentrifuge";
    USUAL_FORCES: std::ops::RangeInclusive<f64> = 1e-9..=1e8, "N, N m, A, V", "Forces, torques, currents and voltages.", "choice: a stage on a chip to the largest press";
    MAX_LINEAR_SERVO: [f64; 2] = [20.0, 981.0], "m/s, m/s^2", "Speed and acceleration beyond both of which no linear servo axis is.", "choice: twice the fastest machine at a hundred times gravity";
    MAX_ROTARY_SERVO: [f64; 2] = [2e3, 2e5], "rad/s, rad/s^2", "Speed and acceleration beyond both of which no rotary servo axis is.", "choice: a motor of 20 000 rpm";
    MAX_FASTER_SHARE: f64 = 0.02, "1", "Part of the samples that may be faster.", "choice: a few that are damaged";
    MAX_DAMAGED_SHARE: f64 = 0.01, "1", "Part of the samples that are damaged cells rather than a wrong unit.", "choice";
    MAX_MEASURED: f64 = 1e30, "SI", "Largest number that is a measurement.", "choice: larger ones mark missing samples, as 3.4e38";
    MIN_EACH_SIGN: usize = 10, "1", "Numbers on each side of zero that tell a counter from flags.", "choice";
    MIN_ACCELERATION_STEPS: f64 = 10.0, "steps", "Rms of the acceleration that a position shows.", "choice";
    MIN_ACCELERATIONS: usize = 10, "1", "Comparisons of two accelerations.", "choice";
    MIN_VELOCITY_STEPS: f64 = 5.0, "steps", "Rms travel within a window that a velocity is compared over.", "choice";
    MAX_RATIO_ERROR: f64 = 0.05, "1", "Deviation of the ratio of two signals from 1 that is put down to the sensors.", "choice";
    MIN_CORRELATION: f64 = 0.7, "1", "Correlation of two signals of one motion.", "choice";
    MIN_USEFUL_SAMPLES: usize = 100, "samples", "Samples on which an interval can be based.", "choice";
    MIN_NEIGHBOUR_CORRELATION: f64 = 0.5, "1", "Correlation of neighbouring samples of a motion.", "choice: that of noise is near 0";
    MAX_SPEED_SPREAD: f64 = 0.05, "1", "Spread of the mean velocities of windows of one speed, over their mean.", "choice";
}
