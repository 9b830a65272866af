//! Robots: the files of all joints, each read by what receives it.

use crate::common::compiled::{gcc, run, write};
use crate::common::terms::with_terms;
use crate::common::{adapting, laws, model};
use crate::mujoco::python;
use std::path::Path;
use stiction_export::{Error, File, Load, Robot, RobotJoint, Target, export_robot};
use stiction_rigid::Document;
use stiction_rigid::urdf::{Inertial, Pose};

const STRICT: &str = "-std=c99 -pedantic -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Wstrict-prototypes \
     -Wmissing-prototypes -Wfloat-equal -Wsign-conversion -Wundef -Wcast-qual -O2 -Werror";
const SANITIZE: &str = "-fsanitize=undefined -fno-sanitize-recover=all";

/// An arm on a rail with a shape, a link without a joint of its own, a joint that follows and one without friction.
const URDF: &str = r#"<?xml version="1.0"?>
<!-- the arm -->
<robot name="arm">
  <link name="base"/>
  <link name="carriage">
    <inertial><origin xyz="0.1 0 0.05" rpy="0.1 0.2 0.3"/><mass value="4.0"/>
      <inertia ixx="0.04" ixy="0.001" ixz="0" iyy="0.05" iyz="0.002" izz="0.06"/></inertial>
    <visual><geometry><mesh filename="package://nowhere/carriage.stl"/></geometry></visual>
  </link>
  <joint name="rail" type="prismatic">
    <parent link="base"/><child link="carriage"/>
    <origin xyz="0 0 1" rpy="0.3 -0.2 0.1"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="200" velocity="2"/>
  </joint>
  <link name="upper">
    <inertial><origin xyz="0 0.02 0.2"/><mass value="2.5"/>
      <inertia ixx="0.03" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.004"/></inertial>
  </link>
  <joint name="shoulder &quot;1&quot;" type="revolute">
    <parent link="carriage"/><child link="upper"/>
    <origin xyz="0.1 0 0.2" rpy="0 1.1 0"/><axis xyz="0.6 0 0.8"/>
    <limit lower="-3" upper="3" effort="0" velocity="2"/>
    <dynamics damping="0.5"/>
  </joint>
  <link name="lower">
    <inertial><origin xyz="0.01 0 0.15"/><mass value="1.5"/>
      <inertia ixx="0.012" ixy="0" ixz="0.001" iyy="0.012" iyz="0" izz="0.002"/></inertial>
  </link>
  <joint name="elbow" type="continuous">
    <parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 0.4"/><axis xyz="0 1 0"/>
  </joint>
  <link name="hand">
    <inertial><origin xyz="0 0 0.03"/><mass value="0.4"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.0005"/></inertial>
  </link>
  <joint name="flange" type="fixed">
    <parent link="lower"/><child link="hand"/><origin xyz="0 0 0.3" rpy="0.5 0 0"/>
  </joint>
  <link name="finger">
    <inertial><origin xyz="0 0.01 0.02"/><mass value="0.1"/>
      <inertia ixx="0.0001" ixy="0" ixz="0" iyy="0.0001" iyz="0" izz="0.0001"/></inertial>
  </link>
  <joint name="grip" type="revolute">
    <parent link="hand"/><child link="finger"/>
    <origin xyz="0 0.02 0.05"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" effort="5" velocity="2"/>
  </joint>
  <link name="other_finger">
    <inertial><origin xyz="0 -0.01 0.02"/><mass value="0.1"/>
      <inertia ixx="0.0001" ixy="0" ixz="0" iyy="0.0001" iyz="0" izz="0.0001"/></inertial>
  </link>
  <joint name="other_grip" type="revolute">
    <parent link="hand"/><child link="other_finger"/>
    <origin xyz="0 -0.02 0.05"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" effort="5" velocity="2"/>
    <mimic joint="grip" multiplier="-1.5" offset="0.1"/>
  </joint>
</robot>
"#;

