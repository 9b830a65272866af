//! What program and wheel are made of, for those who ask: a bill of materials, CycloneDX 1.6 as JSON, the same from any folder.

use super::target::Target;
use crate::shell::{self, Outcome};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Its name in an archive and in a wheel.
pub const FILE: &str = "stiction.cdx.json";

/// A package that is linked in.
struct Package {
    licence: String,
    needs: BTreeSet<String>,
}

/// Writes every package that is linked into a crate with its version, licence and checksum, and which needs which.
pub fn write(target: &Target, crate_: &str, version: &str, to: &Path) -> Outcome {
    let packages = packages(target, crate_)?;
    let sums = checksums()?;
    let main = purl(crate_, version);
    let component = |name: &str, package: &Package| {
        let sum = sums.get(name).map_or_else(String::new, |sum| {
            format!(r#","hashes":[{{"alg":"SHA-256","content":"{sum}"}}]"#)
        });
        let kind = if name == main {
            "application"
        } else {
            "library"
        };
        let (short, version) = parts(name);
        format!(
            r#"{{"type":"{kind}","bom-ref":"{name}","name":"{short}","version":"{version}","purl":"{name}","licenses":[{{"expression":"{}"}}]{sum}}}"#,
            package.licence
        )
    };
    let about = packages
        .get(&main)
        .ok_or_else(|| format!("cargo tree has no {crate_}"))?;
    let about = component(&main, about);
    let others = packages.iter().filter(|(name, _)| **name != main);
    let others: Vec<String> = others
        .map(|(name, package)| component(name, package))
        .collect();
    let needs: Vec<String> = packages
        .iter()
        .map(|(name, package)| {
            let needs: Vec<String> = package
                .needs
                .iter()
                .map(|need| format!("\"{need}\""))
                .collect();
            format!(r#"{{"ref":"{name}","dependsOn":[{}]}}"#, needs.join(","))
        })
        .collect();
    let date = [
        "log",
        "-1",
        "--format=%cd",
        "--date=format-local:%Y-%m-%dT%H:%M:%SZ",
    ];
    let mut date = shell::command("git", &date);
    date.env("TZ", "UTC");
    let text = format!(
        "{{\n\"bomFormat\":\"CycloneDX\",\n\"specVersion\":\"1.6\",\n\"version\":1,\n\"metadata\":{{\"timestamp\":\"{}\",\
         \"lifecycles\":[{{\"phase\":\"build\"}}],\n\"component\":{about}}},\n\"components\":[\n{}\n],\n\"dependencies\":[\n{}\n]\n}}\n",
        shell::output(date)?.trim(),
        others.join(",\n"),
        needs.join(",\n")
    );
    fs::write(to, text).map_err(|e| format!("{}: {e}", to.display()))
}

/// Every package below a crate, by its package URL.
fn packages(target: &Target, crate_: &str) -> Result<BTreeMap<String, Package>, String> {
    let mut packages: BTreeMap<String, Package> = BTreeMap::new();
    // Those above the line that is read, from the crate down.
    let mut above: Vec<String> = Vec::new();
    let tree = tree(target, crate_, "depth", "{p}|{l}")?;
    for line in tree.lines() {
        let digits = line.chars().take_while(char::is_ascii_digit).count();
        let (depth, rest) = line.split_at(digits);
        let depth: usize = depth.parse().map_err(|_| format!("cargo tree: {line}"))?;
        let (package, licence) = rest.split_once('|').ok_or("cargo tree: no licence")?;
        let mut words = package.split_whitespace();
        let (Some(name), Some(version)) = (words.next(), words.next()) else {
            return Err(format!("cargo tree: {line}"));
        };
        let name = purl(name, version.trim_start_matches('v'));
        above.truncate(depth);
        if let Some(parent) = above.last().and_then(|parent| packages.get_mut(parent)) {
            parent.needs.insert(name.clone());
        }
        above.push(name.clone());
        // Old manifests separate licences by a slash, which SPDX does not know.
        let licence = licence.trim_end_matches(" (*)").replace('/', " OR ");
        let needs = BTreeSet::new();
        packages.entry(name).or_insert(Package { licence, needs });
    }
    Ok(packages)
}

/// What is linked into a crate for a target, a line for each package.
pub fn tree(target: &Target, crate_: &str, prefix: &str, format: &str) -> Result<String, String> {
    shell::output(shell::cargo(&format!(
        "tree --locked --package {crate_} --edges normal --target {} --prefix {prefix} --format {format}",
        target.0
    )))
}

/// SHA-256 of the packages of the registry, from the lock file.
fn checksums() -> Result<BTreeMap<String, String>, String> {
    let lock = fs::read_to_string(shell::root().join("Cargo.lock")).map_err(|e| e.to_string())?;
    let value = |entry: &str, key: &str| {
        let begin = format!("{key} = \"");
        let line = entry.lines().find_map(|line| line.strip_prefix(&begin))?;
        Some(line.trim_end_matches('"').to_owned())
    };
    let entries = lock.split("[[package]]");
    Ok(entries
        .filter_map(|entry| {
            let name = purl(&value(entry, "name")?, &value(entry, "version")?);
            Some((name, value(entry, "checksum")?))
        })
        .collect())
}

fn purl(name: &str, version: &str) -> String {
    // A version may name its build after a plus, which stands for a blank in a URL.
    format!("pkg:cargo/{name}@{}", version.replace('+', "%2B"))
}

/// Name and version of a package URL.
fn parts(purl: &str) -> (String, String) {
    let (name, version) = purl.split_once('@').unwrap_or((purl, ""));
    (
        name.trim_start_matches("pkg:cargo/").into(),
        version.replace("%2B", "+"),
    )
}
