//! Nanoseconds per step of the law, by kind of step, shape and damping: `cargo bench -p stiction-friction`.
//!
//! Each sample runs 1000 steps along a sine through its reversals; the item rate that divan prints is steps per second.

use divan::{Bencher, black_box, counter::ItemsCount};
use stiction_friction::compensator::{Compensator, Friction, Input, Settings, Source};
use stiction_friction::{
    Damping, Direction, ElastoPlastic, Element, Elements, Gms, LuGre, Real, Shape, Stribeck,
};

const STEPS: usize = 1000;
const H: f64 = 250e-6;
const SHAPES: [&str; 4] = ["gaussian", "exponential", "power", "lorentzian"];

fn main() {
    divan::main();
}

fn law(shape: &str, damping: Damping<f64>) -> LuGre<f64> {
    let shape = match shape {
        "gaussian" => Shape::Gaussian,
        "exponential" => Shape::Exponential,
        "power" => Shape::Power(1.3),
        _ => Shape::Lorentzian,
    };
    let both = Direction {
        coulomb: 20.0,
        static_friction: 30.0,
        stribeck_velocity: 5e-3,
        viscous: 60.0,
    };
    let curve = Stribeck::symmetric(shape, both, 0.0).expect("parameters of the bench");
    LuGre::new(1.2e5, damping, curve).expect("parameters of the bench")
}

fn velocity<T: Real>() -> Vec<T> {
    let sine = |k: usize| 0.03 * libm::sin(2.0 * std::f64::consts::PI * 4.1 * k as f64 * H);
    (0..=STEPS).map(|k| T::from_f64(sine(k))).collect()
}

/// EXPLIN and the algebraic force not counted: what an identification repeats most.
#[divan::bench(args = SHAPES)]
fn step_record(bencher: Bencher, shape: &str) {
    let (law, v) = (law(shape, Damping::Constant(600.0)), velocity());
    bencher.counter(ItemsCount::new(STEPS)).bench(|| {
        black_box(&v)
            .windows(2)
            .fold(0.0, |z, ends| law.step_record(z, H, ends[0], ends[1]))
    });
}

/// The elasto-plastic record step; a part of the sine is elastic, the rest takes four stages.
#[divan::bench]
fn step_record_elasto_plastic(bencher: Bencher) {
    let law = ElastoPlastic::new(law("gaussian", Damping::Constant(600.0)), 0.7)
        .expect("parameters of the bench");
    let v = velocity();
    bencher.counter(ItemsCount::new(STEPS)).bench(|| {
        black_box(&v)
            .windows(2)
            .fold(0.0, |z, ends| law.step_record(z, H, ends[0], ends[1]))
    });
}

/// The record step of Maxwell slip with `N` elements.
#[divan::bench(consts = [1, 4, 10])]
fn step_record_gms<const N: usize>(bencher: Bencher) {
    let curve = *law("gaussian", Damping::Constant(600.0)).curve();
    let elements = std::array::from_fn(|i| Element {
        stiffness: 1e5 / (i + 1) as f64,
        share: 1.0,
    });
    let law = Gms::<f64, N>::new(elements, 400.0, 0.0, curve).expect("parameters of the bench");
    let v = velocity();
    bencher.counter(ItemsCount::new(STEPS)).bench(|| {
        black_box(&v)
            .windows(2)
            .fold(Elements::default(), |at, ends| {
                law.step_record(at, H, ends[0], ends[1])
            })
            .total()
    });
}

/// The real-time step with its force, sigma1 capped.
#[divan::bench(args = SHAPES)]
fn step(bencher: Bencher, shape: &str) {
    let (law, v) = (law(shape, Damping::Capped(600.0)), velocity());
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench(|| real_time(&law, H, black_box(&v)));
}

/// The whole compensator on the reference velocity, default safety and watchdog on.
#[divan::bench]
fn compensator(bencher: Bencher) {
    let law = Friction::LuGre(law("gaussian", Damping::Capped(600.0)));
    let ready = Compensator::new(law, Source::Reference, Settings::new(H, 100.0))
        .expect("parameters of the bench");
    let v = velocity();
    bencher.counter(ItemsCount::new(STEPS)).bench(|| {
        let mut compensator = ready;
        black_box(&v)[1..].iter().fold(0.0, |_, &v| {
            compensator.step(Input {
                reference_velocity: v,
                enable: true,
                ..Input::default()
            })
        })
    });
}

/// The real-time step with constant sigma1.
#[divan::bench]
fn step_constant_damping(bencher: Bencher) {
    let (law, v) = (law("gaussian", Damping::Constant(600.0)), velocity());
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench(|| real_time(&law, H, black_box(&v)));
}

/// The real-time step in single precision.
#[divan::bench]
fn step_f32(bencher: Bencher) {
    let law = law("gaussian", Damping::Capped(600.0))
        .cast::<f32>()
        .expect("fits f32");
    let v = velocity();
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench(|| real_time(&law, H as f32, black_box(&v)));
}

fn real_time<T: Real>(law: &LuGre<T>, h: T, velocity: &[T]) -> T {
    let mut state = law.rest();
    velocity[1..]
        .iter()
        .fold(T::ZERO, |_, &v| law.step(&mut state, h, v))
}
