//! C sources through the C compiler of this machine: the binary of an FMU, an exported compensator as a program.

use std::path::Path;
use std::process::{Command, Stdio};
use stiction_export::File;

/// The shared library of a source; nothing where there is no gcc, or another machine than the FMU is for.
pub(crate) fn shared_library(source: &File) -> Option<Vec<u8>> {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return None;
    }
    let dir = tempfile::tempdir().ok()?;
    // By its plain name in the folder itself, so that no path of this machine reaches the binary.
    let name = Path::new(&source.path).file_name()?;
    std::fs::write(dir.path().join(name), &source.bytes).ok()?;
    let status = Command::new("gcc")
        .args(stiction_export::GCC)
        .arg("fmu.so")
        .arg(name)
        .arg("-lm")
        .current_dir(dir.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .ok()?;
    if !status.success() {
        return None;
    }
    std::fs::read(dir.path().join("fmu.so")).ok()
}

/// Options of gcc for a program: those with which the exported C is tested.
const PROGRAM: [&str; 3] = ["-std=c99", "-O2", "-ffp-contract=off"];

/// Makes `program` in `dir` of the sources there.
///
/// # Errors
/// What the compiler said, or that there is none.
pub(crate) fn program(dir: &Path, program: &str, sources: &[&str]) -> Result<(), String> {
    let done = Command::new("gcc")
        .args(PROGRAM)
        .args(["-o", program])
        .args(sources)
        .arg("-lm")
        .current_dir(dir)
        .stdin(Stdio::null())
        .output()
        .map_err(|e| format!("gcc cannot be started ({e})"))?;
    if done.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&done.stderr);
    let first = said.lines().find(|line| line.contains("error"));
    Err(match first.or_else(|| said.lines().next()) {
        Some(line) => format!("gcc does not compile it: {}", line.trim()),
        None => "gcc does not compile it".into(),
    })
}
