//! A release, made and tried out on this machine: checks that CI has no time for, an archive with checksums, and the
//! commands that are left to give. Nothing is uploaded.

mod archive;
pub mod notices;
pub mod sbom;
mod semver;
pub mod target;
mod twice;

pub use archive::sums;

use crate::shell::{self, Outcome};
use crate::{licences, package, setup, wheel};
use std::fs;
use std::path::Path;
use target::Target;

/// Makes the archive after all checks; a work tree with changes is refused.
pub fn run() -> Outcome {
    let changes = shell::output(shell::command("git", &["status", "--porcelain"]))?;
    if !changes.is_empty() {
        return Err(format!(
            "the work tree has changes; commit them first:\n{changes}"
        ));
    }
    setup()?;
    let version = version()?;
    has_changes(&version)?;
    named_once()?;
    licences::run()?;
    semver::compare()?;
    package::verified()?;
    let files = archive::make(&version, &Target::host()?)?;
    twice::archive()?;
    println!("\nreleased into {}:", archive::FOLDER);
    for file in files {
        println!("    {file}");
    }
    println!(
        "\nleft to do, each after a look at the one before:\n    \
         cargo xtask test && cargo xtask soak\n    \
         git tag --annotate v{version} --message 'stiction {version}' && git push --tags\n    \
         {}\n    \
         ssh-keygen -Y sign -n stiction -f KEY {folder}/SHA256SUMS    # whose public key users have\n    \
         attach the files above and SHA256SUMS.sig to the release of the tag",
        package::publishing().join("\n    "),
        folder = archive::FOLDER
    );
    Ok(())
}

/// Makes the archive from the work tree as it stands, without checks: to look at it.
pub fn archive() -> Outcome {
    archive::make(&version()?, &Target::host()?).map(drop)
}

/// The same for another kind of machine.
pub fn archive_of_target() -> Outcome {
    archive::make(&version()?, &Target::typed()?).map(drop)
}

/// Builds archive and wheel here and in a copy in another folder, and compares their bytes.
pub fn twice() -> Outcome {
    archive()?;
    twice::archive()?;
    wheel::uploads(&Target::host()?)?;
    twice::wheel()
}

/// Removes what is in a folder of uploads and of another version.
pub fn outdated(folder: &Path) -> Outcome {
    archive::outdated(folder, &version()?)
}

/// The version of the workspace. The crates depend on each other at this version and no other.
pub fn version() -> Result<String, String> {
    let manifest = shell::root().join("Cargo.toml");
    let text = fs::read_to_string(&manifest).map_err(|e| format!("{}: {e}", manifest.display()))?;
    let version = text
        .lines()
        .find_map(|line| line.strip_prefix("version = \"")?.strip_suffix('"'))
        .ok_or("Cargo.toml has no version")?;
    let others: Vec<&str> = text
        .lines()
        .filter(|line| line.contains("path = \"crates/") && line.contains("version = "))
        .filter(|line| !line.contains(&format!("version = \"{version}\"")))
        .collect();
    if others.is_empty() {
        return Ok(version.into());
    }
    Err(format!(
        "Cargo.toml: the workspace is at {version}, its own dependencies are not:\n{}",
        others.join("\n")
    ))
}

/// The address of the repository: the one line of Cargo.toml that a person sets.
pub fn repository() -> Result<String, String> {
    let manifest =
        fs::read_to_string(shell::root().join("Cargo.toml")).map_err(|e| e.to_string())?;
    let begin = "repository = \"";
    let line = manifest.lines().find_map(|line| line.strip_prefix(begin));
    let address = line.ok_or("Cargo.toml names no repository")?;
    Ok(address.trim_end_matches('"').into())
}

/// Refuses the address of the repository in any other file; everything derives from that line.
fn named_once() -> Outcome {
    let address = repository()?;
    let search = ["grep", "-lF", &address, "--", ":!*.snap"];
    let found = shell::output(shell::command("git", &search))?;
    match found.trim() {
        "Cargo.toml" => Ok(()),
        files => Err(format!(
            "{address} stands in more files than Cargo.toml:\n{files}"
        )),
    }
}

/// Refuses a version that the changelog does not know, or the citation gives otherwise.
fn has_changes(version: &str) -> Outcome {
    let read = |name: &str| {
        fs::read_to_string(shell::root().join(name)).map_err(|e| format!("{name}: {e}"))
    };
    let (changes, citation) = (read("CHANGELOG.md")?, read("CITATION.cff")?);
    let heading = format!("## {version} - ");
    let day = changes
        .lines()
        .find_map(|line| line.strip_prefix(&heading))
        .ok_or(format!(
            "CHANGELOG.md has no section `{heading}YEAR-MONTH-DAY`"
        ))?;
    for line in [
        format!("version: {version}"),
        format!("date-released: \"{day}\""),
    ] {
        if !citation.lines().any(|own| own == line) {
            return Err(format!("CITATION.cff has no line `{line}`"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn manifest_changelog_and_citation_give_one_version() {
        version().and_then(|version| has_changes(&version)).unwrap();
        assert!(has_changes("0.0.9").is_err());
    }
}
