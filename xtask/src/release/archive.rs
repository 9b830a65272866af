//! The archive that users unpack: program, completions, manual pages, licences, bill of materials, checksums.

use super::target::{Target, commit_time};
use super::{notices, sbom};
use crate::python;
use crate::shell::{self, Outcome};
use std::fs;
use std::path::{Path, PathBuf};

/// Where the archives go, from the workspace root.
pub const FOLDER: &str = "target/release-archives";
const SHELLS: [(&str, &str); 5] = [
    ("bash", "stiction.bash"),
    ("zsh", "_stiction"),
    ("fish", "stiction.fish"),
    ("elvish", "stiction.elv"),
    ("powershell", "_stiction.ps1"),
];
/// What goes along as it stands.
const FILES: [&str; 6] = [
    "README.md",
    "CHANGELOG.md",
    "SECURITY.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "docs/install.md",
];

/// Builds the program, packs it, unpacks it again and runs it; gives the files made. The same commit and compiler give
/// the same bytes.
pub fn make(version: &str, target: &Target) -> Result<Vec<String>, String> {
    target.build()?;
    let name = format!("stiction-{version}-{}", target.0);
    let all = shell::root().join(FOLDER);
    let folder = all.join(&name);
    outdated(&all, version)?;
    let built = target.program();
    let file = built.file_name().unwrap_or_default();
    copy(&built, &folder.join("bin").join(file))?;
    for file in FILES {
        let name = file.rsplit('/').next().unwrap_or(file);
        copy(&shell::root().join(file), &folder.join(name))?;
    }
    notices::write(target, "stiction-cli", &folder.join(notices::FILE))?;
    sbom::write(target, "stiction-cli", version, &folder.join(sbom::FILE))?;
    for (shell, file) in SHELLS {
        let text = shell::output(target.command(&all, &built, &["completions", shell])?)?;
        write(&folder.join("completions").join(file), &text)?;
    }
    manual(target, &folder.join("man"))?;
    let packed = pack(&[&folder.to_string_lossy(), &commit_time()?])?;
    fs::remove_dir_all(&folder).map_err(|e| format!("{name}: {e}"))?;
    sums(&all)?;
    try_out(target, &name, &packed)?;
    let packed = packed.file_name().unwrap_or_default();
    Ok(vec![packed.to_string_lossy().into(), "SHA256SUMS".into()])
}

/// Removes what was made of other versions: checksums are of all files.
pub fn outdated(all: &Path, version: &str) -> Outcome {
    let ours = format!("stiction-{version}");
    for entry in fs::read_dir(all).into_iter().flatten().flatten() {
        let (name, path) = (entry.file_name(), entry.path());
        if path.is_dir() {
            fs::remove_dir_all(path).map_err(|e| e.to_string())?;
        } else if !name.to_string_lossy().starts_with(&ours) {
            fs::remove_file(path).map_err(|e| e.to_string())?;
        }
    }
    Ok(())
}

/// Writes the checksums of the files in a folder.
pub fn sums(folder: &Path) -> Outcome {
    pack(&["--sums", &folder.to_string_lossy()])?;
    if !shell::on_path("sha256sum") {
        return Ok(());
    }
    let mut check = shell::command("sha256sum", &["--check", "--quiet", "SHA256SUMS"]);
    check.current_dir(folder);
    shell::run(check)
}

fn pack(arguments: &[&str]) -> Result<PathBuf, String> {
    let arguments = [&["xtask/pack.py"], arguments].concat();
    let path = shell::output(shell::command(&python::usual()?, &arguments))?;
    Ok(path.trim().into())
}

/// A manual page for stiction and for each of its commands.
fn manual(target: &Target, folder: &Path) -> Outcome {
    let program = target.program();
    let page = |arguments: &[&str]| -> Result<String, String> {
        shell::output(target.command(&shell::root(), &program, &[&["man"], arguments].concat())?)
    };
    let main = page(&[])?;
    let commands: Vec<&str> = main
        .lines()
        .filter_map(|line| line.strip_prefix("stiction\\-")?.strip_suffix("(1)"))
        .collect();
    for command in commands.iter().filter(|name| **name != "help") {
        write(
            &folder.join(format!("stiction-{command}.1")),
            &page(&[command])?,
        )?;
    }
    write(&folder.join("stiction.1"), &main)
}

/// Unpacks it and runs the demo, as a user does. A program for another kind of machine has to find the bits that the
/// program for this one finds.
fn try_out(target: &Target, name: &str, packed: &Path) -> Outcome {
    let all = shell::root().join(FOLDER);
    let mut unpack = shell::command("tar", &["-xf", &packed.to_string_lossy()]);
    unpack.current_dir(&all);
    shell::run(unpack)?;
    let folder = all.join(name);
    let program = folder
        .join("bin")
        .join(target.program().file_name().unwrap_or_default());
    let found = demo(target, &folder, &program)?;
    let host = Target::host()?;
    if *target != host {
        host.build()?;
        if demo(&host, &folder.join("host"), &host.program())? != found {
            return Err(format!(
                "{name}: the demo has another model than on {}",
                host.0
            ));
        }
        println!(
            "    the model of the demo has the same bits as on {}",
            host.0
        );
    }
    fs::remove_dir_all(folder).map_err(|e| e.to_string())
}

/// Runs the demo in a folder and gives the bytes of its model.
fn demo(target: &Target, folder: &Path, program: &Path) -> Result<Vec<u8>, String> {
    fs::create_dir_all(folder).map_err(|e| e.to_string())?;
    let demo = ["demo", "--quiet", "--out", "demo"];
    shell::run(target.command(folder, program, &demo)?)?;
    let model = folder.join("demo/model.toml");
    fs::read(&model).map_err(|e| format!("{}: {e}", model.display()))
}

fn copy(from: &Path, to: &Path) -> Outcome {
    let parent = to.parent().unwrap_or(to);
    fs::create_dir_all(parent)
        .and_then(|()| fs::copy(from, to))
        .map(drop)
        .map_err(|e| format!("{} to {}: {e}", from.display(), to.display()))
}

fn write(to: &Path, text: &str) -> Outcome {
    let parent = to.parent().unwrap_or(to);
    fs::create_dir_all(parent)
        .and_then(|()| fs::write(to, text))
        .map_err(|e| format!("{}: {e}", to.display()))
}
