//! G: under a force that oscillates below break-away a LuGre block drifts; an elasto-plastic one does not (the subject of
//! Dupont et al. 2002, doi 10.1109/TAC.2002.1000274).

use super::experiment::{Check, Curve, Experiment, TOLERANCE, axis, block};
use crate::plant::{Load, Motion, Plant};
use stiction_friction::{ElastoPlastic, Held, ParamError};

/// Integration steps a second.
const RATE: u32 = 10_000;

/// Break-away ratio: bristles are elastic up to 1.35 N, above the largest force.
const BREAKAWAY: f64 = 0.9;

pub(super) fn run() -> Result<Experiment, ParamError> {
    let axis = axis()?;
    let lugre = under_oscillating_force(&block()?);
    let law = ElastoPlastic::new(axis.law, BREAKAWAY)?;
    let elastic = under_oscillating_force(&Plant::new(axis.mass, law)?);
    let drift = |x: &[f64]| (x[20 * PER] - x[10 * PER]) / 10.0;
    let checks = vec![
        Check::relative("drift of LuGre", "m/s", drift(&lugre), 12.75e-6, TOLERANCE),
        // Each second has steps at the same phases, to rounding.
        Check::absolute(
            "drift of the elasto-plastic law",
            "m/s",
            drift(&elastic),
            0.0,
            1e-18,
        ),
    ];
    let curve = |label: &str, x: &[f64]| {
        let mut curve = Curve::new(label);
        for (k, x) in x.iter().enumerate() {
            curve.push(k as f64 / PER as f64, *x);
        }
        curve
    };
    Ok(Experiment {
        letter: 'G',
        title: "Drift",
        checks,
        axes: [("Time", "s"), ("Position", "m")],
        curves: vec![curve("LuGre", &lugre), curve("Elasto-plastic", &elastic)],
    })
}

/// Positions stored per second.
const PER: usize = 50;

/// Positions, m, over 20 s under .9 + .3 sin(2 pi t) N, [`PER`] a second.
pub(super) fn under_oscillating_force<L: Held<f64>>(plant: &Plant<L>) -> Vec<f64> {
    let h = 1.0 / f64::from(RATE);
    let force = |t: f64| 0.9 + 0.3 * libm::sin(2.0 * std::f64::consts::PI * t);
    let mut motion = Motion::default();
    let mut at = Vec::new();
    for k in 0..=20 * RATE {
        if (k as usize).is_multiple_of(RATE as usize / PER) {
            at.push(motion.position);
        }
        let load = Load::force(force((f64::from(k) + 0.5) * h));
        motion = plant.step(motion, h, load).motion;
    }
    at
}
