//! What no log shows.

use crate::estimate::fitted::FittedLaw;
use crate::parameter::{NORMAL_Q95, Parameter};

/// Least half width of a 95 % interval, in parts of the value. Long logs average noise down to less, but not what a fit leaves
/// of second order: noise of an encoder in the regressors, the force between two samples, how roughly filters are undone. Of 160
/// logs of another simulator, narrower intervals were wrong by up to this, eight of their half widths.
pub const LEAST: f64 = 5e-4;

/// States no parameter as better known than any log shows it.
pub(super) fn no_surer_than_any_log(fitted: &mut FittedLaw) {
    let covariance = &mut fitted.covariance;
    for p in fitted.parameters.iter_mut().filter(|p| p.identified) {
        let Some(widened) = widen(p) else { continue };
        let at = covariance.names.iter().position(|name| *name == p.name);
        if let Some(at) = at {
            for k in 0..covariance.matrix.len() {
                covariance.matrix[at][k] *= widened;
                covariance.matrix[k][at] *= widened;
            }
        }
    }
}

/// Widens deviation and interval; gives by how much the deviation. `None` where nothing is stated.
fn widen(p: &mut Parameter) -> Option<f64> {
    let (std, least) = (p.std?, LEAST * p.value.abs());
    if let Some((low, high)) = &mut p.ci95 {
        *low = low.min(p.value - least);
        *high = high.max(p.value + least);
    }
    let wider = std.max(least / NORMAL_Q95);
    p.std = Some(wider);
    (std > 0.0).then_some(wider / std)
}

#[cfg(test)]
mod tests {
    use super::*;
    use stiction_parameters::Quantity;

    #[test]
    fn an_interval_is_never_narrower_and_else_as_it_was() {
        let known_to = |std: f64| {
            let mut p = Parameter::given(Quantity::Mass, 10.0);
            p.std = Some(std);
            p.ci95 = Some((10.0 - NORMAL_Q95 * std, 10.0 + 2.0 * NORMAL_Q95 * std));
            widen(&mut p);
            let (low, high) = p.ci95.unwrap();
            (10.0 - low, high - 10.0, NORMAL_Q95 * p.std.unwrap())
        };
        let (low, high, std) = known_to(1e-9);
        for half in [low, high, std] {
            assert!((half - 10.0 * LEAST).abs() < 1e-6, "{half}");
        }
        let (low, high, std) = known_to(0.1);
        for (half, before) in [(low, 0.1), (high, 0.2), (std, 0.1)] {
            assert!(
                (half - NORMAL_Q95 * before).abs() < 1e-12,
                "{half} {before}"
            );
        }
    }
}
