//! The library of machines, identified from the recordings.

use crate::shell;

/// Builds the program, runs the command of each machine with it, and writes what is new into `crates/workflows/library`.
pub fn run() -> shell::Outcome {
    // Both at once, or the crates below are built for each.
    let build = "build -p stiction-cli --bin stiction --example library";
    shell::run(shell::linted(shell::cargo(build)))?;
    let built = |name: &str| {
        let file = shell::target().join("debug").join(name);
        file.to_string_lossy().into_owned()
    };
    shell::run(shell::command(
        &built("examples/library"),
        &[&built("stiction")],
    ))
}
