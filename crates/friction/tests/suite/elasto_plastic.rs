//! The elasto-plastic law: against numbers of SciPy, and for what its authors made it.

use crate::common::*;
use proptest::prelude::*;
use stiction_friction::{Damping, Direction, ElastoPlastic, LuGre, Shape, State, Stribeck};

const TAU: f64 = 2.0 * std::f64::consts::PI;

fn law(ratio: f64, damping: Damping<f64>) -> ElastoPlastic<f64> {
    ElastoPlastic::new(lopsided(Shape::Gaussian, damping), ratio).unwrap()
}

fn any_elasto_plastic() -> impl Strategy<Value = ElastoPlastic<f64>> {
    let ratio = prop_oneof![8 => 0.02..0.98, 1 => Just(1e-9), 1 => Just(1.0 - 1e-12)];
    (any_law(), ratio).prop_map(|(bristle, ratio)| ElastoPlastic::new(bristle, ratio).unwrap())
}

fn inside(law: &ElastoPlastic<f64>, z: f64) -> bool {
    z.abs() <= law.bound() * (1.0 + 1e-12)
}

fn two_tones(t: f64) -> f64 {
    8e-3 * (TAU * 1.03 * t + 0.3).sin() + 3e-3 * (TAU * 7.7 * t).sin()
}

/// Deflections in um every 97.3 ms by `other_laws.py`: SciPy's Radau on the published equations.
#[test]
fn follows_the_published_equations() {
    let expected = [
        208.2414901,
        170.3952223,
        173.7878948,
        224.9785526,
        113.7326779,
        -116.3539365,
        -116.6813221,
        -116.6667598,
        -117.4031158,
        59.27601001,
        174.4490344,
        188.3022219,
    ];
    let law = law(0.6, Damping::Constant(0.0));
    let (mut z, h) = (0.0, 0.0973 / 20_000.0);
    for (k, um) in expected.iter().enumerate() {
        for i in 20_000 * k..20_000 * (k + 1) {
            z = law.step_record(z, h, two_tones(h * i as f64), two_tones(h * (i + 1) as f64));
        }
        assert!((z * 1e6 - um).abs() < 2e-6, "{k}: {} {um}", z * 1e6);
    }
}

/// Deflection at `dt, 2 dt, ...` with `per` steps in each `dt`.
fn run(
    law: &ElastoPlastic<f64>,
    v: impl Fn(f64) -> f64,
    dt: f64,
    n: usize,
    per: usize,
) -> Vec<f64> {
    let h = dt / per as f64;
    let mut z = 0.0;
    (0..n)
        .map(|k| {
            for i in k * per..(k + 1) * per {
                z = law.step_record(z, h, v(i as f64 * h), v((i + 1) as f64 * h));
            }
            z
        })
        .collect()
}

