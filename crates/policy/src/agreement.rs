//! Logs, directions and ways to fit that disagree.

thresholds! {
    MIN_CERTAIN_DEVIATIONS: f64 = 4.8, "deviations", "Difference of two logs from which it is no chance.", "Student's t with nine degrees of freedom: 1 in 1000";
    MIN_NAMED_DIFFERENCE: f64 = 0.03, "1", "Relative difference of two logs from which it is named.", "choice";
    MAX_CONSTANT_DIFFERENCE: f64 = 0.1, "1", "Relative difference of two logs from which a value is no constant of the machine.", "choice: the deviation from which a parameter is unknown";
    MIN_POINTS: usize = 6, "1", "Points of a log at speeds that two logs share.", "choice: its scatter must be known";
    MIN_EXPLAINED_DEVIATIONS: f64 = 2.0, "deviations", "Difference of a parameter between the steps and the joint fit above which it is explained.", "choice: as 95 % intervals";
    MAX_CHANCE_DEVIATIONS: f64 = 4.0, "deviations", "Difference that chance explains.", "choice";
    MAX_MASS_RATIO: f64 = 2.0, "1", "Ratio of the masses of two logs that differ by the sign of the force alone.", "choice";
    MAX_LIMIT_RATIO: f64 = 2.0, "1", "Ratio of the mass to `limits.mass` either way.", "choice (docs/axis.md)";
}
