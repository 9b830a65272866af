//! The MuJoCo model, rolled out in MuJoCo: its own self-test, and beside our law over a long motion.

use crate::common::{laws, model};
use std::path::PathBuf;
use std::process::Command;
use stiction_export::{Error, Target, export};
use stiction_friction::compensator::Friction;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};

fn python(script: &str, arguments: &[&str], dir: &std::path::Path) -> String {
    let local = stiction_testkit::workspace().join(".venv/bin/python");
    let python = std::env::var_os("STICTION_PYTHON").map_or(local, PathBuf::from);
    let output = Command::new(&python)
        .arg(script)
        .args(arguments)
        .current_dir(dir)
        .output()
        .unwrap_or_else(|e| panic!("{}: {e}; install with: cargo xtask setup", python.display()));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    said
}

#[test]
fn mujoco_gives_the_forces_that_are_due() {
    let dir = tempfile::tempdir().unwrap();
    let flat = Direction {
        coulomb: 12.0,
        static_friction: 12.0,
        stribeck_velocity: 1.0,
        viscous: 30.0,
    };
    let flat = Stribeck::symmetric(Shape::Gaussian, flat, 2.0).unwrap();
    let dahl = Friction::LuGre(LuGre::new(2e6, Damping::Capped(0.0), flat).unwrap());
    let stage = laws().remove(0).1;
    for (rotary, law) in [(false, stage), (true, stage), (false, dahl)] {
        let mut model = model(law);
        model.rotary = rotary;
        model.force_unit = if rotary { "N m" } else { "N" }.into();
        model.title = "a -- b --> c".into();
        for file in export(&model, Target::Mujoco).unwrap() {
            std::fs::write(dir.path().join(&file.path), &file.bytes).unwrap();
        }
        assert!(python("x_axis_selftest.py", &[], dir.path()).starts_with("ok 151 steps"));
    }
}

/// A mass that is driven by a sine of force through stick and slip: our deflection and force along the velocity that
/// MuJoCo itself went through.
const ROLLOUT: &str = r#"
import math, mujoco
model = mujoco.MjModel.from_xml_path("x_axis_friction.xml")
model.opt.timestep = 1e-4
data = mujoco.MjData(model)
for k in range(20000):
    data.ctrl[2] = 25.0 * math.sin(2 * math.pi * 2.0 * k * 1e-4)
    v = data.qvel[0]
    mujoco.mj_step(model, data)
    print(repr(float(v)), repr(float(-data.actuator_force[0] + model.dof_damping[0] * v)), repr(float(data.act[0])))
"#;

#[test]
fn a_mass_through_stick_and_slip() {
    let Friction::LuGre(law) = laws().remove(0).1 else {
        unreachable!("the first law has bristles")
    };
    let dir = tempfile::tempdir().unwrap();
    for file in export(&model(Friction::LuGre(law)), Target::Mujoco).unwrap() {
        std::fs::write(dir.path().join(&file.path), &file.bytes).unwrap();
    }
    std::fs::write(dir.path().join("rollout.py"), ROLLOUT).unwrap();
    let constant = law
        .with_damping(Damping::Constant(law.damping().at_rest()))
        .unwrap();
    let (mut z, mut worst, mut fastest) = (0.0, 0.0_f64, 0.0_f64);
    for line in python("rollout.py", &[], dir.path()).lines() {
        let [v, force, deflection] =
            [0, 1, 2].map(|i| line.split(' ').nth(i).unwrap().parse::<f64>().unwrap());
        worst = worst.max((constant.force(z, v) - force).abs() / 18.0);
        z = constant.step_held(z, 1e-4, v);
        worst = worst.max((z - deflection).abs() / law.bound());
        fastest = fastest.max(v.abs());
    }
    assert!(fastest > 1e-2, "{fastest}");
    assert!(worst < 1e-9, "{worst}");
    println!("MuJoCo: largest deviation {worst:.1e} of Fs, up to {fastest:.2e} m/s");
}

#[test]
fn what_mujoco_has_not_is_refused() {
    for (name, law) in laws().into_iter().skip(1) {
        let refused = export(&model(law), Target::Mujoco);
        assert!(
            matches!(
                refused,
                Err(Error::Law {
                    target: "mujoco",
                    ..
                })
            ),
            "{name}"
        );
    }
}

#[test]
fn the_example_runs() {
    let dir = tempfile::tempdir().unwrap();
    for file in export(&model(laws().remove(0).1), Target::Mujoco).unwrap() {
        std::fs::write(dir.path().join(&file.path), &file.bytes).unwrap();
    }
    let example = stiction_testkit::workspace().join("examples/export/mujoco/push.py");
    let said = python(&example.to_string_lossy(), &["."], dir.path());
    assert_eq!(said, "15 N: holds\n20 N: moves\n");
}
