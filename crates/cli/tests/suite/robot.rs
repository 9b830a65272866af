//! `robot` as a user meets it: an arm of two links whose torque is known in closed form.

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Two links that hang from a shoulder, with the mass of the second one wrong by a fifth.
const URDF: &str = r#"<robot name="arm"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0 -0.25"/><mass value="5"/>
  <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.02"/></inertial></link>
<link name="lower"><inertial><origin xyz="0 0 -0.2"/><mass value="3.6"/>
  <inertia ixx="0.05" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.01"/></inertial></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" effort="100" velocity="5"/></joint>
<joint name="elbow" type="revolute"><origin xyz="0 0 -0.5"/><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" effort="100" velocity="5"/></joint>
</robot>
"#;
/// Mass of the second link, kg.
const MASS: f64 = 3.0;
/// Coulomb and viscous friction, N m and N m s/rad, and the inertia of the rotor, kg m^2, of each joint.
const FRICTION: [[f64; 3]; 2] = [[4.0, 6.0, 0.3], [1.5, 2.0, 0.1]];

/// Torque of the links without friction: the equations of a double pendulum.
fn torque(q: [f64; 2], v: [f64; 2], a: [f64; 2]) -> [f64; 2] {
    let (m1, c1, i1, l1) = (5.0, 0.25, 0.1, 0.5);
    let (m2, c2, i2) = (MASS, 0.2, 0.05);
    let g = 9.81;
    let (cos, sin) = (libm::cos(q[1]), libm::sin(q[1]));
    let both = i2 + m2 * (c2 * c2 + l1 * c2 * cos);
    let first = i1 + m1 * c1 * c1 + i2 + m2 * (l1 * l1 + c2 * c2 + 2.0 * l1 * c2 * cos);
    let h = m2 * l1 * c2 * sin;
    let lower = m2 * c2 * g * libm::sin(q[0] + q[1]);
    let upper = (m1 * c1 + m2 * l1) * g * libm::sin(q[0]);
    [
        first * a[0] + both * a[1] - h * (2.0 * v[0] * v[1] + v[1] * v[1]) + upper + lower,
        both * a[0] + (i2 + m2 * c2 * c2) * a[1] + h * v[0] * v[0] + lower,
    ]
}

/// Position, velocity and acceleration of a joint.
fn motion(joint: usize, t: f64) -> [f64; 3] {
    let sines = [
        [[0.7, 0.9], [0.25, 2.3], [0.1, 4.1]],
        [[0.6, 1.3], [0.3, 1.9], [0.12, 3.7]],
    ];
    let mut out = [0.0; 3];
    for [size, w] in sines[joint] {
        out[0] += size * libm::sin(w * t);
        out[1] += size * w * libm::cos(w * t);
        out[2] -= size * w * w * libm::sin(w * t);
    }
    out
}

/// A log of the arm at 200 Hz, with encoder steps and noise.
fn log(folder: &Path, name: &str, seconds: usize) {
    let mut text = String::from(
        "time [s],shoulder_position [rad],shoulder_torque [N*m],elbow_position [rad],elbow_torque [N*m]\n",
    );
    let mut noise = 7_u32;
    let mut normal = move || {
        let mut sum = 0.0;
        for _ in 0..12 {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            sum += f64::from(noise) / f64::from(u32::MAX) - 0.5;
        }
        sum
    };
    for k in 0..200 * seconds {
        let t = k as f64 * 5e-3;
        let [one, two] = [motion(0, t), motion(1, t)];
        let rigid = torque([one[0], two[0]], [one[1], two[1]], [one[2], two[2]]);
        let _ = write!(text, "{t:.3}");
        for (joint, [q, v, a]) in [one, two].into_iter().enumerate() {
            let [coulomb, viscous, rotor] = FRICTION[joint];
            let friction = coulomb * libm::tanh(v / 1e-3) + viscous * v;
            let all = rigid[joint] + friction + rotor * a + 0.1 * normal();
            let step = 1e-5;
            let _ = write!(text, ",{:.5},{all:.4}", (q / step).round() * step);
        }
        text.push('\n');
    }
    std::fs::write(folder.join(name), text).unwrap();
}

