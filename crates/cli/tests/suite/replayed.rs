//! A measured robot in MuJoCo: identified on the first half of its log, replayed on the second.

use std::path::Path;
use std::process::Command;

fn said(command: &mut Command) -> String {
    let output = command
        .output()
        .unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(0), "{text}{errors}");
    text
}

/// Position error over windows of 0.1 s that the measured torques drive.
#[test]
#[ignore = "soak: the URDF of a UR10 in example-robot-data, and MuJoCo"]
fn a_replay_of_what_was_identified_is_nearest_to_the_machine() {
    let Some(data) = stiction_testkit::recordings() else {
        return;
    };
    let bag = data.join("robots/ur10_panda/ur10.db3");
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let local = stiction_testkit::workspace().join(".venv/bin/python");
    let python = std::env::var_os("STICTION_PYTHON").unwrap_or_else(|| local.into());
    let robots =
        std::env::var_os("STICTION_PINOCCHIO").expect("cargo xtask soak sets STICTION_PINOCCHIO");
    let list = said(
        Command::new(robots)
            .arg(own.join("../rigid/tests/pinocchio/robots.py"))
            .arg("list"),
    );
    let urdf = list.lines().find(|path| path.ends_with("ur10_robot.urdf"));
    let urdf = urdf.unwrap();
    let folder = tempfile::tempdir().unwrap();
    let stiction = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
        said(command.args(arguments).current_dir(folder.path()))
    };
    let bag = bag.to_str().unwrap();
    stiction(&[
        "robot", bag, "--urdf", urdf, "--split", "0.5", "--out", "arm",
    ]);
    let export = "export arm/robot.toml --target mujoco --name arm --out mujoco";
    stiction(&export.split(' ').collect::<Vec<_>>());
    let replay = said(
        Command::new(python)
            .arg(own.join("tests/replay.py"))
            .args([bag, "mujoco", "arm", urdf])
            .current_dir(folder.path()),
    );
    println!("{replay}");
    let errors: Vec<f64> = replay
        .lines()
        .map(|line| line.split(' ').nth(1).unwrap().parse().unwrap())
        .collect();
    let [identified, nominal, zero] = errors[..] else {
        panic!("{replay}")
    };
    // .0105, 2.8 and .71 rad on 2026-11-30.
    assert!(identified < 0.02, "{replay}");
    assert!(
        nominal > 10.0 * identified && zero > 10.0 * identified,
        "{replay}"
    );
}
