//! `simulate` and `reproduce` as a user or a script meets them.

use std::path::Path;
use std::process::{Command, Stdio};

const STUDY: &str = r#"
[axis]
known      = "motor"
rate       = "2 kHz"
peak_force = "200 N"

[[path]]
kind      = "sine"
amplitude = "1 mm"
frequency = "2 Hz"

[[controller]]
kind      = "cascade"
bandwidth = "40 Hz"

[[compensator]]
kind     = "lugre"
watchdog = false
"#;

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
    command
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null());
    command
}

fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = command(folder, arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code().unwrap_or(-1),
        text(output.stdout),
        crate::said(output.stderr),
    )
}

/// Ctrl-C after some milliseconds of a command that takes longer: its exit code and the status in its file say so.
#[cfg(unix)]
fn interrupted(folder: &Path, arguments: &[&str], after: u64, file: &str) {
    let mut child = command(folder, arguments)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(after));
    let ended = child.try_wait().unwrap();
    assert!(ended.is_none(), "{arguments:?}: too short to interrupt");
    let id = child.id().to_string();
    let kill = Command::new("kill").args(["-INT", &id]).status();
    assert!(kill.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let text = std::fs::read_to_string(folder.join(file)).unwrap();
    let file: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(file["status"], "interrupted");
}

