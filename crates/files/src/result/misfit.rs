//! What a law leaves systematically.

use serde::{Deserialize, Serialize};

/// The part of the residual that comes back with time, place, speed or travel, beyond what noise, encoder and filters explain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MisfitEntry {
    /// The division of the motion that shows most of it.
    pub by: String,
    /// Code of its likely cause; absent where it is too small a part of the residual to be named.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<String>,
    /// Its root mean square, in `unit`.
    pub rmse: f64,
    /// Unit of `rmse`.
    pub unit: String,
    /// Its part of the mean square of the residual, percent.
    pub share_percent: f64,
    /// Pitch of the wave over the position that explains most of it, m or rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch: Option<f64>,
    /// Standard deviation of that pitch, percent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch_std_percent: Option<f64>,
    /// Amplitude of that wave, in `unit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<f64>,
    /// Frequency of the load on its spring while the motor stands still, Hz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency_hz: Option<f64>,
    /// Frequency of motor and load against each other, Hz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resonance_hz: Option<f64>,
    /// Where the encoder of a load on a spring is: `motor` or `load`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub encoder: Option<String>,
    /// Lost motion between motor and load, m or rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lost_motion: Option<f64>,
    /// Standard deviation of that frequency or lost motion, percent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupling_std_percent: Option<f64>,
    /// The load, percent of the moving mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_percent: Option<f64>,
    /// By how much the force falls further behind its motion, millionths, where two clocks run apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock_drift_ppm: Option<f64>,
    /// Standard deviation of that, millionths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock_drift_std_ppm: Option<f64>,
}
