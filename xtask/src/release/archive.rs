//! The archive that users unpack: program, completions, manual pages, licences, checksums.

use super::notices;
use crate::shell::{self, Outcome};
use std::fs;
use std::path::Path;

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
const FILES: [&str; 5] = [
    "README.md",
    "CHANGELOG.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "docs/install.md",
];

/// Builds the program, packs it, unpacks it again and runs it; gives the files made. The same commit and compiler give
/// the same bytes.
pub fn make(version: &str) -> Result<Vec<String>, String> {
    shell::run(shell::cargo(
        "build --profile dist --locked --workspace --bin stiction",
    ))?;
    let name = format!("stiction-{version}-{}", host()?);
    let all = shell::root().join(FOLDER);
    let folder = all.join(&name);
    if all.exists() {
        fs::remove_dir_all(&all).map_err(|e| format!("{FOLDER}: {e}"))?;
    }
    let program = folder.join("bin/stiction");
    let built = shell::target().join("dist/stiction");
    copy(&built, &program)?;
    for file in FILES {
        let name = file.rsplit('/').next().unwrap_or(file);
        copy(&shell::root().join(file), &folder.join(name))?;
    }
    notices::write(&folder.join("THIRD-PARTY.txt"))?;
    let program = program.to_string_lossy().into_owned();
    for (shell, file) in SHELLS {
        let text = shell::output(shell::command(&program, &["completions", shell]))?;
        write(&folder.join("completions").join(file), &text)?;
    }
    manual(&program, &folder.join("man"))?;
    let archive = format!("{name}.tar.gz");
    pack(&name, &archive)?;
    let sums = shell::output(shell::command_in(FOLDER, "sha256sum", &[&archive]))?;
    write(&all.join("SHA256SUMS"), &sums)?;
    fs::remove_dir_all(&folder).map_err(|e| format!("{name}: {e}"))?;
    try_out(&name, &archive)?;
    Ok(vec![archive, "SHA256SUMS".into()])
}

/// A manual page for stiction and for each of its commands.
fn manual(program: &str, folder: &Path) -> Outcome {
    let main = shell::output(shell::command(program, &["man"]))?;
    let commands: Vec<&str> = main
        .lines()
        .filter_map(|line| line.strip_prefix("stiction\\-")?.strip_suffix("(1)"))
        .collect();
    for command in commands.iter().filter(|name| **name != "help") {
        let page = shell::output(shell::command(program, &["man", command]))?;
        write(&folder.join(format!("stiction-{command}.1")), &page)?;
    }
    write(&folder.join("stiction.1"), &main)
}

/// Packs the folder with the time of the commit, nobody's name, and in the order of names.
fn pack(name: &str, archive: &str) -> Outcome {
    let time = shell::output(shell::command("git", &["log", "-1", "--format=@%ct"]))?;
    let time = format!("--mtime={}", time.trim());
    let fixed = "--sort=name --owner=0 --group=0 --numeric-owner --mode=u+rw,go=rX";
    let mut arguments: Vec<&str> = fixed.split_whitespace().collect();
    // gzip writes its own time unless told not to.
    arguments.extend([
        &time,
        "--use-compress-program=gzip -9n",
        "-cf",
        archive,
        name,
    ]);
    shell::run(shell::command_in(FOLDER, "tar", &arguments))
}

/// As a user does: compare, unpack, run.
fn try_out(name: &str, archive: &str) -> Outcome {
    let check = ["--check", "--quiet", "SHA256SUMS"];
    shell::run(shell::command_in(FOLDER, "sha256sum", &check))?;
    shell::run(shell::command_in(FOLDER, "tar", &["-xf", archive]))?;
    let folder = format!("{FOLDER}/{name}");
    let demo = ["demo", "--quiet", "--out", "demo"];
    shell::run(shell::command_in(&folder, "bin/stiction", &demo))?;
    fs::remove_dir_all(shell::root().join(folder)).map_err(|e| e.to_string())
}

/// For which kind of machine this compiler builds.
fn host() -> Result<String, String> {
    let text = shell::output(shell::command("rustc", &["-vV"]))?;
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    Ok(host.ok_or("rustc names no host")?.into())
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
