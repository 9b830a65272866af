//! Exported code under other tools: C and C++ compilers, LinuxCNC, Octave, FMI, matiec, simulated processors. These tests take as long
//! as a third of all others and depend on few crates, so they run when one of those has changed since they passed.

use crate::shell::{self, Outcome};
use crate::{setup, tools};
use std::fs;
use std::io::Write;
use std::process::Stdio;

/// Which tests: modules of the tests of `stiction-export` that run what is exported.
pub const TESTS: &str = "package(stiction-export) and test(/^(c|cpp|drive_table|fmu|hal|matiec|matlab|modelica|mujoco|ros2|rust|st)::/)";
/// What they depend on.
const COVERED: [&str; 7] = [
    "crates/export",
    "crates/friction",
    "crates/number",
    "crates/parameters",
    "crates/testkit",
    "examples/export",
    "xtask/src/debian.rs",
];
/// A hash of all that with which they passed.
const PASSED: &str = "crates/export/tests/passed";

/// Runs them, those of the soak too, and writes with what they passed.
pub fn run() -> Outcome {
    setup()?;
    let hash = hash()?.ok_or("commit first: what passed is named by what is committed")?;
    let tests = tools::command(&tools::NEXTEST, "nextest run --workspace --run-ignored all")?;
    let mut tests = shell::linted(tests);
    tests.args(["-E", TESTS]);
    shell::run(tests)?;
    fs::write(shell::root().join(PASSED), hash).map_err(|e| format!("{PASSED}: {e}"))
}

/// Whether they passed with what is committed, and nothing is changed beside it.
pub fn have_passed() -> bool {
    let then = fs::read_to_string(shell::root().join(PASSED));
    let now = hash().ok().flatten();
    then.is_ok_and(|then| Some(then) == now)
}

/// The hash of what they depend on; `None` where something is not committed.
fn hash() -> Result<Option<String>, String> {
    let except = format!(":(exclude){PASSED}");
    let of = |arguments: &[&str]| {
        let all = [arguments, &["--"], &COVERED, &[&except]].concat();
        shell::output(shell::command("git", &all))
    };
    if !of(&["status", "--porcelain"])?.is_empty() {
        return Ok(None);
    }
    let mut git = shell::command("git", &["hash-object", "--stdin"]);
    git.stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut running = git.spawn().map_err(|e| format!("git: {e}"))?;
    let listed = of(&["ls-files", "-s"])?;
    let written = running
        .stdin
        .take()
        .map(|mut to| to.write_all(listed.as_bytes()));
    written.transpose().map_err(|e| format!("git: {e}"))?;
    let output = running
        .wait_with_output()
        .map_err(|e| format!("git: {e}"))?;
    String::from_utf8(output.stdout)
        .map(Some)
        .map_err(|e| format!("git: {e}"))
}
