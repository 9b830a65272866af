//! A list of logs: `path`, and where they are known `machine`, `time`, `temperature` and `axis`.

use super::time::seconds_of;
use crate::error::Error;
use crate::shell;
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// One log of a list.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Listed {
    /// The log.
    pub path: PathBuf,
    /// Machine that it is of.
    pub machine: Option<String>,
    /// When it was recorded, s.
    pub time: Option<f64>,
    /// Temperature, in the unit of all of the list.
    pub temperature: Option<f64>,
    /// Its axis file.
    pub axis: Option<PathBuf>,
}

impl Listed {
    /// Takes what another mention of the same log says and this one leaves open.
    pub fn take(&mut self, other: Listed) {
        self.machine = self.machine.take().or(other.machine);
        self.time = self.time.or(other.time);
        self.temperature = self.temperature.or(other.temperature);
        self.axis = self.axis.take().or(other.axis);
    }
}

/// The columns that a list may have.
const COLUMNS: [&str; 5] = ["path", "machine", "time", "temperature", "axis"];
/// Longest first line that is looked at, bytes.
const LONGEST_HEADER: u64 = 1 << 16;
/// Largest list, bytes: some million logs.
const LARGEST: u64 = 1 << 30;

/// Whether a file is a list of logs, rather than a log: text whose first line has a cell `path` and mostly columns of a list, or
/// nothing but other columns of one, which is refused for what is missing.
pub fn is_list(file: &Path) -> bool {
    if !stiction_formats::is_regular(file) {
        return false;
    }
    let Ok(opened) = File::open(file) else {
        return false;
    };
    let mut line = String::new();
    let read = BufReader::new(opened.take(LONGEST_HEADER)).read_line(&mut line);
    let cells = || line.trim_start_matches('\u{feff}').split([',', ';', '\t']);
    let any = |name: &str| cells().any(|cell| named(cell, name));
    let known = |cell: &&str| COLUMNS.iter().any(|name| named(cell, name));
    let only = || cells().all(|cell| known(&cell));
    let mostly = || 2 * cells().filter(known).count() >= cells().count();
    read.is_ok() && (any("path") && mostly() || (any("machine") || any("axis")) && only())
}

fn named(cell: &str, name: &str) -> bool {
    let cell = cell.trim();
    let bare = cell.strip_prefix('"').and_then(|c| c.strip_suffix('"'));
    bare.unwrap_or(cell).trim().eq_ignore_ascii_case(name)
}

/// Whether a path is the address of something elsewhere (`s3://..`), which programs on top of this one fetch.
pub fn is_address(path: &Path) -> bool {
    let text = path.to_string_lossy();
    text.split_once("://").is_some_and(|(scheme, _)| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "+-.:".contains(c);
        !scheme.is_empty() && scheme.chars().all(plain)
    })
}

