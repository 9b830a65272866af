//! The known controller of an axis as typed: its units are known with the log.

use stiction_formats::Value;

/// A gain with the place where it stands; its unit must suit the force of the log.
#[derive(Clone, Debug)]
pub(super) struct Gain {
    /// Line and key, as errors begin.
    pub place: String,
    /// The value as typed.
    pub value: Value,
}

/// `[controller]`, checked as far as that goes without a log.
#[derive(Clone, Debug)]
pub(super) struct ControllerValues {
    /// 1/s.
    pub position_gain: f64,
    pub speed_gain: Gain,
    pub integral_gain: Option<Gain>,
    pub velocity_feedforward: f64,
    pub mass_feedforward: Option<Gain>,
    pub force_limit: Option<Gain>,
    /// Hz.
    pub rate: Option<f64>,
}
