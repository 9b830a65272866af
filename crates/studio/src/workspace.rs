//! The folder that the page works in. Nothing outside of it is read or written: a name that could lead out of it, by its own
//! form or through a link, is refused.

use crate::forward;
use crate::origin::{self, Log};
use crate::refused::Refused;
use serde::Serialize;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;
use stiction_files::Axis;
use stiction_files::batch::RESULTS;

/// Most folders below each other.
const DEEPEST: usize = 6;
/// Folders below each other that are listed.
const LISTED_DEEP: usize = 3;
/// Most entries that are listed.
const MOST_LISTED: usize = 2000;
/// Longest name of a file or folder, bytes.
const LONGEST: usize = 200;
/// Largest text that is read, bytes.
const LARGEST_TEXT: u64 = 64 << 20;
/// Beginning of the names of uploads that are not whole yet.
pub const UNFINISHED: &str = ".stiction-upload-";

/// Endings of recordings.
const LOGS: [&str; 27] = [
    "csv", "tsv", "txt", "log", "dat", "asc", "mat", "h5", "hdf5", "npy", "npz", "parquet", "json",
    "arrow", "feather", "ipc", "mcap", "db3", "tdms", "mf4", "svb", "svbx", "svdx", "xlsx", "xml",
    "pcap", "pcapng",
];
/// Names of devices on Windows, which no folder holds as files.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// The folder.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// What stands before a name: nothing where the folder is the working directory, so that results name their inputs as the
    /// command line does in that folder.
    base: PathBuf,
    real: PathBuf,
}

/// A file or folder of it.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    /// From the workspace, with `/`.
    pub name: String,
    /// What it is for the page: `log`, `axis`, `model`, `study`, `plan`, `table`, `result`, `studied`, `planned`, `folder`
    /// or `other`.
    pub kind: &'static str,
    /// Size of a file, bytes.
    pub bytes: u64,
    /// When it was changed last, ms since 1970.
    pub modified: u64,
    /// The logs that it comes from.
    pub of: Vec<Log>,
}

impl Workspace {
    /// Takes a folder that is there.
    pub fn open(folder: &Path) -> std::io::Result<Self> {
        let real = folder.canonicalize()?;
        if !real.is_dir() {
            return Err(std::io::Error::other("not a folder"));
        }
        let here = std::env::current_dir().and_then(|dir| dir.canonicalize());
        let base = match here.is_ok_and(|here| here == real) {
            true => PathBuf::new(),
            false => real.clone(),
        };
        Ok(Self { base, real })
    }

    /// The folder itself.
    pub fn folder(&self) -> &Path {
        &self.real
    }

    /// The path of a name, which need not be there yet.
    pub fn place(&self, name: &str) -> Result<PathBuf, Refused> {
        let parts = parts(name)?;
        let mut real = self.real.clone();
        for part in &parts {
            real.push(part);
            match fs::symlink_metadata(&real) {
                Ok(about) if about.is_symlink() => {
                    return Err(Refused::forbidden(format!(
                        "{name}: goes through a link; the page stays in its folder"
                    )));
                }
                Ok(_) => {}
                // What is not there leads nowhere.
                Err(_) => break,
            }
        }
        Ok(parts
            .iter()
            .fold(self.base.clone(), |path, part| path.join(part)))
    }

    /// The path of a file that is there.
    pub fn file(&self, name: &str) -> Result<PathBuf, Refused> {
        let path = self.place(name)?;
        match fs::symlink_metadata(&path) {
            Ok(about) if about.is_file() => Ok(path),
            _ => Err(Refused::missing(format!("{name}: no such file"))),
        }
    }

    /// The path of a folder that is there.
    pub fn dir(&self, name: &str) -> Result<PathBuf, Refused> {
        let path = self.place(name)?;
        match fs::symlink_metadata(&path) {
            Ok(about) if about.is_dir() => Ok(path),
            _ => Err(Refused::missing(format!("{name}: no such folder"))),
        }
    }

    /// The path of an axis file, which need not be there yet, and its text, if it is.
    pub fn axis(&self, name: &str) -> Result<(PathBuf, Option<String>), Refused> {
        if kind_of_file(name) != "axis" {
            return Err(Refused::bad(format!(
                "{name}: an axis file ends in .toml, without model, study or plan in its name"
            )));
        }
        let path = self.place(name)?;
        if fs::symlink_metadata(&path).is_err() {
            return Ok((path, None));
        }
        // What the engine cannot read is not written over, and its words say what is wrong.
        Axis::read(self.file(name)?)?;
        Ok((path, Some(self.text(name)?)))
    }

    /// Refuses a path that a file of the workspace names and that lies outside of it.
    pub fn holds(&self, path: &Path) -> Result<(), Refused> {
        let whole = self.real.join(path);
        let real = whole.canonicalize().unwrap_or(whole);
        let plain = !real
            .components()
            .any(|part| matches!(part, std::path::Component::ParentDir));
        match plain && real.starts_with(&self.real) {
            true => Ok(()),
            false => Err(Refused::forbidden(format!(
                "{}: lies outside of the folder of this page; use the command line for it",
                path.display()
            ))),
        }
    }

