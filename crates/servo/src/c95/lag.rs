//! C: friction lags behind the velocity.

use super::experiment::{Check, Curve, Experiment, TOLERANCE, axis, largest};
use stiction_friction::ParamError;

/// A whole turn, rad.
const TURN: f64 = 2.0 * std::f64::consts::PI;
/// Steps per period.
const STEPS: usize = 400_000;

/// Speeds, m/s, at which the width of the loop is read.
const SPEEDS: [f64; 3] = [1e-3, 1.5e-3, 2e-3];

pub(super) fn run() -> Result<Experiment, ParamError> {
    let mut checks = Vec::new();
    let mut curves = Vec::new();
    for (w, widths, top) in [
        (1.0, [0.00553, 0.00122, 0.00012], 1.38945),
        (10.0, [0.05399, 0.01278, 0.00125], 1.37791),
        (25.0, [0.10748, 0.03609, 0.00408], 1.34427),
    ] {
        let force = period(w)?;
        let found = largest(force.iter().copied());
        let name = |what: &str| format!("{what}, {w} rad/s");
        checks.push(Check::relative(
            name("largest force"),
            "N",
            found,
            top,
            TOLERANCE,
        ));
        for (speed, width) in SPEEDS.into_iter().zip(widths) {
            let falling = libm::acos(1e3 * speed - 1.5);
            let found = at(&force, TURN - falling) - at(&force, falling);
            // The references have five decimals; .1 % where that is more.
            let tolerance = f64::max(TOLERANCE * width, 0.6e-5);
            let name = name(&format!("width at {} mm/s", 1e3 * speed));
            checks.push(Check::absolute(name, "N", found, width, tolerance));
        }
        let mut curve = Curve::new(format!("{w} rad/s"));
        for k in (0..=STEPS).step_by(STEPS / 1000) {
            curve.push(velocity(k), force[k]);
        }
        curves.push(curve);
    }
    Ok(Experiment {
        letter: 'C',
        title: "Frictional lag",
        checks,
        axes: [("Velocity", "m/s"), ("Friction", "N")],
        curves,
    })
}

/// 1e-3 (1.5 + cos wt), m/s, at a step of the period.
fn velocity(k: usize) -> f64 {
    1e-3 * (1.5 + libm::cos(TURN * k as f64 / STEPS as f64))
}

/// The force over the second period. The path of one period is a hundred deflections or more, so the second is periodic.
fn period(w: f64) -> Result<Vec<f64>, ParamError> {
    let law = axis()?.law;
    let h = TURN / w / STEPS as f64;
    let mut z = 0.0;
    let mut force = Vec::new();
    for _ in 0..2 {
        force.clear();
        for k in 0..STEPS {
            force.push(law.force(z, velocity(k)));
            z = law.step_record(z, h, velocity(k), velocity(k + 1));
        }
        force.push(law.force(z, velocity(STEPS)));
    }
    Ok(force)
}

/// The force at a phase, rad, linear between steps.
fn at(force: &[f64], phase: f64) -> f64 {
    let x = phase / TURN * STEPS as f64;
    let i = x as usize;
    force[i] + (x - i as f64) * (force[i + 1] - force[i])
}
