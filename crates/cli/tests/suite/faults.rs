//! What is wrong with a file or a setting is named as it is, with what to type next.

use std::fmt::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use tempfile::TempDir;

struct Bench(TempDir);

impl Bench {
    fn new() -> Self {
        let bench = Bench(tempfile::tempdir().unwrap());
        bench.write("log.csv", &log());
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
        command
            .args(arguments)
            .current_dir(self.0.path())
            .stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> (i32, String, String) {
        crate::split(self.command(arguments).output().unwrap())
    }

    /// What is said of bad input.
    fn refused(&self, arguments: &[&str]) -> String {
        let (code, out, err) = self.run(arguments);
        assert_eq!(code, 2, "{arguments:?}: {out}{err}");
        err
    }
}

/// 3 s of an axis of 9 kg with 20 N of Coulomb friction, which moves by 5 mm.
fn log() -> String {
    let mut text = String::from("Time [s],Position [mm],Force [N]\n");
    for k in 0..3000 {
        let t = f64::from(k) * 1e-3;
        let (x, v) = (5.0 * (6.0 * t).sin(), 0.03 * (6.0 * t).cos());
        let noise = 0.3 * (997.0 * t * t).sin();
        let force = 20.0 * (v / 1e-4).tanh() + 60.0 * v - 0.324 * x + noise;
        let _ = writeln!(text, "{t:.4},{x:.5},{force:.4}");
    }
    text
}

/// One recording in two files is one, also where one has a byte more.
#[test]
fn a_copy_is_no_second_log() {
    let bench = Bench::new();
    bench.write("copy.csv", &format!("{}\n", log()));
    let fit = ["identify", "log.csv", "--law=stribeck", "--out", "out"];
    let twice = [&fit[..], &["copy.csv"]].concat();
    let said = "stiction: [usage] log.csv and copy.csv are the same recording: time, motion and force agree in all 3000 samples; give each \
                log once, and validate on logs that are not fitted\n";
    assert_eq!(bench.refused(&twice), said);
    let validated = [&fit[..], &["--validate", "copy.csv"]].concat();
    assert_eq!(bench.refused(&validated), said);
    // With one number changed it is another.
    bench.write(
        "copy.csv",
        &log().replacen("0.0000,0.00000,", "0.0000,0.00001,", 1),
    );
    let (code, _, err) = bench.run(&twice);
    assert!(code < 2, "{err}");
}

/// A damaged cell is not a wrong unit.
#[test]
fn a_cell_beyond_all_others_is_named() {
    let bench = Bench::new();
    let named = "[columns]\ntime = { column = 1, unit = \"s\" }\nposition = { column = 2, unit = \"mm\" }\nforce = { column = 3, unit = \"N\" }\n";
    bench.write("axis.toml", named);
    let with = |column: usize, number: &str| {
        let lines = log();
        let lines = lines.lines().enumerate().map(|(k, line)| {
            let mut cells: Vec<&str> = line.split(',').collect();
            if k == 1500 {
                cells[column] = number;
            }
            cells.join(",")
        });
        lines.collect::<Vec<_>>().join("\n")
    };
    let mut out = String::new();
    for (column, number) in [(2, "1e13"), (2, "-3e29"), (1, "1e17")] {
        bench.write("damaged.csv", &with(column, number));
        out += &bench.refused(&["check", "damaged.csv", "--axis", "axis.toml"]);
    }
    // All of them: a unit.
    let mut large = String::from("Time [s],Position [mm],Force [N]\n");
    for line in log().lines().skip(1) {
        let _ = writeln!(large, "{line}e15");
    }
    bench.write("damaged.csv", &large);
    out += &bench.refused(&["check", "damaged.csv", "--axis", "axis.toml"]);
    insta::assert_snapshot!(out);
}

/// A setting of the axis file that leaves no sample is named, with its table.
#[test]
fn a_setting_that_leaves_nothing_is_named() {
    let bench = Bench::new();
    let mut out = String::new();
    for (table, line) in [
        ("conditioning", "decimate = 1000"),
        ("conditioning", "min_speed = \"5 m/s\""),
        ("log", "force_limit = \"0.1 N\""),
        ("log", "resolution = \"50 mm\""),
        ("columns", "force = \"Time\""),
        ("columns", "force = \"Position\"\nposition = \"Position\""),
    ] {
        let axis = format!("kind = \"linear\"\n[{table}]\n{line}\n");
        bench.write("axis.toml", &axis);
        let fit = ["identify", "log.csv", "--axis", "axis.toml", "--law=lugre"];
        let _ = writeln!(out, "[{table}] {line}");
        out += &bench.refused(&[&fit[..], &["--out", "out"]].concat());
    }
    insta::assert_snapshot!(out);
}

/// A file that is not there leads to the one that was meant, or to a look at the folder.
#[test]
fn a_missing_file_leads_on() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("my logs")).unwrap();
    bench.write("my logs/run 1.csv", &log());
    let mut out = String::new();
    for arguments in [
        &["check", "lgo.csv"][..],
        &["check", "my logs/run1.csv", "--json"],
        &["check", "nothing-like-it.csv"],
        &["check", "log.csv", "--axis", "there/is/none.toml"],
        &["simulate", "study.toml", "--out", "out"],
    ] {
        let _ = writeln!(out, "{arguments:?}");
        out += &bench.refused(arguments);
    }
    insta::assert_snapshot!(out);
}

