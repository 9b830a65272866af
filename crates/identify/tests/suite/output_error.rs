//! Output error on simulated logs with known truth: the axis and the cascade of the servo crate, the
//! plant stepped twenty times as finely as the fit steps it.

use crate::common::Noise;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_identify::{
    Control, Controller, Error, Hold, Law, LawKind, Mass, Observer, Progress, Recording, Samples,
    Silent, Simulation, SimulationFit, Status, Terms, output_error, simulate_unseen,
};
use stiction_servo::cascade::{Cascade, CascadeState};
use stiction_servo::encoder::Encoder;
use stiction_servo::path::Reference;
use stiction_servo::plant::{Load, Motion, Plant};

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
    let h = 1e-3;
    let plant = machine();
    let encoder = Encoder::new(count).unwrap();
    let mut noise = Noise::new(seed);
    let mut state = CascadeState::default();
    let mut motion = Motion::default();
    let mut out = Recording::default();
    let (mut position, mut reference) = (Vec::new(), Vec::new());
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
        out.samples.force.push(force + force_noise * noise.normal());
        for _ in 0..FINE {
            motion = plant
                .step(motion, h / FINE as f64, Load::force(force))
                .motion;
        }
    }
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

#[test]
fn a_closed_loop_without_noise_gives_the_truth() {
    for integral_gain in [0.0, 25_000.0] {
        let cascade = Cascade {
            integral_gain,
            ..CASCADE
        };
        let log = closed(&cascade, 4.0, 0.0, 0.0, 1);
        let simulation = Simulation {
            controller: Some(controller(&cascade)),
            ..Simulation::default()
        };
        let found = fit(&[log], &simulation);
        println!(
            "{:?} {:?} {:?}",
            found.fitted.status,
            found.fitted.counts,
            off(&found)
        );
        assert_eq!(found.fitted.status, Status::Converged);
        for (name, off) in off(&found) {
            assert!(off <= 0.1, "{name} off by {off} %");
        }
    }
}

#[test]
fn an_open_loop_without_noise_gives_the_truth() {
    let log = open(4.0, 0.0, 0.0, 0.0, 1);
    let whole = fit(std::slice::from_ref(&log), &Simulation::default());
    println!("{:?} {:?}", whole.fitted.counts, off(&whole));
    assert_eq!(whole.fitted.status, Status::Converged);
    for (name, off) in off(&whole) {
        assert!(off <= 0.1, "{name} off by {off} %");
    }
    let short = Simulation {
        segment: Some(0.5),
        ..Simulation::default()
    };
    let short = fit(&[log], &short);
    println!("{:?} {:?}", short.fitted.counts, off(&short));
    assert_eq!(short.runs, 8);
    for (name, off) in off(&short) {
        assert!(off <= 0.1, "{name} off by {off} %");
    }
}

#[test]
fn noise_leaves_the_truth_inside_the_intervals() {
    let log = closed(&CASCADE, 6.0, 50e-9, 0.5, 7);
    let simulation = Simulation {
        controller: Some(controller(&CASCADE)),
        quantum: Some(50e-9),
        ..Simulation::default()
    };
    let (inside, worst) = covered(&fit(&[log], &simulation));
    assert!(
        inside >= 7 && worst < 3.5,
        "closed loop: {inside} of 8, worst {worst} deviations"
    );

    let log = open(6.0, 0.3, 1e-6, 2e-6, 5);
    let simulation = Simulation {
        quantum: Some(1e-6),
        ..Simulation::default()
    };
    let (inside, worst) = covered(&fit(&[log], &simulation));
    assert!(
        inside >= 7 && worst < 3.5,
        "open loop: {inside} of 8, worst {worst} deviations"
    );
}

#[test]
fn an_unseen_run_is_predicted_to_a_count() {
    let simulation = Simulation {
        quantum: Some(1e-6),
        ..Simulation::default()
    };
    let found = fit(&[open(4.0, 0.0, 1e-6, 0.0, 1)], &simulation);
    let unseen = simulate_unseen(&[open(3.0, 1.1, 1e-6, 0.0, 2)], &found).unwrap();
    // A bristle that lets go a little early moves the whole slip that follows; still below one count.
    assert!(unseen.position.rmse < 1e-6, "{:?}", unseen.position);
    assert!(
        found.position.rmse < 1.02 * found.floor.unwrap(),
        "{:?}",
        found.position
    );
    assert!(unseen.force.is_none());
}

#[test]
fn two_fits_give_the_same_bits() {
    let log = [open(1.0, 0.0, 1e-6, 0.0, 1)];
    let [a, b] = [0, 1].map(|_| fit(&log, &Simulation::default()).fitted.parameters);
    assert_eq!(a, b);
}

#[test]
fn simpler_laws_are_simulated_too() {
    let log = [open(2.0, 0.0, 1e-6, 0.0, 1)];
    for kind in [LawKind::CoulombViscous, LawKind::Stribeck, LawKind::Dahl] {
        let found = output_error(
            &log,
            Law::new(kind),
            &Terms::default(),
            &Simulation::default(),
            &mut Silent,
        )
        .unwrap();
        let mass = found.fitted.value("mass").unwrap();
        println!("{kind}: {mass} {:?}", found.position);
        assert!((mass / MASS - 1.0).abs() < 0.2, "{kind}: {mass}");
        assert!(found.position.r2 > 0.9, "{kind}: {:?}", found.position);
    }
}