/// Reads a list; paths in it are relative to its folder, but for addresses.
///
/// # Errors
/// With the row and the column, and what is allowed there.
pub fn read_list(file: &Path) -> Result<Vec<Listed>, Error> {
    let refused = |place: String, found: String, allowed: &str| Error::Config {
        file: file.to_path_buf(),
        place,
        found,
        allowed: allowed.into(),
    };
    let mut text = String::new();
    let read = File::open(file).and_then(|f| f.take(LARGEST + 1).read_to_string(&mut text));
    match read {
        Err(e) => {
            let allowed = "a list of logs is text in UTF-8";
            return Err(refused(
                String::new(),
                format!("cannot be read ({e})"),
                allowed,
            ));
        }
        Ok(bytes) if bytes as u64 > LARGEST => {
            let allowed = "several lists, each with results of its own";
            return Err(refused(
                String::new(),
                "is larger than 1 GiB".into(),
                allowed,
            ));
        }
        Ok(_) => {}
    }
    let text = text.trim_start_matches('\u{feff}');
    let header = text.lines().next().unwrap_or_default();
    let separator = [',', ';', '\t']
        .into_iter()
        .max_by_key(|s| (header.matches(*s).count(), *s == ','));
    let mut rows = csv::ReaderBuilder::new()
        .delimiter(separator.unwrap_or(',') as u8)
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut rows = rows.records();
    let broken = |e: csv::Error| {
        refused(
            String::new(),
            e.to_string(),
            "lines of cells with commas between",
        )
    };
    let head = rows.next().transpose().map_err(broken)?.unwrap_or_default();
    let mut places: HashMap<&str, usize> = HashMap::new();
    for (at, cell) in head.iter().enumerate() {
        let Some(name) = COLUMNS.into_iter().find(|name| named(cell, name)) else {
            let allowed =
                "columns: path, and where they are known machine, time, temperature, axis";
            return Err(refused(
                format!("line 1, column {}: ", at + 1),
                format!("{cell:?}"),
                allowed,
            ));
        };
        if let Some(before) = places.insert(name, at) {
            let found = format!("{name} is column {} already", before + 1);
            return Err(refused(
                format!("line 1, column {}: ", at + 1),
                found,
                "each column once",
            ));
        }
    }
    if !places.contains_key("path") {
        let found = "has no column path".to_string();
        let allowed = "path, the log of each row, from the folder of the list";
        return Err(refused("line 1: ".into(), found, allowed));
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    let from_there = |path: &str| match is_address(Path::new(path)) {
        true => PathBuf::from(path),
        false => folder.join(path),
    };
    let mut seen: HashMap<PathBuf, u64> = HashMap::new();
    let mut numbers = None;
    let mut out = Vec::new();
    for cells in rows {
        let cells = cells.map_err(broken)?;
        let row = cells.position().map_or(0, |at| at.line());
        let cell = |name: &str| {
            let text = cells.get(*places.get(name)?)?;
            (!text.is_empty()).then_some(text)
        };
        let at = |name: &str| format!("line {row}, column {name}: ");
        if cells.len() != head.len() {
            let found = stiction_number::counted(cells.len(), "cell");
            let allowed = format!("{}, as line 1 has", head.len());
            return Err(refused(format!("line {row}: "), found, &allowed));
        }
        let Some(path) = cell("path") else {
            return Err(refused(
                at("path"),
                "is empty".into(),
                "the path of a log, from the folder of the list",
            ));
        };
        let path = from_there(path);
        // One log may have several paths.
        let place = path.canonicalize().unwrap_or_else(|_| path.clone());
        if let Some(before) = seen.insert(place, row) {
            let found = format!("{} is in line {before} already", shell::text(&path));
            return Err(refused(at("path"), found, "each log once"));
        }
        let time = cell("time").map(|text| {
            let allowed = "a time in ISO 8601, as 2026-03-01T06:30:00Z, or a number of seconds";
            seconds_of(text).ok_or_else(|| refused(at("time"), format!("{text:?}"), allowed))
        });
        if let Some(text) = cell("time") {
            let number = text.parse::<f64>().is_ok();
            if *numbers.get_or_insert(number) != number {
                let allowed = "all times of a list in ISO 8601, or all as numbers of seconds";
                let before = if number { "dates" } else { "seconds" };
                let found = format!("{text:?} in a list whose times before it are {before}");
                return Err(refused(at("time"), found, allowed));
            }
        }
        let temperature = cell("temperature").map(|text| {
            let number = text.parse().ok().filter(|x: &f64| x.is_finite());
            number.ok_or_else(|| refused(at("temperature"), format!("{text:?}"), "a number"))
        });
        out.push(Listed {
            path,
            machine: cell("machine").map(String::from),
            time: time.transpose()?,
            temperature: temperature.transpose()?,
            axis: cell("axis").map(from_there),
        });
    }
    if out.is_empty() {
        return Err(refused(
            String::new(),
            "lists no logs".into(),
            "a row for each log",
        ));
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn said(text: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("list.csv");
        std::fs::write(&file, text).unwrap();
        match read_list(&file) {
            Ok(found) => format!("{found:?}"),
            Err(e) => e
                .to_string()
                .replace(&folder.path().display().to_string(), "DIR"),
        }
    }

    #[cfg(unix)]
    #[test]
    fn one_log_by_two_paths_is_refused_with_its_row() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("a.csv"), "t,x\n").unwrap();
        std::os::unix::fs::symlink(at("a.csv"), at("b.csv")).unwrap();
        std::fs::write(at("list.csv"), "path,machine\na.csv,A\nb.csv,B\n").unwrap();
        let refused = read_list(&at("list.csv")).unwrap_err().to_string();
        assert!(refused.contains("line 3, column path: "), "{refused}");
        assert!(refused.contains("is in line 2 already"), "{refused}");
    }

    #[test]
    fn a_list_is_read_with_any_of_its_columns() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("list.csv");
        let text = "\u{feff}Machine; path;time ;temperature;axis\nA 7;a.csv;2026-03-01;21.5;x.toml\n;\"b; c.csv\";2026-03-02;;\n";
        std::fs::write(&file, text).unwrap();
        assert!(is_list(&file));
        let first = Listed {
            path: folder.path().join("a.csv"),
            machine: Some("A 7".into()),
            time: Some(1_772_323_200.0),
            temperature: Some(21.5),
            axis: Some(folder.path().join("x.toml")),
        };
        let second = Listed {
            path: folder.path().join("b; c.csv"),
            time: Some(1_772_409_600.0),
            ..Listed::default()
        };
        assert_eq!(read_list(&file).unwrap(), [first, second]);
        std::fs::write(&file, "machine;time\nA;1\n").unwrap();
        assert!(is_list(&file));
        std::fs::write(&file, "time,position,force\n0,0,0\n").unwrap();
        assert!(!is_list(&file) && !is_list(folder.path()) && !is_list(Path::new("nowhere.csv")));
    }

    #[test]
    fn what_is_wrong_is_named_with_row_and_column() {
        let texts = [
            "path,machin\na.csv,A\n",
            "path,time,time\na.csv,1,2\n",
            "machine,time\nA,1\n",
            "path,time\na.csv,1\nb.csv,yesterday\n",
            "path,time\na.csv,1\nb.csv,2026-01-01\n",
            "path,time\na.csv\n",
            "path,machine\na.csv,A\n,A\n",
            "path\na.csv\n\nb.csv\na.csv\n",
            "path,temperature\na.csv,warm\n",
            "path\n",
        ];
        insta::assert_snapshot!(texts.map(said).join("\n"));
    }

    proptest! {
        #[test]
        fn any_text_is_read_without_a_fault(text in "(path|time|,|;|\n|\"|[a-z0-9]| ){0,60}") {
            let _ = said(&text);
        }
    }
}
