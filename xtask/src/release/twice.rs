//! The same bytes from another folder: whoever builds a release anew can compare it with what was uploaded.

use super::archive::FOLDER;
use crate::shell::{self, Outcome};
use crate::wheel;
use std::fs;
use std::path::Path;

/// Compares the archive that was made with that of a copy of the repository.
pub fn archive() -> Outcome {
    compared("archive", FOLDER)
}

/// The same of the wheel and the source distribution.
pub fn wheel() -> Outcome {
    compared("wheel --only", &format!("target/{}", wheel::UPLOADS))
}

/// Runs a task in a copy of the commit, and compares the checksums it leaves in a folder with those that are here.
fn compared(task: &str, folder: &str) -> Outcome {
    let copy = std::env::temp_dir().join(format!("stiction-again-{}", std::process::id()));
    let copied = copy.to_string_lossy().into_owned();
    let made = || {
        shell::run(shell::command("git", &["clone", "--quiet", ".", &copied]))?;
        let mut task = shell::cargo(&format!("run --quiet --package xtask -- {task}"));
        task.current_dir(&copy)
            .env_remove("CARGO_TARGET_DIR")
            .env_remove("CARGO_MANIFEST_DIR");
        shell::run(task)?;
        same(&shell::root().join(folder), &copy.join(folder))
    };
    let outcome = made();
    let _ = fs::remove_dir_all(&copy);
    outcome
}

fn same(here: &Path, there: &Path) -> Outcome {
    let read = |folder: &Path| {
        let sums = folder.join("SHA256SUMS");
        fs::read_to_string(&sums).map_err(|e| format!("{}: {e}", sums.display()))
    };
    let (here, there) = (read(here)?, read(there)?);
    let known: Vec<&str> = here.lines().collect();
    match there.lines().find(|line| !known.contains(line)) {
        None => {
            println!("the same bytes from two folders:\n{there}");
            Ok(())
        }
        Some(other) => Err(format!(
            "another folder gives other bytes:\n{other}\nwhile here are\n{here}"
        )),
    }
}
