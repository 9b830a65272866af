//! Where the commands lead that an identification names: to an end, whatever the axis is.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use stiction_testkit::worlds::{Machine, Motion, World, record};
use stiction_testkit::{DEFAULT_RUNS, gate, recordings};

/// Commands after the first one that may lead to the end.
const MOST_STEPS: usize = 3;

fn run(dir: &Path, command: &str) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
        .args(command.split_whitespace())
        .current_dir(dir)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let err = text(output.stderr);
    assert!(!err.contains("panicked"), "{err}");
    let code = output.status.code().unwrap_or(-1);
    assert!(code <= 1, "{command}: {err}");
    (code, text(output.stdout))
}

/// What is to be done first.
struct Lead {
    command: String,
    /// The line to write into the axis file, and where: below `under [TABLE]`, or `in place of the line KEY`.
    line: Option<(String, String)>,
}

impl Lead {
    fn of(out: &str) -> Self {
        let (said, next) = out.rsplit_once("\nnext: stiction ").unwrap();
        let above: Vec<&str> = said.lines().rev().take(3).collect();
        let line = above[0].strip_prefix("    ");
        Self {
            command: next.lines().next().unwrap().to_owned(),
            line: line.map(|line| (line.to_owned(), above[1].trim().to_owned())),
        }
    }

    /// Does to the axis file what is said.
    fn edit(&self, dir: &Path) {
        let Some((line, place)) = &self.line else {
            return;
        };
        let mut words = self.command.split_whitespace();
        let file = words.find(|word| *word == "--axis").and(words.next());
        let file = dir.join(file.unwrap());
        let key = line.split(' ').next().unwrap();
        let replaces = place.contains("in place of the line");
        let (_, table) = place.split_once('[').unwrap_or_default();
        let table = format!("[{}]", table.split(']').next().unwrap());
        let mut after = std::fs::read_to_string(&file).unwrap_or_default();
        if replaces {
            let lines = after.lines().map(|own| match own.starts_with(key) {
                true => line,
                false => own,
            });
            after = lines.collect::<Vec<_>>().join("\n");
        } else if after.contains(&table) {
            after = after.replace(&table, &format!("{table}\n{line}"));
        } else {
            let _ = writeln!(after, "\n{table}\n{line}");
        }
        std::fs::write(file, after).unwrap();
    }

    /// The command and what it reads, without the place of what it writes.
    fn seen(&self) -> (String, Option<(String, String)>) {
        let (command, _) = self
            .command
            .split_once(" --out ")
            .unwrap_or((&self.command, ""));
        (command.to_owned(), self.line.clone())
    }
}

/// Writes a recording with what becomes of each position and force.
fn written(
    file: &Path,
    machine: &Machine,
    motion: Motion,
    world: World,
    changed: impl Fn(f64, f64) -> (f64, f64),
) {
    let log = record(machine, motion, world, 1);
    let mut text = String::from(match machine.kind {
        "rotary" => "time [s],position [rad],force [N*m]\n",
        _ => "time [s],position [m],force [N]\n",
    });
    for ((t, x), f) in log.time.iter().zip(log.position.unwrap()).zip(&log.force) {
        let (x, f) = changed(x, *f);
        let _ = writeln!(text, "{t},{x},{f}");
    }
    std::fs::write(file, text).unwrap();
}

/// Follows what is to be done next, from a command on a log in a folder, until another log is to be recorded or a compensator is written:
/// every command is accepted and none leads back.
fn walk(dir: &Path, log: &str, first: &str) {
    let mut command = first.to_owned();
    let mut seen = vec![(command.replace(" --out result", ""), None)];
    for _ in 0..=MOST_STEPS {
        let (_, out) = run(dir, &command);
        if command.starts_with("export") {
            return;
        }
        let lead = Lead::of(&out);
        assert!(
            !seen.contains(&lead.seen()),
            "{} leads back: {seen:?}",
            lead.command
        );
        println!("{}: {:?}", lead.command, lead.line);
        if !lead.command.starts_with("export") && !lead.command.contains(log) {
            return;
        }
        lead.edit(dir);
        seen.push(lead.seen());
        command = lead.command;
    }
    panic!("{seen:?} and on");
}

fn leads_to_an_end(machine: Machine, world: World, motion: Motion) {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("log.csv");
    written(&file, &machine, motion, world, |x, f| (x, f));
    walk(dir.path(), "log.csv", "identify log.csv --out result");
}

/// From a first look at each measured recording, with its columns and units named.
#[cfg(unix)]
#[test]
fn of_recordings() {
    let Some(data) = recordings() else { return };
    for own in gate(4, DEFAULT_RUNS) {
        let dir = tempfile::tempdir().unwrap();
        std::fs::copy(data.join(own.axis), dir.path().join("axis.toml")).unwrap();
        std::os::unix::fs::symlink(data.canonicalize().unwrap(), dir.path().join("data")).unwrap();
        let log = format!("data/{}", own.log);
        walk(dir.path(), &log, &format!("check {log} --axis axis.toml"));
    }
}

#[test]
fn of_an_axis_as_assumed() {
    leads_to_an_end(Machine::joint(1), World::Faithful, Motion::Sine);
}

#[test]
#[ignore = "soak: other causes lead on beside it"]
fn of_maxwell_slip() {
    leads_to_an_end(Machine::joint(1), World::MaxwellSlip, Motion::Sine);
}

