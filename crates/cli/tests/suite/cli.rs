//! The command line as a user or a script meets it: exit codes, streams, files.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

#[test]
fn help_and_usage() {
    trycmd::TestCases::new().case("tests/cmd/*.trycmd");
}

/// A folder to run in, with logs.
struct Bench(TempDir);

impl Bench {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
        command
            .args(arguments)
            .current_dir(self.0.path())
            .stdin(Stdio::null());
        command
    }

    /// Exit code, standard output, standard error.
    fn run(&self, arguments: &[&str]) -> (i32, String, String) {
        crate::split(self.command(arguments).output().unwrap())
    }

    /// A log of an axis of 9 kg with 20 N, 60 N s/m and bristles too stiff to be seen.
    fn log(&self, name: &str, samples: usize) {
        let mut text = String::from("Time [s],Position [mm],Force [N]\n");
        for i in 0..samples {
            let t = i as f64 * 1e-3;
            let (mut x, mut v, mut a) = (0.0, 0.0, 0.0);
            for (size, w) in [(0.05, 6.3), (0.008, 22.0)] {
                x += size * (w * t).sin();
                v += size * w * (w * t).cos();
                a -= size * w * w * (w * t).sin();
            }
            // A sum of incommensurable tones stands in for noise.
            let noise = 0.2 * ((1e4 * t).sin() + (2.3e4 * t).sin() + (3.1e4 * t * t).sin());
            let force = 20.0 * f64::tanh(v / 1e-4) + 60.0 * v + 9.0 * a + 1.0 + noise;
            let _ = writeln!(text, "{t:.4},{:.6},{force:.4}", 1e3 * x);
        }
        std::fs::write(self.path(name), text).unwrap();
    }

    fn rest(&self, name: &str) {
        let mut text = String::from("Time [s],Position [mm],Force [N]\n");
        for i in 0..3000 {
            let _ = writeln!(text, "{:.4},5.0,{}", f64::from(i) * 1e-3, f64::from(i % 7));
        }
        std::fs::write(self.path(name), text).unwrap();
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.path(folder))
            .unwrap()
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

const FOUR: [&str; 4] = ["fit.csv", "model.toml", "report.html", "result.json"];
const PLAIN: [&str; 3] = ["identify", "log.csv", "--law=coulomb-viscous"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    PLAIN.iter().chain(more).copied().collect()
}

/// Help that does not reach its reader is an error, as a result is.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said() {
    let bench = Bench::new();
    for arguments in [&["--help"][..], &["--version"], &["man"]] {
        let full = std::fs::File::create("/dev/full").unwrap();
        let output = bench.command(arguments).stdout(full).output().unwrap();
        let (code, _, err) = crate::split(output);
        assert_eq!(code, 2, "{arguments:?}: {err}");
        assert!(
            err.starts_with("stiction: [output] standard output: "),
            "{err}"
        );
    }
}

/// A number out of range is told what is allowed, with its sign.
#[test]
fn a_negative_number_is_a_number() {
    let bench = Bench::new();
    bench.log("log.csv", 1000);
    for (option, said) in [
        (
            "--seed",
            "invalid value '-1' for '--seed <N>': a whole number from 0 to 18446744073709551615 is allowed",
        ),
        ("--threads", "-1 is not in 1..=1024"),
        ("--split", "--split -1; a number between 0 and 1"),
    ] {
        let (code, _, err) = bench.run(&with(&[option, "-1", "--out", "a"]));
        assert_eq!(code, 2, "{err}");
        assert!(err.contains(said), "{err}");
        assert!(!err.contains("-- -1"), "{err}");
    }
}

/// What would steer a terminal, in a file, does not reach it.
#[test]
fn control_characters_of_files_are_written_out() {
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    let axis = "[columns]\nforce = \"a\\u001b]0;x\\u0007\\u009b2J\\nb\"\n";
    std::fs::write(bench.path("axis.toml"), axis).unwrap();
    let (code, _, err) = bench.run(&["check", "log.csv", "--axis", "axis.toml"]);
    assert_eq!(code, 2, "{err}");
    // One line of what is wrong, one of what to do about it, and one with the command.
    assert_eq!(err.lines().count(), 3, "{err:?}");
    assert!(
        !err.lines().any(|line| line.contains(char::is_control)),
        "{err:?}"
    );
    assert!(err.contains("u{1b}]0;x"), "{err}");
}

