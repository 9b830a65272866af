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
    let once = "stiction: next: stiction identify log.csv --law=stribeck --out out\n";
    assert_eq!(bench.refused(&twice), format!("{said}{once}"));
    let validated = [&fit[..], &["--validate", "copy.csv"]].concat();
    let looks = "stiction: what the log shows, and what motion to record instead:\nstiction: next: stiction check log.csv\n";
    assert_eq!(bench.refused(&validated), format!("{said}{looks}"));
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
        (&["export", "log.csv"], false),
        (&["simulate", "log.csv", "--out", "out"], true),
        (&["simulate", "log.csv"], false),
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
        let commands = err.lines().filter_map(|line| {
            let line = line.strip_prefix("stiction: ")?;
            line.strip_prefix("next: stiction ")
                .or(line.strip_prefix("then: stiction "))
        });
        for command in commands.filter(|_| works) {
            let words: Vec<&str> = command.split(' ').collect();
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

/// What is wrong in a typed file leads to its lines and back to the same command; all columns that are wrong are told at once.
#[test]
fn a_typed_file_is_corrected_and_the_command_given_again() {
    let bench = Bench::new();
    let mut out = String::new();
    for text in [
        "kind = \"linear\"\n[columns]\ntime = \"Tme\"\nposition = \"Posn\"\n",
        "kind = \"linear\"\nrate = \"-5 Hz\"\n",
        "kind = \"rotary\"\n",
        "kind = \n",
    ] {
        bench.write("my axis.toml", text);
        let _ = writeln!(out, "{text}");
        out += &bench.refused(&["check", "log.csv", "--axis", "my axis.toml"]);
    }
    out += &bench.refused(&["identify", "log.csv", "--axis=log.csv", "--out", "out"]);
    insta::assert_snapshot!(out);
}

/// Everything that is to be decided of a log is told at once, and `--init` begins a file with it.
#[test]
fn all_that_is_to_be_decided_is_told_at_once() {
    let bench = Bench::new();
    let mut text = String::from("t;x;f1;f2\n");
    for k in 0..500 {
        let s = (0.02 * f64::from(k)).sin();
        let _ = writeln!(text, "{k};{s};{};{}", 2.0 * s, 3.0 * s + 1.0);
    }
    bench.write("bare.csv", &text);
    let mut out = bench.refused(&["check", "bare.csv"]);
    let (code, said, _) = bench.run(&["check", "bare.csv", "--init", "bare.axis.toml"]);
    assert_eq!(code, 0);
    out += &said;
    insta::assert_snapshot!(out);
}

/// A folder where one file is wanted leads to all of its logs; a missing folder for the output is filled in.
#[test]
fn a_folder_leads_to_all_of_its_logs() {
    let bench = Bench::new();
    std::fs::create_dir_all(bench.path("logs/sub")).unwrap();
    bench.write("logs/a.csv", &log());
    bench.write("study.toml", "[axis]\nmodel = \"model.toml\"\n");
    let mut out = bench.refused(&["check", "logs", "--axis", "axis.toml"]);
    out += &bench.refused(&["check", "logs"]);
    out += &bench.refused(&["identify", "logs", "--law=lugre", "--out", "all"]);
    out += &bench.refused(&["drift", "logs"]);
    bench.write("logs/sub/results.parquet", "");
    out += &bench.refused(&["drift", "logs"]);
    out += &bench.refused(&["simulate", "study.toml"]);
    out += &bench.refused(&["identify", "log.csv", "--law", "lugre"]);
    insta::assert_snapshot!(out);
}

/// The logs of two formats with one name do not meet in one axis file.
#[test]
fn an_axis_file_is_named_by_the_format_where_another_has_the_name() {
    let bench = Bench::new();
    bench.write("log.txt", &log().replace(" [mm]", ""));
    let (code, ..) = bench.run(&["check", "log.csv", "--init", "log.axis.toml"]);
    assert_eq!(code, 0);
    let mut out = bench.refused(&["check", "log.txt"]);
    out += &bench.refused(&["check", "log.txt", "--init", "log.axis.toml"]);
    bench.write("log.txt.axis.toml", "");
    out += &bench.refused(&["check", "log.txt", "--init", "log.axis.toml"]);
    insta::assert_snapshot!(out);
}

/// A line feed in a name begins no line, on either stream.
#[cfg(unix)]
#[test]
fn a_line_feed_in_a_name_begins_no_line() {
    let bench = Bench::new();
    let name = "a\nfaked: b.csv";
    bench.write(name, &log());
    for arguments in [
        &["check", name][..],
        &[
            "identify",
            name,
            "--law",
            "coulomb-viscous",
            "--out",
            "o\nfaked",
        ],
        &["check", name, "--axis", "none\nfaked.toml"],
    ] {
        let (_, out, err) = bench.run(arguments);
        let begins = |text: &str| {
            text.lines()
                .any(|line| line.trim_start().starts_with("faked"))
        };
        assert!(!begins(&out) && !begins(&err), "{out}{err}");
    }
}

/// A plan without limits is given the lines to fill in, with what a log shows.
#[test]
fn limits_are_given_to_fill_in() {
    let bench = Bench::new();
    bench.write("axis.toml", "kind = \"linear\"\n");
    let mut out = bench.refused(&["plan", "axis.toml", "--out", "plan"]);
    out += &bench.refused(&["plan", "axis.toml", "--log", "log.csv", "--out", "plan"]);
    bench.write(
        "axis.toml",
        "kind = \"rotary\"\n[limits]\nspeed = \"10 rad/s\"\nmass = \"5 kg cm2\"\n",
    );
    out += &bench.refused(&["plan", "axis.toml", "--out", "plan"]);
    insta::assert_snapshot!(out);
}

/// A log beside a result in a folder below is left out of a batch, and that is said.
#[test]
fn a_log_beside_a_result_is_named() {
    let bench = Bench::new();
    for folder in ["logs", "logs/done"] {
        std::fs::create_dir_all(bench.path(folder)).unwrap();
    }
    bench.write("logs/a.csv", &log());
    bench.write("logs/done/b.csv", &log());
    bench.write(
        "logs/done/result.json",
        "{\"schema\":\"stiction.result/1\"}",
    );
    let batch = ["batch", "logs", "--law", "coulomb-viscous", "--out", "out"];
    let (_, _, err) = bench.run(&batch);
    let said = "1 log lies beside the result of an earlier command, and what is in such a folder is left out: logs/done/b.csv; name";
    assert!(err.contains(said), "{err}");
}

/// A force of another file whose clock is late: the offset that is offered is the right one, whichever one is there.
#[test]
fn the_offset_of_a_late_force_is_offered() {
    let bench = Bench::new();
    let mut motion = String::from("Time [s],Position [mm]\n");
    let mut force = String::from("Time [s],Force [N]\n");
    for k in 0..8000 {
        let t = f64::from(k) * 1e-3;
        let (mut x, mut v, mut a) = (0.0, 0.0, 0.0);
        for (size, w) in [(0.05, 6.3), (0.008, 22.0)] {
            x += size * (w * t).sin();
            v += size * w * (w * t).cos();
            a -= size * w * w * (w * t).sin();
        }
        let noise = 0.2 * ((1e4 * t).sin() + (2.3e4 * t).sin() + (3.1e4 * t * t).sin());
        let f = 20.0 * f64::tanh(v / 1e-4) + 60.0 * v + 9.0 * a + noise;
        let _ = writeln!(motion, "{t:.4},{:.6}", 1e3 * x);
        let _ = writeln!(force, "{:.4},{f:.4}", t + 0.04);
    }
    bench.write("motion.csv", &motion);
    bench.write("force.csv", &force);
    let mut offset = 0.01;
    let check = |offset: f64| {
        let text = format!(
            "mass = \"9 kg\"\n[columns]\nforce = {{ file = \"force.csv\", column = \"Force\", offset = \"{offset} s\" }}\n"
        );
        bench.write("axis.toml", &text);
        let (_, out, err) = bench.run(&["check", "motion.csv", "--axis", "axis.toml"]);
        format!("{out}{err}")
    };
    let late = check(offset);
    let (_, rest) = late
        .split_once("write offset = \"")
        .unwrap_or_else(|| panic!("{late}"));
    assert!(rest.contains("in place of the offset there"), "{late}");
    offset = rest.split_once(" s\"").unwrap().0.parse().unwrap();
    assert!((offset + 0.04).abs() < 2e-3, "{late}");
    let mended = check(offset);
    assert!(!mended.contains("[force-late]"), "{mended}");
}

/// A folder, or what is no regular file, where a file is wanted leads to what is in it, to what it is good for, or to a look at it.
#[test]
fn a_folder_in_place_of_a_file_leads_on() {
    let bench = Bench::new();
    for dir in ["empty", "logs", "result", "study", "bare"] {
        std::fs::create_dir(bench.path(dir)).unwrap();
    }
    bench.write("logs/a.csv", &log());
    bench.write("study/study.toml", "[axis]\nmodel = \"model.toml\"\n");
    bench.write("result/model.toml", "schema = \"stiction.model/1\"\n");
    let inputs = "{ \"schema\": \"stiction.result/1\", \"inputs\": [{ \"path\": \"log.csv\" }, { \"path\": \"gone.csv\" }] }";
    bench.write("result/result.json", inputs);
    bench.write(
        "bare/result.json",
        "{ \"schema\": \"stiction.result/1\", \"inputs\": [] }",
    );
    let mut out = String::new();
    for command in [
        "simulate study --out s",
        "simulate study",
        "simulate empty --out s",
        "simulate logs --out s",
        "simulate nothing.toml",
        "check empty",
        "check result",
        "identify bare --out s",
        "drift empty",
        "drift result",
        "drift result/result.json",
        "drift bare/result.json",
        "batch empty --law lugre --out b",
        "batch result --law lugre --out b",
        "plan empty --out p",
        "check log.csv --axis empty",
    ] {
        let words: Vec<&str> = command.split(' ').collect();
        let _ = writeln!(out, "$ {command}\n{}", bench.refused(&words));
    }
    insta::assert_snapshot!(out);
}

/// A name that is taken, or whose folder is not there, leads to one that works; several logs stay several.
#[test]
fn an_axis_file_that_is_there_is_offered() {
    let bench = Bench::new();
    bench.write("open.csv", &log().replacen("Force [N]", "f1", 1));
    let mut out = bench.refused(&["check", "open.csv"]);
    bench.write("open.axis.toml", "kind = \"linear\"\n");
    out += &bench.refused(&["check", "open.csv"]);
    out += &bench.refused(&["check", "log.csv", "--init", "log.csv"]);
    out += &bench.refused(&["check", "log.csv", "--init", "nowhere/axis.toml"]);
    let (_, said, _) = bench.run(&["check", "log.csv", "open.csv", "--init", "two.toml"]);
    out += said.lines().last().unwrap();
    insta::assert_snapshot!(out);
}

/// A key that is misspelt is named beside what is missing for it.
#[test]
fn a_wrong_key_of_the_limits_is_named() {
    let bench = Bench::new();
    bench.write("axis.toml", "[limits]\nvelocty = \"1 m/s\"\nstrok = 3\n");
    insta::assert_snapshot!(bench.refused(&["plan", "axis.toml", "--out", "p"]));
}

/// What is said of an axis file has its name.
#[test]
fn the_axis_file_has_its_own_name() {
    let bench = Bench::new();
    bench.write(
        "my.toml",
        "[columns]\nposition = \"Position\"\nforce = \"Force\"\n",
    );
    let mut lines = String::from("Time [s],Position [counts],Force [N]\n");
    for line in log().lines().skip(1) {
        let _ = writeln!(lines, "{line}");
    }
    bench.write("counts.csv", &lines);
    let err = bench.refused(&["check", "counts.csv", "--axis", "my.toml"]);
    assert!(err.contains("give it in my.toml under [columns]"), "{err}");
}

/// A counter that overflows in a log whose axis file has no wrap is no position to identify from, however well a law fits between.
#[test]
fn a_counter_that_overflows_is_not_trusted() {
    let bench = Bench::new();
    // Few overflows leave stretches that are fitted, many leave none.
    for (per_mm, size, worth) in [(1e4, "0.1 um/count", 1), (1e5, "0.01 um/count", 2)] {
        let mut lines = String::from("Time [s],Position [counts],Force [N]\n");
        for line in log().lines().skip(1) {
            let mut cells = line.split(',');
            let [t, x, f] = std::array::from_fn(|_| cells.next().unwrap());
            let counts = (per_mm * x.parse::<f64>().unwrap()).round() as i64;
            let _ = writeln!(lines, "{t},{},{f}", counts.rem_euclid(65536));
        }
        bench.write("counts.csv", &lines);
        let axis = format!(
            "[columns]\nposition = {{ column = \"Position\", scale = \"{size}\" }}\nforce = \"Force\"\n"
        );
        bench.write("my.toml", &axis);
        let law = "--law=coulomb-viscous";
        let fit = [
            "identify",
            "counts.csv",
            "--axis=my.toml",
            law,
            "--out",
            &size[..4],
        ];
        let (code, out, err) = bench.run(&fit);
        assert_eq!(code, worth, "{out}{err}");
        let line = "write wrap = \"65536 counts\" under [log] in my.toml";
        assert!(format!("{out}{err}").contains(line), "{out}{err}");
        let (_, out, _) = bench.run(&["check", "counts.csv", "--axis", "my.toml"]);
        assert!(
            out.contains("correct my.toml as said above, then\nnext: stiction "),
            "{out}"
        );
    }
}
