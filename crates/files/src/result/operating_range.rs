//! What a log has seen of the quantities that friction and the forces beside it depend on.

use serde::{Deserialize, Serialize};

/// Least and largest values of the samples that were fitted; what no log has is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RangeEntry {
    /// Position, m or rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 2]>,
    /// Travel after which the position of the log wraps, m or rad; the positions are unwrapped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wrap: Option<f64>,
    /// Normal load, in its unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<[f64; 2]>,
    /// Temperature, K.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<[f64; 2]>,
    /// Size of what is transmitted to the load, in the unit of the force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transmitted: Option<[f64; 2]>,
    /// Largest acceleration, m/s^2 or rad/s^2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<f64>,
    /// Top speed, m/s or rad/s, of a model without that of its log.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
}

/// Pitches of the waves along the position, m or rad: of the first, second, ...
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PitchEntry {
    /// Of cogging.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cogging: Vec<f64>,
    /// Of the Coulomb level (`coulomb_pitch`).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub coulomb: Vec<f64>,
}

/// The Coulomb level along the stroke, in the unit of the force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelAlongEntry {
    /// The parameter whose mean along the stroke it has: `coulomb`, or that of a direction.
    pub name: String,
    /// Places from one end of the stroke to the other, m or rad.
    pub position: Vec<f64>,
    /// The level there.
    pub level: Vec<f64>,
    /// Lower end of its 95 % interval.
    pub low: Vec<f64>,
    /// Upper end.
    pub high: Vec<f64>,
}

impl RangeEntry {
    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl PitchEntry {
    /// Whether there is no wave.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