/// A joint whose law is the one of this number.
fn joint(name: &str, law: usize, rotary: bool) -> RobotJoint {
    let mut model = match law {
        0 => model(laws().remove(0).1),
        law => with_terms(laws().remove(law).1, law),
    };
    model.rotary = rotary;
    model.force_unit = if rotary { "N m" } else { "N" }.into();
    RobotJoint {
        name: name.into(),
        model,
        armature: [0.02, 0.11, 0.71][law % 3],
        simulators: (law != 1).then_some([0.25 + law as f64, 1.0 / 3.0]),
    }
}

/// What was identified of a link.
fn upper() -> Inertial {
    Inertial {
        mass: 2.25,
        origin: Pose {
            xyz: [0.01, 0.02, 0.2],
            rpy: [0.0; 3],
        },
        inertia: [0.03, 1e-5, 0.031, 0.0, 0.0, 0.004],
        line: 0,
    }
}

fn robot() -> Robot {
    let joints = vec![
        joint("rail", 1, false),
        joint("shoulder \"1\"", 0, true),
        joint("elbow", 7, true),
    ];
    let provenance = joints[0].model.provenance.clone();
    Robot {
        title: "arm -- größe */".into(),
        identifier: "arm".into(),
        urdf: URDF.into(),
        inertials: vec![("upper".into(), upper())],
        gravity: [0.5, -1.0, -9.7],
        load: Some(Load {
            link: "hand".into(),
            mass: 1.25,
            center: [0.01, 0.02, 0.1],
        }),
        joints,
        feeds_rigid: false,
        draws: None,
        notes: vec!["the URDF is another one".into()],
        provenance,
    }
}

fn exported(robot: &Robot, target: Target) -> (tempfile::TempDir, Vec<File>) {
    let dir = tempfile::tempdir().unwrap();
    let files = export_robot(robot, target).unwrap();
    write(&files, dir.path());
    (dir, files)
}

fn compiled(dir: &Path, robot: &str, joints: &[&str], suffix: &str) -> String {
    let joints = joints.iter().map(|j| format!("{j}_friction{suffix}.c"));
    let all: Vec<String> = joints
        .chain([
            format!("{robot}_robot{suffix}.c"),
            format!("{robot}_robot{suffix}_selftest.c"),
        ])
        .collect();
    let mut rest: Vec<&str> = all.iter().map(String::as_str).collect();
    rest.push("-lm");
    gcc(&format!("{STRICT} {SANITIZE}"), &rest, dir);
    run("./a.out", &[], dir)
}

#[test]
fn the_c_of_all_joints_passes_its_self_test_under_every_warning() {
    let names = ["arm_rail", "arm_shoulder_1", "arm_elbow"];
    for (rigid, adapts) in [(false, false), (true, false), (true, true)] {
        let mut robot = robot();
        robot.feeds_rigid = rigid;
        if adapts {
            let settings = &mut robot.joints[1].model.settings;
            *settings = adapting(*settings);
        }
        let (dir, _) = exported(&robot, Target::C);
        for suffix in ["", "_f32"] {
            let said = compiled(dir.path(), "arm", &names, suffix);
            let due = if rigid {
                "ok: 16 motions"
            } else {
                "ok: 3 joints"
            };
            assert!(said.starts_with(due), "{rigid} {suffix}: {said}");
            println!("{suffix} {said}");
        }
    }
}

/// A torque that is wrong by a little is found by the self-test.
#[test]
fn the_self_test_fails_for_another_robot() {
    let mut robot = robot();
    robot.feeds_rigid = true;
    let (dir, _) = exported(&robot, Target::C);
    let path = dir.path().join("arm_robot.c");
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text.matches("{ 0.0, 0.0, 0.4 }").count(), 1);
    let text = text.replace("{ 0.0, 0.0, 0.4 }", "{ 0.0, 0.0, 0.4000000001 }");
    std::fs::write(&path, text).unwrap();
    let names = ["arm_rail", "arm_shoulder_1", "arm_elbow"];
    let mut all = names.map(|name| format!("{name}_friction.c")).to_vec();
    all.extend(["arm_robot.c", "arm_robot_selftest.c", "-lm"].map(String::from));
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    gcc(STRICT, &all, dir.path());
    let output = std::process::Command::new(dir.path().join("a.out")).output();
    let said = String::from_utf8(output.unwrap().stdout).unwrap();
    assert!(said.starts_with("FAIL: 16 motions"), "{said}");
}

