//! LuGre along a known velocity, with its sensitivities: what a design of experiments asks of the law.

use crate::law::{Law, LawKind};
use crate::separable::recursion::{Trace, trace};

/// The columns that the bristles make along a velocity, one entry a sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Along {
    /// Deflection in units of the Coulomb level, `s0 z / Fc`, from 0 at the first sample.
    pub eta: Vec<f64>,
    /// Rate of the deflection, m/s (rad/s), which the micro-damping multiplies.
    pub rate: Vec<f64>,
    /// Derivatives of `eta` with respect to ln(s0/Fc), ln(Fs/Fc - 1) and ln vs; empty where they are not asked for.
    pub eta_slope: Vec<Vec<f64>>,
    /// The same of `rate`.
    pub rate_slope: Vec<Vec<f64>>,
}

/// LuGre with the Gaussian curve along a `velocity` (m/s, rad/s) in steps of `step` s, as a fit of it sees it.
///
/// `kappa` = s0/Fc in 1/m (1/rad), `excess` = Fs/Fc - 1 and `stribeck_velocity` in m/s (rad/s) are above 0; `slopes` asks for the
/// derivatives.
pub fn lugre_along(
    kappa: f64,
    excess: f64,
    stribeck_velocity: f64,
    step: f64,
    velocity: &[f64],
    slopes: bool,
) -> Along {
    let p = [kappa, excess, stribeck_velocity].map(libm::log);
    Along::of(trace(&Law::new(LawKind::LuGre), &p, step, velocity, slopes))
}

/// LuGre with parameters for each direction of motion along a velocity; `excess` and `stribeck_velocity` are those of the positive and
/// of the negative direction, `ratio` is Fc of the negative over that of the positive one, above 0. `eta` is in units of Fc of the
/// positive direction; derivatives are with respect to ln(s0/Fc), ln(Fs/Fc - 1) and ln vs of the positive direction, ln ratio, and
/// ln(Fs/Fc - 1) and ln vs of the negative one.
pub fn asymmetric_lugre_along(
    kappa: f64,
    excess: [f64; 2],
    stribeck_velocity: [f64; 2],
    ratio: f64,
    (step, velocity): (f64, &[f64]),
    slopes: bool,
) -> Along {
    let [positive, negative] = [0, 1].map(|side| [excess[side], stribeck_velocity[side]]);
    let p = [
        kappa,
        positive[0],
        positive[1],
        ratio,
        negative[0],
        negative[1],
    ]
    .map(libm::log);
    let law = Law::new(LawKind::LuGre).asymmetric();
    Along::of(trace(&law, &p, step, velocity, slopes))
}

impl Along {
    fn of(trace: Trace) -> Self {
        Along {
            eta: trace.eta,
            rate: trace.rate,
            eta_slope: trace.eta_slope,
            rate_slope: trace.rate_slope,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn velocity() -> Vec<f64> {
        (0..4000)
            .map(|k| 0.02 * libm::sin(0.01 * f64::from(k)) * libm::sin(0.0013 * f64::from(k)))
            .collect()
    }

    /// The same in both directions, it is the symmetric law; else each derivative is that of differences.
    #[test]
    fn directions_of_their_own_are_those_of_the_law() {
        let velocity = velocity();
        let along = |p: [f64; 6], slopes: bool| {
            let motion = (1e-3, velocity.as_slice());
            asymmetric_lugre_along(p[0], [p[1], p[4]], [p[2], p[5]], p[3], motion, slopes)
        };
        let one = lugre_along(6e3, 0.5, 5e-3, 1e-3, &velocity, false);
        let two = along([6e3, 0.5, 5e-3, 1.0, 0.5, 5e-3], false);
        for (a, b) in one.eta.iter().zip(&two.eta) {
            assert!((a - b).abs() < 1e-12);
        }
        let p = [6e3, 0.5, 5e-3, 0.7, 0.9, 8e-3];
        let whole = along(p, true);
        for k in 0..6 {
            let near = |by: f64| {
                let mut p = p;
                p[k] *= libm::exp(by);
                along(p, false).eta
            };
            let (low, high) = (near(-1e-5), near(1e-5));
            let largest = whole.eta_slope[k]
                .iter()
                .fold(0.0, |m: f64, x| m.max(x.abs()));
            assert!(largest > 0.0);
            for (i, slope) in whole.eta_slope[k].iter().enumerate() {
                let due = (high[i] - low[i]) / 2e-5;
                assert!(
                    (slope - due).abs() < 1e-4 * largest + 1e-9,
                    "{k} {i}: {slope} {due}"
                );
            }
        }
    }
}
