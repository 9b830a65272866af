//! What an axis may do, as the axis file says it.

use super::values::Axis;
use crate::error::Error;
use stiction_log::Motion;

/// `[limits]`, in SI; what is not given stays open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLimits {
    /// Linear or rotary.
    pub motion: Motion,
    /// How far the axis may go from where it stands, to negative and positive positions, m (rad).
    pub stroke: Option<[f64; 2]>,
    /// Part of the stroke that is left free at either end.
    pub end_zone: Option<f64>,
    /// m/s (rad/s)
    pub speed: Option<f64>,
    /// m/s^2 (rad/s^2)
    pub acceleration: Option<f64>,
    /// m/s^3 (rad/s^3)
    pub jerk: Option<f64>,
    /// Force (torque) that the drive can give for long, N (N m).
    pub rated_force: Option<f64>,
    /// Largest force, N (N m).
    pub peak_force: Option<f64>,
    /// What moves, roughly, kg (kg m^2).
    pub mass: Option<f64>,
    /// Standard deviation of the noise of a logged force, N (N m).
    pub force_noise: Option<f64>,
}

impl Axis {
    /// One error of all keys that are missing, each with what to give.
    pub fn missing(&self, keys: &[(&str, String)]) -> Error {
        let lacking = keys.iter().map(|(key, give)| Error::Config {
            file: self.file.clone(),
            place: format!("{key}: "),
            found: "is missing".into(),
            allowed: format!("give {give}"),
        });
        Error::of_all(lacking.collect()).unwrap_or_else(|| self.missing_nothing())
    }

    fn missing_nothing(&self) -> Error {
        self.misfit("limits: ", "is missing", "give a table [limits]".into())
    }
}
