//! Programs that the set-up installs (`cargo xtask setup`).

use std::path::Path;
use std::process::{Command, Stdio};

/// Runs a program of the set-up (`cargo xtask setup`) and gives what it printed.
pub fn run(program: &str, arguments: &[&str], dir: &Path) -> String {
    let output = Command::new(program)
        .args(arguments)
        .current_dir(dir)
        .output()
        .unwrap_or_else(|e| panic!("{program}: {e}; install with: cargo xtask setup"));
    let text = format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(output.status.success(), "{program} {arguments:?}\n{text}");
    text
}

/// Whether programs of the set-up are here. Without them a test says so and passes over; with `CI=true` that is a failure.
pub fn have(programs: &[&str]) -> bool {
    for program in programs {
        let asked = Command::new(program)
            .arg("--version")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        if let Err(e) = asked {
            let message = format!("SKIPPED: {program}: {e}; install with: cargo xtask setup");
            assert!(std::env::var("CI").as_deref() != Ok("true"), "{message}");
            eprintln!("{message}");
            return false;
        }
    }
    true
}
