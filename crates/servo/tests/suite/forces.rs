//! The axis under spring, damper, disturbance and voltage, against closed forms: friction is a millionth of the other forces.

use std::f64::consts::TAU;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};
use stiction_servo::axis::{Axis, AxisSettings, Correction};
use stiction_servo::cascade::Cascade;
use stiction_servo::controller::Controller;
use stiction_servo::disturbance::Disturbance;
use stiction_servo::drive::Drive;
use stiction_servo::encoder::Encoder;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::integrator::{Integrator, Mid, Quick};
use stiction_servo::path::Reference;
use stiction_servo::plant::Plant;

const RATE: f64 = 4000.0;
const MASS: f64 = 4.6;

/// Without control, encoder steps and delay, and next to without friction.
fn free() -> AxisSettings {
    let both = Direction {
        coulomb: 1e-6,
        static_friction: 1e-6,
        stribeck_velocity: 1e-3,
        viscous: 0.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).unwrap();
    let law = LuGre::new(1.0, Damping::Constant(0.0), curve).unwrap();
    AxisSettings {
        plant: Plant::new(MASS, law).unwrap(),
        drive: Drive::ideal(),
        encoder: Encoder::new(0.0).unwrap(),
        position_noise: 0.0,
        cogging: None,
        disturbance: None,
        controller: Controller::Cascade(Cascade {
            position_gain: 0.0,
            speed_gain: 0.0,
            integral_gain: 0.0,
            mass_feedforward: 0.0,
            force_limit: 1e6,
        }),
        feedforward: Feedforward::default(),
        rate: RATE,
        substeps: 3,
        seed: 0,
    }
}

/// Time, position and velocity under a constant commanded force, N, for `duration` s.
fn pushed<I: Integrator<LuGre<f64>>>(
    settings: &AxisSettings,
    integrator: I,
    force: f64,
    duration: f64,
) -> Vec<[f64; 3]> {
    let mut axis = Axis::new(settings.clone(), integrator).unwrap();
    let push = Correction {
        force,
        ..Correction::default()
    };
    (0..(duration * RATE) as usize)
        .map(|_| axis.step(Reference::default(), 0.0, push))
        .map(|s| [s.time, s.position, s.velocity])
        .collect()
}

/// The largest distance from `expected`, as a part of its largest value.
fn off(all: &[[f64; 3]], column: usize, expected: impl Fn(f64) -> f64) -> f64 {
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for row in all {
        worst = worst.max((row[column] - expected(row[0])).abs());
        largest = largest.max(expected(row[0]).abs());
    }
    worst / largest
}

fn quick() -> Quick {
    Quick::new(1).unwrap()
}

#[test]
fn a_mass_on_a_spring_swings_and_keeps_its_energy() {
    let (spring, force) = (20_000.0, 30.0);
    let mut settings = free();
    settings.plant = settings.plant.with_stiffness(spring).unwrap();
    let omega = (spring / MASS).sqrt();
    let all = pushed(&settings, quick(), force, 0.5);
    let expected = |t: f64| force / spring * (1.0 - (omega * t).cos());
    assert!(off(&all, 1, expected) < 1e-3);
    for [_, x, v] in all {
        let energy = 0.5 * (MASS * v * v + spring * x * x);
        // Friction takes at most 1e-6 N over 10 swings of 3 mm.
        assert!((energy - force * x).abs() < 1e-7, "{energy}");
    }
}

/// Released at its equilibrium under weight and spring nothing moves; under a sine alone it swings as far as the mass lets it.
#[test]
fn disturbances_add_to_the_force() {
    let mut settings = free();
    settings.disturbance = Some(Disturbance::Constant(-25.0));
    let all = pushed(&settings, quick(), 25.0, 0.2);
    assert!(all.iter().all(|row| row[1] == 0.0 && row[2] == 0.0));
    let (amplitude, omega) = (40.0, TAU * 8.0);
    settings.disturbance = Some(Disturbance::Sine {
        amplitude,
        frequency: 8.0,
        phase: 0.25 * TAU,
    });
    let all = pushed(&settings, quick(), 0.0, 0.5);
    let expected = |t: f64| amplitude / (MASS * omega) * (omega * t).sin();
    assert!(off(&all, 2, expected) < 1e-3);
}

const MOTOR: [f64; 3] = [96.0, 70.0, 2.4];

/// A locked motor: `F = Kf u/R (1 - exp(-t R/L))`; the axis is too heavy to move.
#[test]
fn current_after_a_step_of_voltage() {
    let ([kf, k, r], l) = (MOTOR, 0.02);
    let heavy = 1e12;
    let mut settings = free();
    settings.plant = settings.plant.with_mass(heavy).unwrap();
    settings.drive = Drive::voltage(kf, k, r, l);
    let volts = 5.0;
    let all = pushed(&settings, quick(), kf * volts / r, 0.05);
    let tau = l / r;
    let momentum = |t: f64| kf * volts / r * (t - tau * (1.0 - (-t / tau).exp()));
    assert!(off(&all, 2, |t| momentum(t) / heavy) < 1e-9);
}

/// A free motor on a voltage without inductance: `v = u/k (1 - exp(-t Kf k/(R M)))`; with it `L M s^2 + R M s + Kf k`
/// has two poles, real or complex.
#[test]
fn speed_after_a_step_of_voltage() {
    let [kf, k, r] = MOTOR;
    let volts = 20.0;
    for l in [0.0, 5e-4, 0.02] {
        let mut settings = free();
        settings.drive = Drive::voltage(kf, k, r, l);
        let expected = |t: f64| {
            let rate = kf * k / (r * MASS);
            if l == 0.0 {
                return volts / k * (1.0 - (-rate * t).exp());
            }
            let (a, b) = (0.5 * r / l, kf * k / (l * MASS));
            let root = (a * a - b).abs().sqrt();
            let (even, odd) = match a * a > b {
                true => ((root * t).cosh(), (root * t).sinh()),
                false => ((root * t).cos(), (root * t).sin()),
            };
            volts / k * (1.0 - (-a * t).exp() * (even + a / root * odd))
        };
        let force = kf * volts / r;
        let mut last = [f64::INFINITY; 2];
        for substeps in [1, 3, 9] {
            settings.substeps = substeps;
            let quick = pushed(&settings, quick(), force, 0.1);
            let mid = pushed(&settings, Mid::new(2).unwrap(), force, 0.1);
            let found = [quick, mid].map(|all| off(&all, 2, expected));
            // Of second order: a third of the step leaves a ninth of the error.
            for (found, last) in found.iter().zip(last) {
                assert!(*found < last / 6.0, "{l} H, {substeps}: {found:.1e}");
            }
            last = found;
        }
        assert!(last.iter().all(|off| *off < 1e-4), "{l} H: {last:?}");
    }
}
