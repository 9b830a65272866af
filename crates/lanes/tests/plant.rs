//! Simulated axes against the plant of `stiction-servo`.

mod common;

use common::{candidate, spread};
use proptest::prelude::*;
use stiction_lanes::{Axis, Drive, InstructionSet, Measured, Motion, Outcome, plants};
use stiction_servo::plant::{self, Load, Plant};

fn force(steps: usize, most: f64) -> Vec<f64> {
    (0..steps)
        .map(|k| most * (libm::sin(3e-3 * k as f64) + 0.3 * libm::sin(0.041 * k as f64)))
        .collect()
}

/// The motion by the scalar plant, at the end of each step.
fn scalar(axis: &Axis, h: f64, force: &[f64]) -> Vec<plant::Motion> {
    let plant = Plant::new(axis.mass, axis.friction.law().unwrap()).unwrap();
    let mut motion = plant::Motion::default();
    force
        .iter()
        .map(|&u| {
            motion = plant.step(motion, h, Load::force(u)).motion;
            motion
        })
        .collect()
}

fn axes(count: usize, exponents: bool) -> Vec<Axis> {
    let heavy = |i: usize| 2.0 + 0.7 * (i % 11) as f64;
    spread(count, exponents)
        .into_iter()
        .enumerate()
        .map(|(i, mut friction)| {
            friction.stiffness = friction.stiffness.min(1e6);
            Axis {
                mass: heavy(i),
                friction,
            }
        })
        .collect()
}

#[test]
fn motions_are_those_of_the_scalar_plant() {
    let force = force(4000, 80.0);
    let measured: Vec<f64> = force.iter().map(|u| 1e-3 * u).collect();
    for axis in axes(20, true) {
        let right = scalar(&axis, 1e-3, &force);
        let drive = |measured| Drive {
            step: 1e-3,
            force: &force,
            start: Motion::default(),
            measured,
        };
        let best = InstructionSet::best();
        let cost = |measured| plants(&drive(measured), &[axis], best).unwrap()[0];
        let by_position = cost(Measured::Position(&measured));
        let by_velocity = cost(Measured::Velocity(&measured));
        assert_eq!(by_position.end, by_velocity.end);
        let last = right.last().unwrap();
        let end = by_position.end;
        let most =
            |f: fn(&plant::Motion) -> f64| right.iter().map(|m| f(m).abs()).fold(0.0, f64::max);
        for (found, f) in [
            (end.position, (|m| m.position) as fn(&plant::Motion) -> f64),
            (end.velocity, |m| m.velocity),
            (end.deflection, |m| m.deflection),
        ] {
            assert!(
                (found - f(last)).abs() <= 1e-8 * most(f),
                "{end:?} {last:?} {axis:?}"
            );
        }
        let sum = |f: fn(&plant::Motion) -> f64| -> f64 {
            let errors = right.iter().zip(&measured).map(|(m, x)| x - f(m));
            errors.map(|e| e * e).sum()
        };
        assert!((by_position.cost / sum(|m| m.position) - 1.0).abs() < 1e-8);
        assert!((by_velocity.cost / sum(|m| m.velocity) - 1.0).abs() < 1e-8);
    }
}

#[test]
fn outcomes_have_the_same_bits_in_any_company_and_instruction_set() {
    let force = force(500, 80.0);
    let drive = Drive {
        step: 1e-3,
        force: &force,
        start: Motion {
            velocity: 0.01,
            ..Motion::default()
        },
        measured: Measured::Position(&force),
    };
    for exponents in [false, true] {
        let all = axes(33, exponents);
        let right: Vec<Outcome> = all
            .iter()
            .flat_map(|a| plants(&drive, &[*a], InstructionSet::best()).unwrap())
            .collect();
        for set in InstructionSet::all() {
            for count in [1, 3, 7, 8, 9, 17, 33] {
                let found = plants(&drive, &all[33 - count..], set).unwrap();
                assert_eq!(found, right[33 - count..], "{set} {count}");
            }
        }
    }
}

#[test]
fn what_is_wrong_is_named() {
    let force = [1.0, f64::INFINITY];
    let drive = Drive {
        step: 1e-3,
        force: &force,
        start: Motion::default(),
        measured: Measured::Velocity(&[0.0; 2]),
    };
    let refused = |drive: Drive, axes: &[Axis]| {
        plants(&drive, axes, InstructionSet::best())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        refused(drive, &[]),
        "segment 0, force, sample 1: inf; allowed: finite"
    );
    let short = Drive {
        measured: Measured::Velocity(&[0.0]),
        ..drive
    };
    assert_eq!(
        refused(short, &[]),
        "segment 0: measured with 1 entries; allowed: 2"
    );
    let mut axis = axes(1, false)[0];
    axis.mass = 0.0;
    let good = Drive {
        force: &[1.0, 2.0],
        ..drive
    };
    assert_eq!(
        refused(good, &[axis]),
        "candidate 0: mass = 0; allowed: finite and > 0"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Any law, any force: a number, and a deflection within its bound.
    #[test]
    fn any_outcome_is_a_number(
        candidates in prop::collection::vec(candidate(), 1..10),
        mass in 1e-3..1e3,
        force in prop::collection::vec(-1e4..1e4_f64, 1..60),
        h in 1e-5..1e-2,
    ) {
        let axes: Vec<Axis> = candidates.iter().map(|&friction| Axis { mass, friction }).collect();
        let drive = Drive { step: h, force: &force, start: Motion::default(), measured: Measured::Velocity(&force) };
        for (outcome, axis) in plants(&drive, &axes, InstructionSet::best()).unwrap().iter().zip(&axes) {
            prop_assert!(outcome.cost.is_finite());
            let bound = axis.friction.static_friction / axis.friction.stiffness;
            prop_assert!(outcome.end.deflection.abs() <= bound * (1.0 + 1e-12));
        }
    }
}