/// What an axis file names and its log does not have is an error of that file, with any method.
#[test]
fn an_axis_file_that_does_not_fit_the_log() {
    let bench = Bench::new();
    bench.log("log.csv", 900);
    for (text, said) in [
        (
            "[terms]\ncoulomb_load = true",
            "line 2, column 16, terms.coulomb_load: log.csv: no load column",
        ),
        (
            "[controller]\nkind = \"p-p\"\nposition_gain = \"40 1/s\"\nspeed_gain = \"3 kg\"",
            "line 4, column 14, controller.speed_gain: \"3 kg\"; give it in ",
        ),
        (
            "[conditioning]\nsource_cutoff = \"499.999 Hz\"",
            "line 2, column 17, conditioning.source_cutoff: log.csv: cut-off frequency in Hz is 499.999; \
             allowed: from 0.005 to 499.995, below half the sample rate",
        ),
        (
            "[log]\ncrop = [\"5 s\", \"6 s\"]",
            "line 2, column 8, log.crop: log.csv: crop from 5 to 6 s keeps no sample",
        ),
        (
            "[text]\npreamble = 1000",
            "line 2, column 12, text.preamble: log.csv: ",
        ),
    ] {
        std::fs::write(bench.path("axis.toml"), text).unwrap();
        let (code, _, err) = bench.run(&["check", "log.csv", "--axis", "axis.toml"]);
        assert_eq!(code, 2, "{text}: {err}");
        assert!(err.contains(&format!("] axis.toml: {said}")), "{err}");
    }
}

#[test]
fn exit_codes() {
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    bench.rest("rest.csv");
    let (code, out, err) = bench.run(&with(&["--out", "a"]));
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("coulomb") && out.contains("written to a"));
    // No friction can be told from motion in one direction: a result that says so.
    let one_way: String = std::fs::read_to_string(bench.path("log.csv"))
        .unwrap()
        .lines()
        .enumerate()
        .map(|(i, line)| {
            if i == 0 {
                return format!("{line}\n");
            }
            let cells: Vec<f64> = line.split(',').map(|c| c.parse().unwrap()).collect();
            format!(
                "{:.4},{:.6},{:.4}\n",
                cells[0],
                cells[1] + 900.0 * cells[0],
                cells[2]
            )
        })
        .collect();
    std::fs::write(bench.path("oneway.csv"), one_way).unwrap();
    let (code, out, err) = bench.run(&[
        "identify",
        "oneway.csv",
        "--law=coulomb-viscous",
        "--out",
        "b",
    ]);
    assert_eq!((code, err.as_str()), (1, ""), "{out}");
    assert!(
        out.contains("for compensation  NO: the axis moves in one direction only"),
        "{out}"
    );
    for parameter in ["coulomb", "offset"] {
        let row = out.lines().find(|l| l.starts_with(parameter)).unwrap();
        assert!(row.contains("NOT IDENTIFIABLE"), "{out}");
    }
    assert_eq!(bench.names("b"), FOUR);
    let (code, out, err) = bench.run(&["identify", "rest.csv", "--out", "c"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.starts_with("stiction: [no-motion] rest.csv: "), "{err}");
    assert!(err.contains("next: stiction check rest.csv"), "{err}");
    assert!(!bench.path("c").exists(), "nothing is made for nothing");
    let (code, out, _) = bench.run(&["check", "rest.csv"]);
    assert_eq!(code, 1, "{out}");
    let (code, _, _) = bench.run(&["check", "log.csv"]);
    assert_eq!(code, 0);
}

#[test]
fn json_is_one_value_and_nothing_else() {
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    let (code, out, err) = bench.run(&with(&["--out", "a", "--json"]));
    assert_eq!((code, err.as_str()), (0, ""));
    let value = json(&out);
    assert_eq!(value["schema"], "stiction.result/1");
    let file = std::fs::read_to_string(bench.path("a/result.json")).unwrap();
    assert_eq!(value, json(&file));
    let (_, out, err) = bench.run(&["check", "log.csv", "--json"]);
    assert_eq!(
        (json(&out)["schema"].as_str(), err.as_str()),
        (Some("stiction.check/1"), "")
    );
    let (code, out, _) = bench.run(&["check", "log.csv", "--init", "x.toml", "--json"]);
    assert_eq!((code, json(&out)["written"].as_str()), (0, Some("x.toml")));
    // An error is JSON too, and still on standard error for people.
    let (code, out, err) = bench.run(&["check", "no.csv", "--json"]);
    assert_eq!(
        (code, json(&out)["error"]["code"].as_str()),
        (2, Some("log-io"))
    );
    assert!(err.contains("[log-io]"));
}

