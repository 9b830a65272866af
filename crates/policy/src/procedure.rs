//! Constant velocities, force ramps and steps.

thresholds! {
    MIN_RAMP_SAMPLES: usize = 50, "samples", "Samples of a ramp.", "choice";
    MIN_RAMP_STEPS: f64 = 5.0, "steps", "Steps of the position, or deviations, within the window that are motion.", "choice";
    BREAK_AWAY_OF_TOP_SPEED: f64 = 1e-3, "top speeds", "Speed of break-away where none is given.", "choice";
    BREAK_AWAY_OF_ELASTIC_SPEED: f64 = 30.0, "elastic speeds", "Speed of break-away over that on the first fifth of the ramp, where none is given.", "choice: there LuGre is at 97 % of its static level";
    MAX_RAMP_BEND: f64 = 0.1, "1", "Deviation of a ramp from a line, over its rise.", "choice";
    MAX_FORCE_BEFORE: f64 = 0.5, "1", "Force before the ramp over that at break-away.", "choice: an axis moved before is not at rest on its bristles";
    BREAK_AWAY_OF_STRIBECK: f64 = 1.0 / 3.0, "Stribeck velocities", "Speed of break-away where a model is known.", "choice: above the creep of presliding, below the fall of friction";
    MAX_BLOCK_OFFSET: f64 = 4.0, "standard errors", "Distance of the mean of a block from the level of its neighbours.", "choice";
    MAX_OUTLYING_WEIGHT: f64 = 0.1, "1", "Robust weight below which a point lies off the curve.", "choice";
    MIN_UNSETTLED_POINTS: usize = 2, "1", "Slow points below the curve from which on friction has not settled.", "choice: one may be any fault";
    MIN_BOUNDED_RISE: f64 = 3.5, "deviations", "Rise of the loss towards the ends of its range for a bounded Stribeck velocity.", "choice: on a whole grid noise alone reaches two or three";
    MIN_SAMPLES_BEFORE_STEP: usize = 5, "samples", "Samples before a step.", "choice";
    MIN_SAMPLES_AFTER_STEP: usize = 30, "samples", "Samples after a step.", "choice";
    MIN_STEP_HEIGHT: f64 = 6.0, "deviations", "Height of a step over the scatter of the force.", "choice";
    MIN_STEP_JUMP: f64 = 9.0, "usual jumps", "Height of a step over the usual jump of means.", "choice: six deviations";
    MIN_LEVEL_ERROR: f64 = 8.0, "standard errors", "Distance of a mean that is off the level.", "choice: the level has as large an error";
    MAX_FINAL_MOTION: f64 = 0.05, "1", "Motion over the last tenth of a step over the whole.", "choice";
    END_OF_RANGE: f64 = 0.99, "1", "Part of its range from which a delay is at the end.", "choice";
    MAX_VELOCITY_ERROR: f64 = 0.03, "1", "Relative distance of a quarter from the mean velocity while a stretch is looked for.", "choice";
    MAX_VELOCITY_DRIFT: f64 = 0.015, "1", "Relative change of the velocity from the first quarter to the last.", "choice: a piece of a ramp drifts more";
    MIN_STRETCH_SAMPLES: usize = 40, "samples", "Samples of a stretch.", "choice";
    MIN_QUARTER_COUNTS: f64 = 5.0, "counts", "Encoder counts in a quarter of a stretch.", "choice: with fewer the steps decide the slope";
    MAX_APPROACH_DURATION: f64 = 0.2, "1", "Duration over that of a neighbour below which a stretch is its approach.", "choice";
    MAX_NEIGHBOUR_VELOCITY: f64 = 0.4, "1", "Relative difference in velocity of neighbours.", "choice";
    MAX_NEIGHBOUR_GAP: f64 = 0.5, "lengths", "Gap between neighbours.", "choice";
    MAX_STANDSTILL_SPEED: f64 = 0.25, "1", "Speed of a part over the mean below which it is a standstill.", "choice";
    MIN_INDEPENDENT_SAMPLES: f64 = 4.0, "samples", "Independent samples of a half that tell a ripple from a drift.", "choice";
    MAX_FORCE_DRIFT: f64 = 5e-3, "1", "Difference of the halves over their sum that is negligible.", "choice: one percent of the force";
    MIN_SPEEDS: usize = 12, "1", "Speeds in each direction below which a map is warned of.", "choice: they show the whole Stribeck curve (docs/procedures.md)";
    MAX_EQUAL_SPEED: f64 = 0.02, "1", "Relative difference of two speeds that are one.", "choice";
}
