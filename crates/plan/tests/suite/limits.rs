//! Limits hold at every instant, not only at samples.

use proptest::prelude::*;
use stiction_plan::{Atom, HandMade, Limits, Loop, Motion, Rig, dictionary, hand_made, places};

/// Axes from a piezo stage to a gantry, most of them with limits that do not go together well.
fn axes() -> impl Strategy<Value = (Limits, Rig)> {
    let limits = (
        -4.0..1.0_f64,
        -1.0..1.0_f64,
        -3.0..1.0_f64,
        -1.0..2.5_f64,
        0.5..5.0_f64,
        0.0..0.2_f64,
    );
    let rig = (2.3..4.3_f64, -9.0..-5.0_f64, 0.5..2.3_f64);
    (limits, rig).prop_map(
        |((stroke, side, speed, acceleration, jerk, end_zone), rig)| {
            let stroke = libm::exp10(stroke);
            let limits = Limits {
                stroke: [
                    -stroke * (1.0 - side.max(0.0)),
                    stroke * (1.0 + side.min(0.0)),
                ],
                end_zone,
                speed: libm::exp10(speed),
                acceleration: libm::exp10(acceleration),
                jerk: libm::exp10(jerk),
                rated_force: 100.0,
                peak_force: 200.0,
            };
            let rate = libm::exp10(rig.0);
            let rig = Rig {
                rate,
                encoder_step: libm::exp10(rig.1),
                force_noise: 0.5,
                loop_: Loop::Tuned(libm::exp10(rig.2).min(0.05 * rate)),
            };
            (limits, rig)
        },
    )
}

/// All pieces, those to several places too.
fn all(limits: &Limits, rig: &Rig) -> Vec<Atom> {
    [dictionary(limits, rig), places(limits, rig)].concat()
}

/// The largest of what a piece does on a grid of `count` points.
fn on_grid(atom: &Atom, count: usize) -> [f64; 5] {
    let mut out = [0.0_f64; 5];
    for k in 0..=count {
        let at = atom.at(atom.duration() * k as f64 / count as f64);
        out[0] = out[0].min(at.position);
        out[1] = out[1].max(at.position);
        out[2] = out[2].max(at.velocity.abs());
        out[3] = out[3].max(at.acceleration.abs());
        out[4] = out[4].max(at.jerk.abs());
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, max_global_rejects: 10_000, ..ProptestConfig::default() })]

    /// On a grid at least 20 times as fine as the set points of a log at 1 kHz.
    #[test]
    fn every_piece_holds_every_limit_on_a_fine_grid((limits, rig) in axes(), one in any::<prop::sample::Index>()) {
        limits.validate().unwrap();
        let atoms = all(&limits, &rig);
        prop_assume!(!atoms.is_empty());
        let atom = one.get(&atoms);
        let [low, high] = limits.reach();
        let count = ((20_000.0 * atom.duration()) as usize).min(100_000);
        let [least, most, speed, acceleration, jerk] = on_grid(atom, count);
        prop_assert!(least >= low && most <= high, "{atom:?} {limits:?}");
        prop_assert!(speed <= limits.speed, "{atom:?} {limits:?}");
        prop_assert!(acceleration <= limits.acceleration * (1.0 + 1e-12), "{atom:?} {limits:?}");
        prop_assert!(jerk <= limits.jerk * (1.0 + 1e-12), "{atom:?} {limits:?}");
    }

    /// The bounds are bounds, and not much more than what happens.
    #[test]
    fn bounds_are_tight((limits, rig) in axes(), one in any::<prop::sample::Index>()) {
        let atoms = all(&limits, &rig);
        prop_assume!(!atoms.is_empty());
        let atom = one.get(&atoms);
        // Those of moves are their extremes, in ramps that may be too short for any grid.
        prop_assume!(matches!(atom, Atom::Sine { .. }));
        let bounds = atom.extremes();
        let [least, most, speed, acceleration, jerk] = on_grid(atom, 20_000);
        let pairs = [
            (most - least, bounds.position[1] - bounds.position[0]),
            (speed, bounds.speed),
            (acceleration, bounds.acceleration),
            (jerk, bounds.jerk),
        ];
        for (found, bound) in pairs {
            prop_assert!(found <= bound * (1.0 + 1e-12), "{atom:?} {found} {bound}");
            prop_assert!(found >= 0.5 * bound, "{atom:?} {found} {bound}");
        }
    }

    #[test]
    fn hand_made_motions_hold_them_too((limits, rig) in axes()) {
        for kind in HandMade::ALL {
            if let Some(motion) = hand_made(kind, &limits, &rig, 9.0).unwrap() {
                prop_assert!(motion.holds(&limits), "{kind:?} {limits:?} {:?}", motion.extremes());
                prop_assert!(motion.duration() <= 9.0 + 1e-9);
            }
        }
    }
}

