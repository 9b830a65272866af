//! The generalised Maxwell-slip law: against numbers of SciPy, closed forms, and its non-local memory.

use crate::common::*;
use proptest::prelude::*;
use stiction_friction::{Damping, Element, Elements, Gms, GmsState, MaxwellSlip, Shape, Stribeck};

const TAU: f64 = 2.0 * std::f64::consts::PI;

fn curve(shape: Shape<f64>) -> Stribeck<f64> {
    *lopsided(shape, Damping::Constant(0.0)).curve()
}

fn elements<const N: usize>(numbers: [(f64, f64); N]) -> [Element<f64>; N] {
    numbers.map(|(stiffness, share)| Element { stiffness, share })
}

const THREE: [(f64, f64); 3] = [(8e4, 0.5), (3e4, 0.3), (1e4, 0.2)];

fn three(attraction: f64) -> Gms<f64, 3> {
    Gms::new(elements(THREE), attraction, 0.0, curve(Shape::Gaussian)).unwrap()
}

fn two_tones(t: f64) -> f64 {
    8e-3 * (TAU * 1.03 * t + 0.3).sin() + 3e-3 * (TAU * 7.7 * t).sin()
}

/// Sum of the spring forces at `dt, 2 dt, ...` with `per` steps in each `dt`.
fn run<const N: usize>(
    law: &Gms<f64, N>,
    v: impl Fn(f64) -> f64,
    dt: f64,
    n: usize,
    per: usize,
) -> Vec<f64> {
    let h = dt / per as f64;
    let mut at = Elements::default();
    (0..n)
        .map(|k| {
            for i in k * per..(k + 1) * per {
                at = law.step_record(at, h, v(i as f64 * h), v((i + 1) as f64 * h));
            }
            at.total()
        })
        .collect()
}

/// Sums in N every 97.3 ms by `other_laws.py`: SciPy's DOP853 on the published equations, with events.
#[test]
fn follows_the_published_equations() {
    let expected = [
        23.85908543,
        21.35387764,
        21.50349021,
        25.99403025,
        13.35639422,
        -10.93790412,
        -14.01036504,
        -14.00077399,
        -14.13832427,
        6.925408174,
        21.32430367,
        22.4392221,
    ];
    let got = run(&three(400.0), two_tones, 0.0973, 12, 20_000);
    for (got, expected) in got.iter().zip(expected) {
        assert!((got - expected).abs() < 1e-6, "{got} {expected}");
    }
}

#[test]
fn the_record_step_is_of_second_order() {
    for shape in [Shape::Gaussian, Shape::Exponential, Shape::Lorentzian] {
        for attraction in [60.0, 400.0, 1e4] {
            let law = Gms::new(elements(THREE), attraction, 0.0, curve(shape)).unwrap();
            // Zeros and break-aways at no multiple of any step used; the mean of many motions, since where in its step
            // an event falls decides how large its error is.
            let mut squares = [0.0; 4];
            for phase in 0..25 {
                let v = |t: f64| 8e-3 * (TAU * 1.03 * t + 0.08 * f64::from(phase)).sin();
                let truth = run(&law, v, 4e-3, 100, 640);
                for (sum, per) in squares.iter_mut().zip([4, 8, 16, 32]) {
                    let at = run(&law, v, 4e-3, 100, per);
                    *sum += at
                        .iter()
                        .zip(&truth)
                        .map(|(a, b)| (a - b) * (a - b))
                        .sum::<f64>();
                }
            }
            let order = (squares[0] / squares[3]).log2() / 6.0;
            assert!(
                (order - 2.0).abs() < 0.15,
                "{shape:?} {attraction}: {order}"
            );
        }
    }
}

/// At a held velocity one step equals a thousand, break-aways included, and slip follows its closed form.
#[test]
fn a_held_velocity_is_exact() {
    let law = three(400.0);
    for v in [2e-3, -7e-4] {
        let one = law.step_held(Elements::default(), 0.2, v);
        let mut many = Elements::default();
        for _ in 0..1000 {
            many = law.step_held(many, 0.2e-3, v);
        }
        for (a, b) in one.force.iter().zip(&many.force) {
            assert!((a - b).abs() < 1e-11 * a.abs(), "{v}: {a} {b}");
        }
        assert_eq!(one.slips, many.slips);
    }
    // From its limit at rest, 31 N, to that at high speed, 20 N, with the time constant g/C = 20 N/400 N/s.
    let mut at = law.step_record(Elements::default(), 10.0, 0.0, 1e-6);
    for _ in 0..1000 {
        at = law.step_record(at, 10.0, 1e-6, 1e-6);
    }
    assert!((at.total() - 31.0).abs() < 1e-3, "{}", at.total());
    let jump = law.step_held(at, 0.03, 1.0);
    let expected = 20.0 + (at.total() - 20.0) * (-0.03_f64 * 400.0 / 20.0).exp();
    assert!(
        (jump.total() - expected).abs() < 1e-11,
        "{} {expected}",
        jump.total()
    );
}

