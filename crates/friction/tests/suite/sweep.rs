//! A step prepared before the deflection is known is the law's own step, and its derivatives are those of its values.

use proptest::prelude::*;
use stiction_friction::{Damping, Direction, Held, LuGre, Shape, Stribeck};

fn law(shape: usize, damping: usize) -> LuGre<f64> {
    let side = |coulomb: f64| Direction {
        coulomb,
        static_friction: 1.5 * coulomb,
        stribeck_velocity: 5e-3,
        viscous: 60.0,
    };
    let shapes = [
        Shape::Gaussian,
        Shape::Exponential,
        Shape::Power(1.3),
        Shape::Lorentzian,
    ];
    let dampings = [
        Damping::Constant(600.0),
        Damping::Capped(600.0),
        // The cap bites at speed.
        Damping::Capped(1e5),
        Damping::Olsson {
            sigma1: 600.0,
            velocity: 1e-3,
        },
    ];
    let curve = Stribeck::new(shapes[shape], side(20.0), side(23.0), -1.5).expect("in range");
    LuGre::new(1.2e5, dampings[damping], curve).expect("in range")
}

/// The mean force over a step as its definition has it, without what bounds the correction; and whether a bound holds.
fn by_definition(law: &LuGre<f64>, z: f64, start: f64, h: f64, mass: f64, v: f64) -> (f64, bool) {
    let (stiffness, sign) = (law.stiffness(), if v < 0.0 { -1.0 } else { 1.0 });
    let (g, g_slope) = law.curve().level_and_slope(v);
    let (a, end) = (stiffness * h * v.abs() / g, law.hold(z, h, v));
    let (change, mean) = (end - z, 0.5 * (z + end));
    let c = 1.0 / (1.0 + stiffness * h * h / (12.0 * mass));
    // z' = v - sigma0 |v| z/g(v)
    let by_velocity = 1.0 - sign * stiffness * mean / g * (1.0 - v * g_slope / g);
    let rises = 2.0 * (v - start) * by_velocity / (1.0 + a * a);
    let relaxes = -a / h * change / (1.0 + a * a / 60.0);
    let off = c * h / 12.0 * rises;
    let corrected = mean - off - c * h / 12.0 * relaxes;
    let of_mean = |mean: f64| stiffness * mean + law.micro_damping(v) * change / h;
    let smooth = law.curve().direction(v).viscous * v + law.curve().offset();
    let kept = stiffness * mean * change;
    let bounded = stiffness * off.abs() > 0.25 * g * (1.0 - 1e-9)
        || of_mean(corrected) * v * h < kept + 1e-9 * (stiffness * law.bound() * v * h).abs();
    (of_mean(corrected) + smooth, bounded)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn it_is_the_laws_step(
        shape in 0usize..4, damping in 0usize..4,
        speed in -6.0..0.0_f64, negative: bool, share in -1.0..1.0_f64, h in -5.0..-3.0_f64,
        start in -1.0..3.0_f64, heavy in -1.0..2.0_f64,
    ) {
        let law = law(shape, damping);
        let (h, v) = (10f64.powf(h), 10f64.powf(speed) * if negative { -1.0 } else { 1.0 });
        let (z, start) = (share * law.bound(), start * v);
        let mass = 10f64.powf(heavy);
        let sweeps = law.sweeps(h, mass);
        let sweep = sweeps.at(v);
        prop_assert_eq!(sweep.velocity(), v);

        let end = law.hold(z, h, v);
        let (change, change_slope) = sweep.change(z);
        prop_assert!((z + change - end).abs() <= 1e-14 * law.bound(), "{} {end}", z + change);
        let force = sweep.mean_force(z, start).0;
        let (defined, bounded) = by_definition(&law, z, start, h, mass, v);
        // The change of the deflection is a difference: its rounding comes back by sigma1/h.
        let room = 1e-13 * law.reach(h) + 1e-13 * force.abs();
        if !bounded {
            prop_assert!((force - defined).abs() <= room, "{force} {defined}");
        }
        // What is bounded stays near the step without correction, and takes no more than the law from the bristles.
        let plain = law.mean_force(z, end, h, v);
        let most = 2.0 * law.stiffness() * law.bound();
        prop_assert!((force - plain).abs() <= most + room, "{force} {plain}");
        let smooth = law.curve().direction(v).viscous * v + law.curve().offset();
        let balance = |force: f64| (force - smooth) * v * h - 0.5 * law.stiffness() * (end * end - z * z);
        let least = balance(plain).min(0.0) - room * v.abs() * h;
        prop_assert!(balance(force) >= least, "{} {}", balance(force), balance(plain));

        // Central differences, away from the corner that a cap begins with.
        let d = 1e-5 * v.abs();
        let (below, above) = (sweeps.at(v - d), sweeps.at(v + d));
        let quotient = |low: f64, high: f64| (high - low) / (2.0 * d);
        let by_change = quotient(below.change(z).0, above.change(z).0);
        let scale = law.bound() / v.abs();
        prop_assert!((by_change - change_slope).abs() <= 1e-7 * scale, "{by_change} {change_slope}");
        let s1 = |v: f64| law.micro_damping(v);
        let at_rest = law.damping().at_rest();
        let corner = s1(v - d) == at_rest && s1(v + d) < at_rest || s1(v + d) == at_rest && s1(v - d) < at_rest;
        // Where the velocity is even, all that the derivative leaves out is how the share of the decay changes.
        if !corner && !by_definition(&law, z, v, h, mass, v).1 {
            let [low, high] = [below, above].map(|s| s.mean_force(z, v).0);
            let (by_force, slope) = (quotient(low, high), sweep.mean_force(z, v).1);
            let (g, g_slope) = law.curve().level_and_slope(v);
            let a_slope = law.stiffness() * h / g * (1.0 - v * g_slope / g);
            let left_out = law.stiffness() * change.abs() / 12.0 * a_slope;
            let scale = (law.reach(h) + force.abs()) / v.abs();
            prop_assert!((by_force - slope).abs() <= 1e-7 * scale + left_out, "{by_force} {slope}");
        }
    }
}

