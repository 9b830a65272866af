//! Links of the documentation as they are in the site: pages keep their relative links, other files lead to the repository.

use super::PAGES;
use crate::{release, shell};
use std::path::{Component, Path, PathBuf};

/// The text of a page with its links changed; `file` is its path in the tree. A link to nothing is an error.
pub fn rewritten(file: &str, page: &str) -> Result<String, String> {
    let mut out = String::new();
    let mut is_code = false;
    for line in page.split_inclusive('\n') {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        }
        let mut rest = line;
        while let Some((before, after)) = rest.split_once("](").filter(|_| !is_code) {
            let (target, after) = after.split_once(')').unwrap_or((after, ""));
            out += before;
            out += "](";
            out += &link(file, target)?;
            out.push(')');
            rest = after;
        }
        out += rest;
    }
    Ok(out)
}

/// Where a link of that file leads in the site.
fn link(file: &str, target: &str) -> Result<String, String> {
    if target.contains("://") || target.starts_with('#') || target.starts_with("mailto:") {
        return Ok(target.into());
    }
    let (path, anchor) = target
        .split_once('#')
        .map_or((target, String::new()), |(path, anchor)| {
            (path, format!("#{anchor}"))
        });
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    let path = plain(&folder.join(path));
    let on_disk = shell::root().join(&path);
    if let Some(page) = in_site(&path).filter(|_| on_disk.is_file()) {
        // Below `docs/` everything is where it was.
        if file.starts_with("docs/") && path.starts_with("docs/") {
            return Ok(target.into());
        }
        let here = in_site(file).unwrap_or_default();
        let up = "../".repeat(here.matches('/').count());
        return Ok(format!("{up}{page}{anchor}"));
    }
    match (on_disk.is_file(), on_disk.is_dir()) {
        (true, _) => Ok(format!(
            "{}/blob/main/{path}{anchor}",
            release::repository()?
        )),
        (_, true) => Ok(format!("{}/tree/main/{path}", release::repository()?)),
        _ => Err(format!("{file}: the link `{target}` leads to no file")),
    }
}

/// Where a file of the tree is in the site.
fn in_site(file: &str) -> Option<String> {
    let page = PAGES
        .iter()
        .find(|(own, _)| *own == file)
        .map(|(_, page)| *page);
    page.or_else(|| file.strip_prefix("docs/"))
        .map(String::from)
}

/// A path without `.` and `..`.
fn plain(path: &Path) -> String {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(out.pop()),
            Component::CurDir => {}
            part => out.push(part),
        }
    }
    out.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_where_they_led_in_the_tree() {
        let cases = [
            ("README.md", "docs/axis.md#drive", "axis.md#drive"),
            ("docs/codes/gap.md", "../axis.md", "../axis.md"),
            ("docs/python.md", "../README.md", "index.md"),
            (
                "docs/decisions/README.md",
                "../../CONTRIBUTING.md",
                "../CONTRIBUTING.md",
            ),
            ("docs/axis.md", "#terms", "#terms"),
            ("docs/axis.md", "https://doi.org/x", "https://doi.org/x"),
        ];
        for (file, target, expected) in cases {
            assert_eq!(link(file, target).as_deref(), Ok(expected), "{file}");
        }
        let outside = link("docs/validation.md", "../validation/emps.toml").unwrap();
        assert!(
            outside.ends_with("/blob/main/validation/emps.toml"),
            "{outside}"
        );
        assert!(link("docs/axis.md", "no-page.md").is_err());
        let code = "```\na](no-page.md)\n```\n";
        assert_eq!(rewritten("docs/axis.md", code).as_deref(), Ok(code));
    }
}
