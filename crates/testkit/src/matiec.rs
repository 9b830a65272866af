//! The Structured Text compiler matiec (Beremiz, OpenPLC), built from its sources outside the project: a program that
//! tests run, never part of the project nor linked with it.

use crate::programs::run;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// matiec, ready to run: the folder with `iec2c` and `lib`. None where its sources are nowhere; then a test has to say so
/// and skip, and with `CI=true` that is a failure.
///
/// The sources are `matiec.tar.gz` in the folder `STICTION_MATIEC`, else in `../shared/tools` beside the workspace. They
/// are built once, in a folder of their own below the user's caches.
pub fn matiec() -> Option<PathBuf> {
    let tools = std::env::var_os("STICTION_MATIEC")
        .map_or_else(|| crate::workspace().join("../shared/tools"), PathBuf::from);
    let archive = tools.join("matiec.tar.gz");
    let Ok(bytes) = std::fs::read(&archive) else {
        let message = format!(
            "SKIPPED: no {} (set STICTION_MATIEC to the folder that holds it)",
            archive.display()
        );
        assert!(std::env::var("CI").as_deref() != Ok("true"), "{message}");
        eprintln!("{message}");
        return None;
    };
    let hash = Sha256::digest(&bytes);
    let name: String = hash.iter().take(8).map(|b| format!("{b:02x}")).collect();
    let built = caches().join(format!("matiec-{name}"));
    if !built.join("iec2c").is_file() {
        build(&archive, &built);
    }
    Some(built)
}

/// Where programs keep what they can make again.
fn caches() -> PathBuf {
    let named = |name| std::env::var_os(name).filter(|value| !value.is_empty());
    let base = match (named("XDG_CACHE_HOME"), named("HOME")) {
        (Some(caches), _) => PathBuf::from(caches),
        (None, Some(home)) => Path::new(&home).join(".cache"),
        (None, None) => std::env::temp_dir(),
    };
    base.join("stiction")
}

/// Builds beside `built` and moves the result there whole. Other processes wait: it takes a minute.
fn build(archive: &Path, built: &Path) {
    let parent = built.parent().unwrap();
    std::fs::create_dir_all(parent).unwrap();
    let lock = std::fs::File::create(built.with_extension("lock")).unwrap();
    lock.lock().unwrap();
    if built.join("iec2c").is_file() {
        return;
    }
    let own = tempfile::tempdir_in(parent).unwrap();
    let packed = archive.canonicalize().unwrap();
    run(
        "tar",
        &["--no-same-owner", "-xzf", packed.to_str().unwrap()],
        own.path(),
    );
    let sources = own.path().join("matiec");
    run("autoreconf", &["-i"], &sources);
    run("./configure", &[], &sources);
    run("make", &["-j2", "CXXFLAGS=-O1"], &sources);
    std::fs::rename(&sources, built).unwrap();
}

/// Compiles a unit and those that it uses, which come before it, to C, and that with a program that steps it to `program`.
pub fn compile(matiec: &Path, units: &[&str], driver: &str, dir: &Path, program: &str) {
    let source = format!("{program}.st");
    std::fs::write(dir.join(&source), units.concat()).unwrap();
    let library = matiec.join("lib");
    let compiler = matiec.join("iec2c");
    run(
        compiler.to_str().unwrap(),
        &["-I", library.to_str().unwrap(), &source],
        dir,
    );
    let main = format!("{program}.c");
    std::fs::write(dir.join(&main), format!("{HEAD}{driver}")).unwrap();
    let headers = library.join("C");
    run(
        "gcc",
        &[
            "-O1",
            "-ffp-contract=off",
            "-w",
            "-I",
            headers.to_str().unwrap(),
            "-o",
            program,
            &main,
            "-lm",
        ],
        dir,
    );
}

/// What the runtime of a controller has for every unit.
const HEAD: &str = r#"
#include <stdio.h>
#include "iec_std_lib.h"
TIME __CURRENT_TIME;
BOOL __DEBUG;
#include "POUS.h"
#include "POUS.c"
"#;