/// The torque in C of robots whose torques were computed by Pinocchio: its own vectors are those of `stiction-rigid`.
#[test]
fn the_torque_is_that_of_pinocchio() {
    let folder = stiction_testkit::workspace().join("crates/rigid/tests/pinocchio");
    for (name, first) in [("arm6", "joint1"), ("arm7", "joint1"), ("tree", "rail")] {
        let urdf = std::fs::read_to_string(folder.join(format!("{name}.urdf"))).unwrap();
        // Pinocchio computes a joint that follows another as one of its own.
        let followed = |line: &&str| !line.contains("<mimic");
        let urdf: Vec<&str> = urdf.lines().filter(followed).collect();
        let urdf = urdf.join("\n");
        let document = Document::parse(&urdf).unwrap();
        let moving = document.joints.iter();
        let moving = moving.filter(|j| j.kind != stiction_rigid::urdf::Kind::Fixed);
        let names: Vec<&str> = moving.map(|j| j.name.as_str()).collect();
        let known = std::fs::read_to_string(folder.join(format!("{name}.txt"))).unwrap();
        let order: Vec<&str> = known.lines().next().unwrap().split(' ').skip(1).collect();
        let own = stiction_rigid::Robot::new(&document).unwrap();
        let independent = own.independent();
        let fitted = names.iter().find(|n| **n == first).unwrap_or(&names[0]);
        let mut robot = robot();
        robot.urdf = urdf;
        robot.inertials.clear();
        robot.joints = vec![joint(fitted, 0, *fitted != "rail")];
        robot.load = None;
        robot.gravity = stiction_rigid::GRAVITY;
        robot.feeds_rigid = true;
        let (dir, _) = exported(&robot, Target::C);
        let size = independent.len();
        let main = format!(
            "#include \"arm_robot.h\"\n#include <stdio.h>\nint main(void)\n{{\n    double x[4][{size}];\n\
             while (fread(x, sizeof(double), 3 * {size}, stdin) == 3 * {size}) {{\n\
             arm_robot_torque(x[0], x[1], x[2], x[3]);\n\
             for (int i = 0; i < {size}; i++) {{ printf(\"%.17g \", x[3][i]); }}\n}}\nreturn 0;\n}}\n"
        );
        std::fs::write(dir.path().join("main.c"), main).unwrap();
        let friction = format!(
            "{}_friction.c",
            stiction_export::joint_identifiers("arm", &[fitted])[0]
        );
        gcc(
            "-std=c99 -O2",
            &["main.c", "arm_robot.c", &friction, "-lm"],
            dir.path(),
        );
        // From the order of Pinocchio to that of the code and back.
        let places: Vec<usize> = independent
            .iter()
            .map(|i| {
                order
                    .iter()
                    .position(|n| *n == own.joints()[*i].name)
                    .unwrap()
            })
            .collect();
        let values = |word: &str| -> Vec<Vec<f64>> {
            let lines = known.lines().filter_map(|line| line.strip_prefix(word));
            let rows = lines.filter_map(|line| line.strip_prefix(' '));
            let row = |line: &str| -> Vec<f64> {
                let all: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
                places.iter().map(|k| all[*k]).collect()
            };
            rows.map(row).collect()
        };
        let [q, v, a, torque] = ["q", "v", "a", "torque"].map(values);
        let mut bytes = Vec::new();
        for k in 0..q.len() {
            let all = [&q[k], &v[k], &a[k]].into_iter().flatten();
            bytes.extend(all.flat_map(|x| x.to_le_bytes()));
        }
        std::fs::write(dir.path().join("in"), bytes).unwrap();
        let said = run("sh", &["-c", "./a.out < in"], dir.path());
        let found: Vec<f64> = said
            .split_whitespace()
            .map(|x| x.parse().unwrap())
            .collect();
        let due: Vec<f64> = torque.into_iter().flatten().collect();
        assert_eq!(found.len(), due.len());
        let scale = due.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let off = found.iter().zip(&due).map(|(x, y)| (x - y).abs());
        let worst = off.fold(0.0, f64::max) / scale;
        assert!(worst < 1e-12, "{name}: {worst}");
        println!("{name}: {worst:.1e}");
    }
}

