//! Columns and sums against the scalar law of `stiction-friction`, and its differences.

use crate::common;
use crate::common::{candidate, force, motion, sine, spread, trial};
use proptest::prelude::*;
use stiction_lanes::{
    Candidate, InstructionSet, OWN, Segment, Sums, Time, Track, Trial, levels, shared_sums, slopes,
    sums, sums_alone, trace,
};

/// eta and rate by the scalar law with Fc = 1.
fn scalar(t: &Trial, h: f64, velocity: &[f64]) -> [Vec<f64>; 2] {
    let law = Candidate {
        stiffness: libm::exp(t.ln_kappa),
        micro_damping: 0.0,
        viscous: 0.0,
        coulomb: 1.0,
        static_friction: 1.0 + libm::exp(t.ln_excess),
        stribeck_velocity: libm::exp(t.ln_velocity),
        exponent: t.exponent,
    };
    let law = law.law().unwrap();
    let mut z = 0.0;
    let mut out = [Vec::new(), Vec::new()];
    for (k, &v) in velocity.iter().enumerate() {
        if k > 0 {
            z = law.step_record(z, h, velocity[k - 1], v);
        }
        out[0].push(law.stiffness() * z);
        out[1].push(law.deflection_rate(z, v));
    }
    out
}

/// The own columns, the derivatives by differences of fourth order.
fn differences(t: &Trial, h: f64, velocity: &[f64]) -> [Vec<f64>; OWN] {
    let moved = |k: usize, d: f64| {
        let mut t = *t;
        *[&mut t.ln_kappa, &mut t.ln_excess, &mut t.ln_velocity][k] += d;
        scalar(&t, h, velocity)
    };
    let [eta, rate] = scalar(t, h, velocity);
    let d = 1e-3;
    let slopes: Vec<[Vec<f64>; 2]> = (0..3)
        .map(|k| {
            let [a, b, c, e] = [-2.0, -1.0, 1.0, 2.0].map(|i| moved(k, i * d));
            [0, 1].map(|c_| {
                (0..velocity.len())
                    .map(|i| {
                        let near = c[c_][i] - b[c_][i];
                        let wide = e[c_][i] - a[c_][i];
                        (8.0 * near - wide) / (12.0 * d)
                    })
                    .collect()
            })
        })
        .collect();
    let s = |k: usize, c: usize| slopes[k][c].clone();
    [
        eta,
        rate,
        s(0, 0),
        s(1, 0),
        s(2, 0),
        s(0, 1),
        s(1, 1),
        s(2, 1),
    ]
}

