//! How far the other parameters go along the profile of one.
//!
//! At the ends of a profile all other parameters are fitted again. Where the cost is a parabola they stay within their own
//! intervals there. Where it is not - a micro-damping that is hardly known takes the stiffness along, farther than the parabola
//! about the optimum says - their intervals reach as far as they go.

use crate::estimate::{Estimate, optimal};
use crate::parameter::IntervalKind;
use crate::parameter::NORMAL_Q95;
use crate::parameter::physical::Physical;
use crate::separable::optimum::Optimum;
use stiction_parameters::Name;

/// The farthest that each parameter has gone.
pub(super) struct Along {
    raw: Vec<(Name, f64, bool)>,
    /// Distance, SI; the logarithm of the ratio where a parameter is positive.
    down: Vec<f64>,
    up: Vec<f64>,
}

impl Along {
    /// Nowhere yet.
    pub fn new(raw: &[Physical]) -> Self {
        Self {
            raw: raw
                .iter()
                .map(|p| (p.name, p.value, p.is_positive()))
                .collect(),
            down: vec![0.0; raw.len()],
            up: vec![0.0; raw.len()],
        }
    }

    /// Counts an end of the profile of `own`.
    pub fn passes(&mut self, there: &[Physical], own: Name) {
        for (i, (name, value, positive)) in self.raw.iter().enumerate() {
            let Some(q) = there.iter().find(|q| q.name == *name && q.name != own) else {
                continue;
            };
            let way = match positive {
                true => libm::log(q.value / value),
                false => q.value - value,
            };
            if way.is_finite() {
                self.down[i] = self.down[i].max(-way);
                self.up[i] = self.up[i].max(way);
            }
        }
    }

    /// Widens the intervals that end before.
    pub fn reach(
        &self,
        raw: &[Physical],
        optimum: &Optimum,
        levels: &[f64],
        estimate: &mut Estimate,
    ) {
        for (i, p) in raw.iter().enumerate() {
            let parameters = &mut estimate.fitted.parameters;
            let Some(own) = parameters.iter_mut().find(|own| own.name == p.name) else {
                continue;
            };
            let (down, up) = (self.down[i], self.up[i]);
            let far = down.max(up);
            if own.interval == IntervalKind::Profile {
                if let Some((low, high)) = &mut own.ci95 {
                    *low = low.min(own.value * libm::exp(-down));
                    *high = high.max(own.value * libm::exp(up));
                }
                continue;
            }
            let size = if p.is_positive() { p.value } else { 1.0 };
            let variance = (far * size / NORMAL_Q95).powi(2);
            let matrix = &mut estimate.fitted.covariance.matrix;
            let farther = variance > matrix[i][i] && variance.is_finite();
            if !farther || !own.identified {
                continue;
            }
            let widen = (variance / matrix[i][i]).sqrt();
            matrix[i].iter_mut().for_each(|x| *x *= widen);
            matrix.iter_mut().for_each(|row| row[i] *= widen);
            *own = optimal::fitted(p, variance, own.bias, optimum, levels[i]);
        }
    }
}
