//! A static map with the curve that a search found, without the least squares that give it intervals.

use super::static_map::StaticMap;
use crate::estimate::searched::without_interval;
use crate::parameter::covariance::Covariance;
use stiction_parameters::{LawKind, Name, ParameterSet, Quantity, SteadyCurve};

impl StaticMap {
    /// The map with these values, SI; a constant force is the mean of what the curve leaves.
    #[must_use]
    pub fn as_searched(&self, values: &[(Name, f64)]) -> Self {
        let mut out = self.clone();
        for parameter in &mut out.parameters {
            if let Some((_, value)) = values.iter().find(|(name, _)| *name == parameter.name) {
                parameter.value = *value;
            }
            without_interval(parameter, false);
        }
        let named = out.parameters.iter().map(|p| (p.name, p.value));
        let curve = SteadyCurve::of(&ParameterSet::of(LawKind::Stribeck, named));
        let friction: Vec<f64> = (self.points.iter())
            .map(|p| curve.force(p.velocity))
            .collect();
        let left = self.points.iter().zip(&friction).map(|(p, f)| p.force - f);
        let offset = match self.settings.offset {
            true => left.sum::<f64>() / self.points.len().max(1) as f64,
            false => 0.0,
        };
        out.model = friction.iter().map(|f| f + offset).collect();
        for parameter in &mut out.parameters {
            if parameter.name == Quantity::Offset {
                parameter.value = offset;
            }
        }
        out.covariance = Covariance::default();
        out
    }
}
