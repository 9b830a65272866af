//! A command that is killed, wherever it is: the folder has what was there or what was to be there, never some of each.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use stiction_testkit::gate;
use tempfile::TempDir;

/// Every file of a folder, by its path in it.
type Files = BTreeMap<PathBuf, Vec<u8>>;

/// System calls that change what a folder holds.
const CHANGES: [&str; 6] = [
    "rename",
    "renameat2",
    "linkat",
    "unlink",
    "unlinkat",
    "mkdir",
];

/// A command with two inputs, which writes into one folder.
struct Case {
    arguments: [Vec<&'static str>; 2],
    out: &'static str,
}

struct Bench {
    dir: TempDir,
}

impl Bench {
    fn new() -> Self {
        let dir = tempfile::tempdir().unwrap();
        for (name, level) in [("a.csv", 20.0), ("b.csv", 31.0)] {
            std::fs::write(dir.path().join(name), log(level)).unwrap();
        }
        let bench = Self { dir };
        for (log, out) in [("a.csv", "of-a"), ("b.csv", "of-b")] {
            let arguments = ["identify", log, "--law=stribeck", "--out", out];
            bench.run(&arguments);
        }
        for (study, amplitude) in [("a.toml", "1 mm"), ("b.toml", "2 mm")] {
            let text = STUDY.replace("AMPLITUDE", amplitude);
            std::fs::write(bench.path(study), text).unwrap();
        }
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn program(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
        command.args(arguments);
        self.quiet(command)
    }

    fn quiet(&self, mut command: Command) -> Command {
        command
            .current_dir(self.dir.path())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        command
    }

    /// A command that may end without trust, but not in an error.
    fn run(&self, arguments: &[&str]) {
        let output = self.program(arguments).output().unwrap();
        assert!(
            matches!(output.status.code(), Some(0 | 1)),
            "{arguments:?}: {output:?}"
        );
    }

    /// The same, killed as it enters the `nth` of a system call.
    fn killed_at(&self, call: &str, nth: usize, arguments: &[&str]) -> ExitStatus {
        let mut command = Command::new("strace");
        command
            .args(["-f", "-qq", "-o", "/dev/null", "-e", "signal=none"])
            .args(["-e", &format!("trace={call}")])
            .args(["-e", &format!("inject={call}:signal=KILL:when={nth}")])
            .arg(env!("CARGO_BIN_EXE_stiction"))
            .args(arguments);
        self.quiet(command).status().unwrap()
    }

    fn is_pending(&self, case: &Case) -> bool {
        self.path(case.out).join(".stiction-pending").exists()
    }

    /// What a command leaves in an empty place, and what is exported of that.
    fn whole(&self, case: &Case, which: usize) -> (Files, Option<Files>) {
        self.clear(case);
        self.run(&case.arguments[which]);
        (files(&self.path(case.out)), self.exported(case))
    }

    /// What reading the model in the folder comes to; `None` where there is none.
    fn exported(&self, case: &Case) -> Option<Files> {
        let model = self.path(case.out).join("model.toml");
        let model = model.exists().then(|| model.to_str().unwrap())?;
        let _ = std::fs::remove_dir_all(self.path("elsewhere"));
        self.run(&["export", model, "--target=c", "--out=elsewhere"]);
        Some(files(&self.path("elsewhere")))
    }

    fn clear(&self, case: &Case) {
        let _ = std::fs::remove_dir_all(self.path(case.out));
        std::fs::create_dir(self.path(case.out)).unwrap();
    }
}

/// A log of an axis with viscous friction and this Coulomb friction.
fn log(level: f64) -> String {
    use std::fmt::Write;
    let mut text = String::from("Time [s],Position [mm],Force [N]\n");
    for i in 0..1500 {
        let t = f64::from(i) * 2e-3;
        let (mut x, mut v, mut a) = (0.0, 0.0, 0.0);
        for (size, w) in [(0.05, 6.3), (0.008, 22.0)] {
            x += size * (w * t).sin();
            v += size * w * (w * t).cos();
            a -= size * w * w * (w * t).sin();
        }
        let noise = 0.2 * ((1e4 * t).sin() + (2.3e4 * t).sin() + (3.1e4 * t * t).sin());
        let force = level * f64::tanh(v / 1e-4) + 60.0 * v + 9.0 * a + noise;
        let _ = writeln!(text, "{t:.4},{:.6},{force:.4}", 1e3 * x);
    }
    text
}

const STUDY: &str = r#"
[axis]
known      = "motor"
rate       = "2 kHz"
peak_force = "200 N"

[[path]]
kind      = "sine"
amplitude = "AMPLITUDE"
frequency = "2 Hz"

[[controller]]
kind      = "cascade"
bandwidth = "40 Hz"
"#;

fn files(folder: &Path) -> Files {
    fn collect(at: &Path, root: &Path, all: &mut Files) {
        for entry in std::fs::read_dir(at).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(&path, root, all);
            } else {
                let name = path.strip_prefix(root).unwrap().to_path_buf();
                all.insert(name, steady(&path));
            }
        }
    }
    let mut all = Files::new();
    collect(folder, folder, &mut all);
    all
}

