//! The MuJoCo model, rolled out in MuJoCo: its own self-test, and beside our law over a long motion.

use crate::common::{laws, model};
use std::path::PathBuf;
use std::process::Command;
use stiction_export::{Error, Target, export};
use stiction_friction::compensator::Friction;
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};

pub fn python(script: &str, arguments: &[&str], dir: &std::path::Path) -> String {
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
        model.title = "a -- b --> c --- d ----- e".into();
        for file in export(&model, Target::Mujoco).unwrap() {
            std::fs::write(dir.path().join(&file.path), &file.bytes).unwrap();
        }
        assert!(python("x_axis_selftest.py", &[], dir.path()).starts_with("ok 183 steps"));
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

/// A stuck joint that is struck: how far it moves in the last tenth of two seconds, in bristles' lengths.
const STRUCK: &str = r#"
import sys, mujoco
model = mujoco.MjModel.from_xml_path("x_axis_friction.xml")
written = model.opt.timestep
model.opt.timestep = float(sys.argv[1]) * written
data = mujoco.MjData(model)
data.qvel[0] = 1e-6
steps = int(2.0 / model.opt.timestep)
last = []
for k in range(steps):
    mujoco.mj_step(model, data)
    if k > 0.9 * steps:
        last.append(abs(data.qvel[0]))
print(repr(written), max(last))
"#;

/// With the time step that is written a joint that sticks comes to rest; with one a twentieth longer it does not.
#[test]
fn the_time_step_is_the_longest() {
    let dir = tempfile::tempdir().unwrap();
    // (sigma1 + sigma2)/sigma0 = 7.65e-4 s, where a millisecond was asked for.
    let model = model(laws().remove(0).1);
    for file in export(&model, Target::Mujoco).unwrap() {
        std::fs::write(dir.path().join(&file.path), &file.bytes).unwrap();
    }
    std::fs::write(dir.path().join("struck.py"), STRUCK).unwrap();
    let speed = |share: &str| {
        let said = python("struck.py", &[share], dir.path());
        let (step, speed) = said.trim().split_once(' ').unwrap();
        assert_eq!(step, "0.00076");
        speed.parse::<f64>().unwrap()
    };
    let (written, longer) = (speed("1"), speed("1.05"));
    assert!(written < 1e-8 && longer > 1e-5, "{written} {longer}");
    let advice = stiction_export::advice(&model, Target::Mujoco);
    assert!(
        advice
            .iter()
            .any(|a| a.message.contains("0.00076 s in place of 0.001 s")),
        "{advice:?}"
    );
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

/// The motor is led to and fro by far more than the gap, while the load is dragged: by how much the load is at other places on the way
/// back than on the way to. Then the motor is driven through stick and slip, and the load is left alone: how far it goes to each side.
const GAP: &str = r#"
import math, mujoco
model = mujoco.MjModel.from_xml_path("x_axis_friction.xml")
data = mujoco.MjData(model)
h = model.opt.timestep
places = [[], []]
for k in range(int(1.5 / h)):
    at, v = (2e-3 * f for f in (math.sin(4 * math.pi * k * h), 4 * math.pi * math.cos(4 * math.pi * k * h)))
    data.ctrl[2] = 1e5 * (at - data.qpos[0]) + 500.0 * (v - data.qvel[0])
    # Dragged with 10 N s/m.
    data.qfrc_applied[:] = -10.0 * (data.qvel[0] + data.qvel[1])
    mujoco.mj_step(model, data)
    if k * h > 0.5 and abs(data.qpos[0]) < 5e-4:
        places[int(data.qvel[0] < 0)].append(float(data.qpos[1]))
to, back = (sum(own) / len(own) for own in places)
print(repr(back - to))
mujoco.mj_resetData(model, data)
seen = []
for k in range(int(1.0 / h)):
    data.ctrl[2] = 25.0 * math.sin(4 * math.pi * k * h)
    mujoco.mj_step(model, data)
    seen.append(float(data.qpos[1]))
print(repr(min(seen)), repr(max(seen)))
print(model.nv, float(model.body_mass[1]), float(model.body_mass[2]))
"#;

/// The lost motion in MuJoCo is the width of the gap, and the friction of the motor is as without it.
#[test]
fn a_gap_is_lost_motion() {
    for rotary in [false, true] {
        let dir = tempfile::tempdir().unwrap();
        let mut model = model(laws().remove(0).1);
        (model.rotary, model.force_unit) = (rotary, if rotary { "N m" } else { "N" }.into());
        let model = crate::common::terms::with_cogging_and_gap(model);
        for file in export(&model, Target::Mujoco).unwrap() {
            std::fs::write(dir.path().join(&file.path), &file.bytes).unwrap();
        }
        assert!(python("x_axis_selftest.py", &[], dir.path()).starts_with("ok 183 steps"));
        std::fs::write(dir.path().join("gap.py"), GAP).unwrap();
        let said = python("gap.py", &[], dir.path());
        println!("{said}");
        let numbers: Vec<f64> = (said.split_whitespace())
            .map(|x| x.parse().unwrap())
            .collect();
        assert!((numbers[0] / 2e-5 - 1.0).abs() < 1e-3, "{said}");
        assert!((numbers[1] / -1e-5 - 1.0).abs() < 0.05, "{said}");
        assert!((numbers[2] / 1e-5 - 1.0).abs() < 0.05, "{said}");
        assert_eq!(numbers[3..], [2.0, 0.7, 0.3]);
    }
}

#[test]
fn a_gap_shortens_the_time_step() {
    let model = crate::common::terms::with_cogging_and_gap(model(laws().remove(0).1));
    // A fortieth of the time in which 12 N take 0.7 kg over 20 um.
    let advice = stiction_export::advice(&model, Target::Mujoco);
    let says = "the gap between motor and load needs a timestep of at most 0.000038 s: the file has 0.000038 s";
    assert!(advice.iter().any(|a| a.message == says), "{advice:?}");
}
