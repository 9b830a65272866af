//! The C text: compiled under every warning, its self-test run, and sample by sample against the compensator.

mod common;

use common::{adversarial, busy, laws, model, random};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use stiction_export::{File, Model, Target, export};
use stiction_friction::Real;
use stiction_friction::compensator::{Compensator, Friction, Input, Settings, Source};

/// What the C has to pass; the undefined-behaviour sanitizer on top where it runs.
const STRICT: &str = "-std=c99 -pedantic -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Wstrict-prototypes \
     -Wmissing-prototypes -Wfloat-equal -Wsign-conversion -Wundef -Wcast-qual -O2 -Werror";
const SANITIZE: &str = "-fsanitize=undefined,float-divide-by-zero -fno-sanitize-recover=all";

fn write(files: &[File], dir: &Path) {
    for file in files {
        std::fs::write(dir.join(&file.path), &file.bytes).unwrap();
    }
}

/// Runs a program of the set-up (`cargo xtask setup`) and gives what it printed.
fn run(program: &str, arguments: &[&str], dir: &Path) -> String {
    let output = Command::new(program)
        .args(arguments)
        .current_dir(dir)
        .output()
        .unwrap_or_else(|e| panic!("{program}: {e}; install with: cargo xtask setup"));
    let text = format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(output.status.success(), "{program} {arguments:?}\n{text}");
    text
}

fn gcc(flags: &str, rest: &[&str], dir: &Path) {
    let mut arguments: Vec<&str> = flags.split_whitespace().collect();
    arguments.extend(rest);
    run("gcc", &arguments, dir);
}

#[test]
fn the_self_test_passes_under_every_warning() {
    for (name, law) in laws() {
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model(law), Target::C).unwrap(), dir.path());
        for file in ["x_axis_friction", "x_axis_friction_f32"] {
            let (source, test) = (format!("{file}.c"), format!("{file}_selftest.c"));
            gcc(&format!("{STRICT} -fanalyzer -c"), &[&source], dir.path());
            gcc(
                &format!("{STRICT} {}", SANITIZE.replace(",float-divide-by-zero", "")),
                &[&source, &test, "-lm"],
                dir.path(),
            );
            let said = run("./a.out", &[], dir.path());
            assert!(said.starts_with("ok: 151 samples"), "{name}: {said}");
        }
    }
}

/// A self-test that is run with another parameter fails.
#[test]
fn the_self_test_notices() {
    let dir = tempfile::tempdir().unwrap();
    write(
        &export(&model(laws().remove(0).1), Target::C).unwrap(),
        dir.path(),
    );
    let path = dir.path().join("x_axis_friction.c");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(
        &path,
        text.replace("params->sigma1 = 1500.0;", "params->sigma1 = 1500.1;"),
    )
    .unwrap();
    gcc(
        "-std=c99",
        &["x_axis_friction.c", "x_axis_friction_selftest.c", "-lm"],
        dir.path(),
    );
    let status = Command::new(dir.path().join("a.out"))
        .stdout(Stdio::null())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(1));
}

/// The deviations are those that stand in the page of the target, and no others.
#[test]
fn misra() {
    let dir = tempfile::tempdir().unwrap();
    let found: std::collections::BTreeSet<String> = laws()
        .into_iter()
        .filter(|(name, _)| ["power", "stribeck", "coulomb"].contains(name))
        .flat_map(|(_, law)| {
            write(&export(&model(law), Target::C).unwrap(), dir.path());
            let arguments = "--addon=misra --enable=style,warning,performance,portability --inconclusive --std=c99 \
                 --suppress=missingIncludeSystem --suppress=unusedStructMember --quiet --template={id} x_axis_friction.c x_axis_friction_f32.c";
            let said = run("cppcheck", &arguments.split_whitespace().collect::<Vec<_>>(), dir.path());
            said.lines().map(str::to_string).collect::<Vec<_>>()
        })
        .collect();
    let page =
        std::fs::read_to_string(stiction_testkit::workspace().join("docs/deploy/c.md")).unwrap();
    for id in &found {
        let rule = id.trim_start_matches("misra-c2012-");
        assert!(
            page.contains(&format!("| {rule} |")),
            "{found:?}: {id} is not justified in docs/deploy/c.md"
        );
    }
}