#[test]
fn quiet_says_nothing_but_errors() {
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    for arguments in [
        with(&["--out", "a", "--quiet"]),
        vec!["check", "log.csv", "--quiet"],
        vec!["check", "log.csv", "--init", "--quiet"],
    ] {
        let (code, out, err) = bench.run(&arguments);
        assert_eq!(
            (code, out.as_str(), err.as_str()),
            (0, "", ""),
            "{arguments:?}"
        );
    }
    assert_eq!(bench.names("a"), FOUR);
    let (code, out, err) = bench.run(&["check", "no.csv", "--quiet"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("[log-io]"));
}

#[test]
fn a_folder_of_others_is_kept() {
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    std::fs::create_dir(bench.path("mine")).unwrap();
    std::fs::write(bench.path("mine/thesis.tex"), "work").unwrap();
    let (code, out, err) = bench.run(&with(&["--out", "mine"]));
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("[output]") && err.contains("--force"), "{err}");
    assert_eq!(bench.names("mine"), ["thesis.tex"]);
    assert_eq!(bench.run(&with(&["--out", "mine", "--force"])).0, 0);
    assert_eq!(bench.names("mine").len(), 5);
    for bad in ["log.csv", "log.csv/sub"] {
        let (code, _, err) = bench.run(&with(&["--out", bad, "--force"]));
        assert_eq!(code, 2);
        assert!(err.contains("[output]"), "{err}");
    }
    // Twice into its own folder is fine.
    assert_eq!(bench.run(&with(&["--out", "own"])).0, 0);
    assert_eq!(bench.run(&with(&["--out", "own"])).0, 0);
    assert_eq!(bench.names("own"), FOUR);
}

/// A log of that name which the demo did not write is kept, whether it is older or newer than the result beside it.
#[test]
fn the_demo_keeps_a_log_of_others() {
    let bench = Bench::new();
    assert_eq!(bench.run(&["demo", "--out", "d"]).0, 0);
    let ours = std::fs::read(bench.path("d/demo.csv")).unwrap();
    let (code, _, err) = bench.run(&["demo", "--out", "d"]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(bench.names("d").len(), 6);
    std::fs::write(bench.path("d/demo.csv"), "mine").unwrap();
    let file = std::fs::File::options()
        .write(true)
        .open(bench.path("d/demo.csv"));
    file.unwrap().set_modified(std::time::UNIX_EPOCH).unwrap();
    let (code, _, err) = bench.run(&["demo", "--out", "d"]);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("it is kept as d/demo-1.csv"), "{err}");
    let read = |name: &str| std::fs::read(bench.path(name)).unwrap();
    assert_eq!(
        (read("d/demo-1.csv"), read("d/demo.csv")),
        (b"mine".to_vec(), ours)
    );
    // One that was ended between log and result goes on in its folder, and keeps a log of others there too.
    std::fs::create_dir(bench.path("cut")).unwrap();
    std::fs::write(bench.path("cut/demo.csv"), "mine").unwrap();
    let (code, _, err) = bench.run(&["demo", "--out", "cut"]);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains("it is kept as cut/demo-1.csv"), "{err}");
}

#[test]
fn init_keeps_a_file_and_leads_on() {
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    let (code, out, _) = bench.run(&["check", "log.csv", "--init"]);
    assert_eq!(code, 0, "{out}");
    let written = std::fs::read_to_string(bench.path("axis.toml")).unwrap();
    std::fs::write(bench.path("axis.toml"), written.clone() + "# mine\n").unwrap();
    let (code, _, err) = bench.run(&["check", "log.csv", "--init"]);
    assert_eq!(code, 2);
    assert!(err.contains("[output] axis.toml: exists already"), "{err}");
    assert!(
        std::fs::read_to_string(bench.path("axis.toml"))
            .unwrap()
            .ends_with("# mine\n")
    );
    // The file as written is used as it is and changes nothing.
    let (code, out, err) = bench.run(&with(&["--axis", "axis.toml", "--out", "a"]));
    assert_eq!(code, 0, "{out}{err}");
    assert_eq!(bench.run(&with(&["--out", "b"])).0, 0);
    let read = |name: &str| std::fs::read(bench.path(name)).unwrap();
    assert_eq!(read("a/fit.csv"), read("b/fit.csv"));
    // A link that leads nowhere is kept as well.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("nowhere", bench.path("link.toml")).unwrap();
        let (code, _, _) = bench.run(&["check", "log.csv", "--init", "link.toml"]);
        assert_eq!(code, 2);
        assert!(
            bench
                .path("link.toml")
                .symlink_metadata()
                .unwrap()
                .is_symlink()
        );
    }
}