/// Names with marks that turn or hide text are written out in what is written.
#[test]
fn marks_in_names_are_written_out() {
    let bench = Bench::new();
    let name = "lo\u{202e}g\u{200b}.csv";
    bench.write(name, &log().replacen("Force", "Fo\u{2066}rce", 1));
    let axis = "[columns]\nforce = 3\n";
    bench.write("axis.toml", axis);
    let (code, _, err) = bench.run(&[
        "identify",
        name,
        "--axis",
        "axis.toml",
        "--law=dahl",
        "--out",
        "out",
    ]);
    assert!(code < 2, "{err}");
    let (code, _, err) = bench.run(&["check", name, "--init", "new.toml"]);
    assert!(code < 2, "{err}");
    for file in ["out/result.json", "out/model.toml", "new.toml"] {
        let text = std::fs::read_to_string(bench.path(file)).unwrap();
        assert!(
            !text.contains(['\u{202e}', '\u{200b}', '\u{2066}']),
            "{file}"
        );
    }
    let result = std::fs::read_to_string(bench.path("out/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&result).unwrap();
    assert_eq!(result["inputs"][0]["path"], name);
}

/// An interrupt at any moment of a second run leaves the complete result of the first: it is there, or one just like it.
#[cfg(unix)]
#[test]
fn an_interrupt_never_replaces_a_complete_result() {
    let bench = Bench::new();
    let fit = ["identify", "log.csv", "--law=lugre", "--out", "out"];
    let clock = std::time::Instant::now();
    let (code, _, err) = bench.run(&fit);
    assert!(code < 2, "{err}");
    let takes = clock.elapsed();
    let result = || {
        let text = std::fs::read_to_string(bench.path("out/result.json")).unwrap();
        let mut result: serde_json::Value = serde_json::from_str(&text).unwrap();
        without_times(&mut result);
        result
    };
    let first = result();
    for k in 0..20 {
        let mut command = bench.command(&fit);
        let mut child = command
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // The end of it is looked at more closely.
        std::thread::sleep(takes.mul_f64(1.1 * (f64::from(k) / 19.0).sqrt()));
        if child.try_wait().unwrap().is_none() {
            crate::interrupt(&child);
        }
        child.wait().unwrap();
        assert_eq!(result(), first, "after {k} of 20");
    }
}

/// Takes out what a clock says.
#[cfg(unix)]
fn without_times(value: &mut serde_json::Value) {
    match value {
        serde_json::Value::Object(map) => {
            map.retain(|key, _| !(key.ends_with("_s") || key.contains("seconds")));
            map.values_mut().for_each(without_times);
        }
        serde_json::Value::Array(all) => all.iter_mut().for_each(without_times),
        _ => {}
    }
}

/// A folder that cannot be made, or that holds a result of a newer version, is refused before a log is read.
#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_cannot_be_made_is_refused_first() {
    let bench = Bench::new();
    bench.write("file", "");
    std::fs::create_dir(bench.path("newer")).unwrap();
    bench.write(
        "newer/result.json",
        "{\n  \"schema\": \"stiction.result/2\"\n}\n",
    );
    let long = "a".repeat(300);
    let mut said = String::new();
    for out in [&long, "file/out", "/proc/out", "/proc", "newer"] {
        // Of a log that is not there nothing is said.
        said += &bench.refused(&["identify", "nowhere.csv", "--out", out]);
    }
    insta::assert_snapshot!(said.replace(&long, "aaa..."));
    let kept = std::fs::read_to_string(bench.path("newer/result.json")).unwrap();
    assert!(kept.contains("result/2"));
    let forced = [
        "identify",
        "log.csv",
        "--law=stribeck",
        "--out",
        "newer",
        "--force",
    ];
    let (code, _, err) = bench.run(&forced);
    assert!(code < 2, "{err}");
}

/// A log where a model, a study, an axis file or a table is wanted, and what stiction wrote where a log is.
#[test]
fn a_file_in_the_wrong_place_leads_to_commands_that_work() {
    let bench = Bench::new();
    let (code, _, err) = bench.run(&["identify", "log.csv", "--law=lugre", "--out", "fit"]);
    assert!(code < 2, "{err}");
    bench.write(
        "axis.toml",
        "kind = \"linear\"\n[[log]]\nfile = \"log.csv\"\n",
    );
    let mut said = String::new();
    for (arguments, works) in [
        (
            &["export", "log.csv", "--target", "c", "--out", "c"][..],
            true,
        ),
        (&["export", "log.csv"], true),
        (&["simulate", "log.csv", "--out", "out"], true),
        (&["simulate", "log.csv"], true),
        (&["plan", "log.csv", "--out", "out"], false),
        (&["plan", "log.csv"], false),
        (&["drift", "log.csv"], true),
        (&["identify", "fit/result.json", "--out", "out"], true),
        (&["check", "fit/model.toml"], true),
        (&["check", "fit/report.html"], false),
        (&["check", "axis.toml"], true),
        (
            &[
                "identify",
                "log.csv",
                "--axis",
                "fit/model.toml",
                "--out",
                "out",
            ],
            false,
        ),
    ] {
        // What the commands of an earlier case have written would be in the way.
        for written in ["log", "out", "fit/c"] {
            let _ = std::fs::remove_dir_all(bench.path(written));
        }
        let err = bench.refused(arguments);
        said += &err;
        let Some(next) = err.lines().find_map(|line| line.split_once("next")) else {
            continue;
        };
        for command in next.1.split("stiction ").skip(1).filter(|_| works) {
            let words: Vec<&str> = command.trim_end_matches(", then: ").split(' ').collect();
            let (code, _, err) = bench.run(&words);
            assert!(code < 2, "{words:?}: {err}");
        }
    }
    insta::assert_snapshot!(said);
}

/// A log that the axis file lists and that is not there.
#[test]
fn a_listed_log_that_is_not_there_is_named_with_its_line() {
    let bench = Bench::new();
    bench.write(
        "axis.toml",
        "kind = \"linear\"\n[[log]]\nfile = \"log.csv\"\n[[log]]\nfile = \"lgo.csv\"\n",
    );
    let mut said = String::new();
    for arguments in [
        &["check", "--axis", "axis.toml"][..],
        &["identify", "--axis", "axis.toml", "--out", "out"],
    ] {
        said += &bench.refused(arguments);
    }
    insta::assert_snapshot!(said);
}

/// Texts that cannot be read lead to a line of the axis file that works, or to a file to mend, and to no axis file of theirs.
#[test]
fn a_text_that_cannot_be_read_leads_on() {
    let bench = Bench::new();
    let numbers = "1,2\n2,3\n3,4\n";
    let mut said = String::new();
    for (name, text) in [
        ("text.csv", "name;phase\na;hold\nb;go\n".to_string()),
        (
            "units.csv",
            "time;position;force\n0 s;1.5 mm;2 N\n1 s;1.6 mm;3 N\n".to_string(),
        ),
        ("header.csv", "time,position,force\n".to_string()),
        ("either.csv", numbers.to_string()),
        (
            "word.csv",
            "time,position\n0,1.5\nlate,1.6\n2,1.7\n".to_string(),
        ),
    ] {
        bench.write(name, &text);
        for arguments in [
            &["check", name][..],
            &["check", name, "--init", "new.toml"],
            &["identify", name, "--out", "out"],
        ] {
            said += &format!("{arguments:?}\n{}", bench.refused(arguments));
        }
    }
    insta::assert_snapshot!(said);
    // The line that is named reads the text: what is missing next is which column is which.
    bench.write("either.axis.toml", "[text]\nseparator = \"comma\"\n");
    let err = bench.refused(&["check", "either.csv", "--axis", "either.axis.toml"]);
    assert!(err.contains("[log-missing]"), "{err}");
}

/// A file that is something else than what a command reads is named as what it is, with the one that is meant.
#[test]
fn another_kind_of_file_leads_on() {
    let bench = Bench::new();
    let (code, _, err) = bench.run(&["identify", "log.csv", "--law=lugre", "--out", "fit"]);
    assert!(code < 2, "{err}");
    bench.write("axis.toml", "kind = \"linear\"\nrate = \"1 kHz\"\n");
    let mut said = String::new();
    for given in [
        "fit/result.json",
        "fit",
        "fit/report.html",
        "fit/fit.csv",
        "log.csv",
        "axis.toml",
    ] {
        said += &bench.refused(&["export", given, "--target", "c", "--out", "c"]);
    }
    said += "\n";
    for (option, given) in [
        (&["export"][..], "fit/result.json"),
        (&["export", "--target", "hal"], "fit"),
        (&["export"], "log.csv"),
        (
            &["identify", "log.csv", "--out", "other", "--axis"],
            "fit/result.json",
        ),
        (
            &["identify", "log.csv", "--out", "other", "--axis"],
            "fit/model.toml",
        ),
        (&["simulate", "--out", "sim"], "fit/model.toml"),
        (&["simulate", "--out", "sim"], "fit/result.json"),
    ] {
        said += &bench.refused(&[option, &[given]].concat());
    }
    insta::assert_snapshot!(said);
    // The command that is named works.
    let works = [
        "export",
        "fit/model.toml",
        "--target",
        "c",
        "--out",
        "fit/c",
    ];
    let (code, _, err) = bench.run(&works);
    assert!(code < 2, "{err}");
}

/// A log that is validated on and has the wrong sign of force is told so.
#[test]
fn the_sign_of_a_log_that_is_not_fitted_is_told() {
    let bench = Bench::new();
    let turned = log().lines().skip(1).fold(
        String::from("Time [s],Position [mm],Force [N]\n"),
        |mut text, line| {
            let (motion, force) = line.rsplit_once(',').unwrap();
            let force: f64 = force.parse().unwrap();
            let _ = writeln!(text, "{motion},{:.4}", -force + 0.01);
            text
        },
    );
    bench.write("turned.csv", &turned);
    let fit = [
        "identify",
        "log.csv",
        "--law=stribeck",
        "--out",
        "out",
        "--validate",
        "turned.csv",
    ];
    let (code, out, err) = bench.run(&fit);
    assert_eq!(code, 1, "{err}");
    let told = out.lines().filter(|line| line.contains("turned.csv"));
    insta::assert_snapshot!(told.collect::<Vec<_>>().join("\n"));
}

/// Of two joints the one that moves is taken; where another one moves in another log, the two are not mixed.
#[test]
fn logs_in_which_other_joints_move_are_not_mixed() {
    let bench = Bench::new();
    let still = ["0.001", "0.2"];
    for (file, first) in [("first.csv", true), ("second.csv", false)] {
        let head = "Time [s],A position [mm],A force [N],B position [mm],B force [N]\n";
        let text =
            log()
                .lines()
                .skip(1)
                .enumerate()
                .fold(head.to_string(), |mut text, (k, line)| {
                    let (time, moved) = line.split_once(',').unwrap();
                    let still = still.join(",");
                    let _ = match first {
                        true => writeln!(text, "{time},{moved}{},{still}", k % 10),
                        false => writeln!(text, "{time},{still},{moved}"),
                    };
                    text
                });
        bench.write(file, &text);
    }
    let fit = [
        "identify",
        "first.csv",
        "second.csv",
        "--law=stribeck",
        "--out",
        "out",
    ];
    insta::assert_snapshot!(bench.refused(&fit));
    let (code, _, err) = bench.run(&["identify", "first.csv", "--law=stribeck", "--out", "out"]);
    assert!(code < 2, "{err}");
}
