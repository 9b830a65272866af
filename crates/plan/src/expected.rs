//! What a whole motion can be expected to tell.

use crate::aim::Aim;
use crate::predict::{Deviations, deviations, worst};
use crate::run::Peaks;
use crate::select::score;
use crate::table::Entry;

/// Deviations that a motion gives, over the axes that are thought possible.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// For each axis the deviation of each parameter, in its [units](crate::Candidate::units).
    pub axes: Vec<Deviations>,
    /// Over the axes, three quarters of the mean of the logarithm of the deviation of the worst parameter, and a quarter of the mean over
    /// the worst fifth; less is better.
    pub score: f64,
    /// The largest of what happened on any axis.
    pub peaks: Peaks,
    /// On each axis: the root mean square of the force, N (N m), the share of the time in which it is at its limit, and the share of
    /// the motion that really happens.
    pub runs: Vec<Peaks>,
}

impl Expected {
    /// From the entries of a motion on every axis, as [`Aim`] says.
    pub fn of(entries: &[Entry], aim: &Aim) -> Expected {
        let axes: Vec<Deviations> = entries
            .iter()
            .map(|e| deviations(&e.information, aim))
            .collect();
        let logarithms: Vec<f64> = axes
            .iter()
            .map(|d| libm::log(worst(d).max(1e-12)))
            .collect();
        let runs: Vec<Peaks> = entries.iter().map(|e| e.peaks).collect();
        Expected {
            score: score(&logarithms, &vec![0.0; axes.len()]),
            peaks: runs.iter().copied().reduce(Peaks::with).unwrap_or_default(),
            runs,
            axes,
        }
    }

    /// The deviation of a parameter that a part of the axes, 0 to 1, does not exceed.
    pub fn quantile(&self, parameter: usize, part: f64) -> f64 {
        quantile(self.axes.iter().map(|d| d[parameter]).collect(), part)
    }

    /// The same of the worst parameter of each axis.
    pub fn worst(&self, part: f64) -> f64 {
        quantile(self.axes.iter().map(|d| worst(d)).collect(), part)
    }
}

fn quantile(mut values: Vec<f64>, part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let place = part.clamp(0.0, 1.0) * (values.len().saturating_sub(1)) as f64;
    let (low, rest) = (place as usize, place - libm::floor(place));
    match (values.get(low), values.get(low + 1)) {
        (Some(a), Some(b)) => a + rest * (b - a),
        (Some(a), None) => *a,
        (None, _) => 1.0,
    }
}