fn rms(x: &[f64]) -> f64 {
    (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt()
}

fn own(track: &Track, t: &Trial) -> [Vec<f64>; OWN] {
    let found = trace(track, t, true, InstructionSet::best()).unwrap();
    let [a, b, c] = found.eta_slope;
    let [d, e, f] = found.rate_slope;
    [found.eta, found.rate, a, b, c, d, e, f]
}

#[test]
fn columns_are_the_scalar_law_and_its_differences() {
    let velocity = sine(1501, 1e-3, 0.05, 3.0);
    let track = common::track(1e-3, &velocity, &force(&velocity));
    for candidate in spread(12, true) {
        let t = trial(&candidate);
        let right = differences(&t, 1e-3, &velocity);
        let found = own(&track, &t);
        let plain = trace(&track, &t, false, InstructionSet::best()).unwrap();
        for (c, (found, right)) in found.iter().zip(&right).enumerate() {
            let scale = rms(right).max(1e-6 * if c % 5 == 0 { 1.0 } else { 0.05 });
            let tolerance = if c < 2 { 1e-10 } else { 1e-6 };
            for (k, (x, y)) in found.iter().zip(right).enumerate() {
                assert!(
                    (x - y).abs() <= tolerance * (scale + y.abs()),
                    "column {c}, sample {k}: {x} instead of {y}; {candidate:?}"
                );
            }
        }
        for (plain, full) in [(&plain.eta, &found[0]), (&plain.rate, &found[1])] {
            for (x, y) in plain.iter().zip(full) {
                assert!((x - y).abs() <= 1e-12);
            }
        }
    }
}

/// The sums from the columns as they were written out.
fn dense(own: &[Vec<f64>; OWN], shared: &[&[f64]], keep: &[bool]) -> Sums {
    let dot = |a: &[f64], b: &[f64]| -> f64 {
        (0..a.len()).filter(|&k| keep[k]).map(|k| a[k] * b[k]).sum()
    };
    Sums {
        own: std::array::from_fn(|i| std::array::from_fn(|j| dot(&own[i], &own[j]))),
        shared: shared
            .iter()
            .map(|s| std::array::from_fn(|i| dot(s, &own[i])))
            .collect(),
    }
}

fn close<const C: usize>(found: &Sums<C>, right: &Sums, energy: &[f64]) {
    let within = |x: f64, y: f64, a: f64, b: f64| {
        assert!(
            (x - y).abs() <= 1e-12 * (a * b).sqrt() + 1e-290,
            "{x} instead of {y}"
        );
    };
    for i in 0..C {
        for j in 0..C {
            within(
                found.own[i][j],
                right.own[i][j],
                right.own[i][i],
                right.own[j][j],
            );
        }
        for (s, energy) in energy.iter().enumerate() {
            within(
                found.shared[s][i],
                right.shared[s][i],
                *energy,
                right.own[i][i],
            );
        }
    }
}

#[test]
fn sums_are_those_of_the_columns() {
    for further in 0..5 {
        sums_beside(further, |k| k % 5 != 2);
        sums_beside(further, |_| true);
    }
}

/// With further shared columns, and samples left out.
fn sums_beside(further: usize, keep: impl Fn(usize) -> bool) {
    let velocity = sine(1003, 1e-3, 0.05, 3.0);
    let force = force(&velocity);
    let keep: Vec<bool> = (0..1003).map(keep).collect();
    let further: Vec<Vec<f64>> = (0..further)
        .map(|c| {
            velocity
                .iter()
                .map(|v| libm::cos((c + 1) as f64 * 40.0 * v))
                .collect()
        })
        .collect();
    let columns: Vec<&[f64]> = further.iter().map(Vec::as_slice).collect();
    let track = Track::new(&[Segment {
        time: Time::Step(1e-3),
        velocity: &velocity,
        force: &force,
        keep: &keep,
        columns: &columns,
    }])
    .unwrap();
    let mut shared: Vec<&[f64]> = vec![&force, &velocity];
    shared.extend(&columns);
    let found = shared_sums(&track);
    let energy: Vec<f64> = (0..shared.len()).map(|s| found[s][s]).collect();
    for (i, a) in shared.iter().enumerate() {
        for (j, b) in shared.iter().enumerate() {
            let right: f64 = (0..1003).filter(|&k| keep[k]).map(|k| a[k] * b[k]).sum();
            assert!((found[i][j] - right).abs() <= 1e-12 * (energy[i] * energy[j]).sqrt());
        }
    }
    let trials: Vec<Trial> = spread(11, true).iter().map(trial).collect();
    let set = InstructionSet::best();
    for (t, batch) in trials.iter().zip(sums(&track, &trials, set).unwrap()) {
        let right = dense(&own(&track, t), &shared, &keep);
        close(&batch, &right, &energy);
        close(&sums_alone(&track, t, set).unwrap(), &right, &energy);
    }
    for (t, batch) in trials.iter().zip(levels(&track, &trials, set).unwrap()) {
        close(&batch, &dense(&own(&track, t), &shared, &keep), &energy);
    }
}

#[test]
fn slopes_are_those_of_the_weighed_columns() {
    let velocity = sine(1003, 1e-3, 0.05, 3.0);
    let track = common::track(1e-3, &velocity, &force(&velocity));
    for t in spread(11, true).iter().map(trial) {
        let [_, _, eta @ .., a, b, c] = own(&track, &t);
        let found = slopes(&track, &t, [20.0, 600.0], InstructionSet::best()).unwrap();
        for ((found, eta), rate) in found.iter().zip(&eta).zip([a, b, c]) {
            assert_eq!(found.len(), 1003);
            for ((found, eta), rate) in found.iter().zip(eta).zip(&rate) {
                assert_eq!(*found, 20.0 * eta + 600.0 * rate);
            }
        }
    }
}

#[test]
fn sums_have_the_same_bits_in_any_company_and_instruction_set() {
    let velocity = sine(700, 1e-3, 0.05, 7.0);
    let track = common::track(1e-3, &velocity, &force(&velocity));
    for exponents in [false, true] {
        let trials: Vec<Trial> = spread(33, exponents).iter().map(trial).collect();
        let best = InstructionSet::best();
        let right: Vec<Sums> = trials
            .iter()
            .flat_map(|t| sums(&track, &[*t], best).unwrap())
            .collect();
        for set in InstructionSet::all() {
            for count in [1, 3, 7, 8, 9, 17, 33] {
                let found = sums(&track, &trials[33 - count..], set).unwrap();
                assert_eq!(found, right[33 - count..], "{set} {count}");
                let [found, right] = [set, best].map(|s| levels(&track, &trials, s).unwrap());
                assert_eq!(found, right);
                let few = levels(&track, &trials[33 - count..], set).unwrap();
                assert_eq!(few, right[33 - count..], "{set} {count}");
            }
            for t in &trials[..3] {
                let [found, right] = [set, best].map(|s| sums_alone(&track, t, s).unwrap());
                assert_eq!(found, right);
                let [found, right] = [set, best].map(|s| trace(&track, t, true, s).unwrap());
                assert_eq!(found, right);
                let [found, right] = [set, best].map(|s| trace(&track, t, false, s).unwrap());
                assert_eq!(found, right);
                let [found, right] = [set, best].map(|s| slopes(&track, t, [3.0, 7.0], s).unwrap());
                assert_eq!(found, right);
            }
        }
    }
}

#[test]
fn a_trial_out_of_range_is_named() {
    let track = common::track(1e-3, &[0.0, 0.1], &[1.0, 2.0]);
    let mut wrong = trial(&spread(1, false)[0]);
    wrong.ln_velocity = f64::NAN;
    let refused = sums(&track, &[wrong], InstructionSet::best()).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "candidate 0: ln_velocity = NaN; allowed: a magnitude of at most 230"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    /// Any trial, any motion: numbers, and a deflection within its bound.
    #[test]
    fn any_columns_are_numbers_and_eta_stays_within_its_bound(
        candidate in candidate(),
        velocity in motion(),
        h in 1e-5..0.1,
    ) {
        let t = Trial { ln_excess: (candidate.static_friction / candidate.coulomb - 1.0).max(1e-6).ln(), ..trial(&candidate) };
        let track = common::track(h, &velocity, &force(&velocity));
        let columns = own(&track, &t);
        let bound = 1.0 + libm::exp(t.ln_excess);
        for eta in &columns[0] {
            prop_assert!(eta.abs() <= bound * (1.0 + 1e-12), "{eta} {bound}");
        }
        for column in &columns {
            prop_assert_eq!(column.len(), velocity.len());
            prop_assert!(column.iter().all(|x| x.is_finite()));
        }
    }
}
