//! The licences of everything that is linked into the program or the wheel, which have to go along with it.

use super::sbom;
use super::target::{self, Target};
use crate::shell::{self, Outcome};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// The file in archives and wheels. Of a wheel, all that begins so is a licence (pyproject.toml).
pub const FILE: &str = "LICENSE-THIRD-PARTY.txt";
/// How files with a licence or a notice begin.
const BEGINNINGS: [&str; 6] = [
    "license",
    "licence",
    "copying",
    "copyright",
    "notice",
    "unlicense",
];
/// Of a package without one.
const WITHOUT: &str = "(The package comes without a text; its manifest names the licence.)";
/// What is compiled in and is no package of cargo, with its licence here.
const OTHERS: [(&str, &str); 1] = [(
    "uPlot, in the page of `stiction studio` (MIT)",
    "crates/studio/assets/uplot.txt",
)];

/// Writes the licences of what is linked into a crate of the workspace.
pub fn write(target: &Target, crate_: &str, to: &Path) -> Outcome {
    fs::write(to, text(target, crate_)?).map_err(|e| format!("{}: {e}", to.display()))
}

/// One text: each licence once, under the names of the packages that come with it.
fn text(target: &Target, crate_: &str) -> Result<String, String> {
    let tree = sbom::tree(target, crate_, "none", "{p}|{l}")?;
    // Our own have a folder behind their version, on Windows with a letter before it.
    let ours = |line: &str| {
        line.split('|')
            .next()
            .is_some_and(|p| p.contains("(/") || p.contains(":\\"))
    };
    let lines = tree.lines().filter(|line| !ours(line));
    let mut lines: Vec<&str> = lines.map(|line| line.trim_end_matches(" (*)")).collect();
    lines.sort_unstable();
    lines.dedup();
    let mut texts: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for line in lines {
        let (package, licence) = line.split_once('|').ok_or("cargo tree: no licence")?;
        let mut words = package.split_whitespace();
        let (Some(name), Some(version)) = (words.next(), words.next()) else {
            continue;
        };
        let folder = source(name, version.trim_start_matches('v'))?;
        let mut files = Vec::new();
        of_folder(&folder, &mut files)?;
        let mut found: Vec<String> = files
            .iter()
            .map(|file| read(file))
            .collect::<Result<_, _>>()?;
        if found.is_empty() {
            found.push(WITHOUT.into());
        }
        for text in found {
            let entry = texts.entry(text).or_default();
            entry.insert(format!("{name} {version} ({licence})"));
        }
    }
    for (name, file) in OTHERS {
        let text = read(&shell::root().join(file))?;
        texts.entry(text).or_default().insert(name.into());
    }
    let mut out = String::from(
        "stiction is linked with the packages below, under the licences that follow their names.\n",
    );
    for (text, packages) in texts {
        let packages: Vec<String> = packages.into_iter().collect();
        let _ = write!(
            out,
            "\n{}\n{}\n\n{text}\n",
            "-".repeat(80),
            packages.join("\n"),
        );
    }
    Ok(out)
}

/// Adds the files with licences in the folder of a package, and below it: code of others has its own.
fn of_folder(folder: &Path, files: &mut Vec<PathBuf>) -> Outcome {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    paths.sort();
    for path in paths {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let name = name.to_lowercase();
        let is_named = BEGINNINGS.iter().any(|begin| name.starts_with(begin));
        if path.is_dir() {
            of_folder(&path, files)?;
        } else if is_named && !name.ends_with(".rs") {
            files.push(path);
        }
    }
    Ok(())
}

fn read(file: &Path) -> Result<String, String> {
    let bytes = fs::read(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let text = String::from_utf8_lossy(&bytes).replace("\r\n", "\n");
    Ok(text.trim().to_owned())
}

/// Where cargo unpacked a package of the registry.
fn source(name: &str, version: &str) -> Result<PathBuf, String> {
    let registries = target::cargo_home()?.join("registry/src");
    let entries =
        fs::read_dir(&registries).map_err(|e| format!("{}: {e}", registries.display()))?;
    entries
        .filter_map(|entry| Some(entry.ok()?.path().join(format!("{name}-{version}"))))
        .find(|folder| folder.is_dir())
        .ok_or_else(|| format!("{name} {version} is not in {}", registries.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_package_of_the_wheel_has_its_licence() {
        let host = Target::host().unwrap();
        let notices = text(&host, "stiction-python").unwrap();
        let tree = sbom::tree(&host, "stiction-python", "none", "{p}|{l}").unwrap();
        let packages = tree.lines().filter(|line| !line.starts_with("stiction"));
        for line in packages {
            let package = line.split(['|', '(']).next().unwrap().trim();
            assert!(notices.contains(&format!("\n{package} (")), "{package}");
        }
        // The program's and the page's too, and the C library inside a package.
        for other in ["\nclap v", "\naxum v", "Leon Sorokin", "Daan Leijen"] {
            assert!(notices.contains(other), "{other}");
        }
    }
}
