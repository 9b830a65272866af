//! What an axis works in, as a log has it.

/// Load, temperature and place of a simulated axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// Normal load, in the unit of the model.
    pub load: f64,
    /// K
    pub temperature: f64,
    /// Where the origin of the simulated axis lies in the coordinates of the model, m (rad).
    pub origin: f64,
}

impl Surroundings {
    /// Load, temperature and position in the coordinates of the model, the axis being at `position`, m (rad).
    pub fn seen(&self, position: f64) -> [f64; 3] {
        [self.load, self.temperature, self.origin + position]
    }
}