    /// Refuses a TOML text whose words lead to a file outside, seen from the folder that it is in.
    pub fn holds_named(&self, text: &str, file: &Path) -> Result<(), Refused> {
        self.named(text, file)
            .iter()
            .try_for_each(|path| self.holds(path))
    }

    /// What the words of a TOML text lead to, seen from the folder that it is in. Whatever a word means there, what it would be
    /// the path of is known before the engine reads it.
    pub fn named(&self, text: &str, file: &Path) -> Vec<PathBuf> {
        let folder = self.real.join(file.parent().unwrap_or(Path::new("")));
        // What cannot be parsed names nothing; the engine says what is wrong with it.
        let root = text.parse::<toml::Table>().unwrap_or_default();
        let mut rest: Vec<&toml::Value> = root.values().collect();
        let mut paths = Vec::new();
        while let Some(value) = rest.pop() {
            match value {
                toml::Value::Array(all) => rest.extend(all),
                toml::Value::Table(all) => rest.extend(all.values()),
                toml::Value::String(word) => paths.push(folder.join(word)),
                _ => {}
            }
        }
        paths.retain(|path| path.symlink_metadata().is_ok());
        paths
    }

    /// The name of a file that is there, by its path from the working directory of who wrote it, which was the folder.
    pub fn name(&self, path: &Path) -> Option<String> {
        let real = self.real.join(path).canonicalize().ok()?;
        let own = real.strip_prefix(&self.real).ok()?.to_str()?;
        Some(own.replace(std::path::MAIN_SEPARATOR, "/"))
    }

    /// The text of a file that is there.
    pub fn text(&self, name: &str) -> Result<String, Refused> {
        let mut out = String::new();
        let file = fs::File::open(self.file(name)?)?;
        file.take(LARGEST_TEXT + 1).read_to_string(&mut out)?;
        match out.len() as u64 > LARGEST_TEXT {
            true => Err(Refused::too_large(format!(
                "{name}: more than {LARGEST_TEXT} bytes"
            ))),
            false => Ok(out),
        }
    }

    /// What is in it, sorted by name; links and what begins with a dot are left out.
    pub fn list(&self) -> Vec<Entry> {
        let mut out = Vec::new();
        walk(&self.real, "", LISTED_DEEP, &mut out);
        out.sort_by(|a, b| a.name.cmp(&b.name));
        for entry in &mut out {
            entry.of = origin::logs(self, entry);
        }
        out
    }

    /// Removes what an earlier run left when it was ended: unfinished uploads, and files that open its page.
    pub fn tidy(&self) {
        let entries = fs::read_dir(&self.real).into_iter().flatten().flatten();
        for entry in entries {
            let name = entry.file_name();
            let (name, path) = (name.to_string_lossy(), entry.path());
            // What cannot be removed is in nobody's way.
            let _ = match entry.file_type() {
                Ok(kind) if kind.is_file() && name.starts_with(UNFINISHED) => fs::remove_file(path),
                Ok(kind) if kind.is_dir() && name.starts_with(forward::PREFIX) => {
                    fs::remove_dir_all(path)
                }
                _ => Ok(()),
            };
        }
    }
}

/// The parts of a name, each of which is plain on every system.
fn parts(name: &str) -> Result<Vec<&str>, Refused> {
    let refuse = |why: &str| {
        let shown: String = name
            .chars()
            .take(80)
            .flat_map(char::escape_default)
            .collect();
        Refused::forbidden(format!("{shown}: {why}"))
    };
    if name.is_empty() {
        return Err(refuse("a name is needed"));
    }
    let parts: Vec<&str> = name.split('/').collect();
    if parts.len() > DEEPEST {
        return Err(refuse("too many folders below each other"));
    }
    for part in &parts {
        if part.is_empty() || *part == "." || *part == ".." {
            return Err(refuse("a name within the folder, without . and .."));
        }
        if part.len() > LONGEST {
            return Err(refuse("a name of at most 200 bytes"));
        }
        let odd = |c: char| c.is_control() || "\\:*?\"<>|".contains(c);
        if part.contains(odd) {
            return Err(refuse(
                "a name without \\ : * ? \" < > | and control characters",
            ));
        }
        if part.starts_with(['.', '-', '~']) || part.ends_with(['.', ' ']) {
            return Err(refuse(
                "a name that does not begin with . - ~ or end with . or a blank",
            ));
        }
        let stem = part.split('.').next().unwrap_or_default().trim_end();
        let stem = stem.to_ascii_lowercase();
        let numbered = ["com", "lpt"].iter().any(|device| {
            stem.strip_prefix(device)
                .is_some_and(|n| n.chars().count() == 1)
        });
        if numbered || DEVICES.contains(&stem.as_str()) {
            return Err(refuse("the name of a device on Windows"));
        }
    }
    Ok(parts)
}

