//! A law along a known velocity, with its sensitivities: what a design of experiments asks of it.

use crate::gms::recursion;
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

/// What Maxwell-slip elements do along a velocity, one entry a sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlipAlong {
    /// Their force together, N (N m), from unloaded elements at the first sample.
    pub force: Vec<f64>,
    /// Force of each element over its yield force; empty where derivatives are not asked for.
    pub levels: Vec<Vec<f64>>,
    /// Derivatives of `force`: with a curve with respect to ln(Fs/Fc - 1), ln vs and ln a, then to the logarithm of the yield deflection of
    /// each element at a given yield force; empty where they are not asked for.
    pub slopes: Vec<Vec<f64>>,
}

/// A fall of the level with speed, in both directions: the Gaussian curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fall {
    /// Fs/Fc - 1, > 0.
    pub excess: f64,
    /// > 0, m/s (rad/s).
    pub stribeck_velocity: f64,
    /// Rate at which an element that slips follows the curve, > 0, 1/s.
    pub attraction: f64,
}

/// Maxwell-slip elements along a `velocity` (m/s, rad/s) in steps of `step` s, as a fit of them sees it: without a `fall` the law
/// `maxwell-slip`, with it `gms`.
///
/// Of each element `yields` is the deflection at which it yields, > 0, m (rad), and `forces` the force at rest that it yields at, N
/// (N m), as many as there are deflections.
pub fn slip_along(
    yields: &[f64],
    forces: &[f64],
    fall: Option<Fall>,
    (step, velocity): (f64, &[f64]),
    slopes: bool,
) -> SlipAlong {
    let kind = match fall {
        Some(_) => LawKind::Gms,
        None => LawKind::MaxwellSlip,
    };
    let law = Law {
        elements: yields.len(),
        ..Law::new(kind)
    };
    let curve = fall.map(|f| [f.excess, f.stribeck_velocity, f.attraction]);
    let unknowns = curve.iter().flatten().chain(yields);
    let p: Vec<f64> = unknowns.map(|x| libm::log(*x)).collect();
    let elements = recursion::trace(&law, &p, step, velocity, slopes);
    let mut force = vec![0.0; velocity.len()];
    for (element, of) in elements.iter().zip(forces) {
        for (sum, level) in force.iter_mut().zip(&element.level) {
            *sum += of * level;
        }
    }
    let own = |i| recursion::slope(&elements, i, forces);
    SlipAlong {
        force,
        slopes: (0..if slopes { p.len() } else { 0 }).map(own).collect(),
        levels: match slopes {
            true => elements.into_iter().map(|e| e.level).collect(),
            false => Vec::new(),
        },
    }
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

    /// Each derivative of the elements is that of differences, but for instants at which one begins to slip.
    #[test]
    fn elements_have_the_slopes_of_differences() {
        let velocity = velocity();
        let fall = |p: &[f64]| Fall {
            excess: p[0],
            stribeck_velocity: p[1],
            attraction: p[2],
        };
        let forces = [8.0, 5.0, 3.0];
        let p = [0.6, 4e-3, 300.0, 2e-5, 2e-4, 1e-3];
        let along = |p: &[f64], slopes| {
            slip_along(&p[3..], &forces, Some(fall(p)), (1e-3, &velocity), slopes)
        };
        let whole = along(&p, true);
        assert_eq!((whole.slopes.len(), whole.levels.len()), (6, 3));
        let plain = slip_along(&p[3..], &forces, None, (1e-3, &velocity), true);
        assert_eq!(plain.slopes.len(), 3);
        assert!(plain.force.iter().all(|f| f.abs() <= 16.0 + 1e-9));
        for (k, slope) in whole.slopes.iter().enumerate() {
            let near = |by: f64| {
                let mut p = p;
                p[k] *= libm::exp(by);
                along(&p, false).force
            };
            let (low, high) = (near(-1e-6), near(1e-6));
            let largest = slope.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            assert!(largest > 0.0);
            let both = slope.iter().zip(low.iter().zip(&high));
            let off = both.filter(|(slope, (low, high))| {
                (*slope - (*high - *low) / 2e-6).abs() > 1e-3 * largest
            });
            assert!(off.count() < velocity.len() / 200, "{k}");
        }
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
