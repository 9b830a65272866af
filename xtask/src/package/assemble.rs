//! A package out of its parts: `src` of its root, the others in `crates` as they stand in the workspace, so that what they
//! include is where they look for it, and a manifest.

use super::manifest::{self, Dependencies, Manifest};
use super::rewrite::{Paths, rewritten};
use super::{PACKAGES, Package, folder, name};
use crate::shell::{self, Outcome};
use std::fs;
use std::path::{Path, PathBuf};

/// Assembles every package anew, and the workspace that they are in.
pub fn all() -> Outcome {
    let workspace = read(&shell::root().join("Cargo.toml"))?;
    let workspace = Manifest::parse(&workspace);
    for package in &PACKAGES {
        let to = folder().join(package.root);
        if to.exists() {
            fs::remove_dir_all(&to).map_err(|e| format!("{}: {e}", to.display()))?;
        }
        sources(package, &to)?;
        write(&to.join("Cargo.toml"), &text(package, &workspace)?)?;
    }
    let members: Vec<&str> = PACKAGES.iter().map(|package| package.root).collect();
    let own = format!("[workspace]\nresolver = \"3\"\nmembers = {members:?}\n");
    write(&folder().join("Cargo.toml"), &own)?;
    copy(
        &shell::root().join("Cargo.lock"),
        &folder().join("Cargo.lock"),
    )
}

/// The archive of a package.
pub fn packed(name: &str) -> Result<PathBuf, String> {
    let workspace = Manifest::parse(&read(&shell::root().join("Cargo.toml"))?);
    let mut known = workspace.pairs("workspace.package");
    let version = known.find(|(key, _)| *key == "version");
    let version = version.map_or("", |(_, value)| value.trim_matches('"'));
    Ok(shell::target()
        .join("package")
        .join(format!("{name}-{version}.crate")))
}

/// Copies the parts, with the paths of the package in them.
fn sources(package: &Package, to: &Path) -> Outcome {
    let sibling = |part: &str| {
        let mut used = PACKAGES
            .iter()
            .filter(|other| package.uses.contains(&other.root));
        used.find(|other| other.parts.contains(&part))
            .map(|other| format!("stiction_{}::internal::{part}", other.root))
    };
    let program = package.program.map_or(&[][..], |(_, parts)| parts);
    let of = |name: &str| {
        let part = name.strip_prefix("stiction_")?;
        match package.parts.contains(&part) || program.contains(&part) {
            true => Some(format!("crate::internal::{part}")),
            false => sibling(part),
        }
    };
    take(package.root, to, &Paths { own: "", of: &of })?;
    let mut modules = "//! Crates of the workspace of stiction as modules: no part of the interface.\n\n#![allow(dead_code, unused_imports, missing_docs)]\n".to_owned();
    for part in package.parts.iter().chain(program) {
        known(package, part)?;
        let own = format!("internal::{part}");
        let at = to.join("crates").join(part);
        take(part, &at, &Paths { own: &own, of: &of })?;
        let only = match package.program {
            Some((feature, parts)) if parts.contains(part) => {
                format!("#[cfg(feature = \"{feature}\")]\n")
            }
            _ => String::new(),
        };
        modules += &format!("\n{only}#[path = \"../crates/{part}/src/lib.rs\"]\npub mod {part};\n");
    }
    if !package.parts.is_empty() {
        write(&to.join("src/internal.rs"), &modules)?;
        let seen = if package.shared {
            "#[doc(hidden)]\npub "
        } else {
            ""
        };
        let library = to.join("src/lib.rs");
        let mut text = format!("{}\n{seen}mod internal;\n", read(&library)?);
        if let Some((name, _)) = package.program {
            text += &format!(
                "\n#[cfg(feature = \"{name}\")]\n#[doc(hidden)]\npub mod program {{\n    pub use crate::internal::{name}::run;\n}}\n"
            );
            let main = to.join("crates").join(name).join("src/main.rs");
            let own = shell::root().join("crates").join(name).join("src/main.rs");
            let of = |crate_: &str| {
                (crate_ == format!("stiction_{name}")).then(|| format!("{}::program", package.root))
            };
            write(&main, &rewritten(&read(&own)?, &Paths { own: "", of: &of }))?;
        }
        write(&library, &text)?;
    }
    for file in ["README.md", "LICENSE-APACHE", "LICENSE-MIT"] {
        copy(
            &shell::root().join("crates").join(package.root).join(file),
            &to.join(file),
        )?;
    }
    Ok(())
}

/// Refuses a part that depends on a crate which is nowhere in the package and those that it uses.
fn known(package: &Package, part: &str) -> Outcome {
    let root = package.root;
    let used = PACKAGES
        .iter()
        .filter(|other| package.uses.contains(&other.root));
    let mut there: Vec<&str> = package.parts.to_vec();
    there.extend(used.flat_map(|other| other.parts.iter().chain([&other.root])));
    there.extend(package.program.map_or(&[][..], |(_, parts)| parts));
    match of(part)?.own().find(|own| !there.contains(own)) {
        Some(own) => Err(format!(
            "{part}, a part of {root}, needs {own}: give it a package in xtask/src/package.rs"
        )),
        None => Ok(()),
    }
}

