//! Which rows of a log are read: by a column that says when the axis is enabled, and by the parts of `[[log]]`.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

fn run(dir: &Path, command: &str) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
        .args(command.split_whitespace())
        .current_dir(dir)
        .output()
        .unwrap();
    crate::split(output)
}

/// A log of an axis of 9 kg with 20 N and 60 N s/m in mode 8; before and after that it is moved by hand.
fn log(path: &Path, samples: usize) {
    let mut text = String::from("Time [s],Position [mm],Force [N],Mode\n");
    for i in 0..samples {
        let t = i as f64 * 1e-3;
        let (mut x, mut v, mut a) = (0.0, 0.0, 0.0);
        for (size, w) in [(0.05, 6.3), (0.008, 22.0)] {
            x += size * (w * t).sin();
            v += size * w * (w * t).cos();
            a -= size * w * w * (w * t).sin();
        }
        let noise = 0.2 * ((1e4 * t).sin() + (2.3e4 * t).sin() + (3.1e4 * t * t).sin());
        let driven = (600..samples - 400).contains(&i);
        let force = match driven {
            true => 20.0 * f64::tanh(v / 1e-4) + 60.0 * v + 9.0 * a + 1.0 + noise,
            false => 0.0,
        };
        let mode = if driven { 8 } else { 6 };
        let _ = writeln!(text, "{t:.4},{:.6},{force:.4},{mode}", 1e3 * x);
    }
    std::fs::write(path, text).unwrap();
}