/// Every byte of the URDF but those of the joints' friction.
#[test]
fn the_urdf_is_the_one_that_was_given() {
    let robot = robot();
    let files = export_robot(&robot, Target::Urdf).unwrap();
    assert_eq!(files.len(), 1);
    assert_eq!(files[0].path, "arm.urdf");
    let mut old = String::from_utf8(files[0].bytes.clone()).unwrap();
    for (new, given) in [
        ("<dynamics damping=\"0.333333\" friction=\"7.25\"/>", ""),
        (
            "\n    <dynamics damping=\"74.4322\" friction=\"17.066\"/>",
            "",
        ),
        ("damping=\"0.333333\" friction=\"0.25\"", "damping=\"0.5\""),
        ("0.01 0.02 0.2", "0 0.02 0.2"),
        ("value=\"2.25\"", "value=\"2.5\""),
        (
            "ixy=\"1e-5\" ixz=\"0\" iyy=\"0.031\"",
            "ixy=\"0\" ixz=\"0\" iyy=\"0.03\"",
        ),
    ] {
        assert_eq!(old.matches(new).count(), 1, "{new}\n{old}");
        old = old.replace(new, given);
    }
    assert_eq!(old, URDF);
    let xml = roxmltree::Document::parse(std::str::from_utf8(&files[0].bytes).unwrap()).unwrap();
    assert_eq!(
        xml.descendants()
            .filter(|n| n.has_tag_name("dynamics"))
            .count(),
        3
    );
}

/// Pinocchio reads the numbers of the URDF: torques at some states with its own gravity, friction and damping by joint.
const PINOCCHIO: &str = r#"
import sys
try:
    import pinocchio
except ImportError:
    print("skipped")
    sys.exit()
import numpy
model = pinocchio.buildModelFromUrdf("arm.urdf")
data = model.createData()
model.gravity.linear = numpy.array([0.5, -1.0, -9.7])
for line in open("states"):
    q, v, a = numpy.array(line.split(), float).reshape(3, -1)[:, [order for order in ORDER]]
    full = numpy.zeros(model.nq)
    for joint in list(model.joints)[1:]:
        x = q[joint.idx_v]
        full[joint.idx_q : joint.idx_q + joint.nq] = [x] if joint.nq == 1 else [numpy.cos(x), numpy.sin(x)]
    torque = numpy.empty(model.nv)
    torque[ORDER] = pinocchio.rnea(model, data, full, v, a)
    print(*(repr(float(x)) for x in torque))
"#;

#[test]
#[ignore = "soak: needs the package pin of PyPI beside mujoco"]
fn pinocchio_takes_the_urdf() {
    let (dir, files) = exported(&robot(), Target::Urdf);
    let text = std::str::from_utf8(&files[0].bytes).unwrap();
    let mut own = stiction_rigid::Robot::new(&Document::parse(text).unwrap()).unwrap();
    own.set_gravity(robot().gravity);
    let size = own.len();
    let value = |k: usize| 3.0 * (0.7 + 1.3 * k as f64).sin();
    let states: Vec<Vec<f64>> = (0..8)
        .map(|k| (0..3 * size).map(|i| value(31 * k + i)).collect())
        .collect();
    let line = |x: &Vec<f64>| x.iter().map(|x| format!("{x:?} ")).collect::<String>() + "\n";
    let lines: String = states.iter().map(line).collect();
    std::fs::write(dir.path().join("states"), lines).unwrap();
    let names: Vec<&str> = own.joints().iter().map(|j| j.name.as_str()).collect();
    // Joints of Pinocchio in the order of the robot's.
    let order = format!("ORDER = [{names:?}.index(name) for name in list(model.names)[1:]]\n");
    let script = PINOCCHIO.replace("for line in open", &format!("{order}for line in open"));
    std::fs::write(dir.path().join("read.py"), script).unwrap();
    let said = python("read.py", &[], dir.path());
    if said.starts_with("skipped") {
        println!("SKIPPED: no package pin in this Python");
        return;
    }
    let mut workspace = stiction_rigid::Workspace::new(&own);
    let mut worst = 0.0_f64;
    assert_eq!(said.lines().count(), states.len());
    for (line, state) in said.lines().zip(&states) {
        let mut torque = vec![0.0; size];
        let [q, v, a] = [0, 1, 2].map(|i| &state[i * size..][..size]);
        own.torque([q, v, a], &own.parameters(), &mut workspace, &mut torque);
        for (x, due) in line.split(' ').zip(&torque) {
            worst = worst.max((x.parse::<f64>().unwrap() - due).abs());
        }
    }
    println!("Pinocchio: largest deviation {worst:.1e} N m");
    assert!(worst < 1e-11, "{worst}");
}

