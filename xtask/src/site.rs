//! The site of the documentation, from `docs/` and what the programs print; strict, and without the network.

mod fetched;
mod links;

use crate::shell::{self, Outcome, cargo};
use crate::{python, wheel};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// What the site is built with, and its navigation.
const CONFIGURATION: &str = "docs/site.toml";
/// Pages from outside `docs/`, and what they are called in the site.
const PAGES: [(&str, &str); 5] = [
    ("README.md", "index.md"),
    ("ARCHITECTURE.md", "ARCHITECTURE.md"),
    ("CONTRIBUTING.md", "CONTRIBUTING.md"),
    ("CHANGELOG.md", "CHANGELOG.md"),
    ("crates/pages/src/glossary/terms.md", "glossary.md"),
];
const NOTEBOOK: &str = "examples/python/first_log.ipynb";
/// What the tool has pages fetch so that the search works from files, and what stands in for it.
const SHIM: &str = "https://unpkg.com/iframe-worker/shim";
const WORKER: &str = include_str!("site/worker.js");
/// What prints pages.
const BUILD: &str = "build --workspace --lib --bins --example table";

/// Builds the programs that print pages, then the site.
pub fn run() -> Outcome {
    shell::run(shell::linted(cargo(BUILD)))?;
    wheel::run_notebook(NOTEBOOK)?;
    build()
}

/// Builds the site with programs that are built and a notebook that has run.
pub fn build() -> Outcome {
    let pages = shell::target().join("site-source");
    // A page that was removed is gone from the site too.
    let _ = fs::remove_dir_all(&pages);
    for (file, page) in files()? {
        let (from, to) = (shell::root().join(&file), pages.join(page));
        if file.ends_with(".md") {
            let text = fs::read_to_string(&from).map_err(|e| format!("{file}: {e}"))?;
            write(&to, &links::rewritten(&file, &text)?)?;
        } else if ["svg", "png"].iter().any(|end| file.ends_with(end)) {
            write(&to, fs::read(&from).map_err(|e| format!("{file}: {e}"))?)?;
        }
    }
    write(&pages.join("commands.md"), commands()?)?;
    let table = shell::target().join("debug/examples/table");
    let table = shell::output(shell::command(&text(&table), &[]))?;
    let thresholds = format!("# Thresholds\n\nPrinted by `cargo xtask policy`.\n\n{table}");
    write(&pages.join("thresholds.md"), thresholds)?;
    let notebook = wheel::notebook();
    let notebook =
        fs::read_to_string(&notebook).map_err(|e| format!("{}: {e}", notebook.display()))?;
    write(
        &pages.join("first-log.md"),
        links::rewritten(NOTEBOOK, &notebook)?,
    )?;

    let configuration = shell::root().join(CONFIGURATION);
    let configuration = fs::read_to_string(configuration).map_err(|e| e.to_string())?;
    in_navigation(&pages, &configuration)?;
    let file = shell::target().join("zensical.toml");
    write(&file, configuration)?;
    let build = ["-m", "zensical", "build", "--strict", "-f", &text(&file)];
    shell::run(shell::command(&python::environment()?, &build))?;
    let site = shell::target().join("site");
    carries_its_worker(&site)?;
    fetches_nothing(&site)
}

/// Every file of the site by its path in the tree, with its path in the site.
fn files() -> Result<Vec<(String, String)>, String> {
    let listed = [
        "ls-files",
        "--cached",
        "--others",
        "--exclude-standard",
        "docs",
    ];
    let listed = shell::output(shell::command("git", &listed))?;
    let docs = listed.lines().filter_map(|file| {
        let page = file.strip_prefix("docs/")?;
        // A file that was removed is listed until that is committed.
        shell::root()
            .join(file)
            .is_file()
            .then(|| (file.into(), page.into()))
    });
    let others = PAGES.iter().map(|&(file, page)| (file.into(), page.into()));
    Ok(docs.chain(others).collect())
}

/// The help of every command.
fn commands() -> Result<String, String> {
    let program = text(&shell::target().join("debug/stiction"));
    let help = |words: &[&str]| shell::output(shell::command(&program, words));
    let all = help(&["help"])?;
    let mut page = format!("# Commands\n\n```text\n{}```\n", all);
    let names = all
        .lines()
        .skip_while(|line| !line.starts_with("Commands:"))
        .skip(1)
        .take_while(|line| !line.is_empty());
    for line in names {
        // What is set further in goes on with the line above.
        let name = line
            .strip_prefix("  ")
            .filter(|line| !line.starts_with(' '));
        let Some(name) = name.and_then(|line| line.split(' ').next()) else {
            continue;
        };
        if name != "help" {
            let own = help(&["help", name])?;
            let _ = write!(page, "\n## {name}\n\n```text\n{own}```\n");
        }
    }
    Ok(page)
}

/// Refuses a page that neither the navigation nor the first page of its folder leads to.
fn in_navigation(pages: &Path, configuration: &str) -> Outcome {
    let mut lost = Vec::new();
    for page in below(pages)? {
        let path = page.strip_prefix(pages).map_err(|e| e.to_string())?;
        let name = text(path);
        if !name.ends_with(".md") || configuration.contains(&format!("\"{name}\"")) {
            continue;
        }
        let first = page.with_file_name("README.md");
        let own = page.file_name().unwrap_or_default().to_string_lossy();
        let led = fs::read_to_string(first).is_ok_and(|first| first.contains(&format!("]({own}")));
        if !led {
            lost.push(name);
        }
    }
    match lost.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "no way leads to {}; name them in {CONFIGURATION}",
            lost.join(", ")
        )),
    }
}

/// Has pages take the script of their search from the site.
fn carries_its_worker(site: &Path) -> Outcome {
    write(&site.join("worker.js"), WORKER)?;
    for file in below(site)? {
        if file.extension().is_some_and(|end| end == "html") {
            let page = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
            let path = file.strip_prefix(site).map_err(|e| e.to_string())?;
            let up = "../".repeat(path.components().count() - 1);
            write(&file, page.replace(SHIM, &format!("{up}worker.js")))?;
        }
    }
    Ok(())
}

/// Refuses a site whose pages fetch scripts, styles, fonts or pictures from elsewhere.
fn fetches_nothing(site: &Path) -> Outcome {
    for file in below(site)? {
        let marks = match file.extension().and_then(|end| end.to_str()) {
            Some("html") => fetched::HTML,
            Some("css") => fetched::CSS,
            _ => continue,
        };
        let page = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
        if let Some(part) = fetched::first(&page, marks) {
            let file = file.display();
            return Err(format!("{file}: `{part}` is fetched from elsewhere"));
        }
    }
    Ok(())
}

/// Every file below a folder.
fn below(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            files.extend(below(&path)?);
        } else {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn write(file: &Path, content: impl AsRef<[u8]>) -> Outcome {
    let folder = file.parent().unwrap_or(file);
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(file, content))
        .map_err(|e| format!("{}: {e}", file.display()))
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
