//! The level of friction along the stroke.

use crate::conditioning::record::extent;
use crate::estimate::fitted::FittedLaw;
use crate::law::dependence::Dependence;
use crate::parameter::NORMAL_Q95;
use stiction_parameters::{Name, Quantity, Side};

/// Places at which the level is stated: the ends of sixteen equal parts of the stroke.
const PLACES: usize = 17;

/// The Coulomb level along the stroke, in one direction of motion or both.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelAlong {
    /// Of which direction it is.
    pub side: Side,
    /// Places from one end of the stroke to the other, m or rad.
    pub position: Vec<f64>,
    /// The level there, in the unit of the force.
    pub level: Vec<f64>,
    /// Ends of its 95 % interval, each place by itself.
    pub low: Vec<f64>,
    /// The upper end.
    pub high: Vec<f64>,
}

impl FittedLaw {
    /// The level along the stroke of the fitted samples, where it has a line or a map over it; the mean over the pitch of a wave
    /// beside it. Empty for other laws, while there is no covariance, and for a map that is cut off.
    pub fn level_along(&self) -> Vec<LevelAlong> {
        let line = self.terms.dependences.iter().find_map(|own| match own {
            Dependence::CoulombPosition(about) => Some(*about),
            _ => None,
        });
        let map = self.terms.map().filter(|map| map.terms > 0);
        let (start, end) = extent(&self.series.position);
        let changes = line.is_some() || map.is_some();
        let truncated = map.is_some_and(|map| map.is_truncated());
        if !changes || truncated || start >= end || self.covariance.names.is_empty() {
            return Vec::new();
        }
        let slope = |name: Name, side: Side, x: f64| match name.quantity {
            _ if name.side != side => 0.0,
            Quantity::Coulomb => 1.0,
            Quantity::CoulombPosition => line.map_or(0.0, |about| x - about),
            Quantity::CoulombMap(k) => map.map_or(0.0, |map| map.part(k as usize, x)),
            _ => 0.0,
        };
        let last = (PLACES - 1) as f64;
        let places = (0..PLACES).map(|i| start + (end - start) * i as f64 / last);
        let position: Vec<f64> = places.collect();
        let along = |&side: &Side| {
            let at = |x: f64| -> f64 {
                let each = self.parameters.iter();
                each.map(|p| slope(p.name, side, x) * p.value).sum()
            };
            let reach =
                |x: f64| NORMAL_Q95 * self.covariance.deviation(|name| slope(name, side, x));
            let of = |sign: f64| position.iter().map(|&x| at(x) + sign * reach(x)).collect();
            LevelAlong {
                side,
                level: of(0.0),
                low: of(-1.0),
                high: of(1.0),
                position: position.clone(),
            }
        };
        Side::all(self.law.asymmetric).iter().map(along).collect()
    }
}
