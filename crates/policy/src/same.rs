//! Thresholds that mean the same and differ: candidates to become one.

use std::fmt::Debug;

/// What thresholds mean, with the name and value of each.
pub type Same = (&'static str, &'static [(&'static str, &'static dyn Debug)]);

/// Lists thresholds by name, a meaning a line.
macro_rules! same {
    ($($meaning:literal: $($table:ident::$name:ident),+;)*) => {
        /// Thresholds of one meaning that have several values.
        pub const SAME: &[Same] = &[$(($meaning, &[$((
            concat!(stringify!($table), "::", stringify!($name)),
            &crate::$table::$name,
        )),+])),*];
    };
}

same! {
    "deviations of what is surely no chance":
        effect::MIN_STROKE_DEVIATIONS, agreement::MIN_EXPLAINED_DEVIATIONS, delay::MIN_LAG_DEVIATIONS, delay::MAX_CHANCE_DEVIATIONS,
        choice::MIN_EXPONENT_DEVIATIONS, delay::MIN_LOW_PASS_DEVIATIONS, simulation::MIN_BEND, encoder::MAX_RESPONSE_DEVIATIONS,
        procedure::MIN_BOUNDED_RISE, agreement::MAX_CHANCE_DEVIATIONS, delay::MIN_SURE_DEVIATIONS, encoder::MIN_OUTSTANDING_DEVIATIONS,
        encoder::MIN_STANDING_DEVIATIONS, procedure::MAX_BLOCK_OFFSET, rest::MIN_CHANGE_DEVIATIONS, comparison::MAX_PAPER_DEVIATIONS,
        agreement::MIN_CERTAIN_DEVIATIONS, procedure::MIN_RAMP_STEPS, motion::MIN_ACCELERATION, drift::MIN_RELATIVE_LEVEL,
        procedure::MIN_STEP_HEIGHT, procedure::MIN_LEVEL_ERROR, drift::MIN_STEP;
    "error over that of another law up to which both are equal":
        choice::MAX_EQUAL_ERROR, choice::MIN_NAMED_SIMPLER_ERROR, choice::MAX_SIMPLER_ERROR, choice::MAX_CERTAIN_ERROR;
    "error over that of another law below which it is better":
        verdict::MAX_BETTER_ERROR, choice::MAX_NAMED_RICHER_ERROR;
    "explained part of the variance of a fit that stands for the axis":
        verdict::MIN_R2, choice::MIN_START_R2, conditioning::MIN_R2;
    "samples for each unknown":
        verdict::MIN_SAMPLES_PER_UNKNOWN, conditioning::SAMPLES_PER_UNKNOWN;
    "reversals that are enough":
        verdict::MIN_REVERSALS, motion::MIN_REVERSALS, effect::MIN_DELAY_REVERSALS;
    "shift by the conditioning that matters":
        interval::MIN_NAMED_SHIFT, interval::MAX_CORRECTED_SHIFT;
    "samples that are enough for a fit":
        conditioning::MIN_HELD_OUT_SAMPLES, conditioning::MIN_SETTLED_SAMPLES, signal::MIN_USEFUL_SAMPLES, encoder::MIN_STRETCH,
        conditioning::MIN_SAMPLES, conditioning::MIN_DECIMATED_SAMPLES;
    "relative deviation of a number that is known":
        agreement::MAX_CONSTANT_DIFFERENCE, effect::MAX_RELATIVE_DEVIATION, interval::MAX_HALF_WIDTH, plan::MAX_DETERMINED_DEVIATION;
    "speed of rest, in parts of the top speed":
        encoder::MAX_REST_SPEED, motion::MAX_FITTED_REST_SPEED, delay::MIN_LAG_SPEED,
        motion::MAX_REST_SPEED;
    "way back that is a reversal, in strokes":
        effect::MIN_REVERSAL, motion::MIN_TURN;
    "deflections after which the state of the bristles no longer matters":
        conditioning::SETTLING_DEFLECTIONS, motion::TURN_OVER;
    "missing samples in a row that are bridged":
        signal::MAX_BRIDGED_SAMPLES, encoder::MAX_MISSING_READINGS;
    "relative difference of two rates that are one":
        export::MAX_EQUAL_CYCLE, clock::MAX_RATE_ERROR, plan::MAX_PACE_ERROR, tracking::MAX_RATE_DIFFERENCE;
    "relative difference of two speeds or motions that are one":
        procedure::MAX_EQUAL_SPEED, signal::MAX_SPEED_SPREAD, tracking::MAX_MOTION_DIFFERENCE, plan::MAX_SIZE_DIFFERENCE;
    "correlation of two courses of one motion":
        signal::MIN_CORRELATION, plan::MIN_CORRELATION, plan::MIN_CORRELATION_ELSEWHERE;
    "encoder steps of a motion that shows":
        plan::MIN_STROKE_STEPS, plan::MIN_AMPLITUDE_STEPS, effect::MIN_PITCH_COUNTS, procedure::MIN_QUARTER_COUNTS,
        signal::MIN_VELOCITY_STEPS, signal::MIN_ACCELERATION_STEPS, position::MIN_TRAVEL_STEPS;
    "part of its range from which a delay is at the end":
        delay::END_OF_RANGE, procedure::END_OF_RANGE;
}