fn orders(law: &ElastoPlastic<f64>, v: impl Fn(f64) -> f64 + Copy, dt: f64, n: usize) -> Vec<f64> {
    let truth = run(law, v, dt, n, 2000);
    let errors = [4, 8, 16, 32].map(|per| {
        let at = run(law, v, dt, n, per);
        at.iter()
            .zip(&truth)
            .map(|(a, b)| (a - b) * (a - b))
            .sum::<f64>()
            .sqrt()
    });
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

#[test]
fn the_record_step_is_of_second_order() {
    for ratio in [0.3, 0.7, 0.9] {
        let law = law(ratio, Damping::Constant(0.0));
        let one_way = |t: f64| 3e-3 * (1.5 + (25.0 * t).cos());
        let reversals = |t: f64| 8e-3 * (TAU * 1.03 * t + 0.3).sin();
        for order in orders(&law, one_way, 4e-3, 120) {
            assert!((order - 2.0).abs() < 0.15, "{ratio} one way: {order}");
        }
        for order in orders(&law, reversals, 4e-3, 400) {
            assert!((order - 2.0).abs() < 0.15, "{ratio} reversals: {order}");
        }
    }
}

/// At a held velocity one step agrees with a thousand, to the fourth power of its length.
#[test]
fn the_held_step_is_of_fourth_order() {
    let law = law(0.7, Damping::Constant(0.0));
    let v = 3e-3;
    let to =
        |n: i32, path: f64| (0..n).fold(0.0, |z, _| law.step_held(z, path / v / f64::from(n), v));
    let total = 3e-4; // m; breaks away at some 1.9e-4
    let truth = to(4096, total);
    let errors = [16, 32, 64, 128].map(|n| (to(n, total) - truth).abs());
    assert!(errors[0] < 1e-6 * law.bound(), "{errors:?}");
    for e in errors.windows(2) {
        assert!((e[0] / e[1]).log2() > 3.5, "{errors:?}");
    }
}

/// Below break-away the deflection is the path, to the last bit; LuGre creeps.
#[test]
fn below_break_away_nothing_is_left_over() {
    let law = law(0.7, Damping::Constant(0.0));
    // The weaker direction breaks away at .7 * 17 N/1.2e5 N/m = 99 um.
    let (mut z, mut held, mut lugre, mut path) = (0.0, 0.0, 0.0, 0.0);
    let h = 1e-3;
    let v = |k: i32| 8e-5 * TAU * (TAU * f64::from(k) * h).cos();
    for k in 0..10_000 {
        let (va, vb) = (v(k), v(k + 1));
        if va * vb < 0.0 {
            // The two parts of a split step are rounded apart.
            held = law.step_held(held, h, 0.5 * (va + vb));
            (z, path) = (held, held);
            continue;
        }
        z = law.step_record(z, h, va, vb);
        held = law.step_held(held, h, 0.5 * (va + vb));
        lugre = law.bristle().step_record(lugre, h, va, vb);
        path += h * (0.5 * (va + vb));
        assert!(z == path && held == path, "sample {k}: {z} {held} {path}");
    }
    assert!((lugre - path).abs() > 1e-5, "{lugre} {path}");
}

#[test]
fn sliding_settles_on_the_steady_curve() {
    for ratio in [0.1, 0.5, 0.95] {
        let law = law(ratio, Damping::Capped(600.0));
        for v in [-0.3, -4e-3, -1e-4, 1e-4, 3e-3, 0.1] {
            let mut state = law.rest();
            for _ in 0..100 {
                law.step(&mut state, 2.0, v);
            }
            let steady = law.bristle().curve().force(v);
            assert!((state.force / steady - 1.0).abs() < 1e-12, "{ratio} {v}");
            assert!((law.force(state.z, v) / steady - 1.0).abs() < 1e-12);
            assert_eq!(law.plasticity(1.01 * state.z, v), 1.0);
            assert_eq!(law.plasticity(0.99 * ratio * state.z, v), 0.0);
            assert_eq!(law.plasticity(-state.z, v), 0.0);
            let middle = law.plasticity(0.5 * (1.0 + ratio) * state.z, v);
            assert!((middle - 0.5).abs() < 1e-9, "{middle}");
        }
    }
}

#[test]
fn slope_of_the_held_step_matches_differences() {
    for ratio in [0.2, 0.7] {
        let law = law(ratio, Damping::Constant(0.0));
        for v in [-0.2, -3e-3, -1e-4, 1e-4, 2e-3, 6e-3, 0.3] {
            for z in [-2e-4, -1.2e-4, 0.0, 1.1e-4, 2.1e-4, 2.5e-4] {
                let h = 1e-3;
                let (end, slope) = law.step_held_slope(z, h, v);
                assert!((end - law.step_held(z, h, v)).abs() < 1e-13 * law.bound());
                let d = 1e-4 * v;
                let at = |v| law.step_held_slope(z, h, v).0;
                let numeric = (8.0 * (at(v + d) - at(v - d)) - (at(v + 2.0 * d) - at(v - 2.0 * d)))
                    / (12.0 * d);
                let scale = slope.abs().max(1e-3 * h);
                assert!(
                    (slope - numeric).abs() < 1e-5 * scale,
                    "ratio {ratio} v {v} z {z}: {slope} {numeric}"
                );
            }
        }
    }
}

#[test]
fn the_ratio_is_checked() {
    let bristle = c95(Damping::Constant);
    for bad in [0.0, 1.0, -0.1, 1.5, f64::NAN, f64::INFINITY] {
        let error = ElastoPlastic::new(bristle, bad).unwrap_err();
        assert_eq!(error.name, "breakaway_ratio");
        assert_eq!(error.allowed, "above 0 and below 1");
    }
    let small = ElastoPlastic::new(bristle, 1.0 - 1e-12).unwrap();
    assert_eq!(
        small.cast::<f32>().unwrap_err().name,
        "breakaway_ratio",
        "1 in single precision"
    );
}

/// Speeds that no machine has, in a step that is next to nothing, on an axis that is 460 000 times stiffer one way.
#[test]
fn the_largest_speeds_leave_a_deflection() {
    let side = |coulomb: f64, most: f64| Direction {
        coulomb,
        static_friction: most,
        stribeck_velocity: 1.0,
        viscous: 0.0,
    };
    let (slack, tight) = (side(1.2e-3, 3.6e-3), side(556.9, 556.9));
    let curve = Stribeck::new(Shape::Gaussian, slack, tight, 0.0).unwrap();
    let bristle = LuGre::new(9.3, Damping::Constant(0.0), curve).unwrap();
    let law = ElastoPlastic::new(bristle, 0.999_999_999_999).unwrap();
    let record = [0.0, f64::MAX, -f64::MAX, 0.0, f64::MAX];
    for h in [f64::MIN_POSITIVE, 1e-300, 1e-4, 1e300] {
        let (mut z, mut held) = (0.0, 0.0);
        for ends in record.windows(2) {
            z = law.step_record(z, h, ends[0], ends[1]);
            held = law.step_held(held, h, ends[1]);
            assert!(inside(&law, z) && inside(&law, held), "{h:e}: {z} {held}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn no_step_leaves_the_bound(
        law in any_elasto_plastic(),
        start in -1.0..=1.0,
        h in any_time_step(),
        record in prop::collection::vec(any_velocity(), 2..40),
    ) {
        let (mut z, mut held) = (start * law.bound(), start * law.bound());
        let mut unclamped = held;
        for ends in record.windows(2) {
            z = law.step_record(z, h, ends[0], ends[1]);
            prop_assert!(inside(&law, z), "z {z} of {}", law.bound());
            held = law.step_held(held, h, ends[1]);
            prop_assert!(inside(&law, held));
            if h > 1e-100 && h < 1e3 {
                unclamped = law.step_held_slope(unclamped, h, ends[1]).0;
                prop_assert!(inside(&law, unclamped), "the map itself is bounded, not only the clamp");
            }
        }
    }

    #[test]
    fn real_time_force_is_finite_whatever_comes_in(
        law in any_elasto_plastic(),
        z in any::<f64>(),
        force in any::<f64>(),
        samples in prop::collection::vec((any::<f64>(), any::<f64>()), 1..20),
    ) {
        let mut state = State { z, force };
        for (h, v) in samples {
            let out = law.step(&mut state, h, v);
            prop_assert!(out.is_finite() && out == state.force && inside(&law, state.z));
        }
    }

    #[test]
    fn turning_the_axis_round_turns_every_sign(
        law in any_elasto_plastic(), h in 1e-5..1e-2, motion in motion(),
    ) {
        let turned = ElastoPlastic::new(mirrored(law.bristle()), law.breakaway()).unwrap();
        let (mut z, mut zt) = (0.0, 0.0);
        let (mut state, mut state_t) = (law.rest(), turned.rest());
        for ends in motion.windows(2) {
            z = law.step_record(z, h, ends[0], ends[1]);
            zt = turned.step_record(zt, h, -ends[0], -ends[1]);
            prop_assert_eq!(z, -zt);
            prop_assert_eq!(law.step(&mut state, h, ends[1]), -turned.step(&mut state_t, h, -ends[1]));
        }
    }

    #[test]
    fn results_do_not_depend_on_units(law in any_elasto_plastic(), h in 1e-5..1e-2, motion in motion(),
        force in 1e-3..1e3, length in 1e-6..1e3, time in 1e-3..1e3) {
        let bristle = in_units(law.bristle(), force, length, time);
        let other = ElastoPlastic::new(bristle, law.breakaway()).unwrap();
        // Rounding grows with the steepness of alpha.
        let steep = 1.0 / (1.0 - law.breakaway());
        let (mut z, mut zo) = (0.0, 0.0);
        for ends in motion.windows(2) {
            z = law.step_record(z, h, ends[0], ends[1]);
            zo = other.step_record(zo, h * time, ends[0] * length / time, ends[1] * length / time);
            prop_assert!((z * length - zo).abs() <= 1e-11 * steep * other.bound(), "{} {zo}", z * length);
        }
    }

    #[test]
    fn f32_agrees_with_f64(shape in any_shape(), ratio in 0.05..0.9, h in 1e-4..1e-2, motion in motion()) {
        let law = ElastoPlastic::new(lopsided(shape, Damping::Capped(600.0)), ratio).unwrap();
        let small = law.cast::<f32>().unwrap();
        let (mut z, mut zs) = (0.0_f64, 0.0_f32);
        for ends in motion.windows(2) {
            z = law.step_record(z, h, ends[0], ends[1]);
            zs = small.step_record(zs, h as f32, ends[0] as f32, ends[1] as f32);
            prop_assert!((z - f64::from(zs)).abs() < 2e-5 * law.bound(), "{z} {zs}");
        }
    }

    /// The energy balance of LuGre's capped damping holds here too, for every sample.
    #[test]
    fn capped_damping_dissipates_in_every_sample_of_any_motion(
        law in any_law(),
        ratio in 0.02..0.98,
        s1 in -3.0..6.0,
        h in prop_oneof![1e-6..1e-4, 1e-4..1e-2],
        motion in prop::collection::vec((-7.0..1.0_f64, any::<bool>()), 2..60),
    ) {
        let bristle = law.with_damping(Damping::Capped(10f64.powf(s1))).unwrap();
        let law = ElastoPlastic::new(bristle, ratio).unwrap();
        let mut state = law.rest();
        for (e, up) in motion {
            let v = if up { 10f64.powf(e) } else { -10f64.powf(e) };
            let scale = (bristle.curve().largest_static_level() + bristle.micro_damping(v) * v.abs()
                + bristle.curve().offset().abs() + state.force.abs()) * v.abs() * h
                + bristle.stiffness() * bristle.bound() * bristle.bound();
            let before = state.z;
            let force = law.step(&mut state, h, v) - bristle.curve().offset();
            let lost = force * v * h
                - 0.5 * bristle.stiffness() * (state.z - before) * (state.z + before);
            prop_assert!(lost >= -1e-13 * scale, "{lost} J");
        }
    }
}

/// In flowing time: the dissipated power at any state that can occur, sigma1 far above the cap.
#[test]
fn capped_law_dissipates_at_every_state() {
    for (fs, s2) in [(1.01, 0.0), (1.5, 0.4), (5.0, 2.0)] {
        for ratio in [0.1, 0.5, 0.9] {
            let side = direction(1.0, fs, 1e-3, s2);
            let curve = stiction_friction::Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
            let bristle = LuGre::new(1e5, Damping::Capped(1e9), curve).unwrap();
            let law = ElastoPlastic::new(bristle, ratio).unwrap();
            for load in -500..=500 {
                let z = law.bound() * f64::from(load) / 500.0;
                for i in 0..120 {
                    let v = 10f64.powf(-5.0 + 0.05 * f64::from(i));
                    for v in [v, -v] {
                        let power = law.force(z, v) * v
                            - bristle.stiffness() * z * law.deflection_rate(z, v);
                        let scale = (bristle.stiffness() * law.bound()
                            + bristle.micro_damping(v) * v.abs())
                            * v.abs();
                        assert!(
                            power >= -1e-12 * scale,
                            "{fs} {s2} {ratio} {load} {v}: {power} W"
                        );
                    }
                }
            }
        }
    }
}