/// MuJoCo loads the URDF with every joint's numbers, gives the torques of the rigid body, and its bristles slide with the steady force.
#[test]
fn mujoco_takes_it() {
    let (dir, files) = exported(&robot(), Target::Mujoco);
    let paths: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
    assert_eq!(
        paths,
        [
            "arm.urdf",
            "arm_joints.xml",
            "arm_mujoco.py",
            "arm_bristles.xml"
        ]
    );
    let said = python("arm_mujoco.py", &[], dir.path());
    println!("{said}");
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines[4].starts_with("ok 16 motions"), "{said}");
    // What was given, or the nearest to the law, to six digits.
    assert_eq!(lines[1], "shoulder \"1\" 0.02 0.25 0.333333");
    assert_eq!(lines[2], "elbow 0.11 7.25 0.333333");
    assert!(lines[0].starts_with("rail 0.11"), "{said}");
    // The classes are valid in any model that includes them.
    let include = r#"
import mujoco
for friction in ["arm_joints.xml", "arm_bristles.xml"]:
    text = f'''<mujoco><include file="{friction}"/><worldbody><body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <joint name="shoulder &quot;1&quot;" class="arm_shoulder_1"/></body></worldbody></mujoco>'''
    open("whole.xml", "w").write(text)
    model = mujoco.MjModel.from_xml_path("whole.xml")
    print(float(model.dof_armature[0]), float(model.dof_frictionloss[0]), float(model.dof_damping[0]), model.nu, model.na)
"#;
    std::fs::write(dir.path().join("include.py"), include).unwrap();
    let said = python("include.py", &[], dir.path());
    assert_eq!(said, "0.02 0.25 0.333333 0 0\n0.02 0.0 30.0 0 1\n");
}

/// Python reads the numbers of every joint by patterns of its name alone.
#[test]
fn isaac_lab_takes_it() {
    let (dir, _) = exported(&robot(), Target::IsaacLab);
    let read = r#"
import ast, re
tree = ast.parse(open("arm_friction.py").read())
(call,) = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
given = {own.arg: ast.literal_eval(own.value) for own in call.keywords}
names = ["rail", 'shoulder "1"', "elbow", "xelbow", "elbow2"]
for own in given["joint_names_expr"]:
    (name,) = [name for name in names if re.fullmatch(own, name)]
    print(name, *(given[key][own] for key in ["armature", "friction", "dynamic_friction", "viscous_friction"]))
print(call.func.id, given["stiffness"], given["damping"], *(len(given[k]) for k in given if isinstance(given[k], dict)))
"#;
    std::fs::write(dir.path().join("read.py"), read).unwrap();
    let said = python("read.py", &[], dir.path());
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines[0].starts_with("rail 0.11 "), "{said}");
    // Static friction of the law, 18 N m.
    assert_eq!(lines[1], "shoulder \"1\" 0.02 18.0 0.25 0.333333");
    assert_eq!(lines[2], "elbow 0.11 17.0 7.25 0.333333");
    assert_eq!(lines[3], "ImplicitActuatorCfg None None 3 3 3 3");
}

