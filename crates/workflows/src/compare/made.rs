//! Synthetic subjects: axes and curves whose parameters are known.

use super::excitation::{DURATION, Excitation};
use super::genome::{Floor, about, genome};
use super::known::{self, KnownCurve};
use super::options::{CompareOptions, Cost, USUAL_NOISE, USUAL_RATE};
use super::subject::{Data, Subject, lugre};
use crate::error::Error;
use crate::wording::{Setting, TOGETHER_WITH};
use stiction_friction::{LuGre, ParamError};
use stiction_identify as engine;
use stiction_identify::candidates::{Scheme, thinned};
use stiction_identify::{Conditioning, Cutoff, Mass, Record, Samples, Terms};
use stiction_servo::known::KnownAxis;
use stiction_servo::noise::Noise;
use stiction_servo::plant::{Load, Motion, Plant};

/// Steps of the true law in one sample of a synthetic record: with one step a sample the record would contain the
/// integration error of the law.
const STEPS_PER_SAMPLE: usize = 20;
/// Seed of the noise of a made record: the searches have seeds of their own.
const NOISE_SEED: u64 = 1;

pub(super) fn from_curve(options: &CompareOptions, curve: &KnownCurve) -> Result<Subject, Error> {
    let other = [
        (Setting::Cost, options.cost.is_some()),
        (Setting::Excitation, options.excitation.is_some()),
        (Setting::Integrator, options.integrator != Scheme::Explin),
        (Setting::Rate, options.rate.is_some()),
        (Setting::OtherLaw, options.other_law),
    ];
    if let Some((setting, _)) = other.into_iter().find(|(_, given)| *given) {
        return Err(Error::usage(
            [
                setting.into(),
                TOGETHER_WITH.into(),
                Setting::Problem.is(curve.name),
            ],
            "a steady curve has no motion, no memory and one cost",
        ));
    }
    let truth = curve.truth();
    let mut force = curve
        .forces()
        .map_err(|e| Error::usage(e.to_string(), "a law"))?;
    add_noise(&mut force, noise_of(options)?);
    Ok(Subject {
        name: curve.name.into(),
        source: curve.source.into(),
        motion: "forces at the speeds -1 to 1 rad/s in steps of 0.05 (not at 0)".into(),
        samples: force.len() - 1,
        rate_hz: 0.0,
        bounds: about(
            &genome(&truth, Cost::Curve, Floor::NONE),
            options.decades.unwrap_or(1.0),
        )?,
        truth,
        cost: Cost::Curve,
        law: lugre(),
        scheme: Scheme::Explin,
        data: Data::Curve {
            speed: known::speeds(),
            force,
        },
    })
}

/// Slowest and fastest speed of the static step, in Stribeck velocities, and how many between them, spaced evenly in their
/// logarithm, each in both directions: those of `stiction reproduce paper`, about.
const SPEEDS: (f64, f64, usize) = (0.067, 33.0, 16);

/// The steady curve of an axis.
fn curve_of(axis: &KnownAxis, noise: f64) -> Data {
    let (low, high, count) = SPEEDS;
    let curve = axis.law.curve();
    let step = libm::log(high / low) / (count - 1) as f64;
    let speeds = (0..count).map(|i| low * libm::exp(step * i as f64));
    let speeds = speeds.map(|part| part * curve.positive().stribeck_velocity);
    let speed: Vec<f64> = speeds.flat_map(|v| [-v, v]).collect();
    let mut force: Vec<f64> = speed.iter().map(|v| curve.force(*v)).collect();
    add_noise(&mut force, noise);
    Data::Curve { speed, force }
}

fn noise_of(options: &CompareOptions) -> Result<f64, Error> {
    let noise = options.noise.unwrap_or(USUAL_NOISE);
    if (0.0..=1.0).contains(&noise) {
        return Ok(noise);
    }
    Err(Error::usage(
        Setting::Noise.is(noise),
        "deviation over the largest force, 0 to 1",
    ))
}

/// White noise of a share of the largest value.
fn add_noise(values: &mut [f64], share: f64) {
    let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut noise = Noise::new(NOISE_SEED);
    for x in values {
        *x += share * largest * noise.normal();
    }
}

