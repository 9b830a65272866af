//! The Python package: its wheel, and its tests in an environment that has nothing else.

use crate::python;
use crate::shell::{self, Outcome, cargo};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The native half, where cargo builds it with the tests of the workspace.
const LIBRARY: &str = "debug/libstiction_native.so";
/// Where its wheels are made, in the target folder.
const FOLDER: &str = "python";
const TESTS: &str = "python/tests";

/// Builds what the tests of the package need, then runs them.
pub fn built() -> Outcome {
    // With an example, dependencies have the features that they have in the tests, and are not built once more.
    shell::run(cargo("build --workspace --lib --bins --example record"))?;
    test()
}

/// Packs the library that is built already, and runs the tests of the package with it.
pub fn test() -> Outcome {
    let folder = shell::target().join(FOLDER);
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let library = text(&shell::target().join(LIBRARY));
    let stripped = text(&folder.join("_native.abi3.so"));
    shell::run(shell::command("strip", &["-o", &stripped, &library]))?;
    let python = python::environment()?;
    let assemble = ["python/assemble.py", &stripped, &text(&folder)];
    let wheel = shell::output(shell::command(&python, &assemble))?;
    tested(Path::new(wheel.trim()), "debug")
}

/// Builds the wheel that users get, runs the tests of the package with it, and measures it against its bars.
pub fn release() -> Outcome {
    shell::run(cargo(
        "build --release --package stiction-cli --package stiction --bins --example timed",
    ))?;
    let folder = shell::target().join(FOLDER).join("release");
    // Of another version there may be one.
    let _ = fs::remove_dir_all(&folder);
    let python = python::environment()?;
    let arguments = [
        "-m",
        "maturin",
        "build",
        "--release",
        "--out",
        &text(&folder),
    ];
    shell::run(shell::command(&python, &arguments))?;
    let wheels = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut wheels = wheels.flatten().map(|entry| entry.path());
    let wheel = wheels.next().ok_or("maturin built no wheel")?;
    tested(&wheel, "release")?;
    let timed = text(&shell::target().join("release/examples/timed"));
    let measure = ["bench/python/measure.py", &timed, &text(&wheel)];
    shell::run(shell::command(&python::bare()?, &measure))
}

/// The tests of fleets with what there is no time for: more logs, and a worker that is killed twenty times. Needs what
/// [`built`] has built and installed.
pub fn soak() -> Outcome {
    built()?;
    let fleet = format!("{TESTS}/test_fleet.py");
    let mut tests = shell::command(&python::bare()?, &["-m", "pytest", "-q", &fleet]);
    tests
        .env("STICTION_PROGRAM", program("debug"))
        .env("STICTION_SOAK", "1");
    shell::run(tests)
}

/// Installs a wheel beside numpy and pytest, and runs its tests: all in that environment, and those of tables of other
/// packages and of types with the packages of `.venv`.
fn tested(wheel: &Path, profile: &str) -> Outcome {
    let (bare, full) = (python::bare()?, python::environment()?);
    let wheel = text(wheel);
    let install =
        "-m pip install --quiet --disable-pip-version-check --no-index --force-reinstall --no-deps";
    let mut arguments: Vec<&str> = install.split_whitespace().collect();
    arguments.push(&wheel);
    shell::run(shell::command(&bare, &arguments))?;
    shell::run(shell::command(&bare, &["-m", "pip", "check"]))?;
    let mut tests = shell::command(&bare, &["-m", "pytest", "-q", TESTS]);
    tests.env("STICTION_PROGRAM", program(profile));
    // What users get is held small: the build of the tests checks every sum for overflow besides.
    if profile == "release" {
        tests.env("STICTION_WHEEL", &wheel);
    }
    shell::run(tests)?;
    let place = "import sysconfig; print(sysconfig.get_path('purelib'))";
    let place = shell::output(shell::command(&bare, &["-c", place]))?;
    let beside = |arguments: &[&str]| -> Command {
        let mut command = shell::command(&full, arguments);
        command.env("PYTHONPATH", place.trim());
        command
    };
    let frames = format!("{TESTS}/test_frames.py");
    shell::run(beside(&["-m", "pytest", "-q", &frames]))?;
    shell::run(beside(&["-m", "mypy", "python/stiction", TESTS]))?;
    shell::run(beside(&["-m", "mypy.stubtest", "stiction._native"]))?;
    shell::run(beside(&["-m", "basedpyright"]))
}

/// The command line to compare with.
fn program(profile: &str) -> PathBuf {
    shell::target().join(profile).join("stiction")
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
