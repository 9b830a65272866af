//! What counts as known: identifiability and intervals.

thresholds! {
    MAX_HALF_WIDTH: f64 = 0.20, "1", "Relative half width of the interval of a repeat above which a parameter is not identifiable.", "choice";
    MAX_DELAY_HALF_WIDTH: f64 = 0.5, "samples", "Half width of the interval of a delay up to which it is determined.", "choice: a held command is ahead of its motion by as much";
    MAX_CORRECTED_SHIFT: f64 = 0.10, "1", "Shift by the conditioning, as a part of the value, up to which it is taken off.", "choice";
    MAX_LOG_HALF_WIDTH: f64 = 4.0, "1", "Half width in the logarithm beyond which an interval says nothing.", "choice";
    MIN_HALF_WIDTH: f64 = 5e-4, "1", "Least relative half width of a 95 % interval: errors of second order do not average down.", "simulated: 160 logs of another simulator";
    MIN_PRIOR_VARIANCE: f64 = 4.0 / 3.0, "1", "Variance from the log over that with the prior from which on the prior decides.", "choice: half of the prior's deviation is left";
    MIN_SHARED_VARIANCE: f64 = 0.75, "1", "Squared correlation with an unknown from which on a parameter is known only as well.", "choice: twice the deviation beside a known one";
    MIN_TRAVELS: f64 = 1.85, "bristle travels", "Stroke from which on sliding friction shows.", "LuGre, eq. 1 and 2 of Canudas de Wit et al. 1995: within a twentieth of the level";
    MAX_CREEP: f64 = 2.0, "bristle travels", "Stroke within which an axis that never reached its static level may have crept.", "choice";
    MIN_NAMED_CORRELATION: f64 = 0.9, "1", "Correlation from which a pair of parameters is named.", "choice: 2.3 times the deviation with the other one known";
    MAX_NAMED_PARTNERS: usize = 2, "1", "Most partners that are named.", "choice";
    TEMPERATURE_SPAN: f64 = 10.0, "K", "Least change of temperature over which a dependence on it is judged.", "choice";
    MIN_CONFUSED_CORRELATION: f64 = 0.9, "1", "Correlation in the joint fit from which two parameters are hard to tell apart.", "choice";
    MAX_RESERVE_HALF_WIDTH: f64 = 5.0, "%", "Half width up to which the whole force may be compensated in the end.", "decision 0020: some percent";
    MIN_NAMED_SHIFT: f64 = 0.05, "1", "Shift of a parameter by encoder, filters and noise, as a part of its value, above which it is named.", "choice";
}
