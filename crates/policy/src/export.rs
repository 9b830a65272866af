//! Compensators for a target.

thresholds! {
    MIN_WEIGHT: f64 = 0.5, "Coulomb levels", "Constant force that may be a weight.", "choice: friction differs less between directions";
    MAX_EQUAL_CYCLE: f64 = 0.01, "1", "Relative difference of equal cycle times.", "choice";
    MAX_WRAP_ERROR: f64 = 1e-3, "periods", "Distance of a wrap from a whole number of periods.", "choice: beyond, a wave is a degree off after three turns";
    MAX_FORCE_DIFFERENCE: f64 = 1e-12, "1", "Relative difference of the forces of exported code.", "allowed of exported C in double precision";
}
