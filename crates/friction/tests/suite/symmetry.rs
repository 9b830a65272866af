//! What must not depend on the direction of motion, on units, or on the number type.

use crate::common::*;
use proptest::prelude::*;
use stiction_friction::{CoulombViscous, Damping, LuGre, Shape, State, Stribeck};

/// Deflections and forces of all forms along a motion.
fn run(law: &LuGre<f64>, h: f64, motion: &[f64]) -> Vec<(f64, f64)> {
    let (mut z, mut state) = (0.0, law.rest());
    let mut out = Vec::new();
    for ends in motion.windows(2) {
        z = law.step_record(z, h, ends[0], ends[1]);
        out.push((z, law.force(z, ends[1])));
        let force = law.step(&mut state, h, ends[1]);
        out.push((state.z, force));
    }
    out
}

proptest! {
    #[test]
    fn turning_the_axis_round_turns_every_sign(law in any_law(), h in 1e-5..1e-2, motion in motion()) {
        let turned: Vec<f64> = motion.iter().map(|v| -v).collect();
        for ((z, f), (zt, ft)) in run(&law, h, &motion).iter().zip(run(&mirrored(&law), h, &turned)) {
            prop_assert_eq!(*z, -zt);
            prop_assert_eq!(*f, -ft);
        }
    }

    #[test]
    fn results_do_not_depend_on_units(law in any_law(), h in 1e-5..1e-2, motion in motion(),
        force in 1e-3..1e3, length in 1e-6..1e3, time in 1e-3..1e3) {
        let other = in_units(&law, force, length, time);
        let moved: Vec<f64> = motion.iter().map(|v| v * length / time).collect();
        for ((z, f), (zo, fo)) in run(&law, h, &motion).iter().zip(run(&other, h * time, &moved)) {
            prop_assert!((z * length - zo).abs() <= 1e-11 * other.bound());
            // Rounding is that of the terms, which may be far larger than their sum. |v| <= 1 m/s.
            let c = law.curve();
            let (p, n) = (c.positive(), c.negative());
            let ratio = c.largest_static_level() / p.coulomb.min(n.coulomb);
            let terms = c.largest_static_level() + law.damping().at_rest() * (1.0 + ratio)
                + p.viscous.max(n.viscous) + c.offset().abs();
            prop_assert!((f * force - fo).abs() <= 1e-11 * terms * force, "{} {}", f * force, fo);
        }
    }

    #[test]
    fn f32_agrees_with_f64(shape in any_shape(), h in 1e-4..1e-2, motion in motion()) {
        let law = lopsided(shape, Damping::Capped(600.0));
        let small: LuGre<f32> = law.cast().unwrap();
        let (mut z, mut zs) = (0.0_f64, 0.0_f32);
        let (mut state, mut state_s) = (law.rest(), small.rest());
        for ends in motion.windows(2) {
            z = law.step_record(z, h, ends[0], ends[1]);
            zs = small.step_record(zs, h as f32, ends[0] as f32, ends[1] as f32);
            prop_assert!((z - f64::from(zs)).abs() < 2e-5 * law.bound(), "{z} {zs}");
            let f = law.step(&mut state, h, ends[1]);
            let fs = small.step(&mut state_s, h as f32, ends[1] as f32);
            prop_assert!((f - f64::from(fs)).abs() < 2e-5 * (31.0 + f.abs()), "{f} {fs}");
        }
    }
}

#[test]
fn static_laws_are_odd_and_agree_with_each_other() {
    let plain = CoulombViscous::symmetric(20.0, 60.0, 0.0).unwrap();
    let flat =
        Stribeck::symmetric(Shape::Gaussian, direction(20.0, 20.0, 1e-3, 60.0), 0.0).unwrap();
    for v in [0.0, 1e-9, 1e-3, 0.2, 5.0] {
        assert_eq!(plain.force(-v), -plain.force(v));
        assert_eq!(flat.force(v), plain.force(v));
    }
    let sided = CoulombViscous::new([20.0, 17.0], [60.0, 70.0], -3.0).unwrap();
    assert_eq!(sided.force(0.1), 23.0);
    assert_eq!(sided.force(-0.1), -27.0);
}

/// A law at a steady velocity settles on its own steady curve, in both directions and every shape.
#[test]
fn sliding_settles_on_the_steady_curve() {
    for shape in [
        Shape::Gaussian,
        Shape::Exponential,
        Shape::Power(0.7),
        Shape::Lorentzian,
    ] {
        let law = lopsided(shape, Damping::Capped(600.0));
        for v in [-0.3, -4e-3, -1e-4, 1e-4, 3e-3, 0.1] {
            let mut state = State { z: 0.0, force: 0.0 };
            for _ in 0..100 {
                law.step(&mut state, 2.0, v);
            }
            let steady = law.curve().force(v);
            assert!((state.force / steady - 1.0).abs() < 1e-12, "{shape:?} {v}");
            assert!((law.force(state.z, v) / steady - 1.0).abs() < 1e-12);
        }
        assert_eq!(law.curve().force(0.0), -3.0);
        assert_eq!(law.curve().static_level(1.0), 31.0);
        assert_eq!(law.curve().static_level(-1.0), 17.0);
    }
}