/// Every joint has its numbers by its name for Newton, BAM and in the document, the same as for Isaac Lab.
#[test]
fn newton_bam_and_the_document_have_every_joint() {
    let mut robot = robot();
    robot.draws = Some(stiction_export::Draws {
        count: 3,
        seed: 1,
        width: stiction_export::Width::Transfer,
    });
    let (dir, files) = exported(&robot, Target::Newton);
    let paths: Vec<&str> = files.iter().map(|f| f.path.as_str()).collect();
    let due = [
        "arm.urdf",
        "arm_newton.py",
        "arm_domain.json",
        "arm_domain.py",
    ];
    assert_eq!(paths, due);
    for file in export_robot(&robot, Target::Bam).unwrap() {
        std::fs::write(dir.path().join(&file.path), &file.bytes).unwrap();
    }
    let read = r#"
import json
import arm_newton, arm_domain
domain = arm_domain.load()
nominal = arm_domain.numbers(domain)
for (name, own), code in zip(arm_newton.JOINTS.items(), ["arm_rail", "arm_shoulder_1", "arm_elbow"]):
    assert own == {key: nominal[name][of] for key, of in [("armature", "armature"), ("friction", "frictionloss"), ("damping", "damping")]}
    bam = json.load(open(code + "_bam.json"))
    print(name, own["armature"], own["friction"], own["damping"], nominal[name]["static_friction"], bam["model"], bam["armature"])
"#;
    std::fs::write(dir.path().join("read.py"), read).unwrap();
    let said = python("read.py", &[], dir.path());
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines[1], "shoulder \"1\" 0.02 0.25 0.333333 18.0 m2 0.02");
    assert_eq!(lines[2], "elbow 0.11 7.25 0.333333 17.0 m1 0.11");
    assert_eq!(lines.len(), 3);
}

/// yaml-cpp reads the parameters of all joints from one file, and each joint's class takes them.
#[test]
fn ros_2_takes_it() {
    let (dir, files) = exported(&robot(), Target::Ros2);
    let yaml = files.iter().filter(|f| f.path.ends_with(".yaml")).count();
    assert_eq!(yaml, 1);
    let names = ["arm_rail", "arm_shoulder_1", "arm_elbow"];
    for name in names {
        let test = format!("test/{name}/selftest.cpp");
        run(
            "g++",
            &[
                "-std=c++11",
                "-Wall",
                "-Wextra",
                "-Werror",
                "-Iinclude",
                &test,
            ],
            dir.path(),
        );
        assert!(run("./a.out", &[], dir.path()).starts_with("ok f64"));
    }
    let includes = names.map(|name| format!("#include <{name}_friction_ros2.hpp>\n"));
    let joints = names.map(|name| {
        format!(
            "    {{ {name}_friction::ros2::Friction own;\n      const {name}_friction::ros2::Parameters p = {name}_friction::ros2::parameters(get);\n\
             if (!own.configure(p)) {{ return 1; }} }}\n"
        )
    });
    let main = format!(
        "#include <string>\n#include <yaml-cpp/yaml.h>\n{}int main()\n{{\n\
         const YAML::Node tree = YAML::LoadFile(\"config/arm_friction.yaml\")[\"/**\"][\"ros__parameters\"];\n    unsigned asked = 0;\n\
         const auto get = [&](const std::string &name, double) {{ asked++; const size_t dot = name.find('.');\n\
         return tree[name.substr(0, dot)][name.substr(dot + 1)].as<double>(); }};\n{}\
         return (asked == 18 && tree.size() == 3) ? 0 : 2;\n}}\n",
        includes.concat(),
        joints.concat()
    );
    std::fs::write(dir.path().join("node.cpp"), main).unwrap();
    run(
        "g++",
        &["-std=c++17", "-Iinclude", "node.cpp", "-lyaml-cpp"],
        dir.path(),
    );
    run("./a.out", &[], dir.path());
}