/// `--init` writes a study that runs as it is and says how; what exists is kept.
#[test]
fn a_study_that_is_begun_runs() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let (code, out, err) = run(at, &["simulate", "--init"]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(
        out,
        "study.toml written\nnext: stiction simulate study.toml --out study\n"
    );
    let text = std::fs::read_to_string(at.join("study.toml")).unwrap();
    assert!(text.contains("stiction simulate study.toml --out study\n"));
    let (code, out, err) = run(at, &["simulate", "study.toml", "--out", "study"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    for part in ["move, cascade 30 Hz", "crawl at 10 um/s", "hold, cascade"] {
        assert!(out.contains(part), "{out}");
    }
    assert!(!out.contains("warning"), "{out}");

    let (code, out, err) = run(at, &["simulate", "--init", "--json"]);
    assert_eq!(code, 2, "{out}");
    assert!(
        err.contains("exists already and is kept; name another file: --init OTHER.toml"),
        "{err}"
    );
    assert_eq!(
        std::fs::read_to_string(at.join("study.toml")).unwrap(),
        text
    );
    for wrong in [
        &["simulate", "study.toml", "--init", "other.toml"] as &[&str],
        &["simulate", "--init", "other.toml", "--out", "a"],
        &[
            "simulate",
            "study.toml",
            "--out",
            "a",
            "--model",
            "model.toml",
        ],
        &["simulate", "--init", "other.toml", "--model", "absent.toml"],
        &["simulate"],
    ] {
        let (code, out, err) = run(at, wrong);
        assert_eq!((code, out.as_str()), (2, ""), "{err}");
        assert!(!at.join("other.toml").exists());
    }
}

/// Law, parameters and units as a data sheet has them, without anything that an identification writes beside.
const BY_HAND: &str = r#"
law = "lugre"
parameter = [
    { name = "sigma0", value = 2e6, unit = "N/m" },
    { name = "sigma1", value = 1500, unit = "N*s/m" },
    { name = "sigma2", value = 30, unit = "N*s/m" },
    { name = "coulomb", value = 12, unit = "N" },
    { name = "static", value = 18, unit = "N" },
    { name = "stribeck_velocity", value = 0.003, unit = "m/s" },
    { name = "mass", value = 4.6, unit = "kg" },
]
"#;

#[test]
fn a_model_by_hand_is_simulated_and_exported() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::create_dir(at.join("models")).unwrap();
    std::fs::write(at.join("models/hand.toml"), BY_HAND).unwrap();
    let (code, _, err) = run(at, &["simulate", "--init", "--model", "models/hand.toml"]);
    assert_eq!((code, err.as_str()), (0, ""));
    let (code, out, err) = run(at, &["simulate", "study.toml", "--out", "a"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.starts_with("study: an axis written by hand\n"), "{out}");
    // The same numbers are those of the known axis.
    let (_, known, _) = run(at, &["simulate", "--init", "known.toml"]);
    assert!(
        known.contains("next: stiction simulate known.toml --out known"),
        "{known}"
    );
    let (_, known, _) = run(at, &["simulate", "known.toml", "--out", "b"]);
    let table = |text: &str| text.split_once("move, ").map(|(_, rows)| rows.to_string());
    let (found, expected) = (table(&out).unwrap(), table(&known).unwrap());
    assert_eq!(found.replace("to a:", "to b:"), expected);
    let export = ["export", "models/hand.toml", "--target", "c", "--out", "c"];
    let (code, out, err) = run(at, &export);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");

    // Numbers that no study takes are said before one is written.
    let huge = BY_HAND.replace("value = 4.6", "value = 1e99");
    std::fs::write(at.join("huge.toml"), huge).unwrap();
    let args = [
        "simulate",
        "--init",
        "huge_study.toml",
        "--model",
        "huge.toml",
    ];
    let (code, _, err) = run(at, &args);
    assert_eq!((code, at.join("huge_study.toml").exists()), (2, false));
    let said = "huge.toml: line 10, column 30, parameter[7].value: mass = 1.000e99; in a study from -1e15 to 1e15";
    assert!(err.contains(said), "{err}");

    // A study elsewhere finds the model; without a mass it has to be filled in.
    let weightless = BY_HAND.replace("    { name = \"mass\", value = 4.6, unit = \"kg\" },\n", "");
    std::fs::write(at.join("light.toml"), weightless).unwrap();
    let (code, out, _) = run(
        at,
        &[
            "simulate",
            "--init",
            "models/s.toml",
            "--model",
            "light.toml",
        ],
    );
    assert_eq!(
        (code, out.as_str()),
        (
            0,
            "models/s.toml written\nto decide: the model has no mass; give that of the moving part\n\
             fill in what is to decide, then\nnext: stiction simulate models/s.toml --out models/s\n"
        )
    );
    let (code, _, err) = run(at, &["simulate", "models/s.toml", "--out", "d"]);
    assert_eq!(code, 2);
    assert!(err.contains("axis.mass: \"? kg\""), "{err}");
    let text = std::fs::read_to_string(at.join("models/s.toml")).unwrap();
    std::fs::write(at.join("models/s.toml"), text.replace("? kg", "4.6 kg")).unwrap();
    let (code, _, err) = run(at, &["simulate", "models/s.toml", "--out", "d"]);
    assert_eq!((code, err.as_str()), (0, ""));
}

/// `--second-model` begins a study of two axes that runs as it is, along a circle.
#[test]
fn two_axes_are_begun_along_a_circle() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("x.toml"), BY_HAND).unwrap();
    let light = BY_HAND.replace("    { name = \"mass\", value = 4.6, unit = \"kg\" },\n", "");
    std::fs::write(at.join("y.toml"), light).unwrap();
    let init = |name: &str, second: &str| {
        let args = [
            "simulate",
            "--init",
            name,
            "--model",
            "x.toml",
            "--second-model",
            second,
        ];
        run(at, &args)
    };
    let (code, out, err) = init("study.toml", "x.toml");
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(
        out,
        "study.toml written\nnext: stiction simulate study.toml --out study\n"
    );
    let text = std::fs::read_to_string(at.join("study.toml")).unwrap();
    insta::assert_snapshot!(text);
    let (code, out, err) = run(at, &["simulate", "study.toml", "--out", "a"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("circle, cascade 30 Hz"), "{out}");
    assert!(!out.contains("warning"), "{out}");
    let (code, out, _) = init("s.toml", "y.toml");
    assert_eq!(code, 0);
    assert!(out.contains("to decide: a model has no mass"), "{out}");
    let (code, _, err) = run(
        at,
        &["simulate", "--init", "t.toml", "--second-model", "x.toml"],
    );
    assert_eq!((code, at.join("t.toml").exists()), (2, false));
    assert!(err.contains("--model"), "{err}");
}

/// Everything that is wrong with a model is said at once, a line each.
#[test]
fn faults_of_a_model_are_lines() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let wrong = BY_HAND
        .replace("unit = \"m/s\"", "unit = \"mm/s\"")
        .replace("value = 12", "value = -12");
    std::fs::write(at.join("m.toml"), wrong).unwrap();
    let (code, _, err) = run(at, &["export", "m.toml", "--target", "c", "--out", "c"]);
    assert_eq!(code, 2);
    let lines: Vec<_> = err.lines().collect();
    assert_eq!(lines.len(), 4, "{err}");
    let next = "stiction: correct m.toml (lines 7 and 9), then\nstiction: next: stiction export m.toml --target c --out c";
    assert_eq!(lines[2..].join("\n"), next);
    assert!(lines[0].starts_with("stiction: [bad-config] m.toml: line 7, column 33, parameter[4].value: coulomb = -12.00; "), "{err}");
    assert!(
        lines[1].contains("parameter[6].unit: stribeck_velocity in \"mm/s\"; \"m/s\""),
        "{err}"
    );
}

