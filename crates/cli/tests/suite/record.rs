//! `stiction record` from servers that stand for a PLC and a robot.

use std::path::Path;
use std::process::{Command, Stdio};
use stiction_testkit::devices::{Plc, Robot, Script, Variable};

fn command(dir: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
    command
        .args(arguments)
        .current_dir(dir)
        .stdin(Stdio::null());
    command
}

fn run(dir: &Path, arguments: &[&str]) -> (i32, String, String) {
    crate::split(command(dir, arguments).output().unwrap())
}

fn samples(samples: usize) -> Script {
    Script {
        samples,
        ..Script::default()
    }
}

#[test]
fn a_log_of_a_plc_is_taken_by_check_as_it_is() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let variables = [
        Variable::Lreal("MAIN.fActPos"),
        Variable::Lreal("MAIN.fActForce"),
    ];
    for out in ["log.csv", "log.parquet"] {
        let plc = Plc::start(&variables, 1000.0, samples(3000));
        let url = format!("ads://5.12.34.56.1.1:851@{}/MAIN.fActPos=mm", plc.at());
        let typed = [
            "record",
            &url,
            "MAIN.fActForce=N",
            "--time",
            "2s",
            "--out",
            out,
        ];
        let (code, said, err) = run(dir, &typed);
        assert_eq!((code, err.as_str()), (0, ""), "{said}");
        let expected = format!(
            "recorded 2.000 s: 2001 samples at 1000 Hz\nwritten to {out}\nnext: stiction check {out}\n"
        );
        assert_eq!(said, expected);
        let (code, said, err) = run(dir, &["check", out, "--json"]);
        assert_eq!((code, err.as_str()), (0, ""), "{said}");
        assert!(said.contains("MAIN.fActPos"), "{said}");
        assert_eq!(plc.refused(), [""; 0]);
    }
}

#[test]
fn what_was_lost_is_said_and_a_device_that_is_gone_leaves_its_log() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    let script = Script {
        lost: (300..310).collect(),
        cuts: [300, 400].into(),
        ..samples(2000)
    };
    let robot = Robot::start(500.0, script);
    let url = format!("rtde://{}", robot.at());
    let typed = [
        "record", &url, "--rate", "0.5kHz", "--time", "2", "--out", "log.csv",
    ];
    let (code, said, err) = run(dir, &typed);
    assert_eq!((code, err.as_str()), (0, ""), "{said}");
    let expected = "recorded 2.000 s: 991 samples at 500.0 Hz\nlost: 10 samples (1.0 %) in 1 gap; 2 reconnections\n\
        written to log.csv\nnext: stiction robot log.csv --urdf ARM.urdf --out robot\n";
    assert_eq!(said.replace(" at 500 Hz", " at 500.0 Hz"), expected);
    // One joint of it as an axis, which is taken, and told that it never slides.
    let axis =
        "kind = \"rotary\"\n[columns]\nposition = \"actual_q2\"\nforce = \"actual_current2\"\n";
    std::fs::write(dir.join("axis.toml"), axis).unwrap();
    let (code, said, err) = run(dir, &["check", "log.csv", "--axis", "axis.toml", "--json"]);
    assert_eq!((code, err.as_str()), (1, ""), "{said}");
    assert!(said.contains("\"gap\""), "{said}");
    let (code, _, err) = run(dir, &typed);
    assert_eq!(code, 2);
    assert!(
        err.starts_with("stiction: [output] log.csv: exists already and is kept"),
        "{err}"
    );
    assert_eq!(robot.refused(), [""; 0]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_was_recorded() {
    let dir = tempfile::tempdir().unwrap();
    let robot = Robot::start(125.0, samples(1000));
    let url = format!("rtde://{}", robot.at());
    let mut child = command(dir.path(), &["record", &url, "--out", "log.csv", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let part = dir.path().join("log.csv.part");
    // The rows that the robot has sent are there, and it sends no more.
    while std::fs::read_to_string(&part).map_or(0, |text| text.lines().count()) < 1001 {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success()
    );
    let (code, out, err) = crate::split(child.wait_with_output().unwrap());
    assert_eq!((code, err.as_str()), (130, ""), "{out}");
    assert!(
        out.contains("\"samples\": 1000") && out.contains("\"complete\": false"),
        "{out}"
    );
    let text = std::fs::read_to_string(dir.path().join("log.csv")).unwrap();
    assert_eq!(text.lines().count(), 1001);
    assert!(!part.exists());
}

/// A limit to the size of a file stands for a full disk.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_keeps_whole_rows() {
    let dir = tempfile::tempdir().unwrap();
    let robot = Robot::start(125.0, samples(5000));
    let program = env!("CARGO_BIN_EXE_stiction");
    let script = format!(
        "trap '' XFSZ; ulimit -f 512; exec {program} record rtde://{} --time 30s --out log.csv",
        robot.at()
    );
    let output = Command::new("bash")
        .args(["-c", &script])
        .current_dir(dir.path())
        .stdin(Stdio::null())
        .output();
    let (code, out, err) = crate::split(output.unwrap());
    assert_eq!(code, 1, "{out}{err}");
    assert!(
        err.starts_with("stiction: [output] log.csv.part: "),
        "{err}"
    );
    assert!(
        out.contains("that could not be written\nended early: "),
        "{out}"
    );
    let text = std::fs::read_to_string(dir.path().join("log.csv")).unwrap();
    assert!(text.len() > 400_000 && text.ends_with('\n'));
    assert!(text.lines().all(|line| line.split(',').count() == 37));
}
