//! F: under PID control the block hunts about its target; with a friction observer it does not.

use super::experiment::{Check, Curve, Experiment, TOLERANCE, axis, largest};
use crate::axis::{Axis, AxisSettings, Correction};
use crate::controller::Controller;
use crate::drive::Drive;
use crate::encoder::Encoder;
use crate::feedforward::Feedforward;
use crate::integrator::Mid;
use crate::path::Reference;
use crate::pid::Pid;
use stiction_friction::ParamError;
use stiction_friction::compensator::{Compensator, Friction, Settings, Source};

/// Positions stored per second.
const RATE: usize = 10_000;

/// Control periods between two of them. The experiment is in continuous time: here the observer is a hundredth of a
/// millisecond late; at a tenth of this rate its error after 30 s would be off by .5 %.
const FINE: usize = 10;

pub(super) fn run(go_on: &dyn Fn() -> bool) -> Result<Option<Experiment>, ParamError> {
    let mut checks = Vec::new();
    let mut near = |name: &str, unit, found, expected| {
        checks.push(Check::relative(name, unit, found, expected, TOLERANCE))
    };

    let Some(x) = positioning(None, 1, 200, go_on)? else {
        return Ok(None);
    };
    let hunting = thinned("PID alone", &x[..100 * RATE]);
    near("first overshoot", "m", top(&x[..10 * RATE]), 1.5005);
    // The limit cycle: amplitude over the last hundred seconds, period between rising crossings of the target.
    let tail = &x[100 * RATE..];
    let amplitude = largest(tail.iter().map(|x| (x - 1.0).abs()));
    near("amplitude of the limit cycle", "m", amplitude, 0.0639);
    let rising: Vec<usize> = (1..tail.len())
        .filter(|k| tail[k - 1] < 1.0 && tail[*k] >= 1.0)
        .collect();
    let [first, .., last] = rising[..] else {
        return Err(ParamError::new(
            "cycles",
            rising.len() as f64,
            "two or more",
        ));
    };
    let period = (last - first) as f64 / RATE as f64 / (rising.len() - 1) as f64;
    near("period of the limit cycle", "s", period, 24.44);

    let Some(x) = positioning(Some(10.0), FINE, 31, go_on)? else {
        return Ok(None);
    };
    let observed = thinned("With the observer, k = 10 1/s", &x);
    near("overshoot with the observer", "m", top(&x), 1.0725);
    let error = x[10 * RATE] - 1.0;
    let name = "error with the observer at 10 s";
    checks.push(Check::absolute(name, "m", error, 0.0, 1e-12));

    let Some(x) = positioning(Some(0.0), FINE, 31, go_on)? else {
        return Ok(None);
    };
    let open = thinned("The law alone, k = 0", &x);
    for (second, expected) in [(10, 0.0794917), (20, 0.0109630), (30, 0.00232038)] {
        let error = (x[second * RATE] - 1.0).abs();
        let name = format!("error with k = 0 at {second} s");
        checks.push(Check::relative(name, "m", error, expected, TOLERANCE));
    }
    Ok(Some(Experiment {
        letter: 'F',
        title: "Hunting",
        checks,
        axes: [("Time", "s"), ("Position", "m")],
        curves: vec![hunting, observed, open],
    }))
}

/// Positions under Kv 6, Kp 3, Ki 4 and a step of 1 m, with an observer of that gain and the given number of control
/// periods between two of them; asks once per simulated second whether to go on.
fn positioning(
    observer: Option<f64>,
    periods: usize,
    seconds: usize,
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Vec<f64>>, ParamError> {
    let axis = axis()?;
    let rate = (periods * RATE) as f64;
    let compensator = match observer {
        None => None,
        Some(gain) => Some(Compensator::new(
            Friction::LuGre(axis.law),
            Source::Observer(gain),
            Settings::bare(1.0 / rate, 1e4),
        )?),
    };
    let settings = AxisSettings {
        plant: super::experiment::block()?,
        drive: Drive::ideal(),
        encoder: Encoder::new(0.0)?,
        controller: Controller::Pid(Pid {
            proportional: 3.0,
            integral: 4.0,
            derivative: 6.0,
            filter: 0.0,
            mass_feedforward: 0.0,
            force_limit: 1e4,
        }),
        feedforward: Feedforward {
            compensator,
            ..Feedforward::default()
        },
        ..axis.simulated(rate, 1.0)?
    };
    let mut axis = Axis::new(settings, Mid::new(1)?)?;
    let target = Reference {
        position: 1.0,
        ..Reference::default()
    };
    let mut positions = Vec::with_capacity(seconds * RATE + 1);
    for k in 0..=seconds * RATE * periods {
        if k % (RATE * periods) == 0 && !go_on() {
            return Ok(None);
        }
        let sample = axis.step(target, 0.0, Correction::default());
        if k % periods == 0 {
            positions.push(sample.position);
        }
    }
    Ok(Some(positions))
}

fn top(x: &[f64]) -> f64 {
    largest(x.iter().copied())
}

fn thinned(label: &str, x: &[f64]) -> Curve {
    let mut curve = Curve::new(label);
    for k in (0..x.len()).step_by(RATE / 20) {
        curve.push(k as f64 / RATE as f64, x[k]);
    }
    curve
}
