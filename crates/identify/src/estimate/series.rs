//! Measured data and the model of a fit, sample by sample.

/// Signals at the samples of the fit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Which log each sample comes from, counted from 0.
    pub log: Vec<usize>,
    /// Time, s.
    pub time: Vec<f64>,
    /// Position, m or rad.
    pub position: Vec<f64>,
    /// Velocity, m/s or rad/s.
    pub velocity: Vec<f64>,
    /// Measured force.
    pub measured: Vec<f64>,
    /// Model of the force.
    pub model: Vec<f64>,
    /// Part of the model that is not friction: inertia, offset, gravity, cogging.
    pub other: Vec<f64>,
}

impl Series {
    /// Measured minus model.
    pub fn residual(&self) -> Vec<f64> {
        self.measured
            .iter()
            .zip(&self.model)
            .map(|(u, y)| u - y)
            .collect()
    }
}