/// Reads `h, velocity, error, enable` as doubles, writes force and deflection.
const DRIVER: &str = r#"
#include "x_axis_friction@F@.h"
#include <stdio.h>
int main(void) {
    double in[4];
    x_axis@F@_params_t p;
    x_axis@F@_state_t s;
    x_axis@F@_params(&p);
    if (!x_axis@F@_init(&p, &s)) { return 1; }
    while (fread(in, sizeof in, 1, stdin) == 1) {
        const x_axis@F@_input_t input = { (@R@)in[1], (@R@)in[2], in[3] != 0.0 };
        double out[2];
        out[0] = (double)x_axis@F@_step_in(&p, &s, (@R@)in[0], &input);
        out[1] = @Z@;
        (void)fwrite(out, sizeof out, 1, stdout);
    }
    return 0;
}
"#;

/// Force and deflection of the compiled C for each sample.
fn through_c(
    model: &Model,
    single: bool,
    bristles: bool,
    samples: &[(f64, Input<f64>)],
) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    write(&export(model, Target::C).unwrap(), dir.path());
    let (suffix, real) = if single {
        ("_f32", "float")
    } else {
        ("", "double")
    };
    let deflection = if bristles {
        "(double)s.deflection"
    } else {
        "0.0"
    };
    let driver = DRIVER
        .replace("@F@", suffix)
        .replace("@R@", real)
        .replace("@Z@", deflection);
    std::fs::write(dir.path().join("driver.c"), driver).unwrap();
    let source = format!("x_axis_friction{suffix}.c");
    gcc(
        "-std=c99 -O2 -fsanitize=undefined -fno-sanitize-recover=all",
        &["driver.c", &source, "-lm"],
        dir.path(),
    );
    let bytes: Vec<u8> = samples
        .iter()
        .flat_map(|(h, input)| {
            [
                *h,
                input.reference_velocity,
                input.tracking_error,
                f64::from(u8::from(input.enable)),
            ]
        })
        .flat_map(f64::to_le_bytes)
        .collect();
    let mut child = Command::new(dir.path().join("a.out"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || stdin.write_all(&bytes).unwrap());
    let mut out = Vec::new();
    child.stdout.take().unwrap().read_to_end(&mut out).unwrap();
    writer.join().unwrap();
    assert!(child.wait().unwrap().success());
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap());
    out.chunks_exact(16)
        .map(|pair| [number(&pair[..8]), number(&pair[8..])])
        .collect()
}

fn level(friction: &Friction<f64>) -> f64 {
    match friction {
        Friction::Coulomb(law) => law.coulomb()[0].max(law.coulomb()[1]),
        Friction::Stribeck(curve) => curve.largest_static_level(),
        Friction::LuGre(law) => law.curve().largest_static_level(),
    }
}

fn through_rust<T: Real>(
    friction: Friction<T>,
    settings: Settings<T>,
    samples: &[(f64, Input<f64>)],
) -> Vec<f64> {
    let mut compensator = Compensator::new(friction, Source::Reference, settings).unwrap();
    let to = T::from_f64;
    samples
        .iter()
        .map(|(h, input)| {
            let input = Input {
                reference_velocity: to(input.reference_velocity),
                measured_velocity: T::ZERO,
                tracking_error: to(input.tracking_error),
                enable: input.enable,
            };
            compensator.step_in(to(*h), input).to_f64()
        })
        .collect()
}

