//! Where the commands lead that an identification names: to an end, whatever the axis is.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use stiction_testkit::worlds::{Machine, Motion, World, record};

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
    /// The line to write into the axis file, and whether it takes the place of another one.
    line: Option<(String, bool)>,
}

impl Lead {
    fn of(out: &str) -> Self {
        let (_, next) = out.rsplit_once("\nnext: ").unwrap();
        let command = next
            .lines()
            .find_map(|line| line.trim().strip_prefix("stiction "));
        let mut lines = next.lines();
        let line = lines.find_map(|line| line.strip_prefix("    "));
        Self {
            command: command.unwrap().to_owned(),
            line: line.map(|line| (line.to_owned(), next.contains("in place of the line"))),
        }
    }

    /// Does to the axis file what is said.
    fn edit(&self, dir: &Path) {
        let Some((line, replaces)) = &self.line else {
            return;
        };
        let mut words = self.command.split_whitespace();
        let file = words.find(|word| *word == "--axis").and(words.next());
        let file = dir.join(file.unwrap());
        let before = std::fs::read_to_string(&file).unwrap_or_else(|_| "[terms]\n".into());
        let key = line.split(' ').next().unwrap();
        let mut after = String::new();
        for own in before.lines() {
            if !(*replaces && own.starts_with(key)) {
                let _ = writeln!(after, "{own}");
            }
        }
        let _ = writeln!(after, "{line}");
        std::fs::write(file, after).unwrap();
    }

    /// The command and what it reads, without the place of what it writes.
    fn seen(&self) -> (String, Option<(String, bool)>) {
        let (command, _) = self
            .command
            .split_once(" --out ")
            .unwrap_or((&self.command, ""));
        (command.to_owned(), self.line.clone())
    }
}

fn leads_to_an_end(machine: Machine, world: World, motion: Motion) {
    let dir = tempfile::tempdir().unwrap();
    let log = record(&machine, motion, world, 1);
    let mut text = String::from(match machine.kind {
        "rotary" => "time [s],position [rad],force [N*m]\n",
        _ => "time [s],position [m],force [N]\n",
    });
    for ((t, x), f) in log.time.iter().zip(log.position.unwrap()).zip(&log.force) {
        let _ = writeln!(text, "{t},{x},{f}");
    }
    std::fs::write(dir.path().join("log.csv"), text).unwrap();
    let mut command = "identify log.csv --out result".to_owned();
    let mut seen = vec![(command.replace(" --out result", ""), None)];
    for _ in 0..=MOST_STEPS {
        let (_, out) = run(dir.path(), &command);
        let lead = Lead::of(&out);
        assert!(
            !seen.contains(&lead.seen()),
            "{} leads back: {seen:?}",
            lead.command
        );
        println!("{}: {:?}", lead.command, lead.line);
        if !lead.command.starts_with("identify log.csv") {
            return;
        }
        lead.edit(dir.path());
        seen.push(lead.seen());
        command = lead.command;
    }
    panic!("{seen:?} and on");
}

#[test]
fn of_an_axis_as_assumed() {
    leads_to_an_end(Machine::joint(1), World::Faithful, Motion::Sine);
}

#[test]
fn of_maxwell_slip() {
    leads_to_an_end(Machine::joint(1), World::MaxwellSlip, Motion::Sine);
}

/// The cure of the shape has a static friction that the log never shows, so that it is held back.
#[test]
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
