//! Saturation, sign, steps and dropouts of a force.

thresholds! {
    MIN_VALUES: usize = 10, "1", "Values of a force from which parameters may be constants.", "choice: with fewer a step is a tenth of the force and more";
    MIN_FLAT_SAMPLES: usize = 5, "samples", "Constant stretch at the extreme force that may be saturation.", "choice";
    MIN_SATURATION_STEPS: f64 = 1.5, "steps", "Step into or out of saturation.", "choice: at the crest of a quantised sine it is one";
    MIN_HELD_SHARE: f64 = 0.10, "1", "Part of all samples that the extremes hold.", "choice";
    MIN_LEVELS: f64 = 100.0, "1", "Quantisation levels of such a signal.", "choice";
    MIN_SATURATED: f64 = 0.999, "limits", "Force from which on a sample is saturated.", "choice: limits are stated in fewer digits";
    MIN_RANGE_STEPS: f64 = 50.0, "steps", "Range of a force that is not coarse.", "choice";
    MIN_SELDOM_VALUES: usize = 8, "1", "Values of a force that changes seldom and is not coarse.", "choice";
    MAX_STEP_CHANGES: usize = 2, "1", "Changes of a force that is one step.", "choice: there, and back";
    MIN_NET_WORK: f64 = -0.3, "1", "Net work over the sum of its magnitudes, below which the sign is wrong.", "choice: friction as a force gives -1";
    MAX_UNSIGNED_DIFFERENCE: f64 = 0.25, "1", "Difference of the mean force of both directions over their sum, up to which a force of one sign is a magnitude.", "SO-101, four joints of two recordings: 0.005 to 0.05; a weight in balance with friction has 1";
    MAX_UNSIGNED_LOW: f64 = 0.1, "mean forces", "Least value of such a force.", "SO-101: 0; a weight beyond friction does not reach zero";
    MAX_NET_TRAVEL: f64 = 0.5, "paths", "Net travel of a motion to and fro.", "choice";
    MAX_DEAD: f64 = 0.03, "usual forces", "Force that counts as none.", "choice: friction of a moving axis is more";
    MAX_NEAR_DEAD: f64 = 4.0 * MAX_DEAD, "usual forces", "Force up to which a stretch without force is followed.", "choice: a force that changes its sign passes here";
    MIN_DEAD_SHARE: f64 = 0.75, "1", "Part of such a stretch without force.", "choice";
    MAX_DEAD_MEAN: f64 = 0.01, "usual forces", "Mean force over such a stretch.", "choice: an offset of the sensor";
    MAX_DEAD_RMS: f64 = 0.03, "median forces", "Rms force over such a stretch up to which it need not be noise.", "choice";
    NOISE_TIME: f64 = 0.005, "s", "Time within which noise changes.", "choice: a force that follows the motion hardly does";
    MIN_NOISE_CHANGE: f64 = 0.25, "1", "Part of its mean square by which noise changes.", "choice";
    MIN_DEAD_TIME: f64 = 0.25, "s", "Stretch without force.", "choice: a force that changes its sign passes zero sooner";
    MIN_DEAD_SAMPLES: usize = 50, "samples", "Samples of a stretch without force.", "choice";
    MIN_DEAD_TRAVEL: f64 = 0.02, "strokes", "Travel during a stretch without force.", "choice: counts at rest add up to a long path";
    MAX_SPIKES: usize = 20, "1", "Samples above, or below, all others; more are how the force runs.", "choice";
    MIN_SPIKE: f64 = 3.0, "ranges", "Distance of a spike from all others.", "choice";
    MAX_SPIKE_SAMPLES: usize = 2, "samples", "Samples of a spike in a row.", "choice: a force that lasts longer was there";
}