/// Results do not depend on the number of threads.
#[test]
fn threads_do_not_change_a_bit() {
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    for n in ["1", "3"] {
        assert_eq!(
            bench
                .run(&with(&["--threads", n, "--seed", "7", "--out", n]))
                .0,
            0
        );
    }
    for name in ["model.toml", "fit.csv", "report.html"] {
        let read = |n: &str| std::fs::read(bench.path(n).join(name)).unwrap();
        assert!(read("1") == read("3"), "{name}");
    }
}

#[test]
fn odd_paths_work_and_nothing_else_is_written() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("Prüf stand")).unwrap();
    std::fs::create_dir(bench.path("sub")).unwrap();
    bench.log("Prüf stand/Achse 'x' \"中\".csv", 4000);
    let (code, out, err) = bench.run(&[
        "identify",
        "sub/../Prüf stand/Achse 'x' \"中\".csv",
        "--law=coulomb-viscous",
        "--out",
        "sub/../aus gabe/ü",
    ]);
    assert_eq!(code, 0, "{out}{err}");
    assert_eq!(bench.names("aus gabe/ü"), FOUR);
    assert_eq!(bench.names("."), ["Prüf stand", "aus gabe", "sub"]);
    assert_eq!(bench.names("Prüf stand").len(), 1);
    assert_eq!(bench.names("sub").len(), 0);
    let result = json(&std::fs::read_to_string(bench.path("aus gabe/ü/result.json")).unwrap());
    assert_eq!(
        result["inputs"][0]["path"],
        "sub/../Prüf stand/Achse 'x' \"中\".csv"
    );
}

/// Bytes that are no text are fine in names.
#[cfg(target_os = "linux")]
#[test]
fn names_need_not_be_text() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    let odd = OsStr::from_bytes(b"a\xff\xfe.csv");
    std::fs::rename(bench.path("log.csv"), bench.0.path().join(odd)).unwrap();
    let out = OsStr::from_bytes(b"out\xff");
    let output = bench
        .command(&["identify", "--law=coulomb-viscous", "--json"])
        .args([odd, OsStr::new("--out"), out])
        .output()
        .unwrap();
    let (code, text, err) = crate::split(output);
    assert_eq!(code, 0, "{err}");
    json(&text);
    assert!(bench.0.path().join(out).join("result.json").is_file());
}

/// What is no file is refused at once, and nothing waits.
#[cfg(unix)]
#[test]
fn devices_pipes_and_loops_are_refused() {
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    let pipe = bench.path("pipe");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    std::os::unix::fs::symlink("loop", bench.path("loop")).unwrap();
    for bad in ["/dev/zero", "pipe", "loop", "."] {
        let (code, _, err) = bench.run(&["identify", bad, "--out", "x"]);
        assert_eq!(code, 2, "{bad}: {err}");
        assert!(err.starts_with("stiction: [log-io] "), "{err}");
        let (code, _, err) = bench.run(&with(&["--axis", bad, "--out", "x"]));
        assert_eq!(code, 2, "{bad}: {err}");
        assert!(err.starts_with("stiction: [bad-config] "), "{err}");
    }
    for bad in ["pipe", "loop", "/dev/null"] {
        let (code, _, err) = bench.run(&with(&["--out", bad, "--force"]));
        assert_eq!(code, 2, "{bad}: {err}");
        assert!(err.starts_with("stiction: [output] "), "{err}");
    }
    assert!(!bench.path("x").exists());
}

/// A reader that goes away early is no fault; a full disk behind the output is one, said in words.
#[cfg(target_os = "linux")]
#[test]
fn closed_and_full_outputs() {
    let bench = Bench::new();
    bench.log("log.csv", 4000);
    let mut child = bench
        .command(&with(&["--out", "a"]))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let (code, _, err) = crate::split(child.wait_with_output().unwrap());
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(bench.names("a"), FOUR);
    let full = || {
        std::fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap()
    };
    let output = bench
        .command(&with(&["--out", "b"]))
        .stdout(full())
        .output()
        .unwrap();
    let (code, _, err) = crate::split(output);
    assert_eq!(code, 2);
    assert!(
        err.starts_with("stiction: [output] standard output: "),
        "{err}"
    );
}

