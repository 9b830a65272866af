//! When, of what and where figures were made, for the line over a table.

use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// Date, commit, machine and compiler, as `bench/environment.py` has them.
pub fn described() -> String {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let date = stiction_files::batch::date_of(now.unwrap_or_default().as_secs_f64());
    let commit = first_line("git", &["rev-parse", "--short=8", "HEAD"]);
    let rustc = first_line("rustc", &["--version"]);
    let rustc = rustc.split(' ').nth(1).unwrap_or("unknown");
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let cpu = cpu.lines().find_map(|line| line.strip_prefix("model name"));
    let cpu = cpu.map_or(std::env::consts::ARCH, |cpu| {
        cpu.trim_matches([' ', '\t', ':'])
    });
    format!(
        "{}; commit {commit}; {cpu}, {cores} cores; rustc {rustc}",
        &date[..10]
    )
}

/// What a program says in the folder of the workspace; `unknown` where it does not run.
fn first_line(program: &str, arguments: &[&str]) -> String {
    let mut command = Command::new(program);
    let output = command
        .args(arguments)
        .current_dir(stiction_testkit::workspace())
        .output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned());
    let line = text.unwrap_or_default().lines().next().map(str::to_owned);
    line.unwrap_or_else(|| "unknown".into())
}