#[test]
fn what_cannot_be_simulated_is_refused() {
    let law = Law::new(LawKind::LuGre);
    let try_with = |log: Recording, terms: &Terms, simulation: &Simulation| {
        output_error(&[log], law, terms, simulation, &mut Silent).unwrap_err()
    };
    let good = open(1.0, 0.0, 0.0, 0.0, 1);
    let with = Simulation {
        controller: Some(controller(&CASCADE)),
        ..Simulation::default()
    };
    let e = try_with(good.clone(), &Terms::default(), &with);
    assert!(e.to_string().contains("no reference"), "{e}");
    let absent = Terms {
        mass: Mass::Absent,
        ..Terms::default()
    };
    let e = try_with(good.clone(), &absent, &Simulation::default());
    assert!(matches!(e, Error::NotSimulated { .. }), "{e}");
    let mut blind = good.clone();
    blind.samples.velocity = blind.samples.position.take();
    let e = try_with(blind, &Terms::default(), &Simulation::default());
    assert!(e.to_string().contains("no position"), "{e}");
    let mut still = good.clone();
    still.samples.position = Some(vec![0.25; still.samples.time.len()]);
    let e = try_with(still, &Terms::default(), &Simulation::default());
    assert!(matches!(e, Error::NoMotion { .. }), "{e}");
    let mut loose = good.clone();
    loose.samples.force.fill(0.0);
    let e = try_with(loose, &Terms::default(), &Simulation::default());
    assert!(matches!(e, Error::NoForce { .. }), "{e}");
    let mut short = good;
    short.reference = Some(vec![0.0; 3]);
    let e = try_with(short.clone(), &Terms::default(), &with);
    assert!(
        matches!(
            e,
            Error::Length {
                channel: "reference",
                ..
            }
        ),
        "{e}"
    );
    short.reference = Some(vec![0.0; short.samples.time.len()]);
    for (name, bad) in [
        (
            "rate",
            Controller {
                rate: Some(1234.5),
                ..controller(&CASCADE)
            },
        ),
        (
            "gain",
            Controller {
                speed_gain: f64::NAN,
                ..controller(&CASCADE)
            },
        ),
        (
            "limit",
            Controller {
                force_limit: 0.0,
                ..controller(&CASCADE)
            },
        ),
    ] {
        let simulation = Simulation {
            controller: Some(bad),
            hold: Hold::Held,
            ..Simulation::default()
        };
        let e = try_with(short.clone(), &Terms::default(), &simulation);
        assert!(matches!(e, Error::Setting { .. }), "{name}: {e}");
    }
}

/// Numbers at the ends of their range, few samples, absurd rates: an error or a result, never a panic.
#[test]
fn hostile_numbers_are_survived() {
    let law = Law::new(LawKind::LuGre).asymmetric();
    let base = open(0.4, 0.0, 0.0, 0.0, 1);
    let scales = [1e-300, 1e-150, 1e-9, 1.0, 1e9, 1e150, 1e300];
    let mut refused = 0;
    for x in scales {
        for u in scales {
            for t in [1e-12, 1.0, 1e12] {
                let mut log = base.clone();
                let scaled = |v: &mut Vec<f64>, k: f64| v.iter_mut().for_each(|v| *v *= k);
                scaled(log.samples.position.as_mut().unwrap(), x);
                scaled(&mut log.samples.force, u);
                scaled(&mut log.samples.time, t);
                log.samples.position.as_mut().unwrap().truncate(150);
                log.samples.force.truncate(150);
                log.samples.time.truncate(150);
                log.reference = log.samples.position.clone();
                let simulation = Simulation {
                    controller: (x > u).then(|| controller(&CASCADE)),
                    ..Simulation::default()
                };
                let found =
                    output_error(&[log], law, &Terms::default(), &simulation, &mut Short(40));
                match found {
                    Ok(found) => assert!(!found.fitted.parameters.is_empty()),
                    Err(_) => refused += 1,
                }
            }
        }
    }
    println!("{refused} refused");
    for n in 0..30 {
        let mut log = base.clone();
        log.samples.position.as_mut().unwrap().truncate(n);
        log.samples.force.truncate(n);
        log.samples.time.truncate(n);
        let e = output_error(
            &[log],
            law,
            &Terms::default(),
            &Simulation::default(),
            &mut Silent,
        );
        assert!(matches!(e, Err(Error::TooFewSamples { .. })), "{n}");
    }
    let none = output_error(
        &[],
        law,
        &Terms::default(),
        &Simulation::default(),
        &mut Silent,
    );
    assert!(matches!(none, Err(Error::TooFewSamples { .. })));
}

/// Stops after so many looks.
struct Short(usize);

impl Observer for Short {
    fn progress(&mut self, _: &Progress) -> Control {
        self.0 = self.0.saturating_sub(1);
        if self.0 == 0 {
            Control::Stop
        } else {
            Control::Continue
        }
    }
}

#[test]
fn a_search_that_is_stopped_keeps_what_it_has() {
    let log = open(1.0, 0.0, 0.0, 0.0, 1);
    let found = output_error(
        &[log],
        Law::new(LawKind::LuGre),
        &Terms::default(),
        &Simulation::default(),
        &mut Short(1),
    )
    .unwrap();
    assert_eq!(found.fitted.status, Status::Interrupted);
    assert!(found.fitted.counts.total() < 20);
}

/// From nothing but the logs: every search ends at the noise, and the intervals hold the truth.
#[test]
fn every_noisy_log_is_found_and_covered() {
    const NOISE: f64 = 5e-6;
    let mut inside = 0;
    for seed in 100..108 {
        let found = fit(&[open(2.0, 0.3, 1e-7, NOISE, seed)], &Simulation::default());
        assert!(
            found.position.rmse < 1.1 * NOISE,
            "{seed}: {:?}",
            found.position
        );
        inside += covered(&found).0;
    }
    assert!(inside >= 58, "{inside} of 64 inside");
}
