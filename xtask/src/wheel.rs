//! The Python package: its wheel, and its tests in an environment that has nothing else.

use crate::release::target::Target;
use crate::shell::{self, Outcome, cargo};
use crate::{interpreter, python, release};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The native half, where cargo builds it with the tests of the workspace.
const LIBRARY: &str = "debug/libstiction_native.so";
/// Where its wheels are made, in the target folder.
const FOLDER: &str = "python";
const TESTS: &str = "python/tests";
/// The crate of the native half.
const CRATE: &str = "stiction-python";
/// Builds that library and the command line to compare with.
pub const BUILD: &str = "build --workspace --lib --bins --example record";

/// Where wheel and source distribution are for users, in the target folder.
pub const UPLOADS: &str = "python/release";
/// Builds what that wheel is compared with.
const COMPARED: &str =
    "build --profile dist --package stiction-cli --package stiction --bins --example timed";

/// The tests that need no package without wheels for a free-threaded Python: neither Dask nor DataFrames nor pictures.
const FREE_THREADED: &[&str] = &[
    "test_bad_input.py",
    "test_command.py",
    "test_drift.py",
    "test_fit.py",
    "test_guide.py",
    "test_library.py",
    "test_package.py",
    "test_robot.py",
    "test_running.py",
    "test_same_bits.py",
    "test_threads.py",
];

/// Builds what the tests of the package need, then runs them.
pub fn built() -> Outcome {
    // With an example, dependencies have the features that they have in the tests, and are not built once more.
    shell::run(shell::linted(cargo(BUILD)))?;
    test()
}

/// Builds the wheel that the tests install; its path.
pub fn debug() -> Result<String, String> {
    shell::run(shell::linted(cargo(BUILD)))?;
    let wheel = packed(&python::environment()?, &shell::target().join(FOLDER))?;
    Ok(text(&wheel))
}

/// Builds the same for the free-threaded Python, then runs the tests that it has packages for.
pub fn built_free_threaded() -> Outcome {
    let python = interpreter::find()?;
    let mut build = cargo(BUILD);
    build.env("PYO3_PYTHON", &python);
    shell::run(build)?;
    let wheel = packed(&python, &shell::target().join(FOLDER).join("free-threaded"))?;
    tested_free_threaded(&wheel, "debug")
}

/// Packs the library that is built already, and runs the tests of the package with it.
pub fn test() -> Outcome {
    let wheel = packed(&python::environment()?, &shell::target().join(FOLDER))?;
    tested(&wheel, "debug")
}

/// Where its tests leave the notebook as a page of the site, with what its cells show.
pub fn notebook() -> PathBuf {
    shell::target().join(FOLDER).join("first-log.md")
}

/// Packs the library that is built already, and runs nothing but the notebook with it.
pub fn run_notebook(file: &str) -> Outcome {
    let python = python::bare()?;
    let wheel = packed(&python::environment()?, &shell::target().join(FOLDER))?;
    install(&wheel, &python)?;
    let run = ["python/tests/notebook.py", file, &text(&notebook())];
    shell::run(shell::command(&python, &run))
}

/// Packs the library that is built already for that Python.
fn packed(python: &str, folder: &Path) -> Result<PathBuf, String> {
    fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let library = text(&shell::target().join(LIBRARY));
    let stripped = text(&folder.join("_native.so"));
    shell::run(shell::command("strip", &["-o", &stripped, &library]))?;
    let assemble = ["python/assemble.py", &stripped, &text(folder)];
    let wheel = shell::output(shell::command(python, &assemble))?;
    Ok(wheel.trim().into())
}

/// Builds the wheel that users get, runs the tests of the package with it, and measures it against its bars.
pub fn release() -> Outcome {
    let wheel = uploads(&Target::host()?)?;
    shell::run(cargo(COMPARED))?;
    tested(&wheel, "dist")?;
    measured(&wheel, &python::bare()?)
}

/// Builds and installs that wheel, and builds what `bench/python` compares it with.
pub fn measurable() -> Outcome {
    let wheel = uploads(&Target::host()?)?;
    shell::run(cargo(COMPARED))?;
    install(&wheel, &python::bare()?)
}

/// Only builds that wheel and the source distribution.
pub fn only() -> Outcome {
    uploads(&Target::host()?).map(drop)
}

/// The same for another kind of machine.
pub fn of_target() -> Outcome {
    uploads(&Target::typed()?).map(drop)
}

/// The same of the wheel for the free-threaded Python.
pub fn release_free_threaded() -> Outcome {
    let python = interpreter::find()?;
    let folder = shell::target().join("python/release-free-threaded");
    let wheel = released(&folder, &Target::host()?, Some(&python))?;
    shell::run(cargo(COMPARED))?;
    tested_free_threaded(&wheel, "dist")?;
    measured(&wheel, &python::free_threaded()?)
}

