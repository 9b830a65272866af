//! The manifest of a package, from those of its parts and of the workspace.

use std::collections::BTreeMap;

/// A manifest by its sections, in order; the lines of each.
pub struct Manifest(Vec<(String, Vec<String>)>);

impl Manifest {
    /// Splits a manifest as the workspace writes them: no value runs over several lines.
    pub fn parse(text: &str) -> Self {
        let mut sections = vec![(String::new(), Vec::new())];
        for line in text
            .lines()
            .filter(|line| !line.trim_start().starts_with('#'))
        {
            match line.strip_prefix('[').and_then(|l| l.strip_suffix(']')) {
                Some(name) => sections.push((name.into(), Vec::new())),
                None if line.trim().is_empty() => {}
                None => sections.last_mut().expect("one").1.push(line.to_owned()),
            }
        }
        Self(sections)
    }

    /// The lines of a section; none where it has none.
    pub fn section(&self, name: &str) -> &[String] {
        let found = self.0.iter().find(|(section, _)| section == name);
        found.map_or(&[], |(_, lines)| lines)
    }

    /// Keys of a section with their values.
    pub fn pairs(&self, section: &str) -> impl Iterator<Item = (&str, &str)> {
        let lines = self.section(section).iter();
        lines.filter_map(|line| line.split_once(" = "))
    }

    /// Names and values of the dependencies, without `.workspace`.
    fn dependencies(&self) -> impl Iterator<Item = (&str, &str)> {
        self.pairs("dependencies")
            .map(|(name, value)| (name.trim_end_matches(".workspace"), value))
    }

    /// Names of the crates of the workspace that this one depends on, without `stiction-`.
    pub fn own(&self) -> impl Iterator<Item = &str> {
        self.dependencies()
            .filter_map(|(name, _)| name.strip_prefix("stiction-"))
    }
}

/// The values of a list such as `features = ["a", "b"]` in a dependency.
fn list(value: &str, key: &str) -> Vec<String> {
    let Some(at) = value.find(&format!("{key} = [")) else {
        return Vec::new();
    };
    let inside = value[at..].split(['[', ']']).nth(1).unwrap_or_default();
    let items = inside.split(',').map(|item| item.trim().trim_matches('"'));
    items
        .filter(|item| !item.is_empty())
        .map(str::to_owned)
        .collect()
}

/// A dependency on a crate of others.
#[derive(Default)]
struct Dependency {
    features: Vec<String>,
    optional: bool,
}

/// Dependencies of several manifests as those of one.
#[derive(Default)]
pub struct Dependencies(BTreeMap<String, Dependency>);

impl Dependencies {
    /// Adds those of a part; `optional` where the package can do without the part. Returns their names.
    pub fn add(&mut self, part: &Manifest, optional: bool) -> Vec<String> {
        let others = part.dependencies();
        let others =
            others.filter(|(name, _)| *name != "stiction" && !name.starts_with("stiction-"));
        let mut names = Vec::new();
        for (name, value) in others {
            let optional = optional || value.contains("optional = true");
            let known = self.0.contains_key(name);
            let entry = self.0.entry(name.to_owned()).or_default();
            entry.optional = optional && (!known || entry.optional);
            for feature in list(value, "features") {
                if !entry.features.contains(&feature) {
                    entry.features.push(feature);
                }
            }
            names.push(name.to_owned());
        }
        names
    }

    /// Those of `names` that are optional, as features name them.
    pub fn optional(&self, names: &[String]) -> Vec<String> {
        let optional = names.iter().filter(|name| self.0[*name].optional);
        optional.map(|name| format!("dep:{name}")).collect()
    }

    /// Their lines, with the versions of the workspace.
    pub fn lines(&self, workspace: &Manifest) -> Result<Vec<String>, String> {
        let mut lines = Vec::new();
        for (name, wanted) in &self.0 {
            let mut known = workspace.pairs("workspace.dependencies");
            let (_, value) = known
                .find(|(known, _)| known == name)
                .ok_or_else(|| format!("Cargo.toml has no version of {name}"))?;
            let version = match value.starts_with('"') {
                true => value.to_owned(),
                false => {
                    let at = value.find("version = ").map(|at| &value[at + 10..]);
                    let end = at.and_then(|v| v.get(1..)?.find('"').map(|end| &v[..end + 2]));
                    end.ok_or_else(|| format!("{name} has no version"))?
                        .to_owned()
                }
            };
            let mut parts = vec![format!("version = {version}")];
            if value.contains("default-features = false") {
                parts.push("default-features = false".into());
            }
            let mut features = list(value, "features");
            features.extend(wanted.features.iter().cloned());
            features.sort();
            features.dedup();
            if !features.is_empty() {
                parts.push(format!("features = {features:?}"));
            }
            if wanted.optional {
                parts.push("optional = true".into());
            }
            lines.push(format!("{name} = {{ {} }}", parts.join(", ")));
        }
        Ok(lines)
    }
}

/// The `[package]` section of a part with the values of the workspace, but for the files that it takes along.
pub fn package(part: &Manifest, workspace: &Manifest) -> Result<Vec<String>, String> {
    let mut lines = Vec::new();
    for (key, value) in part.pairs("package") {
        if key == "include" || key.starts_with("publish") {
            continue;
        }
        let Some(key) = key.strip_suffix(".workspace") else {
            lines.push(format!("{key} = {value}"));
            continue;
        };
        let mut known = workspace.pairs("workspace.package");
        let (_, value) = known
            .find(|(known, _)| *known == key)
            .ok_or_else(|| format!("the workspace has no {key}"))?;
        lines.push(format!("{key} = {value}"));
    }
    Ok(lines)
}

/// Sections of metadata of parts, the first of each name.
pub fn metadata(parts: &[&Manifest]) -> String {
    let mut named: Vec<&str> = Vec::new();
    let mut text = String::new();
    for (name, lines) in parts.iter().flat_map(|part| &part.0) {
        if name.starts_with("package.metadata") && !named.contains(&name.as_str()) {
            named.push(name);
            text += &section(name, lines);
        }
    }
    text
}

/// A section as text.
pub fn section(name: &str, lines: &[String]) -> String {
    format!("\n[{name}]\n{}\n", lines.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependencies_of_parts_are_those_of_one() {
        let workspace = Manifest::parse(
            "[workspace.dependencies]\nlibm = \"0.2\"\nzip = { version = \"9\", default-features = false, features = [\"deflate\"] }\n",
        );
        let library = Manifest::parse(
            "[dependencies]\nstiction-log.workspace = true\nlibm.workspace = true\n",
        );
        let program = Manifest::parse(
            "[dependencies]\nlibm = { workspace = true, features = [\"arch\"] }\nzip.workspace = true\n",
        );
        let mut all = Dependencies::default();
        all.add(&library, false);
        let names = all.add(&program, true);
        assert_eq!(all.optional(&names), ["dep:zip"]);
        assert_eq!(
            all.lines(&workspace).unwrap(),
            [
                "libm = { version = \"0.2\", features = [\"arch\"] }",
                "zip = { version = \"9\", default-features = false, features = [\"deflate\"], optional = true }",
            ]
        );
        assert_eq!(library.own().collect::<Vec<_>>(), ["log"]);
    }
}
