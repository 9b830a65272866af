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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn it_is_the_laws_step(
        shape in 0usize..4, damping in 0usize..4,
        speed in -6.0..0.0_f64, negative: bool, share in -1.0..1.0_f64, h in -5.0..-3.0_f64,
    ) {
        let law = law(shape, damping);
        let (h, v) = (10f64.powf(h), 10f64.powf(speed) * if negative { -1.0 } else { 1.0 });
        let z = share * law.bound();
        let sweep = law.sweep(h, v);
        prop_assert_eq!(sweep.velocity(), v);

        let end = law.hold(z, h, v);
        let (change, change_slope) = sweep.change(z);
        prop_assert!((z + change - end).abs() <= 1e-14 * law.bound(), "{} {end}", z + change);
        let force = law.mean_force(z, end, h, v);
        let (found, slope) = sweep.mean_force(z);
        // The change of the deflection is a difference: its rounding comes back by sigma1/h.
        let room = 1e-13 * law.reach(h) + 1e-13 * force.abs();
        prop_assert!((found - force).abs() <= room, "{found} {force}");

        // Central differences, away from the corner that a cap begins with.
        let d = 1e-5 * v.abs();
        let (below, above) = (law.sweep(h, v - d), law.sweep(h, v + d));
        let quotient = |low: f64, high: f64| (high - low) / (2.0 * d);
        let by_change = quotient(below.change(z).0, above.change(z).0);
        let scale = law.bound() / v.abs();
        prop_assert!((by_change - change_slope).abs() <= 1e-7 * scale, "{by_change} {change_slope}");
        let s1 = |v: f64| law.micro_damping(v);
        let at_rest = law.damping().at_rest();
        let corner = s1(v - d) == at_rest && s1(v + d) < at_rest || s1(v + d) == at_rest && s1(v - d) < at_rest;
        if !corner {
            let by_force = quotient(below.mean_force(z).0, above.mean_force(z).0);
            let scale = (law.reach(h) + force.abs()) / v.abs();
            prop_assert!((by_force - slope).abs() <= 1e-7 * scale, "{by_force} {slope}");
        }
    }
}