/// As the tests above, on very many axes, by the bounds.
fn no_limit_is_broken_on(cases: u32) {
    let mut runner = proptest::test_runner::TestRunner::new_with_rng(
        ProptestConfig::with_cases(cases),
        proptest::test_runner::TestRng::deterministic_rng(
            proptest::test_runner::RngAlgorithm::ChaCha,
        ),
    );
    let run = runner.run(&axes(), |(limits, rig)| {
        for atom in all(&limits, &rig) {
            let motion = Motion::new(vec![atom]).unwrap();
            prop_assert!(motion.holds(&limits), "{atom:?} {limits:?}");
        }
        Ok(())
    });
    run.unwrap();
}

#[test]
fn no_limit_is_broken_on_300_axes() {
    no_limit_is_broken_on(300);
}

#[test]
#[ignore = "soak: the same on 100 000 axes"]
fn no_limit_is_broken_on_100_000_axes() {
    no_limit_is_broken_on(100_000);
}

#[test]
fn limits_that_are_none_are_refused_by_name() {
    let good = Limits {
        stroke: [-0.1, 0.1],
        end_zone: 0.05,
        speed: 0.2,
        acceleration: 6.0,
        jerk: 1500.0,
        rated_force: 150.0,
        peak_force: 200.0,
    };
    good.validate().unwrap();
    let bad = [
        (
            "stroke",
            Limits {
                stroke: [0.1, 0.2],
                ..good
            },
        ),
        (
            "stroke",
            Limits {
                stroke: [0.0, 0.0],
                ..good
            },
        ),
        (
            "stroke",
            Limits {
                stroke: [f64::NAN, 0.2],
                ..good
            },
        ),
        (
            "end_zone",
            Limits {
                end_zone: 0.5,
                ..good
            },
        ),
        ("speed", Limits { speed: 0.0, ..good }),
        (
            "acceleration",
            Limits {
                acceleration: f64::INFINITY,
                ..good
            },
        ),
        ("jerk", Limits { jerk: -1.0, ..good }),
        (
            "peak_force",
            Limits {
                peak_force: 100.0,
                ..good
            },
        ),
    ];
    for (name, limits) in bad {
        assert_eq!(limits.validate().unwrap_err().name, name);
    }
}

/// Moves go to both sides and to several places, fast and slow.
#[test]
fn places_are_those_of_the_whole_stroke() {
    let limits = Limits {
        stroke: [-0.1, 0.15],
        end_zone: 0.05,
        speed: 0.2,
        acceleration: 6.0,
        jerk: 1500.0,
        rated_force: 150.0,
        peak_force: 200.0,
    };
    let rig = Rig {
        rate: 2000.0,
        encoder_step: 50e-9,
        force_noise: 1.0,
        loop_: Loop::Tuned(60.0),
    };
    let [low, high] = limits.reach();
    let atoms = places(&limits, &rig);
    for part in [0.3, 0.6, 1.0] {
        for end in [low, high] {
            let goes_there = |atom: &&Atom| {
                let [least, most] = atom.extremes().position;
                (if end < 0.0 { least } else { most } / (part * end) - 1.0).abs() < 1e-5
            };
            let speeds: Vec<f64> = (atoms.iter().filter(goes_there))
                .map(|atom| atom.extremes().speed)
                .collect();
            assert!(speeds.len() >= 2, "{part} {end} {speeds:?}");
        }
    }
    // An axis at an end of its stroke goes to one side alone.
    let ended = Limits {
        stroke: [0.0, 0.1],
        end_zone: 0.0,
        ..limits
    };
    let atoms = places(&ended, &rig);
    assert!(!atoms.is_empty());
    assert!(atoms.iter().all(|atom| atom.extremes().position[0] >= 0.0));
}