/// However far a search for the velocity goes, it finds the force of a bristle that slides.
#[test]
fn any_velocity_has_a_force() {
    for (shape, damping) in (0..4).flat_map(|s| (0..4).map(move |d| (s, d))) {
        let law = law(shape, damping);
        let sweeps = law.sweeps(1e-3, 10.0);
        for v in [1e3, 1e9, 1e30, 1e100, 1e200] {
            let (force, slope) = sweeps.at(v).mean_force(-law.bound(), 0.0);
            let smooth = 60.0 * v - 1.5;
            let bristle = if v < 1e12 { force - smooth } else { 0.0 };
            assert!(force.is_finite() && slope.is_finite() && bristle.abs() < law.reach(1e-3));
        }
    }
}

#[test]
fn the_bounds_of_the_correction_are_met() {
    let (law, h, mass) = (law(0, 1), 1e-3, 10.0);
    let count = |find: &dyn Fn(f64, f64, f64) -> bool| {
        let mut found = 0;
        for i in -10..=10 {
            for v in [1e-5, 1e-4, 1e-3, -1e-3, 1e-2] {
                for start in [-0.5, -1e-3, 0.0, 1e-3, 0.5] {
                    found += u32::from(find(f64::from(i) / 10.0 * law.bound(), v, start));
                }
            }
        }
        found
    };
    let off = |z: f64, v: f64, start: f64| {
        let sweep = law.sweeps(h, mass).at(v);
        (sweep.mean_force(z, start).0 - sweep.mean_force(z, v).0).abs() / law.curve().level(v)
    };
    assert_eq!(count(&|z, v, start| off(z, v, start) > 0.2500001), 0);
    assert!(count(&|z, v, start| off(z, v, start) > 0.2499999) > 50);
    // Energy would come back: the force is then just what leaves the bristles their own.
    let balanced = |z: f64, v: f64, start: f64| {
        let sweep = law.sweeps(h, mass).at(v);
        let (force, end) = (sweep.mean_force(z, start).0, law.hold(z, h, v));
        let taken = (force - 60.0 * v + 1.5) * v * h;
        (taken / (0.5 * law.stiffness() * (end * end - z * z)) - 1.0).abs() < 1e-9
    };
    assert!(count(&balanced) > 20);
}
