//! Nanoseconds a step: the Rust compensator, and the exported C compiled by gcc with -O2, in the same run along the same
//! motions. `cargo bench -p stiction-export`. The least of many short batches counts, since the machine may be shared; the
//! C program takes its own times. A step has no loop but over elements, so that the slowest motion is near the worst case.

use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;
use stiction_export::{Model, Provenance, Target, export};
use stiction_friction::compensator::{Compensator, Friction, Input, Settings, Source};
use stiction_friction::{
    Damping, Direction, ElastoPlastic, Element, LuGre, MaxwellSlip, Shape, Stribeck,
};

/// Steps in a batch: shorter than what a scheduler leaves it.
const STEPS: usize = 20_000;
/// Batches of which the least counts.
const BATCHES: usize = 400;
const H: f64 = 250e-6;

fn main() {
    for name in LAWS {
        for motion in MOTIONS {
            println!("{name}\tRust\t{motion}\t{:.1}", rust(name, motion));
        }
        for (suffix, code) in [("", "C"), ("_f32", "C, single precision")] {
            for motion in MOTIONS {
                println!("{name}\t{code}\t{motion}\t{}", c(name, motion, suffix));
            }
        }
    }
}

const LAWS: [&str; 3] = ["lugre", "elasto-plastic", "gms of 4"];

fn law(name: &str) -> Friction<f64> {
    let both = Direction {
        coulomb: 20.0,
        static_friction: 30.0,
        stribeck_velocity: 5e-3,
        viscous: 60.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0).expect("parameters of the bench");
    let law = LuGre::new(1.2e5, Damping::Capped(600.0), curve).expect("parameters of the bench");
    let element = |stiffness, share| Element { stiffness, share };
    let elements = [
        element(6e4, 0.2),
        element(3e4, 0.3),
        element(2e4, 0.3),
        element(1e4, 0.2),
    ];
    match name {
        "lugre" => Friction::LuGre(law),
        "elasto-plastic" => {
            let law = ElastoPlastic::new(law, 0.7).expect("parameters of the bench");
            Friction::ElastoPlastic(law)
        }
        _ => {
            let law = MaxwellSlip::new(&elements, 2e3, curve).expect("parameters of the bench");
            Friction::Gms(law)
        }
    }
}

/// A sine through its reversals, standstill, creep within the bristles' length, a reversal every sample, jumps.
const MOTIONS: [&str; 5] = ["sine", "still", "creep", "reversals", "jumps"];

fn velocity(motion: &str) -> Vec<f64> {
    let at = |k: usize| {
        let sine = libm::sin(2.0 * std::f64::consts::PI * 4.1 * k as f64 * H);
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        match motion {
            "sine" => 0.03 * sine,
            "still" => 0.0,
            "creep" => 1e-5 * sine,
            "reversals" => 6e-3 * sign,
            _ => [0.0, 0.3, -1e-4, 6e-3, 5.0][k % 5] * sign,
        }
    };
    (0..1000).map(at).collect()
}

/// The least of the batches of the Rust compensator, ns a step.
fn rust(name: &str, motion: &str) -> f64 {
    let ready = Compensator::new(law(name), Source::Reference, Settings::new(H, 100.0))
        .expect("parameters of the bench");
    let v = velocity(motion);
    let batch = || {
        let start = Instant::now();
        let mut compensator = ready;
        let mut sum = 0.0;
        for k in 0..STEPS {
            sum += compensator.step(Input {
                reference_velocity: black_box(&v)[k % 1000],
                enable: true,
                ..Input::default()
            });
        }
        black_box(sum);
        start.elapsed().as_secs_f64() * 1e9 / STEPS as f64
    };
    (0..BATCHES).map(|_| batch()).fold(f64::INFINITY, f64::min)
}

/// The least of the batches of the exported C, ns a step.
fn c(name: &str, motion: &str, suffix: &str) -> String {
    let dir = tempfile::tempdir().expect("a folder");
    build(dir.path(), name, motion, suffix);
    let output = Command::new(dir.path().join("a.out"))
        .output()
        .expect("the C to run");
    assert!(output.status.success());
    String::from_utf8_lossy(&output.stdout).trim().to_string()
}

/// Compiles the exported C with a loop over the same motion; its start takes a millisecond of the second it runs.
fn build(dir: &Path, name: &str, motion: &str, suffix: &str) {
    let model = Model {
        title: "bench".into(),
        identifier: "bench".into(),
        rotary: false,
        force_unit: "N".into(),
        friction: law(name),
        terms: stiction_friction::compensator::Terms::default(),
        load_unit: String::new(),
        backlash: None,
        settings: Settings::new(H, 100.0),
        rated_force: None,
        top_speed: None,
        parameters: vec![],
        domain: stiction_export::Domain::default(),
        draws: None,
        notes: vec![],
        provenance: Provenance::default(),
    };
    for file in export(&model, Target::C).expect("a model that can be exported") {
        std::fs::write(dir.join(file.path), file.bytes).expect("room");
    }
    let real = if suffix.is_empty() { "double" } else { "float" };
    let values: Vec<String> = velocity(motion)
        .iter()
        .map(|v| format!("({real}){v:?}"))
        .collect();
    let text = format!(
        "#include \"bench_friction{suffix}.h\"\n#include <stdio.h>\n#include <time.h>\n\
         static const {real} v[] = {{{}}};\n\
         static double now(void) {{ struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return (double)t.tv_sec * 1e9 + (double)t.tv_nsec; }}\n\
         int main(void) {{ bench{suffix}_params_t p; bench{suffix}_state_t s; volatile {real} sum = 0; double least = 1e9;\n\
         bench{suffix}_params(&p); if (!bench{suffix}_init(&p, &s)) {{ return 1; }}\n\
         for (int batch = 0; batch < {BATCHES}; batch++) {{ const double start = now();\n\
         for (long k = 0; k < {STEPS}L; k++) {{ const bench{suffix}_input_t in = {{ v[k % 1000], 0, true }};\n\
         sum += bench{suffix}_step(&p, &s, &in); }}\n\
         const double took = (now() - start) / {STEPS}.0; least = took < least ? took : least; }}\n\
         printf(\"%.1f\\n\", least); return 0; }}\n",
        values.join(",")
    );
    std::fs::write(dir.join("main.c"), text).expect("room");
    let source = format!("bench_friction{suffix}.c");
    let status = Command::new("gcc")
        .args(["-std=gnu99", "-O2", "main.c", &source, "-lm"])
        .current_dir(dir)
        .status()
        .expect("gcc: cargo xtask setup");
    assert!(status.success());
}
