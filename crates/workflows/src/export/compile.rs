//! The binary of an FMU, by the C compiler of this machine.

use std::path::Path;
use std::process::{Command, Stdio};
use stiction_export::File;

/// The shared library of a source; nothing where there is no gcc, or another machine than the FMU is for.
pub(super) fn shared_library(source: &File) -> Option<Vec<u8>> {
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
