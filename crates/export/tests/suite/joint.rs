//! The friction of a joint in URDF, SDFormat and Isaac Lab: the nearest to the law, and read back by MuJoCo and urdfdom, by
//! libsdformat, and by Python.

use crate::common::compiled::{run, write};
use crate::common::{laws, model};
use crate::mujoco::python;
use std::path::Path;
use stiction_export::{Model, Target, advice, export};
use stiction_friction::compensator::Friction;
use stiction_friction::{CoulombViscous, Damping, Direction, LuGre, Shape, Stribeck};

/// A law, rotary or not, with a log of this top speed.
fn axis(friction: Friction<f64>, rotary: bool, top: f64) -> Model {
    Model {
        rotary,
        force_unit: if rotary { "N m" } else { "N" }.into(),
        top_speed: Some(top),
        ..model(friction)
    }
}

fn said(model: &Model) -> String {
    let found = advice(model, Target::Urdf);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].code.as_str(), "export-simplified");
    found[0].message.clone()
}

/// The only file of a target.
fn text(model: &Model, target: Target) -> String {
    let mut files = export(model, target).unwrap();
    assert_eq!(files.len(), 1);
    String::from_utf8(files.remove(0).bytes).unwrap()
}

fn number(text: &str, before: &str) -> f64 {
    let rest = text.split(before).nth(1).unwrap();
    let digits: String = rest
        .chars()
        .take_while(|c| c.is_ascii_digit() || ".e-+".contains(*c))
        .collect();
    digits.parse().unwrap()
}

/// Friction, damping and static friction, as they stand in the snippet of Isaac Lab.
fn written(model: &Model) -> [f64; 3] {
    let text = text(model, Target::IsaacLab);
    [
        "    dynamic_friction=",
        "    viscous_friction=",
        "    friction=",
    ]
    .map(|key| number(&text, key))
}

fn steady(friction: &Friction<f64>, v: f64) -> f64 {
    match friction {
        Friction::Coulomb(law) => law.force(v),
        law => law.curve().unwrap().force(v),
    }
}

/// Root of the mean square difference over speeds and directions, by the rule of Simpson.
fn rms(law: &Friction<f64>, friction: f64, damping: f64, top: f64) -> f64 {
    let n = 20_000;
    let off = |v: f64| steady(law, v) - (friction * v.signum() + damping * v);
    let sum: f64 = (0..=n)
        .map(|k| {
            let v = (top * f64::from(k) / f64::from(n)).max(1e-300);
            let weight = match k {
                0 => 1.0,
                k if k == n => 1.0,
                k if k % 2 == 1 => 4.0,
                _ => 2.0,
            };
            weight * 0.5 * (off(v).powi(2) + off(-v).powi(2))
        })
        .sum();
    (sum / (3.0 * f64::from(n))).sqrt()
}

/// Of directions that differ the mean, and the error in closed form: 12.5 N s/m over speeds to 0.1 m/s.
#[test]
fn directions_that_differ_are_averaged() {
    let law = CoulombViscous::new([20.0, 14.0], [60.0, 85.0], -3.0).unwrap();
    let model = axis(Friction::Coulomb(law), false, 0.1);
    let [friction, damping, at_rest] = written(&model);
    assert_eq!([friction, damping, at_rest], [17.0, 72.5, 17.0]);
    let exact = 12.5 * 0.1 / 3.0_f64.sqrt();
    assert_eq!(format!("{exact:.4}"), "0.7217");
    let said = said(&model);
    assert!(
        said.contains("off by 0.7217 N rms (3.6 percent of static friction), 1.25 N at most, at"),
        "{said}"
    );
    assert!(
        said.contains("over speeds of 0 to 0.1 m/s (those of the log)"),
        "{said}"
    );
}

