//! Rows of two files or columns that are laid together.

thresholds! {
    MIN_GAP: f64 = 1.5, "median steps", "Step of the other column from which on samples are missing in it.", "choice";
    MIN_THINNED_RATIO: f64 = 2.0, "1", "Ratio of the steps from which on rows are thinned.", "choice";
    MAX_ROW_DISTANCE: f64 = 0.5, "steps", "Distance up to which a row belongs to a sample of the other column.", "choice";
    MIN_POINTS: usize = 100, "1", "Points of each course.", "choice";
    MIN_SHARED_PART: f64 = 0.3, "1", "Part of the shorter course that both share.", "choice";
    MIN_COMMON_VARIANCE: f64 = 0.25, "1", "Part of its variance that a course has where both meet.", "choice";
    MIN_RIVAL_RATIO: f64 = 1.2, "1", "What another lag leaves unexplained over what the best one does.", "choice";
    MIN_RIVAL_OF_FORCE: f64 = 0.05, "1", "What it leaves beyond that of the variance of a force, explained by a motion.", "choice";
    MIN_RIVAL_OF_COPY: f64 = 0.01, "1", "What it leaves beyond that of the variance of the same quantity.", "choice";
    MAX_UNEXPLAINED: f64 = 0.5, "1", "Part of the variance that the best lag leaves unexplained.", "choice";
    MAX_OFFSET_ERROR: f64 = 4.0, "samples", "Half width within which an offset has to be known.", "choice: a fit finds delays within as many";
}
