//! Simulated axes against the plant of `stiction-servo`.

use crate::common::{candidate, spread};
use proptest::prelude::*;
use stiction_lanes::{
    Axis, Candidate, Drive, InstructionSet, Measured, Motion, Outcome, Stepping, plants,
};
use stiction_servo::plant::{self, Load, Plant};
use stiction_testkit::MeanOfEnds;

const MID: Stepping = Stepping::Midpoint;

fn force(steps: usize, most: f64) -> Vec<f64> {
    (0..steps)
        .map(|k| most * (libm::sin(3e-3 * k as f64) + 0.3 * libm::sin(0.041 * k as f64)))
        .collect()
}

/// The motion by the scalar plant, at the end of each step.
fn scalar(axis: &Axis, h: f64, force: &[f64]) -> Vec<plant::Motion> {
    let law = MeanOfEnds(axis.friction.law().unwrap());
    let plant = Plant::new(axis.mass, law).unwrap();
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
        let cost = |measured| plants(&drive(measured), &[axis], MID, best).unwrap()[0];
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

/// First order, against the midpoint on a step so fine that it is exact beside them: half the step, half what
/// it is off.
#[test]
fn the_semi_implicit_step_is_of_first_order() {
    let axis = Axis {
        mass: 4.0,
        friction: Candidate::gaussian([1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3]),
    };
    let (time, finest) = (0.4, 1e-6);
    let end = |step: f64, stepping| {
        let steps = (time / step).round() as usize;
        let force: Vec<f64> = (0..steps)
            .map(|k| 60.0 * libm::sin(40.0 * step * (k as f64 + 0.5)))
            .collect();
        let drive = Drive {
            step,
            force: &force,
            start: Motion::default(),
            measured: Measured::Position(&force),
        };
        plants(&drive, &[axis], stepping, InstructionSet::best()).unwrap()[0].end
    };
    let right = end(finest, MID);
    let off = |step| (end(step, Stepping::SemiImplicit).position / right.position - 1.0).abs();
    let errors = [4e-4, 2e-4, 1e-4, 5e-5].map(off);
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((1.8..2.2).contains(&ratio), "{errors:?}");
    }
    let accurate = (end(1e-4, MID).position / right.position - 1.0).abs();
    assert!(accurate < 0.05 * errors[2], "{accurate:e} {errors:?}");
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
    for (exponents, stepping) in [
        (false, MID),
        (true, MID),
        (false, Stepping::SemiImplicit),
        (true, Stepping::SemiImplicit),
    ] {
        let all = axes(33, exponents);
        let right: Vec<Outcome> = all
            .iter()
            .flat_map(|a| plants(&drive, &[*a], stepping, InstructionSet::best()).unwrap())
            .collect();
        for set in InstructionSet::all() {
            for count in [1, 3, 7, 8, 9, 17, 33] {
                let found = plants(&drive, &all[33 - count..], stepping, set).unwrap();
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
        plants(&drive, axes, MID, InstructionSet::best())
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
        let all = |stepping| plants(&drive, &axes, stepping, InstructionSet::best()).unwrap();
        for (axis, (accurate, cheap)) in
            axes.iter().zip(all(MID).iter().zip(all(Stepping::SemiImplicit)))
        {
            let bound = axis.friction.static_friction / axis.friction.stiffness;
            prop_assert!(accurate.cost.is_finite() && !cheap.cost.is_nan());
            for outcome in [accurate, &cheap] {
                prop_assert!(outcome.end.deflection.abs() <= bound * (1.0 + 1e-12));
            }
        }
    }
}
