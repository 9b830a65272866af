//! The virtual environment `.venv` with the packages that tests compare against.

use crate::debian;
use crate::shell::{self, Outcome};
use std::fs;

/// The oldest Python for which all pinned packages have wheels.
const OLDEST: &str = "3.11";
const TOO_OLD: &str = "import sys; sys.exit(sys.version_info < (3, 11))";

/// Makes `.venv` afresh unless it was made from the requirements as they are now.
pub fn install() -> Outcome {
    let folder = shell::root().join(".venv");
    let python = folder.join("bin/python").to_string_lossy().into_owned();
    let file = shell::root().join("xtask/requirements.txt");
    let wanted = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    // A copy of the requirements, written last: it is there only if all of them are installed.
    let stamp = folder.join("requirements.installed");
    let made = fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted);
    if made && shell::succeeds(shell::command(&python, &["-c", "import numpy"])) {
        return Ok(());
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
    shell::run(shell::command(
        "python3",
        &["-m", "venv", "--clear", ".venv"],
    ))?;
    let arguments = "-m pip install --quiet --disable-pip-version-check --only-binary :all: \
                     -r xtask/requirements.txt";
    let arguments: Vec<&str> = arguments.split_whitespace().collect();
    shell::run(shell::command(&python, &arguments))?;
    fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))
}
