//! Friction in steady sliding by speed.

use serde::{Deserialize, Serialize};

/// Friction by speed, whatever the law: in the unit of the force, with half widths of 95 % intervals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionCurveEntry {
    /// Unit of the speeds.
    pub speed_unit: String,
    /// Unit of the force.
    pub unit: String,
    /// Half of the sum of both directions at a twentieth, half and all of the largest speed of the curve, none below its least; of a log
    /// with one direction its own.
    pub at: Vec<FrictionAtEntry>,
    /// Coulomb and viscous friction of the straight line nearest to half of the sum of both directions from a tenth of the top speed
    /// on, as simulators take it; absent for one direction, for one speed, and where the curve ends below half of the top speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<FrictionLineEntry>,
    /// Speeds from the least to the largest at which friction outweighs inertia.
    pub speed: Vec<f64>,
    /// Half of the sum of both directions; absent for one direction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub both: Option<BandEntry>,
    /// Half of their difference: a constant force, a weight, or friction that differs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub constant: Option<BandEntry>,
    /// Friction of motion forward, with the constant force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub forward: Option<BandEntry>,
    /// Friction of motion back, with the constant force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back: Option<BandEntry>,
}

impl FrictionCurveEntry {
    /// Friction in steady sliding at a velocity, m/s (rad/s), with the sign of the velocity; half widths as they are.
    ///
    /// Linear between the speeds of the curve, of the direction of the velocity; the mean where no direction is kept. `None` for a direction that the logs do not have,
    /// below their least and above their largest speed, so also at rest.
    pub fn at_velocity(&self, velocity: f64) -> Option<FrictionAtEntry> {
        let band = match (&self.forward, &self.back) {
            (None, None) => self.both.as_ref()?,
            (_, back) if velocity < 0.0 => back.as_ref()?,
            (forward, _) => forward.as_ref()?,
        };
        let v = velocity.abs();
        let above = self.speed.partition_point(|speed| *speed <= v);
        let (k, part) = match (above.checked_sub(1)?, self.speed.get(above)) {
            (k, Some(next)) => (k, (v - self.speed[k]) / (next - self.speed[k])),
            (k, None) if self.speed[k] == v => (k, 0.0),
            _ => return None,
        };
        let of = |values: &[f64]| {
            let low = *values.get(k)?;
            let high = values.get(k + 1).copied().unwrap_or(low);
            // A band that is not known has no number.
            Some(low + part * (high - low)).filter(|value| value.is_finite())
        };
        Some(FrictionAtEntry {
            speed: v,
            force: 1f64.copysign(velocity) * of(&band.force)?,
            at_once: of(&band.at_once)?,
            repeat: of(&band.repeat)?,
            transfer: of(&band.transfer)?,
        })
    }
}

/// Friction at one speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionAtEntry {
    /// The speed.
    pub speed: f64,
    /// Force against the motion.
    pub force: f64,
    /// Half width for the same test again, now.
    pub at_once: f64,
    /// Half width for the same test on another day.
    pub repeat: f64,
    /// Half width for another motion of the same kind.
    pub transfer: f64,
}

/// Coulomb and viscous friction of a straight line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionLineEntry {
    /// Friction at no speed.
    pub coulomb: ValueEntry,
    /// Friction that is added for each unit of the speed.
    pub viscous: ValueEntry,
    /// Unit of the latter.
    pub viscous_unit: String,
    /// Correlation of the two from day to day, -1 to 1; absent of results that were written before it was kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correlation: Option<f64>,
    /// Correlation of each with the mass, where it was fitted with them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correlation_with_mass: Option<[f64; 2]>,
}

/// A value with half widths of 95 % intervals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ValueEntry {
    /// The value.
    pub value: f64,
    /// Half width for the same test again, now.
    pub at_once: f64,
    /// Half width for the same test on another day.
    pub repeat: f64,
    /// Half width for another motion of the same kind.
    pub transfer: f64,
}

/// Friction at all speeds of the curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BandEntry {
    /// Force against the motion.
    pub force: Vec<f64>,
    /// Half widths for the same test again, now.
    pub at_once: Vec<f64>,
    /// Half widths for the same test on another day.
    pub repeat: Vec<f64>,
    /// Half widths for another motion of the same kind.
    pub transfer: Vec<f64>,
}
