//! Costs against the scalar law of `stiction-friction`.

use crate::common::{candidate, force, motion, sine, spread, track};
use proptest::prelude::*;
use stiction_friction::{LuGre, explicit};
use stiction_lanes::{Candidate, Error, InstructionSet, Scheme, Segment, Time, Track, costs};

/// The cost by the scalar law, one sample after the other, and the force's sum of squares.
fn scalar(
    candidate: &Candidate,
    step: impl Fn(&LuGre<f64>, f64, f64, f64, f64) -> f64,
    h: f64,
    velocity: &[f64],
    force: &[f64],
) -> (f64, f64) {
    let law = candidate.law().unwrap();
    let (mut z, mut cost, mut energy) = (0.0, 0.0, 0.0);
    for (k, (v, u)) in velocity.iter().zip(force).enumerate() {
        if k > 0 {
            z = step(&law, z, h, velocity[k - 1], *v);
        }
        let model = law.force(z, *v);
        cost += (u - model) * (u - model);
        // What either is made of.
        let parts = law.stiffness() * z.abs() + candidate.micro_damping * 2.0 * v.abs();
        energy += u * u + parts * parts;
    }
    (cost, energy)
}

fn explin(law: &LuGre<f64>, z: f64, h: f64, va: f64, vb: f64) -> f64 {
    law.step_record(z, h, va, vb)
}

#[test]
fn costs_are_those_of_the_scalar_law() {
    let velocity = sine(5001, 1e-4, 0.05, 7.0);
    let force = force(&velocity);
    let track = track(1e-4, &velocity, &force);
    assert_eq!(track.nodes() % 64, 0);
    let all = spread(40, true);
    let found = costs(&track, &all, Scheme::Explin, InstructionSet::best()).unwrap();
    for (candidate, cost) in all.iter().zip(found) {
        let (right, _) = scalar(candidate, explin, 1e-4, &velocity, &force);
        assert!(
            (cost / right - 1.0).abs() < 1e-11,
            "{cost} {right} {candidate:?}"
        );
    }
}

#[test]
fn explicit_schemes_are_those_of_the_scalar_law_and_explode_to_infinity() {
    let velocity = sine(2001, 1e-4, 0.02, 3.0);
    let force = force(&velocity);
    let track = track(1e-4, &velocity, &force);
    let mut all = spread(9, true);
    all.iter_mut()
        .for_each(|c| c.stiffness = c.stiffness.min(1e6));
    let stiff = Candidate {
        stiffness: 1e9,
        ..all[0]
    };
    all.push(stiff);
    for (scheme, step) in [
        (
            Scheme::Euler,
            explicit::euler::<f64> as fn(&_, _, _, _, _) -> _,
        ),
        (Scheme::RungeKutta, explicit::rk4::<f64>),
    ] {
        let found = costs(&track, &all, scheme, InstructionSet::best()).unwrap();
        for (candidate, cost) in all.iter().zip(&found).take(9) {
            let (right, _) = scalar(candidate, step, 1e-4, &velocity, &force);
            assert!(
                (cost / right - 1.0).abs() < 1e-9,
                "{scheme:?} {cost} {right} {candidate:?}"
            );
        }
        assert_eq!(found[9], f64::INFINITY);
    }
}

#[test]
fn segments_start_unloaded_and_samples_that_do_not_count_do_not() {
    let velocity = sine(301, 1e-3, 0.02, 3.0);
    let force = force(&velocity);
    let mut holed = force.clone();
    let mut keep = vec![true; 301];
    for k in (5..301).step_by(7) {
        holed[k] = f64::NAN;
        keep[k] = false;
    }
    let time: Vec<f64> = (0..301).map(|k| 1e-3 * k as f64).collect();
    let all = spread(5, false);
    let cost = |segments: &[Segment]| {
        let track = Track::new(segments).unwrap();
        costs(&track, &all, Scheme::Explin, InstructionSet::best()).unwrap()
    };
    let whole = Segment {
        time: Time::Step(1e-3),
        velocity: &velocity,
        force: &force,
        keep: &[],
        columns: &[],
    };
    let kept = Segment {
        force: &holed,
        keep: &keep,
        ..whole
    };
    let (one, other) = (cost(&[whole]), cost(&[kept]));
    let both = cost(&[whole, kept]);
    let timed = cost(&[Segment {
        time: Time::At(&time),
        ..whole
    }]);
    for i in 0..all.len() {
        assert!((both[i] / (one[i] + other[i]) - 1.0).abs() < 1e-13);
        assert!((timed[i] / one[i] - 1.0).abs() < 1e-9);
        let law = all[i].law().unwrap();
        let (mut z, mut right) = (0.0, 0.0);
        for k in 0..301 {
            if k > 0 {
                z = law.step_record(z, 1e-3, velocity[k - 1], velocity[k]);
            }
            if keep[k] {
                let e = force[k] - law.force(z, velocity[k]);
                right += e * e;
            }
        }
        assert!((other[i] / right - 1.0).abs() < 1e-12);
    }
}

#[test]
fn what_is_wrong_is_named() {
    let set = InstructionSet::best();
    let good = track(1e-3, &[0.0, 0.1], &[1.0, 2.0]);
    let mut all = spread(3, false);
    all[2].static_friction = 0.0;
    let refused = costs(&good, &all, Scheme::Explin, set).unwrap_err();
    assert!(matches!(refused, Error::Candidate { index: 2, .. }));
    assert!(refused.to_string().starts_with("candidate 2: static = 0"));
    let segment = Segment {
        time: Time::Step(1e-3),
        velocity: &[0.0, 0.1],
        force: &[1.0, f64::NAN],
        keep: &[],
        columns: &[],
    };
    let message = |s: Segment| Track::new(&[s]).unwrap_err().to_string();
    assert_eq!(
        message(segment),
        "segment 0, force, sample 1: NaN; allowed: finite and below 1e100"
    );
    assert_eq!(
        message(Segment {
            force: &[1.0],
            ..segment
        }),
        "segment 0: force with 1 entries; allowed: 2"
    );
    assert_eq!(
        message(Segment {
            time: Time::At(&[0.0, 0.0]),
            force: &[1.0, 1.0],
            ..segment
        }),
        "segment 0, time, sample 1: 0; allowed: finite and later than the sample before"
    );
    assert_eq!(
        message(Segment {
            time: Time::Step(0.0),
            force: &[1.0, 1.0],
            ..segment
        }),
        "segment 0: time step = 0 s; allowed: finite and > 0"
    );
}

proptest! {
    /// Any law, any motion: a number, and the scalar law's.
    #[test]
    fn any_cost_is_the_scalar_laws(
        candidates in prop::collection::vec(candidate(), 1..20),
        velocity in motion(),
        h in prop_oneof![Just(1e-4), 1e-5..0.1],
    ) {
        let force = force(&velocity);
        let track = track(h, &velocity, &force);
        let found = costs(&track, &candidates, Scheme::Explin, InstructionSet::best()).unwrap();
        for (candidate, cost) in candidates.iter().zip(found) {
            prop_assert!(cost.is_finite());
            let (right, energy) = scalar(candidate, explin, h, &velocity, &force);
            prop_assert!((cost - right).abs() <= 1e-10 * energy, "{cost} {right} {candidate:?}");
        }
    }
}
