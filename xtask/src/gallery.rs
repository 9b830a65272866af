//! The gallery: licensed public recordings, each with its command, picture, numbers and code.

use crate::shell;

/// Builds the program, runs the command of each entry with it, and writes `docs/gallery.md` with its pictures.
pub fn run() -> shell::Outcome {
    // Both at once, or the crates below are built for each.
    let build = "build -p stiction-cli --bin stiction --example gallery";
    shell::run(shell::linted(shell::cargo(build)))?;
    let built = |name: &str| {
        let file = shell::target().join("debug").join(name);
        file.to_string_lossy().into_owned()
    };
    shell::run(shell::command(
        &built("examples/gallery"),
        &[&built("stiction")],
    ))
}