fn walk(dir: &Path, before: &str, deep: usize, out: &mut Vec<Entry>) {
    let entries = fs::read_dir(dir).into_iter().flatten().flatten();
    for entry in entries {
        if out.len() >= MOST_LISTED {
            return;
        }
        let (Ok(name), Ok(about)) = (entry.file_name().into_string(), entry.metadata()) else {
            continue;
        };
        let whole = match before {
            "" => name.clone(),
            before => format!("{before}/{name}"),
        };
        // What cannot be named here cannot be asked for either.
        if parts(&whole).is_err() || about.is_symlink() {
            continue;
        }
        let modified = about.modified().ok();
        let modified = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        out.push(Entry {
            kind: match about.is_dir() {
                true => kind_of_folder(&entry.path()),
                false => kind_of_file(&name),
            },
            name: whole.clone(),
            bytes: about.len(),
            modified: modified.map_or(0, |since| since.as_millis() as u64),
            of: Vec::new(),
        });
        if about.is_dir() && deep > 1 {
            walk(&entry.path(), &whole, deep - 1, out);
        }
    }
}

fn kind_of_folder(path: &Path) -> &'static str {
    let has = |name: &str| path.join(name).is_file();
    match () {
        () if has("result.json") => "result",
        () if has("study.json") => "studied",
        () if has("plan.toml") => "planned",
        () => "folder",
    }
}

/// What a file is for the page, by its name.
pub fn kind_of_file(name: &str) -> &'static str {
    let lower = name.to_ascii_lowercase();
    let written = [
        "result.json",
        "study.json",
        "compare.json",
        "reproduce.json",
        "batch.json",
        "drift.json",
        "fit.csv",
        "trajectories.csv",
        "contours.csv",
        "setpoints.csv",
    ];
    if written.contains(&lower.as_str()) {
        return "other";
    }
    if lower == RESULTS {
        return "table";
    }
    let (stem, ending) = lower.rsplit_once('.').unwrap_or((&lower, ""));
    match ending {
        "toml" if stem.ends_with(".axis") => "axis",
        "toml" if stem.contains("model") => "model",
        "toml" if stem.contains("study") => "study",
        "toml" if stem.contains("plan") => "plan",
        "toml" => "axis",
        ending if LOGS.contains(&ending) => "log",
        _ => "other",
    }
}

#[cfg(test)]
mod tests {
    use super::Workspace;
    use proptest::prelude::*;
    use std::path::Path;

    fn workspace() -> (tempfile::TempDir, Workspace) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("in")).unwrap();
        std::fs::write(folder.path().join("in/log.csv"), "t\n").unwrap();
        let space = Workspace::open(folder.path()).unwrap();
        (folder, space)
    }

    #[test]
    fn names_that_could_lead_out_are_refused() {
        let (_folder, space) = workspace();
        for name in [
            "",
            ".",
            "..",
            "../x",
            "in/../../x",
            "in/..",
            "/etc/passwd",
            "//server/x",
            "in//log.csv",
            "C:\\x",
            "C:x",
            "\\\\?\\C:\\x",
            "in\\..\\x",
            "a\0b",
            "a\nb",
            "log.csv:stream",
            "NUL",
            "con.csv",
            "Com1.txt",
            "lpt9",
            "a.",
            "a ",
            ".hidden",
            "-option",
            "~/x",
            "a/b/c/d/e/f/g",
        ] {
            assert!(space.place(name).is_err(), "{name:?}");
        }
        assert!(space.place(&"a".repeat(201)).is_err());
        for name in ["in/log.csv", "new.csv", "Läufe/März 3.csv", "a..b.csv"] {
            assert!(space.place(name).is_ok(), "{name:?}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        let (folder, space) = workspace();
        let outside = tempfile::tempdir().unwrap();
        std::fs::write(outside.path().join("secret.csv"), "x").unwrap();
        let link = |to: &Path, name: &str| {
            std::os::unix::fs::symlink(to, folder.path().join(name)).unwrap();
        };
        link(outside.path(), "out");
        link(&outside.path().join("secret.csv"), "secret.csv");
        link(&outside.path().join("not there"), "dangling.csv");
        for name in [
            "out/secret.csv",
            "out/new.csv",
            "out",
            "secret.csv",
            "dangling.csv",
        ] {
            assert!(space.place(name).is_err(), "{name}");
        }
        assert!(space.holds(Path::new("out/secret.csv")).is_err());
        assert!(space.holds(Path::new("../x")).is_err());
        assert!(space.holds(outside.path()).is_err());
        assert!(space.holds(Path::new("in/log.csv")).is_ok());
        let names: Vec<String> = space.list().into_iter().map(|entry| entry.name).collect();
        assert_eq!(names, ["in", "in/log.csv"]);
    }

    proptest! {
        #[test]
        fn what_is_taken_stays_below_the_folder(name in "[a-z./\\\\:~ \\-\0]{0,16}") {
            let (folder, space) = workspace();
            if let Ok(path) = space.place(&name) {
                let real = folder.path().canonicalize().unwrap();
                let rest = path.strip_prefix(&real).unwrap();
                let plain = |c: std::path::Component<'_>| matches!(c, std::path::Component::Normal(_));
                prop_assert!(rest.components().all(plain), "{name:?}");
            }
        }
    }
}