/// Masing's rules in presliding: an inner loop closes where it began and leaves no trace. LuGre's does not close.
#[test]
fn inner_loops_close_and_are_wiped_out() {
    let flat = Stribeck::symmetric(Shape::Gaussian, direction(20.0, 20.0, 1e-3, 0.0), 0.0).unwrap();
    let law = Gms::new(elements(THREE), 1e6, 0.0, flat).unwrap();
    let lugre = stiction_friction::LuGre::new(1.2e5, Damping::Constant(0.0), flat).unwrap();
    let go = |mut at: Elements<f64, 3>, mut z: f64, distance: f64| {
        // Sine-shaped, from rest to rest.
        let (n, h) = (2000, 1e-3);
        let v = |k: f64| {
            distance * TAU / 4.0 * (TAU / 2.0 * k / f64::from(n)).sin() / (f64::from(n) * h)
        };
        let scale = (0..n)
            .map(|k| 0.5 * h * (v(f64::from(k)) + v(f64::from(k + 1))))
            .sum::<f64>()
            / distance;
        for k in 0..n {
            let (va, vb) = (v(f64::from(k)) / scale, v(f64::from(k + 1)) / scale);
            at = law.step_record(at, h, va, vb);
            z = lugre.step_record(z, h, va, vb);
        }
        (at, z)
    };
    let near = |a: &Elements<f64, 3>, b: &Elements<f64, 3>| {
        a.force
            .iter()
            .zip(&b.force)
            .all(|(a, b)| (a - b).abs() < 1e-9)
    };
    // Out to 200 um, back by 150, forth by 80, back by 40.
    let (outer, z0) = go(Elements::default(), 0.0, 200e-6);
    let (low, z1) = go(outer, z0, -150e-6);
    let (high, z2) = go(low, z1, 80e-6);
    let (inner, z3) = go(high, z2, -40e-6);
    // Up again by 40: the innermost loop closes.
    let (closed, z4) = go(inner, z3, 40e-6);
    assert!(near(&closed, &high), "{closed:?} {high:?}");
    assert!(
        (z4 - z2).abs() * 1.2e5 > 0.02 * 20.0,
        "LuGre misses by 2 % of Fc: {z4} {z2}"
    );
    // Back by 80: the next one closes, and by 30 more the way goes on as if neither had been.
    let (closed, _) = go(closed, z4, -80e-6);
    assert!(near(&closed, &low));
    let (on, _) = go(closed, 0.0, -30e-6);
    let (direct, _) = go(outer, 0.0, -180e-6);
    assert!(near(&on, &direct), "{on:?} {direct:?}");
    // And the outermost closes when the first turning point is reached again.
    let (back, _) = go(on, 0.0, 180e-6);
    assert!(near(&back, &outer));
}

/// Coming to rest and moving on changes no force at once, in either direction.
#[test]
fn the_force_is_continuous_at_rest() {
    let law = Gms::new(elements(THREE), 400.0, 50.0, curve(Shape::Gaussian)).unwrap();
    let mut at = Elements::default();
    for k in 0..1000 {
        let v = |k: i32| 5e-3 * (1.0 - f64::from(k) / 1000.0);
        at = law.step_record(at, 1e-3, v(k), v(k + 1));
    }
    assert_eq!(at.slips, [false; 3]);
    let rest = law.force(&at, 0.0);
    for v in [1e-12, -1e-12] {
        assert!((law.force(&at, v) - rest).abs() < 1e-6);
        let next = law.step_record(at, 1e-3, 0.0, v);
        assert!((law.force(&next, v) - rest).abs() < 1e-6);
        assert_eq!(law.step_record(at, 1e-3, 0.0, 0.0), at);
    }
}