#[test]
fn a_study_from_a_clean_folder() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("study.toml"), STUDY).unwrap();
    let (code, out, err) = run(at, &["simulate", "study.toml", "--out", "a"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("sine, cascade 40 Hz"), "{out}");
    assert!(
        out.ends_with("written to a: report.html, trajectories.csv, study.json\n"),
        "{out}"
    );
    // Again into the same folder, as JSON: the same file.
    let before = std::fs::read_to_string(at.join("a/study.json")).unwrap();
    let (code, out, _) = run(at, &["simulate", "study.toml", "--out", "a", "--json"]);
    assert_eq!((code, out), (0, before));
    // What another command wrote is not replaced, nor is the study itself.
    let (code, _, err) = run(at, &["reproduce", "1995", "--out", "a"]);
    assert_eq!(code, 2);
    assert!(
        err.starts_with("stiction: [output] a: is not empty"),
        "{err}"
    );
    std::fs::create_dir(at.join("b")).unwrap();
    std::fs::write(at.join("b/study.json"), STUDY).unwrap();
    let arguments = ["simulate", "b/study.json", "--out", "b", "--force"];
    let (code, _, err) = run(at, &arguments);
    assert_eq!(code, 2, "{err}");
    assert!(err.contains("is an input"), "{err}");
    let (code, _, err) = run(at, &["simulate", "none.toml", "--out", "c"]);
    assert_eq!(code, 2);
    assert!(
        err.starts_with("stiction: [bad-config] none.toml: "),
        "{err}"
    );
    assert!(!at.join("c").exists());
}

/// Ctrl-C in the middle: the rows that are done are written.
#[cfg(unix)]
#[test]
fn an_interrupt_keeps_the_runs_that_are_done() {
    let folder = tempfile::tempdir().unwrap();
    let long = STUDY.replace("2 Hz", "0.05 Hz")
        + "\n[[parameter_error]]\nkind = \"corners\"\nby = \"10 %\"\n";
    std::fs::write(folder.path().join("study.toml"), long).unwrap();
    let arguments = ["simulate", "study.toml", "--out", "a", "--threads", "1"];
    interrupted(folder.path(), &arguments, 500, "a/study.json");
}

#[test]
fn the_experiments_of_1995() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, err) = run(folder.path(), &["reproduce", "1995", "--out", "a"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    insta::assert_snapshot!(out);
    let text = std::fs::read_to_string(folder.path().join("a/reproduce.json")).unwrap();
    let file: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(file["all_within"], true);
    assert_eq!(file["checks"].as_array().unwrap().len(), 49);
    assert!(folder.path().join("a/report.html").is_file());
}

/// Ctrl-C in the middle of the searches of the one, of the longest experiment of the other: what was done by then is
/// written.
#[cfg(unix)]
#[test]
fn publications_can_be_interrupted() {
    for publication in ["1995", "paper"] {
        let folder = tempfile::tempdir().unwrap();
        let arguments = ["reproduce", publication, "--out", "a", "--threads", "1"];
        interrupted(folder.path(), &arguments, 1000, "a/reproduce.json");
        assert!(folder.path().join("a/report.html").is_file());
    }
}