/// No other numbers are nearer, for any law; the error is the one that is stated, at the head of every file too.
#[test]
fn the_numbers_are_the_nearest() {
    for (name, friction) in laws() {
        for top in [0.01, 0.3] {
            let model = axis(friction, false, top);
            let [level, damping, at_rest] = written(&model);
            assert!(at_rest >= level, "{name}");
            let least = rms(&friction, level, damping, top);
            for (a, b) in [(1.01, 1.0), (0.99, 1.0), (1.0, 1.01), (1.0, 0.99)] {
                let other = rms(&friction, a * level, b * damping, top);
                assert!(
                    damping == 0.0 && b != 1.0 || other > least,
                    "{name} {top}: {other} {least}"
                );
            }
            let message = said(&model);
            let stated = number(&message, "off by ");
            assert!(
                (stated - least).abs() <= 2e-3 * least,
                "{name} {top}: {stated} {least}"
            );
            for target in [Target::Urdf, Target::Sdf, Target::IsaacLab] {
                let text = text(&model, target);
                assert!(text.contains(&format!("NOTE: {message}")), "{name}: {text}");
            }
        }
    }
}

/// A level that falls over all speeds of the log, without viscous friction: no joint has negative damping.
#[test]
fn damping_is_never_negative() {
    let side = Direction {
        coulomb: 10.0,
        static_friction: 20.0,
        stribeck_velocity: 0.1,
        viscous: 0.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
    let mut model = axis(Friction::Stribeck(curve), false, 0.1);
    let [level, damping, at_rest] = written(&model);
    // 10 + 10 sqrt(pi)/2 erf(1) N
    assert!((level - 17.468).abs() < 1e-3, "{level}");
    assert_eq!([damping, at_rest], [0.0, 20.0]);
    // Without the speeds of the log: a hundred Stribeck velocities.
    model.top_speed = None;
    let said = said(&model);
    assert!(
        said.contains("over speeds of 0 to 10 m/s (assumed"),
        "{said}"
    );
    let flat = CoulombViscous::symmetric(5.0, 1.0, 0.0).unwrap();
    model.friction = Friction::Coulomb(flat);
    let message = advice(&model, Target::Sdf).remove(0).message;
    assert!(message.contains("off by 0 N rms (0.0 percent"), "{message}");
    assert!(message.contains("0 to 1 m/s"), "{message}");
}

fn models() -> [(Model, [&'static str; 2]); 2] {
    let law = laws().remove(0).1;
    [
        (axis(law, false, 0.2), ["prismatic", "prismatic"]),
        (axis(law, true, 0.2), ["continuous", "revolute"]),
    ]
}

/// What MuJoCo makes of the URDF: its numbers, whether 0.9 times the friction holds, and the speed at twice the friction.
const PUSH: &str = r#"
import mujoco
model = mujoco.MjModel.from_xml_path("x_axis_friction.urdf")
print(repr(float(model.dof_frictionloss[0])), repr(float(model.dof_damping[0])), end=" ")
model.opt.gravity[:] = 0
model.opt.timestep = 1e-4
for share in [0.9, 2.0]:
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = share * model.dof_frictionloss[0]
    for k in range(20000):
        mujoco.mj_step(model, data)
    print(repr(float(data.qvel[0])), end=" ")
"#;

#[test]
fn mujoco_and_urdfdom_read_the_urdf() {
    for (mut model, [kind, _]) in models() {
        model.title = "a -- b --> c --- d".into();
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::Urdf).unwrap(), dir.path());
        let [friction, damping, _] = written(&model);
        std::fs::write(dir.path().join("push.py"), PUSH).unwrap();
        let said = python("push.py", &[], dir.path());
        let numbers: Vec<f64> = said
            .split_whitespace()
            .map(|n| n.parse().unwrap())
            .collect();
        assert_eq!(numbers[..2], [friction, damping]);
        let due = friction / damping;
        // Friction in MuJoCo is soft: below its level a joint creeps.
        assert!(numbers[2].abs() < 0.03 * due, "{said}");
        assert!((numbers[3] - due).abs() < 1e-3 * due, "{said} {due}");
        let said = run("check_urdf", &["x_axis_friction.urdf"], dir.path());
        assert!(said.contains("Successfully Parsed XML"), "{said}");
        let text = std::fs::read_to_string(dir.path().join("x_axis_friction.urdf")).unwrap();
        assert!(text.contains(&format!("type=\"{kind}\"")), "{text}");
    }
}

const SDF: &str = r#"
#include <cstdio>
#include <sdf/sdf.hh>
int main()
{
    sdf::Root root;
    const sdf::Errors errors = root.Load("x_axis_friction.sdf");
    for (const auto &error : errors) { (void)printf("%s\n", error.Message().c_str()); }
    if (!errors.empty()) { return 1; }
    const sdf::Joint *joint = root.Model()->JointByName("x_axis_joint");
    const sdf::JointAxis *axis = joint->Axis(0);
    (void)printf("%.17g %.17g %d\n", axis->Friction(), axis->Damping(), joint->Type() == sdf::JointType::PRISMATIC);
    return 0;
}
"#;

#[test]
fn libsdformat_reads_the_sdf() {
    let reader = tempfile::tempdir().unwrap();
    std::fs::write(reader.path().join("read.cpp"), SDF).unwrap();
    let build = "g++ -std=c++17 -o read read.cpp $(pkg-config --cflags --libs sdformat12)";
    run("sh", &["-c", build], reader.path());
    let read = reader.path().join("read");
    for (model, [_, kind]) in models() {
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::Sdf).unwrap(), dir.path());
        let said = run(read.to_str().unwrap(), &[], dir.path());
        let numbers: Vec<f64> = said
            .split_whitespace()
            .map(|n| n.parse().unwrap())
            .collect();
        let [friction, damping, _] = written(&model);
        let linear = f64::from(u8::from(kind == "prismatic"));
        assert_eq!(numbers, [friction, damping, linear]);
    }
}

