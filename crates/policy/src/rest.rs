//! Rests.

thresholds! {
    MIN_TIME: f64 = 1.0, "s", "Rest that is spoken of.", "choice: shorter ones belong to the motion";
    FITTED_TIME: f64 = 0.02, "s", "Part of a rest beside the motion that is fitted.", "choice: the filter would take it off the motion";
    CARRIED_TIME: f64 = 0.48, "s", "Part of a rest beyond that a record keeps without fitting it.", "choice: filters settle in it";
    MAX_SHARE: f64 = 1.0 / 3.0, "1", "Part of the samples at rest between motions above which there is a warning.", "choice";
    QUIETEST_SHARE: f64 = 0.1, "1", "Part of the blocks that shows the noise at rest.", "choice: motion looks like noise too";
    MIN_RANGE: f64 = 30.0, "movements", "Range of the record over what encoder and noise make.", "choice: in presliding each count counts";
    MIN_CROSSINGS: f64 = 5.0, "crossings", "Length of a rest in mean times to leave its band.", "choice: slow motion stands from count to count";
    MAX_DRIFT: f64 = 0.55, "bands", "Distance of the means of the first and last third.", "choice: slow motion has two thirds";
    MAX_HELD_FORCE: f64 = 0.1, "spreads", "Variation of the force of a rest that integrator or brake holds.", "choice";
    MIN_CHANGE: f64 = 0.02, "spreads", "Distance from the first level at which a variation begins.", "choice";
    MIN_CHANGE_DEVIATIONS: f64 = 4.0, "standard errors", "The same distance over the error of the mean of a block.", "choice";
    MIN_SWING: f64 = 0.25, "spreads", "Movement of the force to and fro on purpose.", "choice";
    MAX_STEPS: f64 = 2.0, "steps", "Range of an axis at rest.", "choice: an encoder may dither between two counts";
}