/// A file without what differs from run to run: the time that it took.
fn steady(path: &Path) -> Vec<u8> {
    let bytes = std::fs::read(path).unwrap();
    let text = path.extension().is_some_and(|e| e == "json" || e == "html");
    let Some(text) = String::from_utf8(bytes.clone()).ok().filter(|_| text) else {
        return bytes;
    };
    let lines = text.lines().filter(|line| !line.contains("wall_s"));
    lines
        .flat_map(|line| [line, "\n"])
        .collect::<String>()
        .into()
}

/// `compare` and `reproduce` write as `identify` does; what they write differs from run to run by the time it took.
fn cases() -> [Case; 3] {
    // Of one name: an export of another name stands beside the first and replaces nothing.
    let export = |model| {
        let to = ["--target=c", "--name=axis", "--out", "out", "--force"];
        [&["export", model][..], &to].concat()
    };
    let both = [
        ["a.csv", "b.csv"].map(|log| vec!["identify", log, "--law=stribeck", "--out", "out"]),
        ["a.toml", "b.toml"].map(|study| vec!["simulate", study, "--out", "out"]),
        ["of-a/model.toml", "of-b/model.toml"].map(export),
    ];
    both.map(|arguments| Case {
        arguments,
        out: "out",
    })
}

/// Killed as it enters any system call that changes a folder.
#[test]
fn at_every_change_of_a_folder() {
    let bench = Bench::new();
    for case in gate(1, cases()) {
        let [old, new] = [bench.whole(&case, 0), bench.whole(&case, 1)];
        assert_ne!(old.0, new.0, "{:?}", case.arguments);
        let mut kills = 0;
        let mut between = 0;
        for call in CHANGES {
            for nth in 1.. {
                bench.clear(&case);
                bench.run(&case.arguments[0]);
                let status = bench.killed_at(call, nth, &case.arguments[1]);
                if matches!(status.code(), Some(0 | 1)) {
                    break;
                }
                kills += 1;
                between += usize::from(bench.is_pending(&case));
                let place = format!("{:?} killed at {call} {nth}", case.arguments[1]);
                one_or_the_other(&bench, &case, [&old, &new], &place);
            }
        }
        // Before each file gets its name, and before the record goes.
        let counts = format!("{:?}: {kills}, {between}", case.arguments);
        assert!(kills > between && between > old.0.len(), "{counts}");
    }
}

