//! A free-threaded Python, which runs its threads at the same time. Debian has none, so it is built from the sources that Ubuntu 26.04 has.

use crate::debian;
use crate::shell::{self, Outcome};
use std::fs;
use std::path::{Path, PathBuf};

/// Its program; pyo3 takes no earlier one, and the next one has other libraries.
const NAME: &str = "python3.14t";
/// Its sources.
const SOURCE: &str =
    "http://archive.ubuntu.com/ubuntu/pool/main/p/python3.14/python3.14_3.14.4.orig.tar.xz";
const SHA256: &str = "d923c51303e38e249136fc1bdf3568d56ecb03214efdef48516176d3d7faaef8";
/// What the archive holds.
const UNPACKED: &str = "Python-3.14.4";
/// Where it is built, in the target folder.
const FOLDER: &str = "python/free-threaded";
/// Whether a Python is one; it has what pip needs.
const PROBE: &str = "import sys, ssl, zlib, ctypes, venv; sys.exit(sys._is_gil_enabled())";

/// The free-threaded Python: on the PATH, or built by [`install`].
pub fn find() -> Result<String, String> {
    let built = text(&built());
    let works = |python: &String| shell::succeeds(shell::command(python, &["-c", PROBE]));
    [NAME.to_owned(), built.clone()].into_iter().find(works).ok_or_else(|| {
        format!(
            "no free-threaded Python: neither is {NAME} on the PATH nor {built} there; `cargo xtask interpreter` builds it"
        )
    })
}

/// Builds it where there is none; about ten minutes on two cores.
pub fn install() -> Outcome {
    if find().is_ok() {
        return Ok(());
    }
    debian::install_for_python()?;
    let folder = shell::target().join(FOLDER);
    fetch(&folder)?;
    let build = folder.join("build");
    // What an earlier call left may be of half a build.
    let _ = fs::remove_dir_all(&build);
    fs::create_dir_all(&build).map_err(|e| format!("{}: {e}", build.display()))?;
    let run = |program: &str, arguments: &[&str]| -> Outcome {
        let mut command = shell::command(program, arguments);
        command.current_dir(&build);
        shell::run(command)
    };
    let configure = text(&folder.join(UNPACKED).join("configure"));
    let prefix = format!("--prefix={}", folder.join("installed").display());
    // Without the optimisation by profiles, which runs the whole of its tests.
    run(
        &configure,
        &["-q", &prefix, "--disable-gil", "--disable-test-modules"],
    )?;
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    run("make", &["-s", &format!("-j{jobs}")])?;
    run("make", &["-s", "install"])?;
    for done in [build, folder.join(UNPACKED)] {
        fs::remove_dir_all(&done).map_err(|e| format!("{}: {e}", done.display()))?;
    }
    find().map(drop)
}

/// Fetches the sources and unpacks them; others than the pinned ones are refused.
fn fetch(folder: &Path) -> Outcome {
    fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let run = |program: &str, arguments: &[&str]| -> Outcome {
        let mut command = shell::command(program, arguments);
        command.current_dir(folder);
        shell::run(command)
    };
    let archive = "python.tar.xz";
    run("curl", &["-sSfL", "-o", archive, SOURCE])?;
    let sums = format!("{SHA256}  {archive}\n");
    let list = folder.join("SHA256SUMS");
    fs::write(&list, sums).map_err(|e| format!("{}: {e}", list.display()))?;
    run("sha256sum", &["--check", "--quiet", "SHA256SUMS"])?;
    run("tar", &["-xf", archive])
}

/// Where [`install`] leaves it.
fn built() -> PathBuf {
    let folder = shell::target().join(FOLDER);
    folder.join("installed/bin/python3.14t")
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
