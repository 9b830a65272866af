//! D: the break-away force falls with the rate at which the force grows.

use super::experiment::{Check, Curve, Experiment, block};
use crate::plant::{Load, Motion};
use stiction_friction::ParamError;

pub(super) fn run() -> Result<Experiment, ParamError> {
    let mut checks = Vec::new();
    let mut curve = Curve::new("Break-away");
    for (rate, expected) in [
        (0.1, 1.4852),
        (1.0, 1.4324),
        (2.0, 1.3944),
        (5.0, 1.3132),
        (10.0, 1.2200),
        (20.0, 1.0986),
        (30.0, 1.0245),
        (50.0, 1.007),
    ] {
        let found = break_away(rate)?;
        let name = format!("break-away at {rate} N/s");
        checks.push(Check::relative(name, "N", found, expected, 5e-3));
        curve.push(rate, found);
    }
    Ok(Experiment {
        letter: 'D',
        title: "Break-away force",
        checks,
        axes: [("Rate of the force", "N/s"), ("Break-away force", "N")],
        curves: vec![curve],
    })
}

/// The first maximum of friction under a force that grows by `rate` N/s.
fn break_away(rate: f64) -> Result<f64, ParamError> {
    let plant = block()?;
    let h = 1e-5;
    let mut motion = Motion::default();
    let mut most = 0.0;
    for k in 0u32.. {
        let load = Load::force(rate * (f64::from(k) + 0.5) * h);
        motion = plant.step(motion, h, load).motion;
        let force = plant.law().force(motion.deflection, motion.velocity);
        if force < most {
            break;
        }
        most = force;
    }
    Ok(most)
}