#[test]
fn sliding_settles_on_the_steady_curve() {
    for attraction in [50.0, 1e4, f64::INFINITY] {
        let law = Gms::new(elements(THREE), attraction, 600.0, curve(Shape::Gaussian)).unwrap();
        for v in [-0.3, -4e-3, -1e-4, 1e-4, 3e-3, 0.1] {
            let mut state = law.rest();
            for _ in 0..100 {
                law.step(&mut state, 10.0, v);
            }
            let steady = law.curve().force(v);
            assert!(
                (state.force / steady - 1.0).abs() < 1e-12,
                "{attraction} {v}"
            );
            assert!((law.force(&state.elements, v) / steady - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn a_law_of_counted_elements_is_that_of_its_number() {
    let law = three(400.0);
    let counted = MaxwellSlip::new(law.elements(), law.attraction(), *law.curve()).unwrap();
    assert_eq!(counted.elements().len(), 3);
    assert_eq!(counted.gms::<3>().unwrap().curve(), law.curve());
    assert!(counted.gms::<2>().is_none());
    let none: [Element<f64>; 0] = [];
    let many = [law.elements()[0]; 11];
    for wrong in [&none[..], &many[..]] {
        let refused = MaxwellSlip::new(wrong, 1.0, *law.curve()).unwrap_err();
        assert_eq!((refused.name, refused.allowed), ("elements", "1 to 10"));
    }
    // The last slips where its share of the level is reached.
    let last = law
        .elements()
        .iter()
        .map(|e| e.share * law.bound() / e.stiffness);
    assert_eq!(counted.longest_yield(), last.fold(0.0, f64::max));
}

#[test]
fn slope_of_the_held_step_matches_differences() {
    let law = three(400.0);
    let mut at = Elements::default();
    for k in 0..4000 {
        let t = 5e-4 * f64::from(k);
        at = law.step_record(at, 5e-4, two_tones(t), two_tones(t + 5e-4));
        if k % 37 != 0 {
            continue;
        }
        for v in [-0.2, -3e-3, -1e-5, 1e-5, 2e-3, 0.3] {
            let h = 2e-3;
            let (end, slope) = law.total_held_slope(&at, h, v);
            assert!((end - law.step_held(at, h, v).total()).abs() < 1e-12 * law.bound());
            let d = 1e-5 * v;
            let numeric = (law.total_held_slope(&at, h, v + d).0
                - law.total_held_slope(&at, h, v - d).0)
                / (2.0 * d);
            let scale = slope.abs().max(1e-3 * h * law.stiffness());
            assert!(
                (slope - numeric).abs() < 1e-4 * scale,
                "v {v} {at:?}: {slope} {numeric}"
            );
        }
    }
}

#[test]
fn every_parameter_is_named_when_out_of_range() {
    let curve = curve(Shape::Gaussian);
    let name = |k: f64, nu: f64, c: f64, s1: f64| {
        Gms::new(elements([(k, nu), (1e4, 0.5)]), c, s1, curve)
            .unwrap_err()
            .name
    };
    assert_eq!(name(0.0, 0.5, 1.0, 0.0), "element_stiffness");
    assert_eq!(name(f64::INFINITY, 0.5, 1.0, 0.0), "element_stiffness");
    assert_eq!(name(1e4, -0.5, 1.0, 0.0), "element_share");
    assert_eq!(name(1e4, f64::NAN, 1.0, 0.0), "element_share");
    assert_eq!(name(1e4, 0.5, 0.0, 0.0), "attraction");
    assert_eq!(name(1e4, 0.5, f64::NAN, 0.0), "attraction");
    assert_eq!(name(1e4, 0.5, 1.0, -1.0), "sigma1");
    let huge = elements([(f64::MAX, 0.5), (f64::MAX, 0.5)]);
    let error = Gms::new(huge, 1.0, 0.0, curve).unwrap_err();
    assert_eq!(error.name, "sum of element_stiffness");
    let none: [Element<f64>; 0] = [];
    assert_eq!(
        Gms::new(none, 1.0, 0.0, curve).unwrap_err().name,
        "elements"
    );
    let many = elements([(1e4, 0.1); 11]);
    assert_eq!(
        Gms::new(many, 1.0, 0.0, curve).unwrap_err().to_string(),
        "elements = 11; allowed: 1 to 10"
    );
    // Only ratios count.
    let twice = elements(THREE.map(|(k, nu)| (k, 7.0 * nu)));
    let law = Gms::new(twice, 400.0, 0.0, curve).unwrap();
    for (element, (_, nu)) in law.elements().iter().zip(THREE) {
        assert!((element.share / nu - 1.0).abs() < 1e-15);
    }
}

fn any_gms() -> impl Strategy<Value = Gms<f64, 4>> {
    let element = (0.0..9.0, 0.01..1.0).prop_map(|(e, share)| Element {
        stiffness: 10f64.powf(e),
        share,
    });
    let attraction =
        prop_oneof![4 => (-2.0..8.0).prop_map(|e| 10f64.powf(e)), 1 => Just(f64::INFINITY)];
    (
        prop::array::uniform4(element),
        attraction,
        0.0..1e4,
        any_curve(),
    )
        .prop_map(|(elements, c, s1, curve)| Gms::new(elements, c, s1, curve).unwrap())
}

fn inside(law: &Gms<f64, 4>, at: &Elements<f64, 4>) -> bool {
    at.force
        .iter()
        .zip(law.elements())
        .all(|(f, e)| f.abs() <= e.share * law.bound() * (1.0 + 1e-12))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn no_step_leaves_the_bound(
        law in any_gms(),
        start in prop::array::uniform4(-1.0..=1.0_f64),
        h in any_time_step(),
        record in prop::collection::vec(any_velocity(), 2..40),
    ) {
        let mut at = Elements::default();
        for ((force, part), element) in at.force.iter_mut().zip(start).zip(law.elements()) {
            *force = part * element.share * law.bound();
        }
        for ends in record.windows(2) {
            at = law.step_record(at, h, ends[0], ends[1]);
            prop_assert!(inside(&law, &at), "{at:?}");
        }
    }

    #[test]
    fn real_time_force_is_finite_whatever_comes_in(
        law in any_gms(),
        force in prop::array::uniform4(any::<f64>()),
        slips: [bool; 4],
        forward: bool,
        last in any::<f64>(),
        samples in prop::collection::vec((any::<f64>(), any::<f64>()), 1..20),
    ) {
        let mut state = GmsState { elements: Elements { force, slips, forward }, force: last };
        for (h, v) in samples {
            let out = law.step(&mut state, h, v);
            prop_assert!(out.is_finite() && out == state.force && inside(&law, &state.elements));
        }
    }

    #[test]
    fn turning_the_axis_round_turns_every_sign(law in any_gms(), h in 1e-5..1e-2, motion in motion()) {
        let c = law.curve();
        let other = Stribeck::new(c.shape(), *c.negative(), *c.positive(), -c.offset()).unwrap();
        let turned = Gms::new(*law.elements(), law.attraction(), law.damping(), other).unwrap();
        // Made of the same shares: dividing by their sum, 1 to rounding, may move them by a bit.
        let law = Gms::new(*law.elements(), law.attraction(), law.damping(), *c).unwrap();
        let (mut at, mut at_t) = (law.rest(), turned.rest());
        for ends in motion.windows(2) {
            at.elements = law.step_record(at.elements, h, ends[0], ends[1]);
            at_t.elements = turned.step_record(at_t.elements, h, -ends[0], -ends[1]);
            prop_assert_eq!(at.elements.force.map(|f| -f), at_t.elements.force);
            prop_assert_eq!(law.step(&mut at, h, ends[0]), -turned.step(&mut at_t, h, -ends[0]));
        }
    }

    #[test]
    fn results_do_not_depend_on_units(
        law in any_gms(), s0 in 1.0..1e6, h in 1e-5..1e-2, motion in motion(),
        force in 1e-3..1e3, length in 1e-6..1e3, time in 1e-3..1e3,
    ) {
        let bristle = stiction_friction::LuGre::new(s0, Damping::Constant(law.damping()), *law.curve()).unwrap();
        let bristle = in_units(&bristle, force, length, time);
        let elements = law.elements().map(|e| Element { stiffness: e.stiffness * force / length, ..e });
        let c = law.attraction() * force / time;
        let other = Gms::new(elements, c, bristle.damping().at_rest(), *bristle.curve()).unwrap();
        let (mut at, mut ot) = (Elements::default(), Elements::default());
        for ends in motion.windows(2) {
            at = law.step_record(at, h, ends[0], ends[1]);
            ot = other.step_record(ot, h * time, ends[0] * length / time, ends[1] * length / time);
            for (a, b) in at.force.iter().zip(&ot.force) {
                prop_assert!((a * force - b).abs() <= 1e-11 * other.bound(), "{} {b}", a * force);
            }
        }
    }

    #[test]
    fn f32_agrees_with_f64(c in 1.0..1e4, h in 1e-4..1e-2, motion in motion()) {
        let law = three(c);
        let small = law.cast::<f32>().unwrap();
        let (mut at, mut at_s) = (Elements::default(), Elements::default());
        for ends in motion.windows(2) {
            at = law.step_record(at, h, ends[0], ends[1]);
            at_s = small.step_record(at_s, h as f32, ends[0] as f32, ends[1] as f32);
            prop_assert!((at.total() - f64::from(at_s.total())).abs() < 5e-5 * law.bound());
        }
    }

    /// With a flat curve slipping elements stand on their limit, and every sample dissipates, at any sigma1.
    #[test]
    fn a_flat_curve_dissipates_in_every_sample(
        law in any_gms(),
        h in 1e-6..1e-2,
        motion in prop::collection::vec((-7.0..1.0_f64, any::<bool>()), 2..60),
    ) {
        let flat = |d: &stiction_friction::Direction<f64>| direction(d.coulomb, d.coulomb, d.stribeck_velocity, d.viscous);
        let level = flat(law.curve().positive());
        let curve = Stribeck::symmetric(law.curve().shape(), level, 0.0).unwrap();
        let law = Gms::new(*law.elements(), law.attraction(), law.damping(), curve).unwrap();
        let stored = |at: &Elements<f64, 4>| at.force.iter().zip(law.elements())
            .map(|(f, e)| 0.5 * f * f / e.stiffness).sum::<f64>();
        let mut state = law.rest();
        for (e, up) in motion {
            let v = if up { 10f64.powf(e) } else { -10f64.powf(e) };
            let before = stored(&state.elements);
            let force = law.step(&mut state, h, v);
            let lost = force * v * h - (stored(&state.elements) - before);
            let scale = force.abs() * v.abs() * h + before + stored(&state.elements);
            prop_assert!(lost >= -1e-12 * scale, "{lost} J of {scale}");
        }
    }

    /// A compensator's elements give back no energy, with any curve, attraction and motion, and are those of the law wherever it
    /// loads none of them without motion.
    #[test]
    fn elements_of_a_compensator_are_passive(
        law in any_gms(),
        h in 1e-6..1e-2,
        motion in prop::collection::vec((-7.0..1.0_f64, any::<bool>()), 2..60),
    ) {
        let passive = MaxwellSlip::new(law.elements(), law.attraction(), *law.curve()).unwrap();
        // Made once of shares whose sum is 1 to rounding.
        let law = passive.gms::<4>().unwrap();
        let stored = |force: &[f64]| force.iter().zip(law.elements())
            .map(|(f, e)| 0.5 * f * f / e.stiffness).sum::<f64>();
        let mut state = passive.rest();
        for (e, up) in motion {
            let v = if up { 10f64.powf(e) } else { -10f64.powf(e) };
            let before = state.elements;
            let held = law.step_held(
                Elements { force: before.force[..4].try_into().unwrap(), slips: before.slips[..4].try_into().unwrap(), forward: before.forward },
                h,
                v,
            );
            let force = passive.step(&mut state, h, v) - law.curve().offset();
            let after = &state.elements;
            for (i, element) in law.elements().iter().enumerate() {
                let most = element.stiffness * h * v.abs();
                let loaded = v.signum() * (held.force[i] - before.force[i]);
                let due = if loaded > most { before.force[i] + v.signum() * most } else { held.force[i] };
                prop_assert!((after.force[i] - due).abs() <= 1e-12 * law.bound());
            }
            let [stored_before, stored_after] = [stored(&before.force[..4]), stored(&after.force[..4])];
            let lost = force * v * h - (stored_after - stored_before);
            let scale = force.abs() * v.abs() * h + stored_before + stored_after + (law.curve().offset() * v * h).abs();
            prop_assert!(lost >= -1e-12 * scale, "{lost} J of {scale}");
        }
    }

    #[test]
    fn a_compensator_is_finite_whatever_comes_in(
        law in any_gms(),
        force in prop::array::uniform10(any::<f64>()),
        slips: [bool; 10],
        forward: bool,
        last in any::<f64>(),
        samples in prop::collection::vec((any::<f64>(), any::<f64>()), 1..20),
    ) {
        let law = MaxwellSlip::new(law.elements(), law.attraction(), *law.curve()).unwrap();
        let mut state = GmsState { elements: Elements { force, slips, forward }, force: last };
        for (h, v) in samples {
            let out = law.step(&mut state, h, v);
            prop_assert!(out.is_finite() && out == state.force);
            prop_assert!(state.elements.force.iter().zip(law.elements())
                .all(|(f, e)| f.abs() <= e.share * law.bound() * (1.0 + 1e-12)));
        }
    }
}
