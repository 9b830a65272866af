//! Virtual environments with the Python packages that stiction is compared against.

use crate::debian;
use crate::shell::{self, Outcome};
use std::fs;

/// The oldest Python for which all pinned packages have wheels.
const OLDEST: &str = "3.11";
const TOO_OLD: &str = "import sys; sys.exit(sys.version_info < (3, 11))";

/// A virtual environment; paths from the workspace root.
pub struct Environment {
    pub folder: &'static str,
    /// Exact versions of its packages.
    pub requirements: &'static str,
    /// Python that runs only where the packages are whole.
    pub probe: &'static str,
}

/// What tests need.
const TESTS: Environment = Environment {
    folder: ".venv",
    requirements: "xtask/requirements.txt",
    probe: "import numpy",
};

/// Makes `.venv`.
pub fn install() -> Outcome {
    tests().map(drop)
}

/// The Python of `.venv`, made if it is not there.
pub fn tests() -> Result<String, String> {
    make(&TESTS)
}

/// Makes an environment afresh unless it was made from the requirements as they are now, and gives its Python.
pub fn make(environment: &Environment) -> Result<String, String> {
    let folder = shell::root().join(environment.folder);
    let python = folder.join("bin/python").to_string_lossy().into_owned();
    let file = shell::root().join(environment.requirements);
    let wanted = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    // A copy of the requirements, written last: it is there only if all of them are installed.
    let stamp = folder.join("requirements.installed");
    let made = fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted);
    if made && shell::succeeds(shell::command(&python, &["-c", environment.probe])) {
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
    let arguments = ["-m", "venv", "--clear", environment.folder];
    shell::run(shell::command("python3", &arguments))?;
    let install = "-m pip install --quiet --disable-pip-version-check --only-binary :all: -r";
    let mut arguments: Vec<&str> = install.split_whitespace().collect();
    arguments.push(environment.requirements);
    shell::run(shell::command(&python, &arguments))?;
    fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))?;
    Ok(python)
}
