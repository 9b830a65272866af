//! Long work that is ended by force, wherever it is, and goes on with `--resume`: the same bits as if it had not been.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use stiction_testkit::gate;
use tempfile::TempDir;

/// Paths, contours, passes of learning, a load that is looked for, corners and a sweep.
const STUDY: &str = r#"
[axis]
known      = "motor"
rate       = "4 kHz"
peak_force = "200 N"
encoder    = "50 nm"

[second_axis]
known      = "machine"
peak_force = "2 kN"

[coupling]
bandwidth = "30 Hz"
limit     = "10 mm/s"

[[path]]
kind      = "sine"
amplitude = "1 mm"
frequency = "2 Hz"

[[path]]
kind         = "move"
distance     = "10 mm"
velocity     = "50 mm/s"
acceleration = "1 m/s^2"
jerk         = "50 m/s^3"

[[contour]]
kind = "circle"

[[controller]]
kind      = "cascade"
bandwidth = "30 Hz"

[[compensator]]
kind = "lugre"

[[compensator]]
kind          = "lugre"
name          = "finds the load"
load_estimate = true
watchdog      = false

[[compensator]]
kind   = "learning"
lead   = "4 ms"
cutoff = "100 Hz"

[[parameter_error]]
kind = "corners"
by   = "10 %"

[[sweep]]
key    = "path.amplitude"
values = ["0.5 mm", "1 mm", "2 mm"]
"#;

struct Bench(TempDir);

impl Bench {
    fn new() -> Self {
        let bench = Bench(tempfile::tempdir().unwrap());
        std::fs::write(bench.path("study.toml"), STUDY).unwrap();
        bench
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

    fn run(&self, arguments: &[&str]) -> (i32, String, String) {
        crate::split(self.command(arguments).output().unwrap())
    }

    /// Whether the command was killed that long after its start, rather than done before.
    fn killed(&self, arguments: &[&str], after: Duration) -> bool {
        let mut command = self.command(arguments);
        let mut child = command
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(after);
        let killed = child.try_wait().unwrap().is_none();
        let _ = child.kill();
        child.wait().unwrap();
        killed
    }

    /// Kills a command again and again, at moments that are spread over the time that it takes, each time a little later; then
    /// lets it end. How often it was killed.
    fn killed_often(&self, whole: &[&str], again: &[&str], takes: Duration) -> usize {
        let mut kills = 0;
        let mut moment = 0.37_f64;
        for k in gate(4, 0..12) {
            // As good as random, and the same each time: the golden section.
            moment = (moment + 0.618_034) % 1.0;
            let arguments = if k == 0 { whole } else { again };
            if !self.killed(arguments, takes.mul_f64(0.4 * moment)) {
                break;
            }
            kills += 1;
        }
        let (code, _, err) = self.run(again);
        assert!(matches!(code, 0 | 1), "{code}: {err}");
        kills
    }
}

/// Every file of a folder.
fn files(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(dir).unwrap().map(Result::unwrap);
    let all = entries.map(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        (name, std::fs::read(entry.path()).unwrap())
    });
    all.collect()
}

#[test]
fn a_study_that_is_killed_again_and_again_ends_with_the_same_bits() {
    let bench = Bench::new();
    let clock = Instant::now();
    let (code, _, err) = bench.run(&["simulate", "study.toml", "--out", "whole"]);
    assert_eq!(code, 0, "{err}");
    let takes = clock.elapsed();
    let whole = ["simulate", "study.toml", "--out", "killed"];
    let again = [&whole[..], &["--resume"]].concat();
    let kills = bench.killed_often(&whole, &again, takes);
    assert!(kills > 1);
    let (expected, found) = (files(&bench.path("whole")), files(&bench.path("killed")));
    let names: Vec<&String> = expected.keys().collect();
    assert_eq!(
        names,
        [
            "contours.csv",
            "report.html",
            "study.json",
            "trajectories.csv"
        ]
    );
    assert_eq!(found.keys().collect::<Vec<_>>(), names);
    for (name, content) in &expected {
        assert!(found[name] == *content, "{name} differs");
    }
    // On one thread as on all.
    assert!(bench.killed(&[&whole[..], &["--threads", "1"]].concat(), takes / 3));
    let (code, _, err) = bench.run(&again);
    assert_eq!(code, 0, "{err}");
    assert!(files(&bench.path("killed")) == expected);
}

