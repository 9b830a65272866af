//! Cost of simulating an axis: 20 000 samples of a closed loop, eight shared unknowns.
//!
//! Items are sample-steps: samples times evaluations of the fit, with and without derivatives.

use divan::Bencher;
use divan::counter::ItemsCount;
use stiction_identify::{
    Controller, Law, LawKind, Recording, Samples, Silent, Simulation, SimulationFit, Terms,
    output_error, simulate_unseen,
};
use stiction_servo::cascade::{Cascade, CascadeState};
use stiction_servo::known;
use stiction_servo::path::Reference;
use stiction_servo::plant::{Load, Motion, Plant};

fn main() {
    divan::main();
}

const SAMPLES: usize = 20_000;
const CASCADE: Cascade = Cascade {
    position_gain: 60.0,
    speed_gain: 2500.0,
    integral_gain: 0.0,
    mass_feedforward: 0.0,
    force_limit: 500.0,
};

/// The machine axis, its position in steps of 50 nm.
fn log() -> Recording {
    let h = 1e-3;
    let axis = known::find("machine").expect("it is in the library");
    let plant = Plant::new(axis.mass, axis.law).expect("valid");
    let (mut state, mut motion) = (CascadeState::default(), Motion::default());
    let mut samples = Samples::default();
    let (mut position, mut reference) = (Vec::new(), Vec::new());
    for k in 0..SAMPLES {
        let t = k as f64 * h;
        let path = 0.01 * (2.0 * t).sin() + 4e-4 * (17.0 * t).sin() + 0.004 * (9.0 * t).sin();
        let wanted = Reference {
            position: path,
            velocity: 0.0,
            acceleration: 0.0,
        };
        let x = 50e-9 * (motion.position / 50e-9).round();
        let force = CASCADE.force(&mut state, h, wanted, x);
        samples.time.push(t);
        samples.force.push(force);
        position.push(x);
        reference.push(path);
        for _ in 0..5 {
            motion = plant.step(motion, h / 5.0, Load::force(force)).motion;
        }
    }
    samples.position = Some(position);
    Recording {
        samples,
        reference: Some(reference),
    }
}

fn fit(log: &[Recording]) -> SimulationFit {
    let simulation = Simulation {
        controller: Some(Controller {
            position_gain: CASCADE.position_gain,
            speed_gain: CASCADE.speed_gain,
            integral_gain: 0.0,
            velocity_feedforward: 0.0,
            mass_feedforward: 0.0,
            force_limit: CASCADE.force_limit,
            rate: None,
        }),
        quantum: Some(50e-9),
        ..Simulation::default()
    };
    let law = Law::new(LawKind::LuGre);
    output_error(log, law, &Terms::default(), &simulation, &mut Silent).expect("a fit")
}

#[divan::bench(sample_count = 3)]
fn whole_fit_from_nothing(bencher: Bencher) {
    let log = [log()];
    let evaluations = fit(&log).fitted.counts.total();
    bencher
        .counter(ItemsCount::new(SAMPLES * evaluations))
        .bench(|| fit(&log));
}

/// Simulation, with derivatives of the start only.
#[divan::bench(sample_count = 5)]
fn unseen(bencher: Bencher) {
    let log = [log()];
    let found = fit(&log);
    let counts = simulate_unseen(&log, &found, &mut Silent)
        .expect("a simulation")
        .counts;
    bencher
        .counter(ItemsCount::new(SAMPLES * found.substeps * counts.total()))
        .bench(|| simulate_unseen(&log, &found, &mut Silent).expect("a simulation"));
}

/// The plant of the servo crate alone, to compare a step with.
#[divan::bench(sample_count = 5)]
fn servo_plant(bencher: Bencher) {
    let axis = known::find("machine").expect("it is in the library");
    let plant = Plant::new(axis.mass, axis.law).expect("valid");
    bencher.counter(ItemsCount::new(SAMPLES)).bench(|| {
        let mut motion = Motion::default();
        for k in 0..SAMPLES {
            let t = k as f64 * 1e-3;
            let force = 40.0 * (4.0 * t).sin() + 10.0 * (23.0 * t).sin();
            motion = plant.step(motion, 1e-3, Load::force(force)).motion;
        }
        motion
    });
}