pub(super) fn from_axis(options: &CompareOptions, axis: &KnownAxis) -> Result<Subject, Error> {
    let rate = options.rate.unwrap_or(USUAL_RATE);
    if !(100.0..=100_000.0).contains(&rate) {
        return Err(Error::usage(Setting::Rate.is(rate), "100 to 100000 Hz"));
    }
    let noise = noise_of(options)?;
    let cost = options.cost.unwrap_or(Cost::Six);
    let excitation = options.excitation.unwrap_or_default();
    let step = 1.0 / rate;
    let samples = (DURATION * rate).round() as usize + 1;
    let law = match options.other_law {
        true => known::mismatched(&axis.law),
        false => Ok(axis.law),
    };
    let law = law.map_err(|e| Error::usage(e.to_string(), "a law"))?;
    let side = axis.law.curve().positive();
    let truth = [
        ("sigma0", axis.law.stiffness()),
        ("sigma1", axis.law.damping().at_rest()),
        ("sigma2", side.viscous),
        ("coulomb", side.coulomb),
        ("static", side.static_friction),
        ("stribeck_velocity", side.stribeck_velocity),
    ];
    let searched = |name: &str| match cost {
        Cost::Curve => !["sigma0", "sigma1"].contains(&name),
        Cost::Dynamic => ["sigma0", "sigma1"].contains(&name),
        _ => true,
    };
    let truth = truth.into_iter().filter(|(name, _)| searched(name));
    let truth: Vec<(String, f64)> = truth.map(|(n, v)| (n.to_string(), v)).collect();
    let floor = Floor::new(side.coulomb, 10.0 * side.stribeck_velocity);
    let bounds = about(&genome(&truth, cost, floor), options.decades.unwrap_or(1.0))?;
    let made = |e: ParamError| Error::usage(e.to_string(), "a law");
    let given = options.excitation.is_some() || options.integrator != Scheme::Explin;
    if given && [Cost::Position, Cost::Curve].contains(&cost) {
        return Err(Error::usage(
            [
                Setting::Excitation.into(),
                " or ".into(),
                Setting::Integrator.into(),
                TOGETHER_WITH.into(),
                Setting::Cost.is(cost.name()),
            ],
            match cost {
                Cost::Position => "the motion is what the force makes of it",
                _ => "a steady curve has no motion and no memory",
            },
        ));
    }
    let (data, motion) = if cost == Cost::Curve {
        let (low, high, count) = SPEEDS;
        let motion = format!("forces at {count} speeds from {low} to {high} vs, both ways");
        (curve_of(axis, noise), motion)
    } else if cost == Cost::Position {
        let size = 1.5 * side.static_friction;
        let force: Vec<f64> = (0..samples)
            .map(|i| size * libm::sin(std::f64::consts::TAU * (i as f64 + 0.5) * step))
            .collect();
        let mut position = moved(axis.mass, law, step, &force).map_err(made)?;
        add_noise(&mut position, noise);
        let data = Data::Drive {
            mass: axis.mass,
            step,
            force,
            position,
        };
        (
            data,
            "force sine of 1.5 Fs and 1 Hz from rest, position out".into(),
        )
    } else {
        let (velocity, mut force) = match excitation {
            Excitation::BreakAway => broken_away(axis, law, step, samples).map_err(made)?,
            _ => along(&law, step, samples, |t| {
                side.stribeck_velocity * excitation.velocity(t).unwrap_or(0.0)
            }),
        };
        add_noise(&mut force, noise);
        let record =
            record(step, velocity, force).map_err(|source| Error::identify(axis.name, source))?;
        let data = Data::Record {
            thinned: thinned(&record).map(Box::new),
            record: Box::new(record),
            terms: Box::new(Terms {
                mass: Mass::Absent,
                offset: false,
                ..Terms::default()
            }),
            held: (cost == Cost::Dynamic).then_some(*side),
        };
        (data, excitation.description().to_string())
    };
    let other = if options.other_law {
        "; the data follow another law: Stribeck exponent 1, in the negative direction Fc and sigma2 of 80 %, Fs of 90 %"
    } else {
        ""
    };
    let (samples, rate) = match &data {
        Data::Curve { force, .. } => (force.len(), 0.0),
        _ => (samples, rate),
    };
    Ok(Subject {
        name: axis.name.into(),
        source: axis.source.into(),
        motion: format!("{motion}{other}"),
        samples,
        rate_hz: rate,
        truth,
        cost,
        law: lugre(),
        scheme: options.integrator,
        bounds,
        data,
    })
}

/// Velocity and friction force at each sample, the law on a finer grid.
fn along(
    law: &LuGre<f64>,
    step: f64,
    samples: usize,
    velocity: impl Fn(f64) -> f64,
) -> (Vec<f64>, Vec<f64>) {
    let h = step / STEPS_PER_SAMPLE as f64;
    let mut z = 0.0;
    (0..samples)
        .map(|i| {
            for k in 0..if i > 0 { STEPS_PER_SAMPLE } else { 0 } {
                let t = (i - 1) as f64 * step + k as f64 * h;
                z = law.step_record(z, h, velocity(t), velocity(t + h));
            }
            let v = velocity(i as f64 * step);
            (v, law.force(z, v))
        })
        .unzip()
}

/// The same where force ramps move the mass.
fn broken_away(
    axis: &KnownAxis,
    law: LuGre<f64>,
    step: f64,
    samples: usize,
) -> Result<(Vec<f64>, Vec<f64>), ParamError> {
    let plant = Plant::new(axis.mass, law)?;
    let largest = axis.law.curve().positive().static_friction;
    let h = step / STEPS_PER_SAMPLE as f64;
    let mut at = Motion::default();
    let mut out = (Vec::with_capacity(samples), Vec::with_capacity(samples));
    for i in 0..samples {
        for k in 0..if i > 0 { STEPS_PER_SAMPLE } else { 0 } {
            let t = (i - 1) as f64 * step + (k as f64 + 0.5) * h;
            let load = Load::force(largest * Excitation::force(t));
            at = plant.step(at, h, load).motion;
        }
        out.0.push(at.velocity);
        out.1.push(law.force(at.deflection, at.velocity));
    }
    Ok(out)
}

/// Position at the end of each step under a force held in it.
fn moved(mass: f64, law: LuGre<f64>, step: f64, force: &[f64]) -> Result<Vec<f64>, ParamError> {
    let plant = Plant::new(mass, law)?;
    let h = step / STEPS_PER_SAMPLE as f64;
    let mut at = Motion::default();
    let mut out = Vec::with_capacity(force.len());
    for &u in force {
        for _ in 0..STEPS_PER_SAMPLE {
            at = plant.step(at, h, Load::force(u)).motion;
        }
        out.push(at.position);
    }
    Ok(out)
}

fn record(step: f64, velocity: Vec<f64>, force: Vec<f64>) -> Result<Record, engine::Error> {
    let samples = Samples {
        time: (0..velocity.len()).map(|i| i as f64 * step).collect(),
        velocity: Some(velocity),
        force,
        ..Samples::default()
    };
    let raw = Conditioning {
        source_cutoff: Cutoff::Off,
        common_cutoff: Cutoff::Off,
        ..Conditioning::default()
    };
    engine::condition(&[samples], &raw)
}
