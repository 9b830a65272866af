//! Running other programs from the workspace root.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Nothing, or the message to end with.
pub type Outcome = Result<(), String>;

/// The workspace root, also when the built binary was carried over from another clone.
pub fn root() -> PathBuf {
    let here = env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    here.parent().map(Path::to_path_buf).unwrap_or(here)
}

/// A command that will run in the workspace root, without standard input.
pub fn command(program: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command
        .args(arguments)
        .current_dir(root())
        .stdin(Stdio::null());
    command
}

/// As [`command`], in a folder of the workspace.
pub fn command_in(folder: &str, program: &str, arguments: &[&str]) -> Command {
    let folder = root().join(folder);
    // A program of that folder itself is not looked for on the PATH.
    let beside = folder.join(program);
    let program = if beside.is_file() {
        beside.to_string_lossy().into_owned()
    } else {
        program.into()
    };
    let mut command = command(&program, arguments);
    command.current_dir(folder);
    command
}

/// Where cargo builds.
pub fn target() -> PathBuf {
    root().join(env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into()))
}

/// The cargo that started this task, with arguments separated by blanks.
pub fn cargo(arguments: &str) -> Command {
    let arguments: Vec<&str> = arguments.split_whitespace().collect();
    command(
        &env::var("CARGO").unwrap_or_else(|_| "cargo".into()),
        &arguments,
    )
}

/// A build through clippy, with warnings as errors. All that share a target folder go through it, or the workspace is built twice.
pub fn linted(mut command: Command) -> Command {
    command
        .env("RUSTC_WORKSPACE_WRAPPER", "clippy-driver")
        .env("CLIPPY_ARGS", "-Dwarnings__CLIPPY_HACKERY__");
    command
}

/// Every command run so far, with the time it took.
static STEPS: Mutex<Vec<(String, Duration)>> = Mutex::new(Vec::new());

/// Prints and keeps the time of a command that has ended.
fn ended(line: &str, start: Instant) {
    let time = start.elapsed();
    println!("    {:.1} s", time.as_secs_f64());
    if let Ok(mut steps) = STEPS.lock() {
        steps.push((line.into(), time));
    }
}

/// The commands run so far, in the order in which they ended.
pub fn steps() -> Vec<(String, Duration)> {
    STEPS
        .lock()
        .map_or_else(|_| Vec::new(), |steps| steps.clone())
}

/// Runs to the end with its output shown, says how long it took, and fails if it failed.
pub fn run(mut command: Command) -> Outcome {
    let line = describe(&command);
    println!("==> {line}");
    let start = Instant::now();
    let status = command
        .status()
        .map_err(|error| format!("cannot start `{line}`: {error}"))?;
    ended(&line, start);
    if status.success() {
        Ok(())
    } else {
        Err(format!("`{line}` failed ({status})"))
    }
}

/// As [`run`], but what the command writes to standard error is shown at its end, and stands in the error.
pub fn run_keeping_errors(mut command: Command) -> Outcome {
    let line = describe(&command);
    println!("==> {line}");
    let start = Instant::now();
    let output = command
        .stdout(Stdio::inherit())
        .stderr(Stdio::piped())
        .output()
        .map_err(|error| format!("cannot start `{line}`: {error}"))?;
    let said = String::from_utf8_lossy(&output.stderr);
    eprint!("{said}");
    ended(&line, start);
    if output.status.success() {
        return Ok(());
    }
    Err(format!(
        "`{line}` failed ({}): {}",
        output.status,
        said.trim()
    ))
}

/// Standard output of a command that must succeed.
pub fn output(mut command: Command) -> Result<String, String> {
    let line = describe(&command);
    let output = command
        .output()
        .map_err(|error| format!("cannot start `{line}`: {error}"))?;
    succeeded(&line, output)
}

/// As [`output`], with the command and the time it took shown, and its errors as they come.
pub fn timed_output(mut command: Command) -> Result<String, String> {
    let line = describe(&command);
    println!("==> {line}");
    let start = Instant::now();
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("cannot start `{line}`: {error}"))?;
    ended(&line, start);
    succeeded(&line, output)
}

/// What a command that must succeed has written to standard output.
fn succeeded(line: &str, output: Output) -> Result<String, String> {
    if !output.status.success() {
        let detail = String::from_utf8_lossy(&output.stderr);
        let said = format!("`{line}` failed ({}): {}", output.status, detail.trim());
        return Err(said.trim_end_matches(": ").into());
    }
    String::from_utf8(output.stdout).map_err(|error| format!("`{line}`: {error}"))
}

/// Whether the command starts and ends well; its output is hidden.
pub fn succeeds(mut command: Command) -> bool {
    command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|s| s.success())
}

/// Whether a program of this name is on the PATH.
pub fn on_path(program: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// As one would type it, the program by its bare name.
fn describe(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let mut line = program
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    for argument in command.get_args() {
        line.push(' ');
        line.push_str(&argument.to_string_lossy());
    }
    line
}
