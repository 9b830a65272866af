//! The virtual environments: one with the Python packages that tests compare stiction with, one that has nothing but the
//! Python package stiction and what its tests need, for long tests one with Pinocchio, and one that builds releases.

use crate::shell::{self, Outcome};
use crate::{debian, interpreter};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, iter};

/// The oldest Python for which all pinned packages have wheels.
const OLDEST: &str = "3.11";
const TOO_OLD: &str = "import sys; sys.exit(sys.version_info < (3, 11))";

/// A virtual environment.
struct Environment {
    /// Where it is made.
    folder: PathBuf,
    /// Exact versions of its packages, a file from the workspace root.
    requirements: &'static str,
    /// A package that is there only if they are whole.
    probe: &'static str,
    /// The Python that it is of; `None` for the usual one.
    python: Option<String>,
}

/// Makes both.
pub fn install() -> Outcome {
    environment().and_then(|_| bare()).map(drop)
}

/// The Python of `.venv`.
pub fn environment() -> Result<String, String> {
    made(&Environment {
        folder: shell::root().join(".venv"),
        requirements: "xtask/requirements.txt",
        probe: "numpy",
        python: None,
    })
}

/// The Python that has numpy and pytest alone, for the package stiction.
pub fn bare() -> Result<String, String> {
    made(&Environment {
        folder: shell::target().join("python/venv"),
        requirements: "python/tests/requirements.txt",
        probe: "numpy",
        python: None,
    })
}

/// A free-threaded Python that has numpy and pytest alone, for the same.
pub fn free_threaded() -> Result<String, String> {
    made(&Environment {
        folder: shell::target().join("python/free-threaded/venv"),
        requirements: "python/tests/requirements-free-threaded.txt",
        probe: "numpy",
        python: Some(interpreter::find()?),
    })
}

/// The Python that has Pinocchio and the robots that `stiction-rigid` is compared with.
pub fn pinocchio() -> Result<String, String> {
    made(&Environment {
        folder: shell::target().join("python/pinocchio/venv"),
        requirements: "crates/rigid/tests/pinocchio/requirements.txt",
        probe: "numpy",
        python: None,
    })
}

/// A command that will run a program of those that build releases, which find each other on the PATH.
pub fn release(program: &str, arguments: &[&str]) -> Result<Command, String> {
    let python = made(&Environment {
        folder: shell::target().join("python/release-venv"),
        requirements: "xtask/release-requirements.txt",
        probe: "maturin",
        python: None,
    })?;
    let folder = Path::new(&python).parent().ok_or("no folder of Python")?;
    let program = folder.join(program).to_string_lossy().into_owned();
    let path = env::var_os("PATH").unwrap_or_default();
    let path = iter::once(folder.to_path_buf()).chain(env::split_paths(&path));
    let mut command = shell::command(&program, arguments);
    command.env("PATH", env::join_paths(path).map_err(|e| e.to_string())?);
    Ok(command)
}

/// The robots of example-robot-data beside that Python.
pub fn robots(python: &str) -> Result<String, String> {
    let place = "import sysconfig; print(sysconfig.get_path('purelib'))";
    let place = shell::output(shell::command(python, &["-c", place]))?;
    let folder = "cmeel.prefix/share/example-robot-data/robots";
    Ok(format!("{}/{folder}", place.trim()))
}

/// The Python of an environment, which is made afresh unless it was made from the requirements as they are now.
fn made(environment: &Environment) -> Result<String, String> {
    let folder = &environment.folder;
    let python = if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    };
    let python = folder.join(python).to_string_lossy().into_owned();
    let file = shell::root().join(environment.requirements);
    let wanted = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    // A copy of the requirements, written last: it is there only if all of them are installed.
    let stamp = folder.join("requirements.installed");
    let probe = format!("import {}", environment.probe);
    let made = fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted);
    if made && shell::succeeds(shell::command(&python, &["-c", &probe])) {
        return Ok(python);
    }
    let base = match &environment.python {
        Some(python) => python.clone(),
        None => usual()?,
    };
    let arguments = ["-m", "venv", "--clear", &folder.to_string_lossy()];
    shell::run(shell::command(&base, &arguments))?;
    let install =
        "-m pip install --quiet --disable-pip-version-check --no-compile --only-binary :all: -r";
    let mut arguments: Vec<&str> = install.split_whitespace().collect();
    arguments.push(environment.requirements);
    shell::run(shell::command(&python, &arguments))?;
    fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))?;
    Ok(python)
}

/// The Python on the PATH, able to make an environment.
pub fn usual() -> Result<String, String> {
    if cfg!(windows) {
        return Ok("python".into());
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
    Ok("python3".into())
}