#[test]
fn runs_of_another_study_are_not_taken_and_what_is_left_is_said() {
    let bench = Bench::new();
    let slow = ["simulate", "study.toml", "--out", "out", "--threads", "1"];
    let kept = bench.path("out/.stiction-runs");
    let mut after = Duration::from_millis(100);
    // Until something was done.
    while !std::fs::read_to_string(&kept).is_ok_and(|text| text.lines().count() > 2) {
        assert!(bench.killed(&slow, after), "done too early");
        after += after / 2;
    }
    let other = STUDY.replace("\"2 Hz\"", "\"2.5 Hz\"");
    std::fs::write(bench.path("other.toml"), other).unwrap();
    let (code, _, err) = bench.run(&["simulate", "other.toml", "--out", "out", "--resume"]);
    assert_eq!(code, 2);
    let begin = "stiction: [bad-checkpoint] out/.stiction-runs: holds runs of another study: SHA-256 of all that they depend on ";
    assert!(err.starts_with(begin), "{err}");
    let next = "stiction: to begin anew:\nstiction: next: stiction simulate other.toml --out out\n";
    assert!(err.ends_with(next), "{err}");
    // Of another version.
    let text = std::fs::read_to_string(&kept).unwrap();
    let version = env!("CARGO_PKG_VERSION");
    let older = text.replacen(&format!("\t{version}\t"), "\t0.0.1\t", 1);
    std::fs::write(&kept, older).unwrap();
    let resumed = ["simulate", "study.toml", "--out", "out", "--resume"];
    let (code, _, err) = bench.run(&resumed);
    assert_eq!(code, 2);
    let said = format!("holds runs of version 0.0.1, this is {version}");
    assert!(err.contains(&said), "{err}");
    std::fs::write(&kept, text).unwrap();
    // What is taken is said, and nothing is left over.
    let (code, _, err) = bench.run(&resumed);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains(" runs are taken\n"), "{err}");
    assert!(!kept.exists());
    let (_, _, err) = bench.run(&resumed);
    let none = "stiction: out holds no runs of an earlier call: it begins with the first\n";
    assert_eq!(err, none);
}

#[test]
fn a_comparison_that_is_killed_ends_as_if_it_had_not_been() {
    let bench = Bench::new();
    let options = |out| {
        let problem = ["compare", "--problem", "machine", "--methods", "ga,de,lm"];
        let size = ["--seeds", "6", "--evaluations", "3000", "--out", out];
        [&problem[..], &size].concat()
    };
    let clock = Instant::now();
    let (code, _, err) = bench.run(&options("whole"));
    assert_eq!(code, 0, "{err}");
    let takes = clock.elapsed();
    let again = [&options("killed")[..], &["--resume"]].concat();
    bench.killed_often(&options("killed"), &again, takes);
    let [expected, found] = ["whole", "killed"].map(|dir| {
        let text = std::fs::read_to_string(bench.path(dir).join("compare.json")).unwrap();
        let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
        without_times(&mut file);
        file
    });
    assert_eq!(expected, found);
    let names = files(&bench.path("killed"));
    let names: Vec<&String> = names.keys().collect();
    assert_eq!(names, ["compare.json", "report.html"]);
}

/// Takes out what depends on the machine.
fn without_times(value: &mut serde_json::Value) {
    match value {
        serde_json::Value::Object(map) => {
            for key in ["wall_s", "seconds", "seconds_to_success", "by_time"] {
                map.remove(key);
            }
            map.values_mut().for_each(without_times);
        }
        serde_json::Value::Array(all) => all.iter_mut().for_each(without_times),
        _ => {}
    }
}

#[test]
fn a_study_that_is_too_large_says_how_to_run_it() {
    let bench = Bench::new();
    let (code, _, err) = bench.run(&[
        "simulate",
        "study.toml",
        "--out",
        "a b",
        "--max-samples=1e5",
        "--quiet",
    ]);
    assert_eq!(code, 2);
    assert!(
        err.starts_with("stiction: [too-large] study.toml: "),
        "{err}"
    );
    let next = err.lines().last().unwrap();
    let typed = next.strip_prefix("stiction: next: stiction ").unwrap();
    let (command, samples) = typed.split_once(" --max-samples=").unwrap();
    assert_eq!(command, "simulate study.toml --out 'a b'");
    let samples = samples.strip_suffix(" --quiet").unwrap();
    let words = [
        "simulate",
        "study.toml",
        "--out",
        "a b",
        "--max-samples",
        samples,
    ];
    let (code, _, err) = bench.run(&words);
    assert_eq!(code, 0, "{err}");
    let (code, _, err) = bench.run(&[
        "compare",
        "--problem",
        "V2",
        "--out",
        "c",
        "--max-samples",
        "1e4",
    ]);
    assert_eq!(code, 2);
    assert!(err.starts_with("stiction: [too-large] V2: "), "{err}");
    // What the options say is what the library does.
    let help = bench.run(&["simulate", "--help"]).1;
    let usual = stiction_files::study::MOST_SAMPLES;
    assert_eq!(usual as f64, 2e9);
    assert!(help.contains("[default: 2e9]"), "{help}");
}
