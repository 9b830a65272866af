//! Output error on simulated logs with known truth: the axis and the cascade of the servo crate, the
//! plant stepped twenty times as finely as the fit steps it.

mod delay;
mod elements;
mod known;
mod refused;
mod stopped;
mod unseen;

use crate::common::Noise;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{
    Control, Controller, Delay, Error, Hold, Law, LawKind, Mass, Observer, Progress, Recording,
    Samples, Silent, Simulation, SimulationFit, Status, Terms, output_error, simulate_unseen,
};
use stiction_servo::cascade::{Cascade, CascadeState};
use stiction_servo::encoder::Encoder;
use stiction_servo::path::Reference;
use stiction_servo::plant::{Load, Motion, Plant};
use stiction_testkit::gate;

const FINE: usize = 20;
const MASS: f64 = 10.0;

/// The machine slide of the library, with an offset.
fn machine() -> Plant {
    let both = Direction {
        coulomb: 20.0,
        static_friction: 30.0,
        stribeck_velocity: 5e-3,
        viscous: 60.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 2.0).unwrap();
    Plant::new(
        MASS,
        LuGre::new(1.2e5, Damping::Constant(600.0), curve).unwrap(),
    )
    .unwrap()
}

const TRUTH: [(&str, f64); 8] = [
    ("sigma0", 1.2e5),
    ("sigma1", 600.0),
    ("sigma2", 60.0),
    ("coulomb", 20.0),
    ("static", 30.0),
    ("stribeck_velocity", 5e-3),
    ("mass", MASS),
    ("offset", 2.0),
];

/// Slow reversals, presliding, and faster strokes.
fn path(t: f64) -> f64 {
    0.01 * (2.0 * t).sin() + 4e-4 * (17.0 * t).sin() + 0.004 * (9.0 * t).sin()
}

const CASCADE: Cascade = Cascade {
    position_gain: 60.0,
    speed_gain: 2500.0,
    integral_gain: 0.0,
    mass_feedforward: 0.0,
    force_limit: 500.0,
};

fn controller(cascade: &Cascade) -> Controller {
    Controller {
        position_gain: cascade.position_gain,
        speed_gain: cascade.speed_gain,
        integral_gain: cascade.integral_gain,
        velocity_feedforward: 0.0,
        mass_feedforward: 0.0,
        force_limit: cascade.force_limit,
        rate: None,
    }
}

/// A closed loop as the drive logs it; the controller sees the encoder, the log's force has noise.
fn closed(cascade: &Cascade, seconds: f64, count: f64, force_noise: f64, seed: u64) -> Recording {
    beside(cascade, seconds, count, force_noise, seed, |_| 0.0)
}

/// The same beside a known force.
fn beside(
    cascade: &Cascade,
    seconds: f64,
    count: f64,
    force_noise: f64,
    seed: u64,
    external: impl Fn(f64) -> f64,
) -> Recording {
    let h = 1e-3;
    let plant = machine();
    let encoder = Encoder::new(count).unwrap();
    let mut noise = Noise::new(seed);
    let mut state = CascadeState::default();
    let mut motion = Motion::default();
    let mut out = Recording::default();
    let (mut position, mut reference, mut beside) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..(seconds / h) as usize {
        let t = k as f64 * h;
        let wanted = Reference {
            position: path(t),
            velocity: 0.0,
            acceleration: 0.0,
        };
        let x = encoder.read(motion.position);
        let force = cascade.force(&mut state, h, wanted, x);
        out.samples.time.push(t);
        position.push(x);
        reference.push(path(t));
        let outside = external(t);
        let logged = force + force_noise * noise.normal();
        out.samples.force.push(logged + outside);
        beside.push(outside);
        for _ in 0..FINE {
            motion = plant
                .step(motion, h / FINE as f64, Load::force(force + outside))
                .motion;
        }
    }
    out.samples.external = Some(beside).filter(|x| x.iter().any(|u| *u != 0.0));
    out.samples.position = Some(position);
    out.reference = Some(reference);
    out
}

/// A force commanded open loop, held from sample to sample.
fn open(seconds: f64, phase: f64, count: f64, noise: f64, seed: u64) -> Recording {
    let h = 1e-3;
    let plant = machine();
    let encoder = Encoder::new(count).unwrap();
    let mut random = Noise::new(seed);
    let mut motion = Motion::default();
    let mut samples = Samples::default();
    let mut position = Vec::new();
    for k in 0..(seconds / h) as usize {
        let t = k as f64 * h;
        let force = 2.0
            + 38.0 * (4.0 * t + phase).sin()
            + 10.0 * (23.0 * t).sin()
            + 6.0 * (60.0 * t + phase).sin();
        samples.time.push(t);
        position.push(encoder.read(motion.position + noise * random.normal()));
        samples.force.push(force);
        for _ in 0..FINE {
            motion = plant
                .step(motion, h / FINE as f64, Load::force(force))
                .motion;
        }
    }
    samples.position = Some(position);
    Recording {
        samples,
        reference: None,
    }
}

fn fit(recordings: &[Recording], simulation: &Simulation) -> SimulationFit {
    let law = Law::new(LawKind::LuGre);
    output_error(recordings, law, &Terms::default(), simulation, &mut Silent).unwrap()
}

fn off(found: &SimulationFit) -> Vec<(&'static str, f64)> {
    TRUTH
        .iter()
        .map(|(name, truth)| {
            let value = found.fitted.value(name).unwrap();
            (*name, 100.0 * (value / truth - 1.0).abs())
        })
        .collect()
}

fn covered(found: &SimulationFit) -> (usize, f64) {
    let mut inside = 0;
    let mut worst = 0.0_f64;
    for (name, truth) in TRUTH {
        let p = found.fitted.parameter(name).unwrap();
        let (low, high) = p.ci95.unwrap();
        inside += usize::from(low <= truth && truth <= high);
        worst = worst.max((p.value - truth).abs() / p.std.unwrap());
        println!("{name} {} {:?} truth {truth}", p.value, p.ci95);
    }
    (inside, worst)
}

/// A force that swings below break-away: the position shows the bristles and nothing of the levels, whatever a fit makes of
/// their creep. The slow swings show no inertia either.
#[test]
fn an_axis_that_never_breaks_away_leaves_its_levels_open() {
    let h = 1e-3;
    let plant = machine();
    let encoder = Encoder::new(1e-7).unwrap();
    let mut motion = Motion::default();
    let mut samples = Samples::default();
    let mut position = Vec::new();
    for k in 0..8000 {
        let t = k as f64 * h;
        let force = 2.0 + (14.0 + t) * (3.0 * t).sin();
        samples.time.push(t);
        samples.force.push(force);
        position.push(encoder.read(motion.position));
        for _ in 0..FINE {
            let load = Load::force(force);
            motion = plant.step(motion, h / FINE as f64, load).motion;
        }
    }
    samples.position = Some(position);
    let log = Recording {
        samples,
        reference: None,
    };
    let found = fit(&[log], &Simulation::default());
    assert!(found.never_breaks_away);
    for p in &found.fitted.parameters {
        println!("{} {} {}", p.name, p.value, p.reason);
    }
    for name in ["coulomb", "static", "stribeck_velocity", "sigma2", "mass"] {
        let p = found.fitted.parameter(name).unwrap();
        assert!(!p.identifiable, "{name}: {}", p.value);
    }
}