#[test]
fn what_cannot_be_exported_is_refused() {
    let refused = |robot: &Robot, target| export_robot(robot, target).unwrap_err().to_string();
    for target in Target::ALL {
        if export_robot(&robot(), target).is_err() {
            let said = refused(&robot(), target);
            let due = "takes no robot; allowed: urdf, mujoco, isaaclab, newton, bam, domain-json, ros2 and c; or export the model.toml of a joint";
            assert!(said.contains(due), "{said}");
        }
    }
    let changed = |change: &dyn Fn(&mut Robot)| {
        let mut robot = robot();
        change(&mut robot);
        robot
    };
    for (robot, target, says) in [
        (
            changed(&|r| r.feeds_rigid = true),
            Target::Mujoco,
            "no feedforward of the rigid body",
        ),
        (
            changed(&|r| r.joints[0].name = "knee".into()),
            Target::C,
            "joint \"knee\": the URDF has no such moving joint",
        ),
        (
            changed(&|r| r.joints[0].name = "flange".into()),
            Target::C,
            "no such moving joint",
        ),
        (
            changed(&|r| r.joints[0].name = "other_grip".into()),
            Target::C,
            "it follows another joint",
        ),
        (
            changed(&|r| r.joints[1].name = "elbow".into()),
            Target::C,
            "joint \"elbow\": it is given twice",
        ),
        (
            changed(&|r| r.joints[1].model.force_unit = "A".into()),
            Target::IsaacLab,
            "joint \"shoulder \"1\"\": target isaaclab needs forces in N m",
        ),
        (
            changed(&|r| {
                r.joints[1].model.force_unit = "A".into();
                r.feeds_rigid = true;
            }),
            Target::C,
            "joint \"shoulder \"1\"\": target c needs forces in N m",
        ),
        (
            changed(&|r| r.joints[0].model.rotary = true),
            Target::C,
            "joint \"rail\": it slides, and its friction law is of a joint that turns",
        ),
        (
            changed(&|r| r.inertials[0].0 = "hip".into()),
            Target::Urdf,
            "URDF: link \"hip\": no such link",
        ),
        (
            changed(&|r| r.urdf = "<robot>".into()),
            Target::Urdf,
            "URDF: ",
        ),
        (
            changed(&|r| r.identifier = "2".into()),
            Target::C,
            "name \"2\"",
        ),
        (
            changed(&|r| r.load.as_mut().unwrap().link = "base".into()),
            Target::C,
            "it is part of the base",
        ),
    ] {
        let said = refused(&robot, target);
        assert!(said.contains(says), "{said}");
    }
    let current = changed(&|r| r.joints[1].model.force_unit = "A".into());
    assert!(matches!(
        export_robot(&current, Target::Mujoco),
        Err(Error::OfJoint { .. })
    ));
}

proptest::proptest! {
    /// No two names in the C of a robot are the same, in either precision and whatever the case of letters.
    #[test]
    fn names_are_distinct(joints in proptest::collection::vec("(robot|arm_|a|A|_f32|ä| ){1,4}", 1..8)) {
        let joints: Vec<&str> = joints.iter().map(String::as_str).collect();
        let names = stiction_export::joint_identifiers("arm", &joints);
        let mut all = vec!["arm_robot".to_string(), "arm_robot_f32".into()];
        for name in names {
            proptest::prop_assert!(stiction_export::check_identifier(&name).is_ok());
            proptest::prop_assert!(name.to_ascii_lowercase().starts_with("arm"));
            all.extend([format!("{name}_f32").to_ascii_lowercase(), name.to_ascii_lowercase()]);
        }
        let count = all.len();
        all.sort();
        all.dedup();
        proptest::prop_assert_eq!(all.len(), count);
    }
}

/// The text that the receiving engineer reads.
#[test]
fn texts() {
    let mut robot = robot();
    for (target, wanted) in [
        (Target::C, vec!["arm_robot.h", "arm_robot_f32.c"]),
        (Target::Mujoco, vec!["arm_bristles.xml", "arm_mujoco.py"]),
        (Target::IsaacLab, vec!["arm_friction.py"]),
        (Target::Ros2, vec!["config/arm_friction.yaml"]),
    ] {
        robot.feeds_rigid = target == Target::C;
        for file in export_robot(&robot, target).unwrap() {
            let text = String::from_utf8(file.bytes).unwrap();
            assert!(text.is_ascii() && !text.contains("*/ "), "{}", file.path);
            if wanted.contains(&file.path.as_str()) {
                insta::assert_snapshot!(format!("robot_{}", file.path.replace('/', "_")), text);
            }
        }
    }
}