/// The snippet as Python reads it: one call with numbers, of which the static friction is not below the dynamic.
const TREE: &str = r#"
import ast
tree = ast.parse(open("x_axis_friction.py").read())
compile(tree, "x_axis_friction.py", "exec")
imported, assigned = tree.body
assert imported.module == "isaaclab.actuators" and imported.names[0].name == assigned.value.func.id == "ImplicitActuatorCfg"
assert assigned.targets[0].id == "X_AXIS_FRICTION"
given = {word.arg: ast.literal_eval(word.value) for word in assigned.value.keywords}
assert list(given) == ["joint_names_expr", "stiffness", "damping", "friction", "dynamic_friction", "viscous_friction"], given
assert given["joint_names_expr"] == ["x_axis_joint"]
print(given["friction"], given["dynamic_friction"], given["viscous_friction"])
"#;

#[test]
fn python_reads_the_snippet() {
    for (mut model, _) in models() {
        model.title = "a \"\"\" b ''' \\ #".into();
        let dir = tempfile::tempdir().unwrap();
        write(&export(&model, Target::IsaacLab).unwrap(), dir.path());
        std::fs::write(dir.path().join("read.py"), TREE).unwrap();
        let said = python("read.py", &[], Path::new(dir.path()));
        let numbers: Vec<f64> = said
            .split_whitespace()
            .map(|n| n.parse().unwrap())
            .collect();
        let [friction, damping, at_rest] = written(&model);
        assert_eq!(numbers, [at_rest, friction, damping]);
        assert_eq!(at_rest, 18.0);
    }
}

/// The pages have the numbers of this model.
#[test]
fn the_pages_have_these_numbers() {
    let model = models()[0].0.clone();
    let folder = stiction_testkit::workspace().join("docs/deploy");
    let page = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let message = said(&model);
    for line in [
        format!(
            "| root of the mean square | {} |",
            number(&message, "off by ")
        ),
        format!(
            "| largest, at standstill | {} |",
            number(&message, "static friction), ")
        ),
    ] {
        assert!(page("urdf.md").contains(&line), "{line}");
    }
    for (name, target, keys) in [
        ("urdf.md", Target::Urdf, &["<dynamics "][..]),
        ("sdf.md", Target::Sdf, &["<damping>", "<friction>"]),
        (
            "isaaclab.md",
            Target::IsaacLab,
            &["friction=", "dynamic_", "viscous_"],
        ),
    ] {
        for line in text(&model, target).lines().map(str::trim) {
            if keys.iter().any(|key| line.starts_with(key)) {
                assert!(page(name).contains(line), "{name}: {line}");
            }
        }
    }
}

/// What the limit, the cycle time and the bristles would be warned of is nothing to a joint.
#[test]
fn nothing_else_is_warned_of() {
    let side = Direction {
        coulomb: 12.0,
        static_friction: 18.0,
        stribeck_velocity: 3e-3,
        viscous: 30.0,
    };
    let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
    let law = LuGre::new(1e9, Damping::Constant(1e6), curve).unwrap();
    let mut model = axis(Friction::LuGre(law), false, 0.2);
    model.settings.limit = 1.0;
    said(&model);
}
