//! Comparisons of searches, reproduction of the paper.

thresholds! {
    MAX_OPTIMUM_DIFFERENCE: f64 = 1e-6, "1", "Relative difference of costs of one optimum.", "choice: descents stop within it";
    MAX_COST_DIFFERENCE: f64 = 1e-13, "1", "Difference of equal costs J.", "rounding of sums of squares: V5 without noise";
    MAX_SUCCESS_EXCESS: f64 = 1e-4, "1", "Cost over that of the optimum, minus 1, up to which a run with noise is a success.", "choice";
    MAX_SUCCESS_ERROR: f64 = 0.01, "1", "Relative error of each parameter up to which a run without noise is a success.", "choice";
    MAX_ARRIVED_COST: f64 = 1e-8, "1", "Cost J above the optimum of a run that has arrived.", "choice: a relative error of 1e-4";
    MAX_ROUNDING_COST: f64 = 1e-14, "1", "Cost J that is only rounding.", "rounding";
    MAX_PAPER_ERROR: f64 = 0.01, "1", "Relative error of a found parameter.", "Liao et al. 2023 (doi 10.3390/s23042076), without noise";
    MAX_PAPER_MASS_ERROR: f64 = 0.02, "1", "Relative error of a mass found while running.", "choice: found from a tenth of the record";
    MAX_PAPER_DEVIATIONS: f64 = 4.0, "deviations", "Error beyond the bias of six parameters, worst of five draws.", "normal draws: 1 of 500 runs is beyond";
    MAX_PAPER_RIPPLE: f64 = 0.01, "Stribeck velocities", "Rms deviation of an even velocity.", "choice: moves the mean force by 1e-4 of the rise at most";
}