/// Killed anywhere, a batch that says that it is complete says it of the table beside it.
#[test]
fn a_batch_is_complete_for_its_own_table() {
    let bench = Bench::new();
    let arguments =
        ["a.csv", "b.csv"].map(|log| vec!["batch", log, "--law=stribeck", "--out", "out"]);
    let case = Case {
        arguments,
        out: "out",
    };
    let [old, new] = [bench.whole(&case, 0), bench.whole(&case, 1)];
    let mut kills = 0;
    for call in ["rename", "renameat2", "linkat", "unlink", "unlinkat"] {
        for nth in 1.. {
            bench.clear(&case);
            bench.run(&case.arguments[0]);
            let status = bench.killed_at(call, nth, &case.arguments[1]);
            if matches!(status.code(), Some(0 | 1)) {
                break;
            }
            kills += 1;
            let there = files(&bench.path(case.out));
            let [said, table] =
                ["batch.json", "results.parquet"].map(|name| &there[Path::new(name)]);
            let said_complete = String::from_utf8_lossy(said).contains("\"status\": \"complete\"");
            let is = |all: &Files| {
                all[Path::new("batch.json")] == *said && all[Path::new("results.parquet")] == *table
            };
            assert!(
                !said_complete || is(&old.0) || is(&new.0),
                "killed at {call} {nth}"
            );
        }
    }
    assert!(kills > 2, "{kills}");
}

#[test]
#[ignore = "soak: killed 1000 times at random, every command that writes"]
fn at_any_time() {
    let bench = Bench::new();
    for case in cases() {
        let [old, new] = [bench.whole(&case, 0), bench.whole(&case, 1)];
        let begun = std::time::Instant::now();
        bench.run(&case.arguments[1]);
        let whole = begun.elapsed();
        for k in 0..1000_u32 {
            bench.clear(&case);
            bench.run(&case.arguments[0]);
            let mut child = bench.program(&case.arguments[1]).spawn().unwrap();
            // More of them towards the end, where files are written.
            let share = 1.2 * (f64::from(k % 100 + 1) / 100.0).sqrt();
            std::thread::sleep(whole.mul_f64(share));
            let _ = child.kill();
            child.wait().unwrap();
            let place = format!("{:?}, {k}", case.arguments[1]);
            one_or_the_other(&bench, &case, [&old, &new], &place);
        }
    }
}

/// A folder has the files of one outcome, or says itself that it is being replaced: then whoever reads a file of it has that of
/// the new one and changes nothing, and whoever writes it again ends that first. In the end nothing is left of the killed one.
fn one_or_the_other(bench: &Bench, case: &Case, all: [&(Files, Option<Files>); 2], place: &str) {
    let [(old, _), (new, _)] = all;
    let temporary = |path: &Path| path.to_str().unwrap().starts_with(".stiction-part-");
    // Runs that were done, for a later call: no part of an outcome.
    let kept = |path: &Path| path == Path::new(".stiction-runs");
    if case.arguments[1][0] == "export" {
        // Whatever compiles what is there now has not files of two models.
        let there = files(&bench.path(case.out));
        let own = there
            .iter()
            .filter(|(path, _)| !temporary(path) && *path != Path::new(".stiction-pending"));
        let of = |all: &Files| {
            own.clone()
                .all(|(path, bytes)| all.get(path) == Some(bytes))
        };
        let names: Vec<_> = there.keys().collect();
        assert!(of(old) || of(new), "{place}: {names:?} of two models");
    }
    let there = files(&bench.path(case.out));
    let exported = bench.exported(case);
    assert!(all.map(|(_, whole)| whole).contains(&&exported), "{place}");
    assert!(there == files(&bench.path(case.out)), "{place}");
    if !bench.is_pending(case) {
        let there = files(&bench.path(case.out));
        let own: Files = there
            .into_iter()
            .filter(|(path, _)| !temporary(path) && !kept(path))
            .collect();
        let names: Vec<_> = own.keys().collect();
        assert!(own == *old || own == *new, "{place}: {names:?}");
    }
    bench.run(&case.arguments[1]);
    let mut again = files(&bench.path(case.out));
    // One that was just made may be about to be locked by a program that runs: a minute later it goes.
    again.retain(|path, bytes| !(temporary(path) && bytes.is_empty()));
    let names: Vec<_> = again.keys().collect();
    assert!(again == *new, "{place}, written again: {names:?}");
}