/// Builds the wheel for all Pythons and the source distribution, with checksums; gives the wheel.
pub fn uploads(target: &Target) -> Result<PathBuf, String> {
    let folder = shell::target().join(UPLOADS);
    release::outdated(&folder)?;
    let wheel = released(&folder, target, None)?;
    let mut sources = python::release("maturin", &["sdist", "--out", &text(&folder)])?;
    release::target::reproducible(&mut sources)?;
    shell::run(sources)?;
    release::sums(&folder)?;
    Ok(wheel)
}

/// Builds a wheel as users get it, for a Python or for all, into a folder.
fn released(folder: &Path, target: &Target, python: Option<&str>) -> Result<PathBuf, String> {
    // Alone in a folder first: its name is maturin's.
    let alone = folder.join(&target.0);
    let out = text(&alone);
    let mut arguments = vec![
        "build",
        "--locked",
        "--profile",
        "dist",
        "--out",
        &out,
        "--target",
        &target.0,
    ];
    // Any Linux since 2012; maturin refuses a library that asks for more.
    if target.has_glibc() {
        arguments.extend(["--zig", "--compatibility", "manylinux2014"]);
    }
    arguments.extend(python.iter().flat_map(|python| ["--interpreter", *python]));
    let materials = folder.join(release::sbom::FILE);
    let included = text(&materials);
    arguments.extend(["--sbom-include", &included]);
    let mut build = python::release("maturin", &arguments)?;
    release::target::reproducible(&mut build)?;
    // Not in the tree: it follows the target and the lock file.
    let notices = shell::root().join(release::notices::FILE);
    release::notices::write(target, CRATE, &notices)?;
    fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    release::sbom::write(target, CRATE, &release::version()?, &materials)?;
    let built = shell::run(build);
    for made in [&notices, &materials] {
        fs::remove_file(made).map_err(|e| format!("{}: {e}", made.display()))?;
    }
    built?;
    let failed = |e: std::io::Error| format!("{}: {e}", alone.display());
    let made = fs::read_dir(&alone).map_err(failed)?.next();
    let made = made.ok_or("maturin built no wheel")?.map_err(failed)?;
    let wheel = folder.join(made.file_name());
    fs::rename(made.path(), &wheel).map_err(failed)?;
    fs::remove_dir_all(&alone).map_err(failed)?;
    Ok(wheel)
}

/// Measures a wheel that is installed beside a Python.
fn measured(wheel: &Path, python: &str) -> Outcome {
    let timed = text(&shell::target().join("dist/examples/timed"));
    let measure = ["bench/python/measure.py", &timed, &text(wheel)];
    shell::run(shell::command(python, &measure))
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
    install(wheel, &bare)?;
    shell::run(tests(wheel, profile, &bare, &[TESTS]))?;
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

/// Installs a wheel beside numpy and pytest of the free-threaded Python, and runs its tests there.
fn tested_free_threaded(wheel: &Path, profile: &str) -> Outcome {
    let python = python::free_threaded()?;
    install(wheel, &python)?;
    let files: Vec<String> = FREE_THREADED
        .iter()
        .map(|file| format!("{TESTS}/{file}"))
        .collect();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let mut tests = tests(wheel, profile, &python, &files);
    // A lock of the interpreter fails them.
    tests.env("STICTION_FREE_THREADED", "1");
    shell::run(tests)
}

/// Installs a wheel and nothing else.
fn install(wheel: &Path, python: &str) -> Outcome {
    let install =
        "-m pip install --quiet --disable-pip-version-check --no-index --force-reinstall --no-deps";
    let wheel = text(wheel);
    let mut arguments: Vec<&str> = install.split_whitespace().collect();
    arguments.push(&wheel);
    shell::run(shell::command(python, &arguments))?;
    shell::run(shell::command(python, &["-m", "pip", "check"]))
}

/// Tests of a wheel that is installed.
fn tests(wheel: &Path, profile: &str, python: &str, files: &[&str]) -> Command {
    let arguments = [&["-m", "pytest", "-q"], files].concat();
    let mut tests = shell::command(python, &arguments);
    tests
        .env("STICTION_PROGRAM", program(profile))
        .env("STICTION_NOTEBOOK_PAGE", notebook());
    // What users get is held small: the build of the tests checks every sum for overflow besides.
    if profile == "dist" {
        tests.env("STICTION_WHEEL", text(wheel));
    }
    tests
}

/// The command line to compare with.
fn program(profile: &str) -> PathBuf {
    shell::target().join(profile).join("stiction")
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
