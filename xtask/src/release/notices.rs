//! The licences of everything that is linked into the program, which have to go along with it.

use super::sbom;
use super::target::{self, Target};
use crate::shell::Outcome;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// How files with a licence or a notice begin.
const BEGINNINGS: [&str; 5] = ["license", "licence", "copying", "notice", "unlicense"];

/// Writes one text: each licence once, under the names of the packages that come with it.
pub fn write(target: &Target, to: &Path) -> Outcome {
    let tree = sbom::tree(target, "none", "{p}|{l}")?;
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
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for line in lines {
        let (package, licence) = line.split_once('|').ok_or("cargo tree: no licence")?;
        let mut words = package.split_whitespace();
        let (Some(name), Some(version)) = (words.next(), words.next()) else {
            continue;
        };
        let folder = source(name, version.trim_start_matches('v'))?;
        for text in of_folder(&folder)? {
            let entry = texts.entry(text).or_default();
            entry.push(format!("{name} {version} ({licence})"));
        }
    }
    let mut out = String::from(
        "stiction is linked with the packages below, under the licences that follow their names.\n",
    );
    for (text, packages) in texts {
        let _ = write!(
            out,
            "\n{}\n{}\n\n{}\n",
            "-".repeat(80),
            packages.join("\n"),
            text.trim()
        );
    }
    fs::write(to, out).map_err(|e| format!("{}: {e}", to.display()))
}

/// Licence texts in the folder of a package. A package without one states its licence in its manifest.
fn of_folder(folder: &Path) -> Result<Vec<String>, String> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.is_file())
        .filter(|path| {
            let name = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .to_lowercase();
            BEGINNINGS
                .iter()
                .any(|beginning| name.starts_with(beginning))
        })
        .collect();
    files.sort();
    if files.is_empty() {
        return Ok(vec![
            "(The package comes without a text; its manifest names the licence.)".into(),
        ]);
    }
    files
        .iter()
        .map(|file| {
            let bytes = fs::read(file).map_err(|e| format!("{}: {e}", file.display()))?;
            Ok(String::from_utf8_lossy(&bytes)
                .replace("\r\n", "\n")
                .trim()
                .to_owned())
        })
        .collect()
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
