//! B: below break-away the block is a spring with hysteresis.

use super::experiment::{Check, Curve, Experiment, TOLERANCE, block};
use crate::plant::{Load, Motion};
use stiction_friction::ParamError;

/// Integration steps a second.
const RATE: usize = 10_000;

/// Force ramps of .1425 N/s to +-95 % of Fs with holds of 5 s.
fn force(t: f64) -> f64 {
    let top = 1.425;
    match t {
        t if t < 10.0 => 0.1425 * t,
        t if t < 15.0 => top,
        t if t < 35.0 => top - 0.1425 * (t - 15.0),
        t if t < 40.0 => -top,
        t if t < 60.0 => -top + 0.1425 * (t - 40.0),
        _ => top,
    }
}

pub(super) fn run() -> Result<Experiment, ParamError> {
    let plant = block()?;
    let h = 1.0 / RATE as f64;
    let mut motion = Motion::default();
    let mut curve = Curve::new("65 s");
    // Positions every .05 s.
    let mut at = Vec::new();
    for k in 0..=65 * RATE {
        if k % (RATE / 20) == 0 {
            at.push(motion.position);
            curve.push(motion.position, force(k as f64 * h));
        }
        let load = Load::force(force((k as f64 + 0.5) * h));
        motion = plant.step(motion, h, load).motion;
    }
    let second = |s: usize| at[20 * s];
    let mut checks: Vec<Check> = [
        (10, 44.858e-6),
        (15, 45.312e-6),
        (35, -9.564e-6),
        (40, -10.017e-6),
        (60, 44.858e-6),
        (65, 45.312e-6),
    ]
    .map(|(s, x)| Check::relative(format!("x({s} s)"), "m", second(s), x, TOLERANCE))
    .to_vec();
    let open = second(65) - second(15);
    checks.push(Check::absolute("gap of the loop", "m", open, 0.0, 1e-9));
    // The tangent falls linearly with the force; that at zero force is the bristles' stiffness. It is drawn from chords,
    // as the damping keeps the position a little behind the force.
    let chord = |k: usize| 0.1425 * 0.05 / (at[k + 1] - at[k]);
    let stiffness = chord(1) - 1.5 * (chord(2) - chord(1));
    let sigma0 = plant.law().stiffness();
    checks.push(Check::relative(
        "initial stiffness",
        "N/m",
        stiffness,
        sigma0,
        TOLERANCE,
    ));
    Ok(Experiment {
        letter: 'B',
        title: "Presliding",
        checks,
        axes: [("Position", "m"), ("Force", "N")],
        curves: vec![curve],
    })
}