/// A million samples of every kind over all laws: within 4 units in the last place of the larger of force and static
/// friction, or 1e-12 of the force; deflection within its bound.
#[test]
fn double_precision_agrees() {
    let mut identical = 0;
    let mut worst = 0.0_f64;
    let laws = laws();
    let each = 1_000_000 / laws.len() + 1;
    for (seed, (name, friction)) in laws.into_iter().enumerate() {
        let mut model = model(friction);
        model.settings = busy();
        if seed % 2 == 1 {
            model.settings.watchdog = None;
        }
        let samples = adversarial(each, true, &mut random(seed as u64));
        let bristles = matches!(friction, Friction::LuGre(_));
        let c = through_c(&model, false, bristles, &samples);
        let rust = through_rust(friction, model.settings, &samples);
        assert_eq!(c.len(), rust.len());
        for (i, ([force, z], due)) in c.into_iter().zip(rust).enumerate() {
            let off = (force - due).abs();
            let allowed = 4.0 * f64::EPSILON * due.abs().max(level(&friction));
            identical += u64::from(force == due);
            worst = worst.max(off / level(&friction));
            assert!(
                off <= allowed.max(1e-12 * due.abs()),
                "{name} {i}: {force} {due} at {:?}",
                samples[i]
            );
            if let Friction::LuGre(law) = friction {
                assert!(z.abs() <= law.bound(), "{name} {i}: {z}");
            }
        }
    }
    println!("double: {identical} identical, largest deviation {worst:.2e} of Fs");
}

#[test]
fn single_precision_agrees() {
    let mut worst = 0.0_f64;
    let laws = laws();
    let each = 1_000_000 / laws.len() + 1;
    for (seed, (name, friction)) in laws.into_iter().enumerate() {
        let mut model = model(friction);
        model.settings = busy();
        let samples = adversarial(each, true, &mut random(100 + seed as u64));
        let c = through_c(&model, true, false, &samples);
        let to = |x: [f64; 2]| x.map(|x| x as f32);
        let small: Friction<f32> = match &friction {
            Friction::Coulomb(law) => Friction::Coulomb(
                stiction_friction::CoulombViscous::new(
                    to(law.coulomb()),
                    to(law.viscous()),
                    law.offset() as f32,
                )
                .unwrap(),
            ),
            Friction::Stribeck(curve) => Friction::Stribeck(curve.cast().unwrap()),
            Friction::LuGre(law) => Friction::LuGre(law.cast().unwrap()),
        };
        let s = model.settings;
        let settings = Settings {
            gain: s.gain as f32,
            dead_zone: s.dead_zone as f32,
            slew: s.slew as f32,
            ramp: s.ramp as f32,
            watchdog: Some(stiction_friction::compensator::Watchdog {
                window: 0.5,
                ratio: 1.0,
            }),
            ..Settings::new(s.cycle_time as f32, s.limit as f32)
        };
        for (i, ([force, _], due)) in c
            .into_iter()
            .zip(through_rust(small, settings, &samples))
            .enumerate()
        {
            let off = (force - due).abs() / level(&friction);
            worst = worst.max(off);
            assert!(off <= 2e-6, "{name} {i}: {force} {due} at {:?}", samples[i]);
        }
    }
    println!("single: largest deviation {worst:.2e} of Fs");
}

/// Work done on the exported law is never less than the energy that its bristles gained: gain 1 and nothing that holds
/// the force back, so that the force is the law's.
#[test]
fn the_exported_law_is_passive() {
    for (name, friction) in laws() {
        let Friction::LuGre(law) = friction else {
            continue;
        };
        let mut model = model(friction);
        model.settings = Settings::bare(1e-3, 1e12);
        let mut samples = adversarial(100_000, false, &mut random(7));
        samples
            .iter_mut()
            .for_each(|(_, input)| input.enable = true);
        for single in [false, true] {
            let mut work = 0.0;
            let mut done = 0.0;
            for ((h, input), [force, z]) in samples
                .iter()
                .zip(through_c(&model, single, true, &samples))
            {
                // What the offset does is given back on the way back; it is no part of the law's energy.
                let power = (force - law.curve().offset()) * input.reference_velocity;
                work += power * h;
                done += power.abs() * h;
                let stored = 0.5 * law.stiffness() * z * z;
                let rounding = if single { 1e-5 } else { 1e-12 };
                assert!(
                    work - stored >= -rounding * done.max(stored),
                    "{name}: {work} {stored}"
                );
            }
        }
    }
}
