//! C sources through the C compilers of this machine: the binaries of an FMU, an exported compensator as a program.

use std::path::Path;
use std::process::{Command, Stdio};
use stiction_export::{File, Platform};

/// The shared library of a source; nothing where there is no compiler for the platform, or it failed.
pub(crate) fn shared_library(source: &File, platform: Platform) -> Option<Vec<u8>> {
    let own = match platform {
        Platform::LinuxX86_64 => cfg!(all(target_os = "linux", target_arch = "x86_64")),
        Platform::LinuxAarch64 => cfg!(all(target_os = "linux", target_arch = "aarch64")),
        Platform::WindowsX86_64 => false,
    };
    let mut compilers = own.then_some("gcc").into_iter().chain([platform.gcc()]);
    compilers.find_map(|compiler| compiled(source, platform, compiler))
}

fn compiled(source: &File, platform: Platform, compiler: &str) -> Option<Vec<u8>> {
    let dir = tempfile::tempdir().ok()?;
    let source_path = Path::new(&source.path);
    let name = source_path.file_name()?.to_str()?;
    let stem = source_path.file_stem()?.to_str()?;
    let library = format!("{stem}.{}", platform.extension());
    std::fs::write(dir.path().join(name), &source.bytes).ok()?;
    let status = Command::new(compiler)
        .args(platform.arguments(name, &library))
        .current_dir(dir.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .ok()?;
    if !status.success() {
        return None;
    }
    std::fs::read(dir.path().join(&library)).ok()
}

/// Options of gcc for a program: those with which the exported C is tested.
const PROGRAM: [&str; 3] = ["-std=c99", "-O2", "-ffp-contract=off"];

/// Makes `program` in `dir` of the sources there.
///
/// # Errors
/// What the compiler said, or that there is none.
pub(crate) fn program(dir: &Path, program: &str, sources: &[&str]) -> Result<(), String> {
    let done = Command::new("gcc")
        .args(PROGRAM)
        .args(["-o", program])
        .args(sources)
        .arg("-lm")
        .current_dir(dir)
        .stdin(Stdio::null())
        .output()
        .map_err(|e| format!("gcc cannot be started ({e})"))?;
    if done.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&done.stderr);
    let of_the_source =
        |line: &&str| line.contains("error:") || line.contains("undefined reference");
    let mut told = said.lines().filter(|line| !line.starts_with("collect2"));
    let first = told.find(of_the_source);
    Err(match first.or_else(|| said.lines().next()) {
        Some(line) => format!("gcc does not compile it: {}", line.trim()),
        None => "gcc does not compile it".into(),
    })
}
