//! When force and motion of a row do not belong together: delays, low-passes, late rows.

thresholds! {
    END_OF_RANGE: f64 = 0.75, "1", "Part of its range from which on a delay may be further away.", "choice";
    MAX_ROW_ERROR: f64 = 0.5, "1", "Error at the rows that are found over that as logged.", "choice";
    MAX_ALIGNED_ROW_ERROR: f64 = 1.0, "1", "Error at the rows that are found over that of force and motion that were aligned before.", "choice: any less is better";
    MAX_LATE_ROW_ERROR: f64 = 0.97, "1", "Error of a later force over that as logged, where nothing else explains more.", "choice: a delay just beyond its range leaves about as much";
    MIN_VELOCITY_LAG: f64 = 1.5, "samples", "Lag of a velocity behind its force from which on it is filtered.", "choice: a held command and a mean over a sample make half a sample each";
    MIN_FORCE_LAG: f64 = 0.3, "samples", "Lag of a held force from which on a low-pass is looked for.", "choice";
    MAX_LOW_PASS_EXCESS: f64 = 1.0, "samples", "Time constant beyond the delay of the force.", "choice: rows and filters move a delay by as much";
    MIN_LOW_PASS_DEVIATIONS: f64 = 3.0, "deviations", "Square of a time constant from which on there is a low-pass.", "choice";
    MAX_LOW_PASS_ERROR: f64 = 1.0, "1", "Error with the low-pass over that without.", "choice";
    MAX_LOW_PASS_DELAY: f64 = 0.75, "samples", "Delay beside a low-pass from that of a held force.", "choice: what only looks like a low-pass leaves another delay";
    MAX_FURTHER_ERROR: f64 = 0.3, "1", "Error with a low-pass over that without, beside which the force may be later by rows.", "choice";
    MAX_FURTHER_DELAY: f64 = 2.0, "samples", "Rows by which a force behind a low-pass may be later.", "choice";
    MAX_MEAN_ERROR: f64 = 0.8, "1", "Error with a mean over rows over that without.", "choice";
    MAX_MEAN_OVER_LOW_PASS: f64 = 0.95, "1", "Error with a mean over rows over that with a low-pass.", "choice";
    MIN_MEAN_ROWS: f64 = 3.0, "samples", "Fewest rows of a mean.", "choice";
    MIN_FLAT_DEVIATION: f64 = 1.0, "samples", "Deviation of a delay from which on its profile is flat.", "choice";
    MIN_LAG_SPEED: f64 = 0.01, "top speeds", "Speed from which on samples show a lag.", "choice: what filters make of rests would be a lag";
    MIN_LAG: f64 = 0.1, "samples", "Lag up to which nothing is asked.", "choice: a held force loses as much as by a lag of 0.3";
    ROWS_OF_A_FIT: usize = 3, "samples", "Delay that a fit finds by itself.", "choice";
    MAX_LATE_ERROR: f64 = 0.5, "1", "Squared error at the best lag over that where a fit would find it.", "choice";
    MIN_LAG_DEVIATIONS: f64 = 2.0, "deviations", "Lag from which it is certain.", "choice: 1.7 where all lags are as likely";
    MAX_CHANCE_DEVIATIONS: f64 = 2.0, "deviations", "Difference of a fitted delay that chance explains.", "choice";
    MIN_SURE_DEVIATIONS: f64 = 4.0, "deviations", "Difference of a fitted delay that is surely one.", "choice";
    MAX_ROWS_APART: usize = 6, "samples", "Difference of the delays of two logs.", "choice: what one fit finds either side of the middle";
    MAX_ROWS_OVER_FILTER: f64 = 1.3, "1", "Error with late rows over that with a filter up to which rows are believed.", "choice: a filter has one number more";
}