fn bench() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.urdf"), URDF).unwrap();
    folder
}

fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
    command
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null());
    crate::split(command.output().unwrap())
}

#[test]
fn an_arm_is_identified_and_written() {
    let folder = bench();
    let dir = folder.path();
    log(dir, "run.csv", 60);
    let (code, out, err) = run(
        dir,
        &[
            "robot", "run.csv", "--urdf", "arm.urdf", "--split", "0.6", "--out", "out",
        ],
    );
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.lines().count() <= 20 + 2, "{out}");
    assert!(
        out.contains("2 joints: shoulder, elbow (columns by the names of the joints)"),
        "{out}"
    );
    assert!(out.contains("for feedforward  yes"), "{out}");
    let next = "next: stiction export out/robot.toml --target urdf --out out/urdf";
    assert_eq!(out.lines().last(), Some(next), "{out}");

    // What is known of the arm.
    let text = std::fs::read_to_string(dir.join("out/robot.json")).unwrap();
    let file: stiction_files::robot::result::RobotFile = serde_json::from_str(&text).unwrap();
    for (joint, [coulomb, viscous, rotor]) in file.joints.iter().zip(FRICTION) {
        let fit = joint.fit.as_ref().unwrap();
        let near = |found: f64, truth: f64, part: f64| (found / truth - 1.0).abs() < part;
        let found = fit.coulomb.as_ref().unwrap().value;
        assert!(near(found, coulomb, 0.1), "{} {found}", joint.name);
        let found = fit.viscous.as_ref().unwrap().value;
        assert!(near(found, viscous, 0.1), "{} {found}", joint.name);
        assert!(fit.held_out_rms < 0.1 * fit.torque_rms, "{fit:?}");
        let both = fit.armature.value;
        assert!(both >= 0.0 && both < 5.0 * rotor, "{both}");
    }
    let moment = file
        .base
        .iter()
        .find(|own| own.name.ends_with("mz(elbow)"))
        .unwrap();
    assert!(
        (moment.value.abs() / (0.2 * MASS) - 1.0).abs() < 0.03,
        "{moment:?}"
    );

    // Each joint is a model of an axis, and the robot file leads back to the URDF.
    let (code, said, err) = run(
        dir,
        &[
            "export",
            "out/joints/elbow/model.toml",
            "--target",
            "c",
            "--out",
            "c",
        ],
    );
    assert!(code < 2, "{said}{err}");
    for name in ["result.json", "model.toml", "fit.csv"] {
        assert!(
            dir.join("out/joints/shoulder").join(name).is_file(),
            "{name}"
        );
    }
    let robot = std::fs::read_to_string(dir.join("out/robot.toml")).unwrap();
    assert!(robot.contains("urdf = \"../arm.urdf\""), "{robot}");
    let export = [
        "export",
        "out/robot.toml",
        "--target",
        "urdf",
        "--out",
        "out/urdf",
    ];
    let (code, said, err) = run(dir, &export);
    assert!(code < 2, "{said}{err}");
    let (code, _, err) = run(dir, &["export", "out", "--target", "urdf", "--out", "u"]);
    assert_eq!(code, 2);
    let next = "next: stiction export out/robot.toml --target urdf --out u\n";
    assert!(err.ends_with(next), "{err}");
    let page = std::fs::read_to_string(dir.join("out/report.html")).unwrap();
    for words in [
        "Torque of each joint",
        "shoulder",
        "elbow",
        "base parameter",
        "upper",
        "lower",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert!(page.len() < 1_500_000, "{}", page.len());

    // The same again takes the place of it; another folder is left alone.
    std::fs::create_dir(dir.join("other")).unwrap();
    std::fs::write(dir.join("other/notes.txt"), "mine").unwrap();
    let (code, _, err) = run(
        dir,
        &["robot", "run.csv", "--urdf", "arm.urdf", "--out", "other"],
    );
    assert_eq!(code, 2, "{err}");
    let (code, json, _) = run(
        dir,
        &[
            "robot", "run.csv", "--urdf", "arm.urdf", "--split", "0.6", "--out", "out", "--json",
        ],
    );
    assert_eq!(code, 0);
    assert_eq!(
        serde_json::from_str::<stiction_files::robot::result::RobotFile>(&json).unwrap(),
        file
    );
}