/// A check has nothing to keep: Ctrl-C ends it, whatever it is at.
#[cfg(unix)]
#[test]
fn an_interrupt_ends_a_check_at_once() {
    let bench = Bench::new();
    bench.log("log.csv", 300_000);
    let mut child = bench
        .command(&["check", "log.csv"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "the log is too short");
    crate::interrupt(&child);
    let (code, out, err) = crate::split(child.wait_with_output().unwrap());
    let said = "stiction: [interrupted] stopped; nothing was written\n";
    assert_eq!((code, out.as_str(), err.as_str()), (130, "", said));
}

/// A log that would take more memory than is allowed is refused with what it asks for and how to allow it.
#[test]
fn a_log_beyond_the_memory_that_is_allowed_is_refused() {
    let bench = Bench::new();
    bench.log("log.csv", 300_000);
    let check = |memory| {
        crate::split(
            bench
                .command(&["check", "log.csv", "--max-memory", memory])
                .output()
                .unwrap(),
        )
    };
    let (code, out, err) = check("2MB");
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(
        err.starts_with("stiction: [log-limit] log.csv: reading "),
        "{err}"
    );
    let (_, offered) = err.split_once("--max-memory ").unwrap();
    let (offered, _) = offered.split_once(' ').unwrap();
    // What is offered is enough, and a size that is none is refused.
    let (code, out, err) = check(offered);
    assert!(code < 2, "{offered}: {err}");
    // A fit takes more than reading does: the log is looked at without, and identified not at all.
    let fit = "[log-limit] log.csv: a fit of 300000 samples would take 300 MB of memory";
    assert!(
        out.contains("log-limit: log.csv: a fit of 300000 samples"),
        "{out}"
    );
    let identified = bench
        .command(&["identify", "log.csv", "--max-memory", offered, "--out", "a"])
        .output();
    let (code, out, err) = crate::split(identified.unwrap());
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains(fit) && err.contains("crop = ["), "{err}");
    assert!(!bench.path("a").exists());
    for wrong in ["much", "3", "-1GB", "1e9GB"] {
        let (code, _, err) = check(wrong);
        assert_eq!(code, 2);
        assert!(err.contains("a size from 1MB is allowed"), "{err}");
    }
}

