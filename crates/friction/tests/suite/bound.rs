//! No finite input leads a deflection out of its bound, or to something that is not a number.

use crate::common::*;
use proptest::prelude::*;
use stiction_friction::{Damping, LuGre, Shape, State};

fn inside(law: &LuGre<f64>, z: f64) -> bool {
    z.abs() <= law.bound() * (1.0 + 1e-12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn record_step_keeps_the_bound(
        law in any_law(),
        start in -1.0..=1.0,
        h in any_time_step(),
        record in prop::collection::vec(any_velocity(), 2..40),
    ) {
        let mut z = start * law.bound();
        for ends in record.windows(2) {
            z = law.step_record(z, h, ends[0], ends[1]);
            prop_assert!(inside(&law, z), "z {z} of {}", law.bound());
        }
    }

    #[test]
    fn held_step_keeps_the_bound(
        law in any_law(),
        start in -1.0..=1.0,
        h in any_time_step(),
        record in prop::collection::vec(any_velocity(), 1..40),
    ) {
        let mut z = start * law.bound();
        let mut unclamped = z;
        for v in record {
            z = law.step_held(z, h, v);
            prop_assert!(inside(&law, z));
            if h > 1e-100 && h < 1e3 {
                unclamped = law.step_held_slope(unclamped, h, v).0;
                prop_assert!(inside(&law, unclamped), "the map itself is bounded, not only the clamp");
            }
        }
    }

    #[test]
    fn real_time_force_is_finite_whatever_comes_in(
        law in any_law(),
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
}

/// A long creep towards the bound with very small steps, where rounding has the best chance to add up.
#[test]
fn a_million_small_steps_do_not_creep_over_the_bound() {
    let law = c95(Damping::Constant);
    let mut z = law.bound() * (1.0 - 1e-9);
    for k in 0..1_000_000 {
        let v = 1e-7 * (1.0 + 0.5 * f64::from(k % 7));
        z = law.step_record(z, 1e-4, v, v);
        assert!(inside(&law, z), "step {k}: {z}");
    }
}

#[test]
fn a_bad_sample_repeats_the_last_force() {
    let law = lopsided(Shape::Gaussian, Damping::Capped(600.0));
    let mut state = law.rest();
    assert_eq!(
        law.step(&mut state, 1e-3, f64::NAN),
        -3.0,
        "before any good sample: the offset"
    );
    let good = law.step(&mut state, 1e-3, 0.01);
    let before = state;
    for (h, v) in [
        (1e-3, f64::NAN),
        (1e-3, f64::INFINITY),
        (f64::NAN, 0.01),
        (-1e-3, 0.01),
    ] {
        assert_eq!(law.step(&mut state, h, v), good);
        assert_eq!(state, before);
    }
    assert_ne!(law.step(&mut state, 1e-3, 0.01), good);
}

proptest! {
    #[test]
    fn zero_input_keeps_the_deflection(law in any_law(), start in -1.0..=1.0, h in any_time_step()) {
        let z = start * law.bound();
        prop_assert_eq!(law.step_record(z, h, 0.0, 0.0), z);
        prop_assert_eq!(law.step_held(z, h, 0.0), z);
        let mut state = State { z, ..law.rest() };
        law.step(&mut state, h, 0.0);
        prop_assert_eq!(state.z, z);
    }
}
