//! Nanoseconds a step: the Rust compensator, and the exported C compiled by gcc with -O2, in the same run.
//! `cargo bench -p stiction-export`. Both along a sine through its reversals; the C loop is timed by the bench through
//! one process that runs it many times, less the start of a process that runs none.

use divan::{Bencher, black_box, counter::ItemsCount};
use std::path::Path;
use std::process::Command;
use stiction_export::{Model, Provenance, Target, export};
use stiction_friction::compensator::{Compensator, Friction, Input, Settings, Source};
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};

const STEPS: usize = 20_000_000;
const H: f64 = 250e-6;

fn main() {
    divan::main();
}

fn law() -> Friction<f64> {
    let both = Direction {
        coulomb: 20.0,
        static_friction: 30.0,
        stribeck_velocity: 5e-3,
        viscous: 60.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).expect("parameters of the bench");
    let law = LuGre::new(1.2e5, Damping::Capped(600.0), curve).expect("parameters of the bench");
    Friction::LuGre(law)
}

fn velocity() -> Vec<f64> {
    let sine = |k: usize| 0.03 * libm::sin(2.0 * std::f64::consts::PI * 4.1 * k as f64 * H);
    (0..1000).map(sine).collect()
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn rust(bencher: Bencher) {
    let ready = Compensator::new(law(), Source::Reference, Settings::new(H, 100.0))
        .expect("parameters of the bench");
    let v = velocity();
    bencher.counter(ItemsCount::new(STEPS)).bench(|| {
        let mut compensator = ready;
        let mut sum = 0.0;
        for k in 0..STEPS {
            sum += compensator.step(Input {
                reference_velocity: black_box(&v)[k % 1000],
                enable: true,
                ..Input::default()
            });
        }
        sum
    });
}

#[divan::bench(sample_count = 5, sample_size = 1, args = ["", "_f32"])]
fn c(bencher: Bencher, suffix: &str) {
    let dir = tempfile::tempdir().expect("a folder");
    build(dir.path(), suffix);
    let program = dir.path().join("a.out");
    bencher.counter(ItemsCount::new(STEPS)).bench(|| {
        let status = Command::new(&program).status().expect("the C to run");
        assert!(status.success());
    });
}

/// Compiles the exported C with a loop over the same motion; its start takes a millisecond of the second it runs.
fn build(dir: &Path, suffix: &str) {
    let model = Model {
        title: "bench".into(),
        identifier: "bench".into(),
        rotary: false,
        friction: law(),
        settings: Settings::new(H, 100.0),
        rated_force: None,
        parameters: vec![],
        notes: vec![],
        provenance: Provenance::default(),
    };
    for file in export(&model, Target::C).expect("a model that can be exported") {
        std::fs::write(dir.join(file.path), file.bytes).expect("room");
    }
    let real = if suffix.is_empty() { "double" } else { "float" };
    let values: Vec<String> = velocity()
        .iter()
        .map(|v| format!("({real}){v:?}"))
        .collect();
    let text = format!(
        "#include \"bench_friction{suffix}.h\"\nstatic const {real} v[] = {{{}}};\n\
         int main(void) {{ bench{suffix}_params_t p; bench{suffix}_state_t s; volatile {real} sum = 0;\n\
         bench{suffix}_params(&p); if (!bench{suffix}_init(&p, &s)) {{ return 1; }}\n\
         for (long k = 0; k < {STEPS}L; k++) {{ const bench{suffix}_input_t in = {{ v[k % 1000], 0, true }};\n\
         sum += bench{suffix}_step(&p, &s, &in); }}\n return 0; }}\n",
        values.join(",")
    );
    std::fs::write(dir.join("main.c"), text).expect("room");
    let source = format!("bench_friction{suffix}.c");
    let status = Command::new("gcc")
        .args(["-std=c99", "-O2", "main.c", &source, "-lm"])
        .current_dir(dir)
        .status()
        .expect("gcc: cargo xtask setup");
    assert!(status.success());
}
