//! The choice of a law.

thresholds! {
    MAX_EQUAL_ERROR: f64 = 1.01, "1", "Ratio of two held-out errors up to which they are equal.", "choice: less than 1 % has no practical use";
    MAX_EQUAL_DEVIATIONS: f64 = 1.0, "standard errors", "Difference of a held-out error from the least up to which a law is as good.", "Breiman, Friedman, Olshen and Stone 1984, section 3.4.3";
    MAX_SIMPLER_ERROR: f64 = 1.05, "1", "Ratio of two held-out errors up to which the law with fewer parameters is taken.", "tuned: repeats of a servo choose one law in eight of ten, of four robot joints in ten of twelve";
    MAX_CERTAIN_ERROR: f64 = 1.1, "1", "Ratio of two held-out errors above which laws are never equal.", "choice: the simpler law would leave a tenth more";
    AIC_PER_PARAMETER: f64 = 2.0, "1", "What a part of a map has to gain in -2 ln L.", "Akaike 1974";
    MIN_EXPONENT_DEVIATIONS: f64 = 3.0, "deviations", "Distance of a Stribeck exponent from the next law's from which it is another one.", "choice";
    MAX_HELD_OUT_PERCENT: f64 = 100.0, "%", "Held-out error from which a law says nothing of other samples.", "choice: as much as without any force";
    MAX_SIMPLER_COST: f64 = 0.99, "1", "Cost of the simpler law over that of the richer one below which the search of the richer one has missed.", "choice: one more unknown cannot explain less";
    MIN_START_R2: f64 = 0.9, "1", "Explained part of the variance from which a simulated fit starts at the separable one.", "choice: less may be the valley of another minimum";
    MAX_EQUAL_LOSS: f64 = 1e-6, "1", "Relative difference of the losses of two maps that are one.", "choice: above rounding, below any other minimum";
    MAX_EQUAL_RESIDUAL: f64 = 1e-6, "1", "Relative difference of the residuals of two fits that are one.", "choice: above rounding";
    MIN_NAMED_SIMPLER_ERROR: f64 = 1.02, "1", "Held-out error over that of a simpler law from which the simpler one is named.", "choice: twice what counts as equal";
    MAX_NAMED_RICHER_ERROR: f64 = 0.8, "1", "Held-out error of a richer law over that of this one below which the richer one is named.", "choice: a fifth less biases parameters visibly";
    MAX_STATIC_REST_SHARE: f64 = 0.05, "1", "Part of the samples near rest above which a static law is warned of.", "choice";
    MAX_STATIC_REST_ERROR: f64 = 1.5, "1", "Rms residual near rest over that of all samples above which a static law is warned of.", "choice";
}