/// Ctrl-C in the middle of a search: what was found so far is saved, and says what it is.
#[cfg(unix)]
#[test]
fn an_interrupt_saves_what_was_found() {
    let bench = Bench::new();
    bench.log("log.csv", 300_000);
    let (clock, (code, out, err)) =
        crate::interrupted(|| bench.command(&["identify", "log.csv", "--out", "a"]));
    assert_eq!(code, 130, "{out}{err}");
    assert!(
        clock.elapsed().as_secs() < 15,
        "took {:?} to stop",
        clock.elapsed()
    );
    assert_eq!(bench.names("a"), FOUR);
    let result = json(&std::fs::read_to_string(bench.path("a/result.json")).unwrap());
    assert_eq!(result["search"]["status"], "interrupted");
    assert_eq!(result["trust"]["trustworthy"], false);
    let codes: Vec<&str> = result["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|w| w["code"].as_str())
        .collect();
    assert!(codes.contains(&"interrupted"), "{codes:?}");
}

/// The demo needs nothing, and finds what it simulated.
#[test]
fn the_demo_finds_the_truth() {
    let bench = Bench::new();
    let (code, out, err) = bench.run(&["demo"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("  true"), "{out}");
    let mut files = bench.names("stiction-demo");
    files.retain(|name| !["demo.csv", "study.toml"].contains(&name.as_str()));
    assert_eq!(files, FOUR);
    // What is written beside the model runs as it is.
    let study = [
        "simulate",
        "stiction-demo/study.toml",
        "--out",
        "stiction-demo/study",
    ];
    assert!(
        out.contains(&format!("stiction {}", study.join(" "))),
        "{out}"
    );
    assert_eq!(bench.run(&study).0, 0);
    let result = json(&std::fs::read_to_string(bench.path("stiction-demo/result.json")).unwrap());
    let value = |name: &str| {
        let all = result["parameters"].as_array().unwrap();
        let found = all.iter().find(|p| p["name"] == name);
        found.unwrap_or_else(|| panic!("no {name}"))["value"]
            .as_f64()
            .unwrap()
    };
    // The axis `machine` of the simulator.
    for (name, truth) in [
        ("sigma0", 1.2e5),
        ("sigma1", 600.0),
        ("sigma2", 60.0),
        ("coulomb", 20.0),
        ("static", 30.0),
        ("stribeck_velocity", 5e-3),
    ] {
        let off = value(name) / truth - 1.0;
        assert!(off.abs() < 0.02, "{name} is off by {:.2} %", 100.0 * off);
    }
    // A second demo replaces the first; one in a folder of others does not happen.
    assert_eq!(bench.names("."), ["stiction-demo"]);
    let refused = bench.run(&["demo", "--out", "."]);
    assert_eq!(refused.0, 2, "{}", refused.2);
    assert!(Path::new(&bench.path("stiction-demo/demo.csv")).is_file());
}

/// Where a setting of the axis file leaves too little, or the log has too little for any method, the next step says so.
#[test]
fn too_few_samples_lead_where_there_are_more() {
    let bench = Bench::new();
    let rows = |n: u32| -> String {
        let row = |k: u32| {
            let t = f64::from(k) * 1e-3;
            let phase = 20.0 * t;
            let force = 12.0 * phase.sin() + 3.0 * phase.cos();
            format!("{t},{:.9},{force:.6}\n", 1e-3 * phase.sin())
        };
        let rows: String = (0..n).map(row).collect();
        format!("time [s],position [m],force [N]\n{rows}")
    };
    std::fs::write(bench.path("long.csv"), rows(3000)).unwrap();
    std::fs::write(bench.path("few.csv"), rows(60)).unwrap();
    for (name, setting) in [
        ("decimate.toml", "decimate = 200"),
        ("slow.toml", "min_speed = \"1 m/s\""),
    ] {
        let text = format!("kind = \"linear\"\n[conditioning]\n{setting}\n");
        std::fs::write(bench.path(name), text).unwrap();
    }
    for (asked, next) in [
        (
            &["long.csv", "--axis", "decimate.toml"][..],
            "in decimate.toml, under [conditioning], in place of the line decimate write decimate = 10",
        ),
        (
            &["long.csv", "--axis", "slow.toml"],
            "in slow.toml, under [conditioning], in place of the line min_speed write min_speed = \"0.002 m/s\"",
        ),
        (&["few.csv"], "next: stiction check few.csv\n"),
    ] {
        let asked = [&["identify"], asked, &["--out", "out"]].concat();
        let (code, _, err) = bench.run(&asked);
        assert_eq!(code, 2, "{err}");
        assert!(err.contains(next), "{err}");
    }
}

/// A stretch that the filters leave too little of goes to the method that filters nothing, with the command complete.
#[test]
fn a_short_stretch_is_sent_to_the_simulation() {
    let bench = Bench::new();
    let rows: String = (0..400)
        .map(|k| {
            let t = f64::from(k) * 1e-3;
            let phase = 20.0 * t;
            format!(
                "{t},{:.9},{:.6}\n",
                1e-3 * phase.sin(),
                12.0 * phase.sin() + 3.0 * phase.cos()
            )
        })
        .collect();
    std::fs::write(
        bench.path("my log.csv"),
        format!("time [s],position [m],force [N]\n{rows}"),
    )
    .unwrap();
    std::fs::write(
        bench.path("axis.toml"),
        "kind = \"linear\"\nmass = \"4 kg\"\n",
    )
    .unwrap();
    std::fs::write(
        bench.path("rig.toml"),
        "kind = \"linear\"\nmass = \"none\"\n",
    )
    .unwrap();
    let asked = [
        "identify",
        "my log.csv",
        "--axis",
        "axis.toml",
        "--law",
        "dahl",
        "--asymmetric",
    ];
    let (code, _, err) = bench.run(&[&asked[..], &["--out", "out"]].concat());
    assert_eq!(code, 2, "{err}");
    assert!(
        err.contains(
            "next: stiction identify 'my log.csv' --axis axis.toml --law dahl --asymmetric --method output-error --out out\n"
        ),
        "{err}"
    );
    let (_, _, err) = bench.run(&["identify", "my log.csv", "--law", "lugre", "--out", "out"]);
    let lugre =
        "next: stiction identify 'my log.csv' --law lugre --method output-error --out out\n";
    assert!(err.contains(lugre), "{err}");
    let (_, _, err) = bench.run(&["identify", "my log.csv", "--out", "out"]);
    assert!(err.contains(&lugre.replace(" --law lugre", "")), "{err}");
    // A rig without a mass cannot be simulated, and not every law can.
    for other in [
        ["--axis", "rig.toml", "--law", "dahl"],
        ["--axis", "axis.toml", "--law", "elasto-plastic"],
    ] {
        let asked = [&["identify", "my log.csv"][..], &other, &["--out", "out"]].concat();
        let (code, _, err) = bench.run(&asked);
        assert_eq!(code, 2, "{err}");
        assert!(err.contains("next: stiction check 'my log.csv'"), "{err}");
    }
}

/// A log whose columns are not clear leads to `--init`, which fills in those that are.
#[test]
fn unclear_columns_lead_to_an_axis_file() {
    let bench = Bench::new();
    let mut plain = String::new();
    let mut counted = String::from("time,cnt,i_q\n");
    for i in 0..300 {
        let t = f64::from(i) * 1e-3;
        let (x, force) = ((20.0 * t).sin(), (20.0 * t).cos());
        let _ = writeln!(plain, "{t:.3},{x:.5},{force:.4}");
        let _ = writeln!(counted, "{t:.3},{:.0},{force:.4}", 1e5 * x);
    }
    std::fs::write(bench.path("plain.csv"), plain).unwrap();
    std::fs::write(bench.path("counted.csv"), counted).unwrap();
    for command in ["check", "identify"] {
        let mut arguments = vec![command, "plain.csv"];
        if command == "identify" {
            arguments.extend(["--out", "out"]);
        }
        let (code, _, err) = bench.run(&arguments);
        assert_eq!(code, 2, "{err}");
        assert!(
            err.contains(": stiction check plain.csv --init plain.axis.toml"),
            "{err}"
        );
    }
    let (code, _, err) = bench.run(&["check", "counted.csv", "--init", "axis.toml"]);
    assert_eq!(code, 0, "{err}");
    let axis = std::fs::read_to_string(bench.path("axis.toml")).unwrap();
    for line in [
        "\ntime = { column = \"time\" }",
        "\nposition = { column = \"cnt\", unit = \"counts\" }",
        "\n# with the size of a count add, such as: scale = ",
        "\nforce = { column = \"i_q\" }",
    ] {
        assert!(axis.contains(line), "{line}: {axis}");
    }
}

/// A log before and after a compensator was put into operation: what improved, and what got worse.
#[test]
fn a_log_before_and_one_after() {
    let bench = Bench::new();
    let log = |name: &str, seconds: usize, peak: &dyn Fn(usize) -> f64| {
        let mut text = String::from("Time [s],Reference [mm],Position [mm],Force [N]\n");
        for i in 0..1000 * seconds {
            let t = i as f64 * 1e-3;
            let phase = std::f64::consts::TAU * 0.5 * t;
            // The error comes up at each turn of the reference, a cosine of 0.5 Hz, and fades in 30 ms.
            let (stroke, since) = (t.floor(), t.fract());
            let sign = if stroke % 2.0 == 0.0 { -1.0 } else { 1.0 };
            let error = sign * 1e-6 * peak(stroke as usize) * (-since / 0.03).exp();
            let reference = 0.05 * phase.cos();
            let v = -0.05 * 0.5 * std::f64::consts::TAU * phase.sin();
            let noise = 0.2 * ((1e4 * t).sin() + (2.3e4 * t).sin());
            let force = 20.0 * f64::tanh(v / 1e-4) + 60.0 * v - 9.9 * 9.0 * reference + noise;
            let position = reference - error;
            let _ = writeln!(
                text,
                "{t:.4},{:.6},{:.6},{force:.4}",
                1e3 * reference,
                1e3 * position
            );
        }
        std::fs::write(bench.path(name), text).unwrap();
    };
    log("before.csv", 10, &|_| 60.0);
    // One reversal is worse than before.
    log("after.csv", 10, &|stroke| {
        if stroke == 6 { 80.0 } else { 6.0 }
    });
    let changed = |arguments: &[&str]| {
        let (code, out, err) = bench.run(arguments);
        assert_eq!(code, 0, "{err}");
        // It is said first; what each log shows follows.
        assert!(out.starts_with("following error of"), "{out}");
        out.split("\n\n").next().unwrap_or_default().to_string()
    };
    insta::assert_snapshot!(changed(&["check", "before.csv", "after.csv"]));
    // The same recording with fewer rows, none of them at a reversal: what both show is the same.
    let rows = |path: &str| -> Vec<Vec<String>> {
        let text = std::fs::read_to_string(bench.path(path)).unwrap();
        // Without the force, which makes no difference here.
        let cells = |row: &str| row.split(',').take(3).map(str::to_string).collect();
        text.lines().map(cells).collect()
    };
    let head = "Time [s],Reference [mm],Position [mm]\n";
    let whole: Vec<Vec<String>> = rows("before.csv").split_off(1);
    let put = |name: &str, rows: &[Vec<String>]| {
        let rows: Vec<String> = rows.iter().map(|row| row.join(",") + "\n").collect();
        std::fs::write(bench.path(name), head.to_string() + &rows.concat()).unwrap();
    };
    let every = |n: usize, first: usize| -> Vec<Vec<String>> {
        whole.iter().skip(first).step_by(n).cloned().collect()
    };
    put("whole.csv", &whole);
    let compared = |name: &str| bench.run(&["check", "whole.csv", name]).1;
    let peaks = |name: &str| {
        let (_, out, _) = bench.run(&["check", "whole.csv", name, "--json"]);
        let json: serde_json::Value = serde_json::from_str(&out).unwrap();
        ["before", "after"].map(|log| {
            let peaks = &json["tracking"][0][log]["peaks"];
            peaks[3]["error"].as_f64().unwrap()
        })
    };
    put("thin.csv", &every(8, 4));
    let [a, b] = peaks("thin.csv");
    assert!((a / b - 1.0).abs() < 0.03 && b < 55e-6, "{a} {b}");
    let said = compared("thin.csv");
    assert!(
        said.contains("the rates differ, 1000 and 125.0 Hz"),
        "{said}"
    );
    put("slow.csv", &every(100, 50));
    let why = "slow.csv is not compared: it has 10 Hz and the first log 1000 Hz";
    let said = compared("slow.csv");
    assert!(said.contains(why) && said.contains("from 100 Hz"), "{said}");
    // Rows that were not measured show nothing of a reversal.
    let mut frozen = whole.clone();
    let stopped = frozen[2950].clone();
    for row in &mut frozen[2950..3150] {
        row[1..3].clone_from_slice(&stopped[1..3]);
    }
    put("frozen.csv", &frozen);
    let said = compared("frozen.csv");
    assert!(
        said.contains("1 of 9 reversals of frozen.csv are left out"),
        "{said}"
    );
    assert!(said.contains("worse at no reversal"), "{said}");
    // Nor do rows without a reference of the error between them.
    let mut unasked = whole.clone();
    for row in &mut unasked[2400..2600] {
        row[1].clear();
    }
    put("unasked.csv", &unasked);
    let said = compared("unasked.csv");
    let rows = "200 rows of the motion of unasked.csv left out";
    assert!(said.contains(rows), "{said}");
    let (_, out, _) = bench.run(&["check", "whole.csv", "unasked.csv", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    let [a, b] = ["before", "after"].map(|log| {
        let log = &json["tracking"][0][log];
        [&log["rms"], &log["largest"]].map(|x| x.as_f64().unwrap())
    });
    assert!(
        (b[0] / a[0] - 1.0).abs() < 0.05 && b[1] <= a[1],
        "{a:?} {b:?}"
    );
    let mut holes = whole.clone();
    let turns = |i: usize| i % 1000 < 100;
    (holes.iter_mut().enumerate()).for_each(|(i, row)| {
        if turns(i) {
            row[2].clear()
        }
    });
    put("holes.csv", &holes);
    let said = compared("holes.csv");
    assert!(
        said.contains("every reversal of its reference lies beside a gap"),
        "{said}"
    );
    let mut copied = whole.clone();
    copied.iter_mut().for_each(|row| row[2] = row[1].clone());
    put("copied.csv", &copied);
    let said = compared("copied.csv");
    assert!(
        said.contains("its position is its reference, row by row"),
        "{said}"
    );
    let mut coarse = whole.clone();
    for row in &mut coarse {
        let x: f64 = row[2].parse().unwrap();
        row[2] = format!("{:.1}", (x / 0.2).round() * 0.2);
    }
    put("coarse.csv", &coarse);
    let said = compared("coarse.csv");
    assert!(
        said.contains("the encoder of coarse.csv has steps of 200.0 um, larger than its peaks"),
        "{said}"
    );
    log("longer.csv", 14, &|_| 6.0);
    let said = changed(&["check", "before.csv", "longer.csv"]);
    assert!(
        said.contains("the motions differ (reversals, duration)"),
        "{said}"
    );
    // Without a reference there is nothing to compare, and it is said.
    bench.log("none.csv", 6000);
    let (_, out, _) = bench.run(&["check", "before.csv", "none.csv"]);
    let why = "the following error of none.csv is not compared: it has no reference position";
    assert!(out.contains(why), "{out}");
    // One log has nothing to be compared with.
    let (_, out, _) = bench.run(&["check", "before.csv"]);
    assert!(!out.contains("following error of"), "{out}");
}
