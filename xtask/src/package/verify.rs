//! The packed crates on their own: each from its archive, without the workspace. They build, the examples of the
//! documentation run, the program writes what that of the workspace writes, and no module shows that is internal.

use super::assemble::{copy, packed, read, write};
use super::{PACKAGES, folder, name, names};
use crate::shell::{self, Outcome, cargo};
use crate::wheel;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Unpacks, builds, runs, compares.
pub fn all() -> Outcome {
    // Before the packed program, which cargo puts at the same place.
    shell::run(shell::linted(cargo(wheel::BUILD)))?;
    let (own, theirs) = (folder().join("workspace"), folder().join("packed"));
    let program = shell::target().join("debug/stiction");
    demo(&program, &own)?;
    let unpacked = unpack()?;
    shell::run(within(
        &unpacked,
        "build --workspace --features stiction/cli",
    ))?;
    demo(&program, &theirs)?;
    equal(&own, &theirs)?;
    shell::run(within(&unpacked, "run --quiet --package program"))?;
    let packages: String = names()
        .iter()
        .map(|name| format!(" --package {name}"))
        .collect();
    shell::run(within(
        &unpacked,
        &format!("test --quiet --doc --features stiction/cli{packages}"),
    ))?;
    documented(&unpacked, &packages)
}

/// Cargo in the workspace of what was unpacked; it builds where all else does.
fn within(unpacked: &Path, arguments: &str) -> Command {
    let mut command = cargo(arguments);
    command
        .arg("--offline")
        .current_dir(unpacked)
        .env("CARGO_TARGET_DIR", shell::target());
    command
}

/// Unpacks the archives into a workspace that stands in for the registry, beside a program of the first example.
fn unpack() -> Result<PathBuf, String> {
    let to = folder().join("unpacked");
    if to.exists() {
        fs::remove_dir_all(&to).map_err(|e| format!("{}: {e}", to.display()))?;
    }
    let mut members = vec!["program".to_owned()];
    let mut patches = String::new();
    for name in names() {
        let archive = packed(&name)?;
        fs::create_dir_all(&to).map_err(|e| e.to_string())?;
        let (archive, into) = (archive.display().to_string(), to.display().to_string());
        shell::run(shell::command("tar", &["-xzf", &archive, "-C", &into]))?;
        let member = Path::new(&archive).file_stem().unwrap_or_default();
        let member = member.to_string_lossy().into_owned();
        patches += &format!("{name} = {{ path = \"{member}\" }}\n");
        members.push(member);
    }
    let workspace = read(&shell::root().join("Cargo.toml"))?;
    write(
        &to.join("Cargo.toml"),
        &format!(
            "[workspace]\nresolver = \"3\"\nmembers = {members:?}\n\n[patch.crates-io]\n{patches}{}",
            profiles(&workspace)
        ),
    )?;
    copy(&shell::root().join("Cargo.lock"), &to.join("Cargo.lock"))?;
    write(
        &to.join("program/Cargo.toml"),
        "[package]\nname = \"program\"\nedition = \"2024\"\n\n[dependencies]\nstiction = \"*\"\ntempfile = \"*\"\n",
    )?;
    let library = read(&shell::root().join("crates/stiction/src/lib.rs"))?;
    write(&to.join("program/src/main.rs"), &example(&library))?;
    Ok(to)
}

/// The profiles of the workspace for crates of others, which then need not be built again.
fn profiles(workspace: &str) -> String {
    let mut kept = false;
    let mut text = String::new();
    for line in workspace.lines() {
        if line.starts_with('[') {
            kept = line.starts_with("[profile.dev") && !line.contains(".stiction");
        }
        if kept {
            text += &format!("{line}\n");
        }
    }
    text
}

/// The first example of a library as a program, with the lines that its documentation hides.
fn example(library: &str) -> String {
    let lines = library.lines().map(|line| {
        line.strip_prefix("//!")
            .unwrap_or(line)
            .trim_start_matches(' ')
    });
    let lines = lines.skip_while(|line| *line != "```").skip(1);
    let lines = lines.take_while(|line| *line != "```");
    let shown: Vec<&str> = lines
        .map(|line| line.strip_prefix("# ").unwrap_or(line))
        .collect();
    let body = shown.join("\n");
    format!("fn main() -> Result<(), Box<dyn std::error::Error>> {{\n{body}\n}}\n")
}

/// Identifies the demo's log in a folder of its own.
fn demo(program: &Path, to: &Path) -> Outcome {
    if to.exists() {
        fs::remove_dir_all(to).map_err(|e| format!("{}: {e}", to.display()))?;
    }
    fs::create_dir_all(to).map_err(|e| format!("{}: {e}", to.display()))?;
    // In that folder, so that no path differs.
    let mut command = shell::command(&program.display().to_string(), &["demo", "--out", "."]);
    command.current_dir(to);
    command.stdout(std::process::Stdio::null());
    shell::run(command)
}

/// Refuses a file of the packed program that has other lines than that of the workspace, but for the time of the run.
fn equal(own: &Path, theirs: &Path) -> Outcome {
    let lines = |path: &Path| -> Result<Vec<String>, String> {
        let text = read(path)?;
        let lines = text.lines().filter(|line| !line.contains("\"wall_s\""));
        Ok(lines.map(str::to_owned).collect())
    };
    for file in [
        "demo.csv",
        "fit.csv",
        "model.toml",
        "result.json",
        "report.html",
    ] {
        let [a, b] = [own, theirs].map(|folder| folder.join(file));
        if lines(&a)? != lines(&b)? {
            return Err(format!("{} and {} differ", a.display(), b.display()));
        }
        println!("    {file} is that of the workspace");
    }
    Ok(())
}

/// Builds the documentation, in which no internal module may have a page; rustdoc leads from those paths to the public ones.
fn documented(unpacked: &Path, packages: &str) -> Outcome {
    shell::run(within(
        unpacked,
        &format!("doc --quiet --no-deps{packages}"),
    ))?;
    for package in &PACKAGES {
        let page = name(package.root).replace('-', "_");
        let internal = shell::target().join("doc").join(page).join("internal");
        if internal.exists() {
            only_redirects(&internal)?;
        }
    }
    Ok(())
}

fn only_redirects(folder: &Path) -> Outcome {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for entry in entries {
        let path = entry.map_err(|e| e.to_string())?.path();
        if path.is_dir() {
            only_redirects(&path)?;
        } else if path.extension().is_some_and(|end| end == "html")
            && !read(&path)?.contains("<title>Redirection</title>")
        {
            return Err(format!("{} documents what is internal", path.display()));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_example_is_a_program() {
        let library = "//! Words.\n//!\n//! ```\n//! # use a::b;\n//! let x = 1;\n//!\n//! if x { y() }\n//! ```\n//!\n//! ```\n//! other\n//! ```\n";
        let program = "fn main() -> Result<(), Box<dyn std::error::Error>> {\nuse a::b;\nlet x = 1;\n\nif x { y() }\n}\n";
        assert_eq!(example(library), program);
    }
}
