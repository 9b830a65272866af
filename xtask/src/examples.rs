//! Examples of the command that run the program and write what the repository keeps.

use crate::shell;

/// Builds the program and the example, and runs it with the path of the program.
pub fn run(example: &str) -> shell::Outcome {
    // Both at once, or the crates below are built for each.
    let build = format!("build -p stiction-cli --bin stiction --example {example}");
    shell::run(shell::linted(shell::cargo(&build)))?;
    let built = |name: &str| {
        let file = shell::target().join("debug").join(name);
        file.to_string_lossy().into_owned()
    };
    let example = format!("examples/{example}");
    shell::run(shell::command(&built(&example), &[&built("stiction")]))
}
