//! The virtual environment with the Python packages that tests compare stiction with.

use crate::debian;
use crate::shell::{self, Outcome};
use std::fs;

/// The oldest Python for which all pinned packages have wheels.
const OLDEST: &str = "3.11";
const TOO_OLD: &str = "import sys; sys.exit(sys.version_info < (3, 11))";

/// Where the environment is made, from the workspace root.
const FOLDER: &str = ".venv";
/// Exact versions of its packages.
const REQUIREMENTS: &str = "xtask/requirements.txt";
/// Python that runs only where the packages are whole.
const PROBE: &str = "import numpy";

/// Makes `.venv`.
pub fn install() -> Outcome {
    environment().map(drop)
}

/// The Python of `.venv`, which is made afresh unless it was made from the requirements as they are now.
pub fn environment() -> Result<String, String> {
    let folder = shell::root().join(FOLDER);
    let python = folder.join("bin/python").to_string_lossy().into_owned();
    let file = shell::root().join(REQUIREMENTS);
    let wanted = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    // A copy of the requirements, written last: it is there only if all of them are installed.
    let stamp = folder.join("requirements.installed");
    let made = fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted);
    if made && shell::succeeds(shell::command(&python, &["-c", PROBE])) {
        return Ok(python);
    }
    if !shell::on_path("python3") {
        return Err(format!(
            "python3 is not on the PATH; Python {OLDEST} or later is needed"
        ));
    }
    let has = |code: &str| shell::succeeds(shell::command("python3", &["-c", code]));
    if !has(TOO_OLD) {
        let found = shell::output(shell::command("python3", &["--version"]))?;
        return Err(format!(
            "found {}; {OLDEST} or later is needed",
            found.trim()
        ));
    }
    if !has("import ensurepip, venv") {
        debian::install_python_venv()?;
    }
    let arguments = ["-m", "venv", "--clear", FOLDER];
    shell::run(shell::command("python3", &arguments))?;
    let install = "-m pip install --quiet --disable-pip-version-check --only-binary :all: -r";
    let mut arguments: Vec<&str> = install.split_whitespace().collect();
    arguments.push(REQUIREMENTS);
    shell::run(shell::command(&python, &arguments))?;
    fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))?;
    Ok(python)
}