#[test]
fn what_a_robot_lacks_is_said() {
    let folder = bench();
    let dir = folder.path();
    log(dir, "run.csv", 5);
    let (code, _, err) = run(dir, &["robot", "run.csv", "--out", "out"]);
    assert_eq!(code, 2);
    assert!(err.contains("--urdf"), "{err}");
    let (code, _, err) = run(
        dir,
        &["robot", "run.csv", "--urdf", "gone.urdf", "--out", "out"],
    );
    assert_eq!(code, 2);
    assert!(
        err.contains("gone.urdf") && err.ends_with("next: ls .\n"),
        "{err}"
    );
    // Files in each other's place.
    std::fs::write(dir.join("robot.toml"), "urdf = \"arm.urdf\"\n").unwrap();
    let (code, _, err) = run(dir, &["identify", "robot.toml", "--out", "out"]);
    assert_eq!(code, 2);
    let next = "next: stiction robot log.csv --axis robot.toml --out robot\n";
    assert!(err.ends_with(next), "{err}");
    std::fs::remove_file(dir.join("robot.toml")).unwrap();
    std::fs::write(
        dir.join("axis.toml"),
        "kind = \"rotary\"\n[columns]\nposition = \"q\"\n",
    )
    .unwrap();
    let typed = [
        "robot",
        "run.csv",
        "--urdf",
        "arm.urdf",
        "--axis",
        "axis.toml",
        "--out",
        "out",
    ];
    let (code, _, err) = run(dir, &typed);
    assert_eq!(code, 2, "{err}");
    let next = "next: stiction robot run.csv --urdf arm.urdf --out out\n";
    assert!(err.ends_with(next), "{err}");
    std::fs::write(dir.join("half.urdf"), &URDF[..200]).unwrap();
    let (code, _, err) = run(
        dir,
        &["robot", "run.csv", "--urdf", "half.urdf", "--out", "out"],
    );
    assert_eq!(code, 2);
    assert!(err.contains("correct half.urdf, then"), "{err}");
    assert!(!dir.join("out").exists());
}

/// The measured arms, of which the URDF is not in the tree: one of the same joints in its place.
#[test]
fn a_bag_of_joints_leads_to_its_robot() {
    let Some(data) = stiction_testkit::recordings() else {
        return;
    };
    let folder = bench();
    let dir = folder.path();
    let bag = data.join("robots/ur10_panda/ur10.db3");
    let bag = bag.to_str().unwrap();
    let (code, _, err) = run(dir, &["identify", bag, "--out", "out"]);
    assert_eq!(code, 2);
    let lead = format!(
        "for all joints of a robot at once: stiction robot {bag} --urdf ARM.urdf --out robot"
    );
    assert!(err.contains(&lead), "{err}");
    std::fs::write(
        dir.join("two.urdf"),
        URDF.replace("shoulder", "wrist_1_joint")
            .replace("elbow", "wrist_2_joint"),
    )
    .unwrap();
    let (code, out, err) = run(dir, &["robot", bag, "--urdf", "two.urdf", "--out", "two"]);
    assert!(code < 2, "{err}");
    assert!(
        out.contains("2 joints: wrist_1_joint, wrist_2_joint (columns by the names of the joints)"),
        "{out}"
    );
    assert!(out.contains("at 125.0 Hz"), "{out}");
    assert!(dir.join("two/robot.toml").is_file());
}
