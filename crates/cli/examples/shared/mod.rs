//! What the examples that read recordings share.

use std::path::PathBuf;
use std::process::Command;
use stiction_testkit::workspace;

/// Where the robots of example-robot-data are: `STICTION_URDFS`, else those of the Python of the tests.
pub fn urdfs() -> Option<PathBuf> {
    if let Some(folder) = std::env::var_os("STICTION_URDFS") {
        return Some(folder.into());
    }
    let python = std::env::var_os("STICTION_PYTHON").map(PathBuf::from);
    let python = python.unwrap_or_else(|| workspace().join(".venv/bin/python"));
    let line = "import sysconfig; print(sysconfig.get_path('purelib'))";
    let ran = Command::new(python).args(["-c", line]).output().ok()?;
    let packages = PathBuf::from(String::from_utf8(ran.stdout).ok()?.trim());
    let folder = packages.join("cmeel.prefix/share/example-robot-data/robots");
    folder.is_dir().then_some(folder)
}

/// The day, UTC.
pub fn today() -> Result<String, String> {
    let ran = Command::new("date")
        .args(["-u", "+%F"])
        .output()
        .map_err(|e| e.to_string())?;
    let day = String::from_utf8(ran.stdout).map_err(|e| e.to_string())?;
    Ok(day.trim().into())
}
