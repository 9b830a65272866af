//! What the counts of an encoder show, at rest and through the controller's response.

thresholds! {
    MIN_REST_SHARE: f64 = 0.15, "1", "Part of the samples at rest from which the counts are asked.", "choice";
    MAX_MISSING_READINGS: usize = 20, "samples", "Missing readings in a row that do not split a stretch.", "choice";
    MIN_STRETCH: usize = 100, "samples", "Samples of a stretch that is worth a start of its own.", "choice";
    MAX_DISTURBANCE: f64 = 0.4, "1", "Deviation of the disturbance over that of the force noise.", "choice (decision 0060)";
    MAX_DISTURBANCE_DENSITY: f64 = 2.5, "1", "Density of the disturbance at low frequencies over that of the noise.", "choice: what is left of a noise has no more than the noise";
    MAX_PART_EXCESS: f64 = 2.0, "1", "Factor by which a part of the samples may exceed the limits of the disturbance.", "choice";
    MAX_DELAY_OFFSET: f64 = 0.35, "1", "Distance of the best delay from the nearest one tried, over that between two.", "choice";
    MAX_EQUAL_LIKELIHOOD: f64 = 3.0, "1", "Difference of the log likelihoods of two Stribeck curves that are as likely.", "simulated: 16 logs, -72 to -1 where the Gaussian was right, else 2 to 121";
    MAX_FINE_COUNTS: f64 = 3.0, "counts", "Finest scale of the position where a response is read off.", "choice: beyond, the motion itself bends";
    MAX_RESPONSE_DEVIATIONS: f64 = 3.0, "deviations", "Rest of the force beyond which a sample is left out.", "choice: the reference jumps there";
    MIN_OUTSTANDING_DEVIATIONS: f64 = 4.0, "deviations", "Part of a force that is no noise.", "choice";
    MAX_READING_IN_COUNTS: f64 = 4.0, "rms counts", "Fast part of a reading that no motion asked for.", "choice";
    MAX_READING_IN_MEDIANS: f64 = 6.0, "medians", "Fast part of a reading that no motion asked for, over its median.", "choice";
    MIN_RESPONSE_GAIN: f64 = 4.0, "chance gains", "Fall of the residual variance of the fast force by which a response is accepted.", "choice";
    MIN_STANDING_DEVIATIONS: f64 = 4.0, "deviations", "Response to a standing difference of position from which it is believed.", "choice";
    REST_WINDOW: usize = 16, "samples", "Samples over which a position that stays is a rest.", "choice";
    MAX_REST_SPEED: f64 = 0.003, "top speeds", "Speed below which an axis rests.", "choice";
}