#[test]
fn rows_of_another_mode_are_not_fitted() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    log(&dir.join("log.csv"), 4000);
    let axis = "[columns]\nenable = { column = \"Mode\", equals = 8 }\n";
    std::fs::write(dir.join("axis.toml"), axis).unwrap();
    let identify = "identify log.csv --axis axis.toml --law coulomb-viscous --out a --verbose";
    let (_, out, err) = run(dir, identify);
    assert!(
        out.contains("not fitted: 1000 of 4000 rows, by column 4 \"Mode\""),
        "{out}{err}"
    );
    let result = std::fs::read_to_string(dir.join("a/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&result).unwrap();
    assert_eq!(result["inputs"][0]["samples"], 3000);
    assert_eq!(result["inputs"][0]["not_enabled"]["rows"], 1000);
    let coulomb = result["parameters"].as_array().unwrap().iter();
    let coulomb = coulomb.clone().find(|p| p["name"] == "coulomb").unwrap();
    let value = coulomb["value"].as_f64().unwrap();
    assert!((value - 20.0).abs() < 0.5, "{value}");
    // A column of modes needs the mode.
    std::fs::write(dir.join("axis.toml"), "[columns]\nenable = \"Mode\"\n").unwrap();
    let (code, _, err) = run(dir, identify);
    assert_eq!(code, 2, "{err}");
    insta::assert_snapshot!(err);
}

/// One part is fitted and another validated on, of the logs that the axis file lists; what the command line says besides must not
/// contradict it.
#[test]
fn parts_of_listed_logs() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    std::fs::create_dir(dir.join("logs")).unwrap();
    for name in ["a.csv", "c.csv"] {
        log(&dir.join("logs").join(name), 4000);
    }
    log(&dir.join("logs/b.csv"), 5000);
    let columns = "[columns]\nenable = { column = \"Mode\", equals = 8 }\n";
    let list = "[[log]]\nfile = \"a.csv\"\nfit = [\"0 s\", \"2.5 s\"]\nvalidate = [\"2.5 s\", \"4 s\"]\n\
                [[log]]\nfile = \"b.csv\"\nvalidate = \"all\"\n";
    std::fs::write(dir.join("logs/axis.toml"), format!("{columns}{list}")).unwrap();
    let identify = "identify --axis logs/axis.toml --law coulomb-viscous --out a";
    let (_, out, err) = run(dir, identify);
    assert!(
        out.starts_with("logs/a.csv, 0 to 2.5 s: 1900 samples"),
        "{out}{err}"
    );
    for name in ["logs/a.csv, 2.5 to 4 s", "logs/b.csv"] {
        assert!(out.contains(&format!("% on {name}")), "{out}");
    }
    let result = std::fs::read_to_string(dir.join("a/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&result).unwrap();
    let inputs = result["inputs"].as_array().unwrap();
    assert_eq!(inputs.len(), 1);
    assert_eq!(inputs[0]["part"], "0 to 2.5 s");
    assert_eq!(inputs[0]["not_enabled"]["rows"], 600);
    // A log that is named is used as it is listed, by whatever path.
    let (_, out, err) = run(
        &dir.join("logs"),
        "identify ./a.csv --axis axis.toml --law coulomb-viscous --out a",
    );
    assert!(
        out.starts_with("./a.csv, 0 to 2.5 s: 1900 samples"),
        "{out}{err}"
    );
    assert!(!out.contains("b.csv"), "{out}");
    let (_, out, err) = run(dir, "check --axis logs/axis.toml");
    assert!(out.contains("logs/b.csv"), "{out}{err}");
    let late = "[[log]]\nfile = \"logs/a.csv\"\nfit = [[\"0 s\", \"2 s\"], [\"14 s\", \"15 s\"]]\n";
    std::fs::write(dir.join("late.toml"), late).unwrap();
    std::fs::write(dir.join("columns.toml"), columns).unwrap();
    let mut said = String::new();
    for command in [
        format!("{identify} --split 0.5"),
        "identify logs/b.csv --axis logs/axis.toml --out b".into(),
        format!("{identify} --validate logs/a.csv"),
        "identify logs/c.csv --axis late.toml --validate logs/a.csv --out b".into(),
        format!("{identify} logs/c.csv --validate logs/c.csv"),
        "identify logs/a.csv --axis late.toml --out b".into(),
        "identify --axis columns.toml --out b".into(),
        "check --axis columns.toml".into(),
    ] {
        let force = if command.contains("--out a") {
            " --force"
        } else {
            ""
        };
        let (code, _, err) = run(dir, &format!("{command}{force}"));
        assert_eq!(code, 2, "{command}: {err}");
        let _ = writeln!(said, "{command}\n{err}");
    }
    insta::assert_snapshot!(said);
}

/// The force of another file, at another rate and by another clock.
#[test]
fn a_force_from_another_file() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    log(&dir.join("log.csv"), 4000);
    let text = std::fs::read_to_string(dir.join("log.csv")).unwrap();
    let (mut motion, mut force) = (String::new(), String::new());
    for (i, line) in text.lines().enumerate() {
        let cells: Vec<&str> = line.split(',').collect();
        let _ = writeln!(motion, "{},{},{}", cells[0], cells[1], cells[3]);
        // The clock of the drive began 3.5 s before that of the log.
        let stamp = cells[0].parse::<f64>().map(|t| format!("{:.4}", t + 3.5));
        if i % 2 == 1 || i == 0 {
            let _ = writeln!(
                force,
                "{},{}",
                stamp.unwrap_or("stamp [s]".into()),
                cells[2]
            );
        }
    }
    std::fs::write(dir.join("motion.csv"), &motion).unwrap();
    std::fs::write(dir.join("again.csv"), motion.replace("Mode", "mode")).unwrap();
    std::fs::write(dir.join("tau.csv"), force).unwrap();
    let axis = |offset: &str| {
        let force = format!("force = {{ file = \"tau.csv\", column = \"Force\"{offset} }}");
        let text = format!("[columns]\n{force}\nenable = {{ column = \"Mode\", equals = 8 }}\n");
        std::fs::write(dir.join("axis.toml"), text).unwrap();
    };
    axis(", offset = \"-3.5 s\"");
    let (_, out, err) = run(
        dir,
        "identify motion.csv --axis axis.toml --law coulomb-viscous --out a",
    );
    assert!(
        out.starts_with("motion.csv: 1500 samples at 500.0 Hz"),
        "{out}{err}"
    );
    let result = std::fs::read_to_string(dir.join("a/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&result).unwrap();
    let joined = &result["inputs"][0]["joined"][0];
    assert_eq!(
        (&joined["column"], &joined["path"]),
        (&"force".into(), &"tau.csv".into())
    );
    let mut parameters = result["parameters"].as_array().unwrap().iter();
    let coulomb = parameters.find(|p| p["name"] == "coulomb").unwrap();
    let value = coulomb["value"].as_f64().unwrap();
    assert!((value - 20.0).abs() < 0.5, "{value}");
    let (_, out, _) = run(dir, "check motion.csv --axis axis.toml");
    assert!(
        out.contains("[joined] force is joined from tau.csv"),
        "{out}"
    );
    let mut said = String::new();
    for (offset, command) in [
        (
            ", offset = \"-3.5 s\"",
            "check motion.csv again.csv --axis axis.toml",
        ),
        (
            ", offset = \"-3.5 s\"",
            "identify motion.csv --validate again.csv --axis axis.toml --out b",
        ),
        (
            ", offset = \"1 min\"",
            "identify motion.csv --axis axis.toml --out b",
        ),
    ] {
        axis(offset);
        let (code, _, err) = run(dir, command);
        assert_eq!(code, 2, "{command}: {err}");
        let _ = writeln!(said, "{command}\n{err}");
    }
    insta::assert_snapshot!(said);

    // Each log has its own by its name: both are fitted, each with its force, and a batch takes neither force for a log.
    std::fs::create_dir(dir.join("runs")).unwrap();
    for (from, to) in [
        ("motion", "mon"),
        ("tau", "mon_tau"),
        ("again", "tue"),
        ("tau", "tue_tau"),
    ] {
        let to = dir.join(format!("runs/{to}.csv"));
        std::fs::copy(dir.join(format!("{from}.csv")), to).unwrap();
    }
    std::fs::write(dir.join("runs/tue.csv"), later(&motion)).unwrap();
    let stamps = std::fs::read_to_string(dir.join("tau.csv")).unwrap();
    std::fs::write(dir.join("runs/tue_tau.csv"), later(&stamps)).unwrap();
    let named = std::fs::read_to_string(dir.join("axis.toml")).unwrap();
    let named = named
        .replace("tau.csv", "{log}_tau.csv")
        .replace("1 min", "-3.5 s");
    std::fs::write(dir.join("axis.toml"), named).unwrap();
    let command =
        "identify runs/mon.csv runs/tue.csv --axis axis.toml --law coulomb-viscous --out c";
    let (code, _, err) = run(dir, command);
    assert!(code < 2, "{err}");
    let result = std::fs::read_to_string(dir.join("c/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&result).unwrap();
    for (i, path) in ["runs/mon_tau.csv", "runs/tue_tau.csv"].iter().enumerate() {
        assert_eq!(&result["inputs"][i]["joined"][0]["path"], path);
    }
    let (_, out, err) = run(
        dir,
        "batch runs --axis axis.toml --law coulomb-viscous --out d",
    );
    let rows = std::fs::read_to_string(dir.join("d/batch.json")).unwrap();
    let rows: serde_json::Value = serde_json::from_str(&rows).unwrap();
    assert_eq!(
        (&rows["logs"], &rows["identified"]),
        (&2.into(), &2.into()),
        "{out}{err}"
    );
    std::fs::remove_file(dir.join("runs/tue_tau.csv")).unwrap();
    let (code, _, err) = run(dir, "check runs/tue.csv --axis axis.toml");
    let said = "[log-io] axis.toml: line 2, column 18, columns.force.file: runs/tue_tau.csv: cannot be read";
    assert!(code == 2 && err.contains(said), "{err}");
}

/// The same columns with other time stamps, a day on: a log of its own.
fn later(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        let (stamp, rest) = line.split_once(',').unwrap();
        match stamp.parse::<f64>() {
            Ok(time) => writeln!(out, "{:.4},{rest}", time + 86400.0).unwrap(),
            Err(_) => writeln!(out, "{line}").unwrap(),
        }
    }
    out
}