/// The cure of the shape has a static friction that the log never shows, so that it is held back.
#[test]
#[ignore = "soak: other causes lead on beside it"]
fn of_a_cure_that_is_held_back() {
    leads_to_an_end(Machine::stage(1), World::MaxwellSlip, Motion::Sine);
}

#[test]
fn of_a_curve_that_is_no_gaussian() {
    leads_to_an_end(Machine::joint(1), World::Exponent, Motion::Sine);
}

#[test]
fn of_cogging() {
    leads_to_an_end(Machine::joint(1), World::Cogging, Motion::Commissioning);
}

#[test]
fn of_backlash() {
    leads_to_an_end(Machine::joint(1), World::Backlash, Motion::Commissioning);
}

/// Runs a line that was printed, as a shell takes it; its exit code.
#[cfg(unix)]
fn pasted(dir: &Path, line: &str) -> Option<i32> {
    let binary = env!("CARGO_BIN_EXE_stiction");
    let script = line.trim().replacen("stiction", binary, 1);
    let output = Command::new("bash")
        .args(["-c", &script])
        .current_dir(dir)
        .output();
    let output = output.ok()?;
    let err = String::from_utf8_lossy(&output.stderr).into_owned();
    let code = output.status.code();
    assert!(code.is_some_and(|code| code <= 1), "{line}: {err}");
    code
}

/// Logs that the law was validated on and from which nothing can be identified are looked at, not identified; the command names
/// them, whatever their names are.
#[cfg(unix)]
#[test]
fn of_validation_on_logs_that_show_nothing() {
    use std::os::unix::ffi::OsStrExt;
    let dir = tempfile::tempdir().unwrap();
    let machine = Machine::joint(1);
    let write = |name: &std::ffi::OsStr, changed: fn(f64, f64) -> (f64, f64)| {
        let file = dir.path().join(name);
        written(&file, &machine, Motion::Sine, World::Faithful, changed);
    };
    let silent = std::ffi::OsStr::from_bytes(b"it's\x1b[31m\xff.csv");
    write("log.csv".as_ref(), |x, f| (x, f));
    write(silent, |x, _| (x, 0.0));
    write("rest.csv".as_ref(), |_, f| (0.0, f));
    for other in [silent, "rest.csv".as_ref()] {
        let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
            .args(["identify", "log.csv", "--out", "result", "--validate"])
            .arg(other)
            .current_dir(dir.path())
            .output()
            .unwrap();
        let out = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(1), "{out}");
        assert!(!out.contains(['\u{1b}', '\u{10ffff}']), "{out}");
        let (_, next) = out.rsplit_once("\nnext: ").unwrap();
        let line = next.lines().next().unwrap();
        assert!(line.starts_with("stiction check "), "{out}");
        pasted(dir.path(), line);
    }
}

/// A force of a few values gives no constants, and one that is cut off nearly everywhere is not simulated.
#[test]
fn of_a_force_that_tells_too_little() {
    let dir = tempfile::tempdir().unwrap();
    let machine = Machine::joint(1);
    let most = machine.static_friction;
    let write = |name: &str, changed: &dyn Fn(f64) -> f64| {
        let file = dir.path().join(name);
        written(&file, &machine, Motion::Sine, World::Faithful, |x, f| {
            (x, changed(f))
        });
    };
    write("coarse.csv", &|f| (f / most).round() * most);
    write("cut.csv", &|f| f.clamp(-0.1 * most, 0.1 * most));
    let (_, out) = run(dir.path(), "identify coarse.csv --out coarse");
    assert!(out.contains("coarse-force"), "{out}");
    assert!(out.contains("as constants      none"), "{out}");
    let (code, out) = run(dir.path(), "check cut.csv");
    assert_eq!(code, 1, "{out}");
    assert!(!out.contains("--method output-error"), "{out}");
    let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
        .args(["identify", "cut.csv", "--out", "cut"])
        .args(["--method", "output-error"])
        .current_dir(dir.path())
        .output()
        .unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{err}");
    assert!(err.contains("are saturated, missing or frozen"), "{err}");
    assert!(err.contains("stiction check cut.csv"), "{err}");
}

/// What no search has to look for is said with the command that does without one; logs without a channel in common by their file.
#[test]
fn of_what_cannot_be_combined() {
    let dir = tempfile::tempdir().unwrap();
    let machine = Machine::joint(1);
    let file = dir.path().join("log.csv");
    written(&file, &machine, Motion::Sine, World::Faithful, |x, f| {
        (x, f)
    });
    let text = std::fs::read_to_string(&file).unwrap();
    let text = text.replace("position [rad]", "velocity [rad/s]");
    std::fs::write(dir.path().join("speed.csv"), text).unwrap();
    for (command, says, next) in [
        (
            "identify log.csv --method ga --law coulomb-viscous --out out",
            "this law has no parameter that a search could look for",
            "next: stiction identify log.csv --method separable --law coulomb-viscous --out out",
        ),
        (
            "identify log.csv speed.csv --out out",
            "log.csv: a fit together with a log that has no position needs a velocity channel",
            "stiction: next: stiction check log.csv\n",
        ),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
            .args(command.split_whitespace())
            .current_dir(dir.path())
            .output()
            .unwrap();
        let err = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{err}");
        assert!(err.contains(says) && err.contains(next), "{err}");
    }
}
