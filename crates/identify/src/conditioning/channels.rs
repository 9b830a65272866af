//! Channels that friction may depend on beside the velocity, and a measured acceleration.

/// At the full rate of a segment, unfiltered, since the column that a law makes of them passes the
/// common filter as a whole; empty where the log has no such channel.
#[derive(Clone, Debug, Default)]
pub struct Channels {
    /// Position as it was measured (source filter passed), m or rad.
    pub position: Vec<f64>,
    /// Normal load, in the unit of the log.
    pub load: Vec<f64>,
    /// Temperature, K.
    pub temperature: Vec<f64>,
    /// What acts on the axis from outside, in the unit of the force.
    pub external: Vec<f64>,
    /// By how much that may be wrong: of each of some independent errors one standard deviation.
    pub external_deviations: Vec<Vec<f64>>,
    /// Acceleration as it was measured (source filter passed), m/s^2 or rad/s^2.
    pub acceleration: Vec<f64>,
}

impl Channels {
    /// Every n-th sample.
    pub(crate) fn every(&self, n: usize) -> Self {
        let pick = |x: &[f64]| x.iter().step_by(n.max(1)).copied().collect();
        Self {
            position: pick(&self.position),
            load: pick(&self.load),
            temperature: pick(&self.temperature),
            external: pick(&self.external),
            external_deviations: self.external_deviations.iter().map(|x| pick(x)).collect(),
            acceleration: pick(&self.acceleration),
        }
    }
}
