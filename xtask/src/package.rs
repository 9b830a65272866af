//! The three packages that are published, assembled from the crates of the workspace (docs/decisions/0127).

mod assemble;
mod manifest;
mod rewrite;
mod verify;

use crate::shell::{self, Outcome, cargo};
use std::fs;
use std::path::PathBuf;

/// A package: a crate of the workspace, with others as modules of it.
struct Package {
    /// The folder in `crates` of the crate whose manifest and public names it has; also its folder in the packages.
    root: &'static str,
    /// Crates that are modules of it, under `internal`.
    parts: &'static [&'static str],
    /// Packages whose crates this one uses.
    uses: &'static [&'static str],
    /// Whether another package uses the modules: public then, though undocumented.
    shared: bool,
    /// The crate of its program, which is the name of the feature that builds it too, and the modules that it needs, its own
    /// among them.
    program: Option<(&'static str, &'static [&'static str])>,
}

/// In the order in which they are published.
const PACKAGES: [Package; 3] = [
    Package {
        root: "friction",
        parts: &[],
        uses: &[],
        shared: false,
        program: None,
    },
    Package {
        root: "formats",
        parts: &["codes", "number"],
        uses: &[],
        shared: true,
        program: None,
    },
    Package {
        root: "stiction",
        parts: &[
            "dispatch",
            "drift",
            "export",
            "files",
            "identify",
            "lanes",
            "log",
            "pages",
            "parameters",
            "plan",
            "policy",
            "record",
            "report",
            "rigid",
            "say",
            "search",
            "servo",
            "signal",
            "workflows",
        ],
        uses: &["friction", "formats"],
        shared: false,
        program: Some(("cli", &["studio", "cli"])),
    },
];

/// The name of the package of a crate's folder.
fn name(folder: &str) -> String {
    match folder {
        "stiction" => folder.into(),
        _ => format!("stiction-{folder}"),
    }
}

/// The names of what is published, in that order.
fn names() -> Vec<String> {
    PACKAGES.iter().map(|package| name(package.root)).collect()
}

/// The commands that publish them, in the order in which each finds those that it depends on.
pub fn publishing() -> Vec<String> {
    let manifest = workspace();
    let one = |name| format!("cargo publish --manifest-path {manifest} --package {name}");
    names().into_iter().map(one).collect()
}

/// Where the packages are assembled: a workspace of its own.
fn folder() -> PathBuf {
    shell::target().join("packages")
}

/// The manifest of that workspace, for `--manifest-path`.
pub fn workspace() -> String {
    folder().join("Cargo.toml").display().to_string()
}

/// Assembles the packages: `src` of each, and its manifest.
pub fn assembled() -> Outcome {
    assemble::all()
}

/// Assembles the packages and packs them; whether they also build is for [`verified`] to say.
pub fn run() -> Outcome {
    assemble::all()?;
    let mut pack = cargo("package --workspace --quiet --offline --no-verify --manifest-path");
    pack.arg(workspace())
        .env("CARGO_TARGET_DIR", shell::target());
    shell::run(pack)?;
    for name in names() {
        let packed = assemble::packed(&name)?;
        let size = fs::metadata(&packed).map_err(|e| format!("{}: {e}", packed.display()))?;
        println!("    {:5} kB  {}", size.len() / 1000, packed.display());
    }
    Ok(())
}

/// Packs them, builds each from its own archive, and holds what they do beside what the workspace does.
pub fn verified() -> Outcome {
    run()?;
    verify::all()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_crate_is_in_one_package() {
        let mut known: Vec<&str> = vec!["python", "testkit"];
        for package in &PACKAGES {
            known.push(package.root);
            known.extend(package.parts);
            if let Some((program, parts)) = package.program {
                assert!(parts.contains(&program));
                known.extend(parts);
            }
        }
        known.sort_unstable();
        let crates = fs::read_dir(shell::root().join("crates")).unwrap();
        let mut there: Vec<String> = crates
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        there.sort_unstable();
        assert_eq!(there, known);
    }
}
