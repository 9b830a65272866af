//! Nanoseconds per step of the plant: `cargo bench -p stiction-servo`.
//!
//! Each sample runs 1000 steps of 50 us under a sine force that breaks the axis away in both directions.

use divan::{Bencher, black_box, counter::ItemsCount};
use stiction_friction::{ElastoPlastic, Element, Gms, Held};
use stiction_servo::known;
use stiction_servo::plant::{Load, Motion, Plant};

const STEPS: usize = 1000;
const H: f64 = 50e-6;

fn main() {
    divan::main();
}

fn force(amplitude: f64) -> Vec<f64> {
    let sine =
        |k: usize| amplitude * libm::sin(2.0 * std::f64::consts::PI * 20.0 * (k as f64 + 0.5) * H);
    (0..STEPS).map(sine).collect()
}

/// LuGre, sigma1 constant and capped.
#[divan::bench(args = [false, true])]
fn lugre(bencher: Bencher, capped: bool) {
    let axis = known::find("machine").expect("a known axis");
    let law = if capped { axis.capped_law() } else { axis.law };
    let plant = Plant::new(axis.mass, law).expect("parameters of the bench");
    run(bencher, &plant);
}

#[divan::bench]
fn elasto_plastic(bencher: Bencher) {
    let axis = known::find("machine").expect("a known axis");
    let law = ElastoPlastic::new(axis.law, 0.7).expect("parameters of the bench");
    run(
        bencher,
        &Plant::new(axis.mass, law).expect("parameters of the bench"),
    );
}

/// Four elements.
#[divan::bench]
fn gms(bencher: Bencher) {
    let axis = known::find("machine").expect("a known axis");
    let elements = [(8e4, 0.4), (3e4, 0.3), (1e4, 0.2), (2e3, 0.1)]
        .map(|(stiffness, share)| Element { stiffness, share });
    let law = Gms::new(elements, 2e3, 600.0, *axis.law.curve()).expect("parameters of the bench");
    run(
        bencher,
        &Plant::new(axis.mass, law).expect("parameters of the bench"),
    );
}

fn run<L: Held<f64> + Sync>(bencher: Bencher, plant: &Plant<L>) {
    let force = force(60.0);
    bencher.counter(ItemsCount::new(STEPS)).bench(|| {
        black_box(&force).iter().fold(Motion::default(), |m, &u| {
            plant.step(m, H, Load::force(u)).motion
        })
    });
}