/// Copies the folders that a crate is packed of; of its sources, with other paths.
fn take(part: &str, to: &Path, paths: &Paths) -> Outcome {
    let manifest = of(part)?;
    let mut include = manifest
        .pairs("package")
        .filter(|(key, _)| *key == "include");
    let (_, include) = include
        .next()
        .ok_or_else(|| format!("{part} includes nothing"))?;
    let folders = include.split('"').skip(1).step_by(2);
    for folder in folders.filter(|name| !name.contains(['.', '*'])) {
        tree(
            &shell::root().join("crates").join(part).join(folder),
            &to.join(folder),
            paths,
        )?;
    }
    Ok(())
}

fn tree(from: &Path, to: &Path, paths: &Paths) -> Outcome {
    let entries = fs::read_dir(from).map_err(|e| format!("{}: {e}", from.display()))?;
    for entry in entries {
        let path = entry.map_err(|e| e.to_string())?.path();
        let to = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            // What tests compare with.
            if !path.ends_with("snapshots") {
                tree(&path, &to, paths)?;
            }
        } else if path.extension().is_some_and(|end| end == "rs") {
            write(&to, &rewritten(&read(&path)?, paths))?;
        } else {
            copy(&path, &to)?;
        }
    }
    Ok(())
}

/// The manifest of a part.
fn of(part: &str) -> Result<Manifest, String> {
    let path = shell::root().join("crates").join(part).join("Cargo.toml");
    Ok(Manifest::parse(&read(&path)?))
}

/// The manifest of the package.
fn text(package: &Package, workspace: &Manifest) -> Result<String, String> {
    let root = of(package.root)?;
    let mut all = Dependencies::default();
    all.add(&root, false);
    for part in package.parts {
        all.add(&of(part)?, false);
    }
    let mut features: Vec<String> = root.section("features").to_vec();
    let mut metadata = vec![];
    let mut program = String::new();
    if let Some((name, parts)) = package.program {
        let own = of(name)?;
        let mut names = Vec::new();
        for part in parts {
            names.extend(all.add(&of(part)?, true));
        }
        // What the program leaves out is in it here: its own feature has all of it.
        let mut all_of: Vec<String> = all.optional(&names);
        for (feature, _) in own.pairs("features").filter(|(key, _)| *key != "default") {
            features.push(format!("{feature} = []"));
            all_of.push(feature.into());
        }
        features.push(format!(
            "# The command `stiction`, which `cargo install stiction` is for.\ndefault = [\"{name}\"]\n{name} = {all_of:?}"
        ));
        program = format!(
            "\n[[bin]]\nname = \"stiction\"\npath = \"crates/{name}/src/main.rs\"\nrequired-features = [\"{name}\"]\ndoc = false\ntest = false\n"
        );
        program += &manifest::section("profile.release", workspace.section("profile.release"));
        metadata.push(own);
    }
    let mut head = manifest::package(&root, workspace)?;
    head.push(
        "include = [\"/src\", \"/crates\", \"/templates\", \"/README.md\", \"/LICENSE-*\"]".into(),
    );
    head.push("autobins = false".into());
    let version = head
        .iter()
        .find_map(|line| line.strip_prefix("version = \""));
    let version = version.unwrap_or_default().trim_end_matches('"').to_owned();
    let mut dependencies = Vec::new();
    for used in package.uses {
        dependencies.push(format!(
            "{} = {{ path = \"../{used}\", version = \"={version}\" }}",
            name(used)
        ));
    }
    dependencies.extend(all.lines(workspace)?);
    let mut parts = vec![&root];
    parts.extend(&metadata);
    let mut text = "# Made by `cargo xtask package` of the workspace.\n".to_owned();
    text += manifest::section("package", &head).trim_start();
    text += &manifest::metadata(&parts);
    // Unit tests need what is not published; examples of the documentation run.
    text += "\n[lib]\ntest = false\n";
    if !features.is_empty() {
        text += &manifest::section("features", &features);
    }
    text += &manifest::section("dependencies", &dependencies);
    Ok(text + &program)
}

pub fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}

pub fn write(path: &Path, text: &str) -> Outcome {
    let folder = path.parent().unwrap_or(path);
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, text))
        .map_err(|e| format!("{}: {e}", path.display()))
}

pub fn copy(from: &Path, to: &Path) -> Outcome {
    let folder = to.parent().unwrap_or(to);
    fs::create_dir_all(folder)
        .and_then(|()| fs::copy(from, to))
        .map(drop)
        .map_err(|e| format!("{}: {e}", from.display()))
}
