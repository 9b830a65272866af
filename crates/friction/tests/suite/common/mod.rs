//! Laws and random generators shared by the tests.
#![allow(dead_code)]

use proptest::prelude::*;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};

pub fn direction(fc: f64, fs: f64, vs: f64, s2: f64) -> Direction<f64> {
    Direction {
        coulomb: fc,
        static_friction: fs,
        stribeck_velocity: vs,
        viscous: s2,
    }
}

/// Parameters of the 1995 paper (doi 10.1109/9.376053, Table I), in newton form.
pub fn c95(damping: fn(f64) -> Damping<f64>) -> LuGre<f64> {
    let curve = Stribeck::symmetric(Shape::Gaussian, direction(1.0, 1.5, 1e-3, 0.4), 0.0).unwrap();
    LuGre::new(1e5, damping(1e5_f64.sqrt()), curve).unwrap()
}

/// A strongly asymmetric law.
pub fn lopsided(shape: Shape<f64>, damping: Damping<f64>) -> LuGre<f64> {
    let pos = direction(20.0, 31.0, 5e-3, 60.0);
    let neg = direction(14.0, 17.0, 2e-3, 85.0);
    LuGre::new(
        1.2e5,
        damping,
        Stribeck::new(shape, pos, neg, -3.0).unwrap(),
    )
    .unwrap()
}

fn log_uniform(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

pub fn any_shape() -> impl Strategy<Value = Shape<f64>> {
    prop_oneof![
        Just(Shape::Gaussian),
        Just(Shape::Exponential),
        (0.3..4.0).prop_map(Shape::Power),
        Just(Shape::Lorentzian),
    ]
}

pub fn any_direction() -> impl Strategy<Value = Direction<f64>> {
    (
        log_uniform(1e-3, 1e4),
        0.0..3.0,
        log_uniform(1e-6, 1.0),
        prop_oneof![Just(0.0), 0.0..1e3],
    )
        .prop_map(|(fc, excess, vs, s2)| direction(fc, fc * (1.0 + excess), vs, s2))
}

/// Symmetric and asymmetric curves of every shape.
pub fn any_curve() -> impl Strategy<Value = Stribeck<f64>> {
    (
        any_shape(),
        any_direction(),
        any_direction(),
        any::<bool>(),
        -10.0..10.0,
    )
        .prop_map(|(shape, pos, neg, symmetric, offset)| {
            let neg = if symmetric { pos } else { neg };
            Stribeck::new(shape, pos, neg, offset).unwrap()
        })
}

pub fn any_damping() -> impl Strategy<Value = Damping<f64>> {
    let s1 = || prop_oneof![Just(0.0), log_uniform(1e-3, 1e6)];
    prop_oneof![
        s1().prop_map(Damping::Constant),
        s1().prop_map(Damping::Capped),
        (s1(), log_uniform(1e-4, 10.0))
            .prop_map(|(sigma1, velocity)| Damping::Olsson { sigma1, velocity }),
    ]
}

/// Any law with sigma0 from 1 to 1e12.
pub fn any_law() -> impl Strategy<Value = LuGre<f64>> {
    (log_uniform(1.0, 1e12), any_damping(), any_curve())
        .prop_map(|(s0, damping, curve)| LuGre::new(s0, damping, curve).unwrap())
}

/// Velocities from rest over the usable range to the largest finite number.
pub fn any_velocity() -> impl Strategy<Value = f64> {
    let sized = |range: std::ops::Range<f64>| {
        (log_uniform(range.start, range.end), any::<bool>())
            .prop_map(|(v, minus)| if minus { -v } else { v })
    };
    prop_oneof![
        1 => Just(0.0),
        1 => Just(-0.0),
        6 => sized(1e-9..10.0),
        1 => sized(1e-300..1e-9),
        1 => prop_oneof![Just(f64::MAX), Just(f64::MIN), Just(f64::MIN_POSITIVE), Just(5e-324)],
        1 => any::<f64>().prop_filter("finite", |v| v.is_finite()),
    ]
}

/// Time steps from 0 over the usable range to absurd ones.
pub fn any_time_step() -> impl Strategy<Value = f64> {
    prop_oneof![
        1 => Just(0.0),
        8 => log_uniform(1e-9, 10.0),
        1 => prop_oneof![Just(f64::MAX), Just(f64::MIN_POSITIVE), Just(5e-324), Just(1e100)],
    ]
}

/// Usual velocities, 1e-7 to 1 m/s, of either sign.
pub fn motion() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(
        (-7.0..0.0_f64, any::<bool>())
            .prop_map(|(e, up)| if up { 10f64.powf(e) } else { -10f64.powf(e) }),
        2..30,
    )
}

/// The same law seen from the other side: directions exchanged, offset turned.
pub fn mirrored(law: &LuGre<f64>) -> LuGre<f64> {
    let c = law.curve();
    let curve = Stribeck::new(c.shape(), *c.negative(), *c.positive(), -c.offset()).unwrap();
    LuGre::new(law.stiffness(), law.damping(), curve).unwrap()
}

fn scaled_damping(d: Damping<f64>, by: f64, velocity_by: f64) -> Damping<f64> {
    match d {
        Damping::Constant(s) => Damping::Constant(s * by),
        Damping::Capped(s) => Damping::Capped(s * by),
        Damping::Olsson { sigma1, velocity } => Damping::Olsson {
            sigma1: sigma1 * by,
            velocity: velocity * velocity_by,
        },
    }
}

/// The law in other units of force, length and time.
pub fn in_units(law: &LuGre<f64>, force: f64, length: f64, time: f64) -> LuGre<f64> {
    let speed = length / time;
    let c = law.curve();
    let side = |d: &Direction<f64>| {
        direction(
            d.coulomb * force,
            d.static_friction * force,
            d.stribeck_velocity * speed,
            d.viscous * force / speed,
        )
    };
    let curve = Stribeck::new(
        c.shape(),
        side(c.positive()),
        side(c.negative()),
        c.offset() * force,
    )
    .unwrap();
    let damping = scaled_damping(law.damping(), force / speed, speed);
    LuGre::new(law.stiffness() * force / length, damping, curve).unwrap()
}
