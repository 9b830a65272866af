//! The Modelica package: read by pymoca, a parser, and its equations evaluated beside the law. No tool that simulates Modelica is
//! run.

use crate::common::{elasto_plastic, laws, lugre, model, random};
use rand::RngExt;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use stiction_export::{Error, Model, Target, export};
use stiction_friction::compensator::Friction;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};

/// Rate of the deflection and force for each deflection and velocity.
fn evaluated(model: &Model, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    let files = export(model, Target::Modelica).unwrap();
    assert_eq!(files.len(), 1);
    assert_eq!(files[0].path, "x_axis_friction.mo");
    std::fs::write(dir.path().join(&files[0].path), &files[0].bytes).unwrap();
    let workspace = stiction_testkit::workspace();
    let local = workspace.join(".venv/bin/python");
    let python = std::env::var_os("STICTION_PYTHON").map_or(local, PathBuf::from);
    let mut child = Command::new(python)
        .arg(workspace.join("crates/export/tests/modelica/evaluate.py"))
        .arg("x_axis_friction")
        .current_dir(dir.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let lines: String = points
        .iter()
        .map(|[z, v]| format!("{z:?} {v:?}\n"))
        .collect();
    let mut stdin = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || stdin.write_all(lines.as_bytes()).unwrap());
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    assert!(output.status.success(), "install with: cargo xtask setup");
    let said = String::from_utf8(output.stdout).unwrap();
    said.lines()
        .map(|line| {
            let (rate, force) = line.split_once(' ').unwrap();
            [rate.parse().unwrap(), force.parse().unwrap()]
        })
        .collect()
}

/// Every law that is taken, with every curve, each direction its own.
fn taken() -> Vec<(&'static str, Friction<f64>)> {
    let flat = Direction {
        coulomb: 12.0,
        static_friction: 12.0,
        stribeck_velocity: 1.0,
        viscous: 30.0,
    };
    let flat = Stribeck::symmetric(Shape::Gaussian, flat, 1.0).unwrap();
    let dahl = LuGre::new(2e6, Damping::Capped(0.0), flat).unwrap();
    let mut all = vec![("dahl", Friction::LuGre(dahl)), laws().remove(0)];
    for shape in [
        Shape::Gaussian,
        Shape::Exponential,
        Shape::Power(1.3),
        Shape::Lorentzian,
    ] {
        all.push(("lugre", Friction::LuGre(lugre(shape))));
        all.push(("elasto-plastic", elasto_plastic(shape)));
    }
    // Friction enough for the limit of the micro-damping to act.
    let much = lugre(Shape::Gaussian).with_damping(Damping::Capped(2e4));
    all.push(("much damping", Friction::LuGre(much.unwrap())));
    all
}

#[test]
fn the_equations_are_those_of_the_law() {
    let mut worst = 0.0_f64;
    for (seed, (name, law)) in taken().into_iter().enumerate() {
        let random = &mut random(seed as u64);
        let bound = law.bristle().unwrap().bound();
        let mut points = vec![[0.0, 0.0], [0.5 * bound, 0.0], [-0.9 * bound, -0.0]];
        for _ in 0..2000 {
            let speed = 10f64.powf(random.random_range(-7.0..0.5));
            let sign = if random.random_range(0..2) == 0 {
                1.0
            } else {
                -1.0
            };
            points.push([bound * random.random_range(-1.0..1.0), sign * speed]);
        }
        let found = evaluated(&model(law), &points);
        assert_eq!(found.len(), points.len());
        for ([z, v], [rate, force]) in points.into_iter().zip(found) {
            let (due_rate, due_force) = match &law {
                Friction::LuGre(law) => (law.deflection_rate(z, v), law.force(z, v)),
                Friction::ElastoPlastic(law) => (law.deflection_rate(z, v), law.force(z, v)),
                _ => unreachable!("only these are taken"),
            };
            let off = (force - due_force).abs() / due_force.abs().max(law.scale());
            worst = worst.max(off);
            // Bristles at the steady deflection take the difference of nearly equal velocities.
            assert!(
                (rate - due_rate).abs() <= 1e-13 * v.abs() && off <= 1e-12,
                "{name} at {z} {v}: {rate} {due_rate}, {force} {due_force}"
            );
        }
    }
    println!("Modelica: largest deviation {worst:.2e} of Fs");
}

#[test]
fn rotary_axes_have_flanges_that_turn() {
    let mut model = model(elasto_plastic(Shape::Gaussian));
    (model.rotary, model.force_unit) = (true, "N m".into());
    model.title = "a */ // \" within ;".into();
    let [[rate, _]] = evaluated(&model, &[[0.0, 0.01]])[..] else {
        panic!("one point")
    };
    assert_eq!(rate, 0.01);
    let text = export(&model, Target::Modelica).unwrap().remove(0).bytes;
    let text = String::from_utf8(text).unwrap();
    assert!(text.contains("Modelica.Mechanics.Rotational.Interfaces"));
    assert!(text.contains("unit = \"N.m\"") && text.contains("unit = \"rad/s\""));
}

/// What is no differential equation is refused with what is.
#[test]
fn laws_without_a_bristle_are_refused() {
    for name in ["gms", "maxwell-slip", "stribeck", "coulomb"] {
        let (_, law) = laws().into_iter().find(|(n, _)| *n == name).unwrap();
        let refused = export(&model(law), Target::Modelica).unwrap_err();
        assert!(
            matches!(
                refused,
                Error::Law {
                    target: "modelica",
                    ..
                }
            ) && refused.to_string().contains("the target fmu has every law"),
            "{name}: {refused}"
        );
    }
}
