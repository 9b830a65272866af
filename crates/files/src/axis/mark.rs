//! What of a log is kept, fitted and validated on, written into an axis file that otherwise stays as it is.

use super::listed::Validated;
use super::values::Axis;
use std::fmt::Write;
use std::ops::Range;
use std::path::Path;

/// The parts of a log, s from the first sample of its file.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Marks {
    /// What is kept; `None` for all.
    pub crop: Option<(f64, f64)>,
    /// What is fitted; empty for all that is kept and not validated on.
    pub fit: Vec<(f64, f64)>,
    /// What is validated on.
    pub validate: Vec<(f64, f64)>,
    /// Whether that is the whole log.
    pub validate_all: bool,
}

impl Axis {
    /// The parts of a log as this file has them.
    pub fn marks(&self, log: &Path) -> Marks {
        let Some(listed) = self.listed(log) else {
            return Marks {
                crop: self.mapping.crop,
                ..Marks::default()
            };
        };
        Marks {
            crop: listed.mapping.crop,
            fit: listed.fit.clone().unwrap_or_default(),
            validate: match &listed.validated {
                Validated::Stretches(stretches) => stretches.clone(),
                _ => Vec::new(),
            },
            validate_all: listed.validated == Validated::All,
        }
    }

    /// The same axis for the whole of a log: nothing is left out, and times count from the first sample of its file.
    pub fn of_whole(&self, log: &Path) -> Self {
        let mut axis = self.clone();
        if let Some(listed) = self.listed(log) {
            axis.mapping = listed.mapping.clone();
        }
        axis.logs.clear();
        axis.mapping.crop = None;
        axis.mapping.parts = None;
        axis
    }
}

/// The text of an axis file with these parts of a log, whose path is as the file names it; a `[log]` becomes that of this log.
/// `None` where the lines cannot be placed: a key that spans several lines, or parts that the file may not have.
pub fn mark(text: &str, file: &str, marks: &Marks) -> Option<String> {
    let mut out = text.to_string();
    if !out.is_empty() && !out.ends_with('\n') {
        out.push('\n');
    }
    let entry = match tables(&out, "[[log]]")
        .into_iter()
        .find(|own| names(&out[own.clone()], file))
    {
        Some(entry) => entry,
        None => match tables(&out, "[log]").into_iter().next() {
            Some(entry) => {
                let line = out[entry.clone()].find('\n')? + 1;
                let header = out[entry.start..entry.start + line].replace("[log]", "[[log]]");
                let header = format!("{header}file = {}\n", quoted(file));
                let longer = header.len() - line;
                out.replace_range(entry.start..entry.start + line, &header);
                entry.start..entry.end + longer
            }
            None => {
                let start = out.len();
                let _ = write!(out, "\n[[log]]\nfile = {}\n", quoted(file));
                start + 1..out.len()
            }
        },
    };
    let mut lines: Vec<String> = out[entry.clone()]
        .split_inclusive('\n')
        .filter(|line| !["fit", "validate", "crop"].contains(&key(line)))
        .map(String::from)
        .collect();
    let at = lines.iter().position(|line| key(line) == "file")? + 1;
    lines.splice(at..at, written(marks));
    out.replace_range(entry, &lines.concat());
    let read = Axis::parse(&out).ok()?;
    (read.marks(Path::new(file)) == *marks).then_some(out)
}

/// The lines of some parts.
fn written(marks: &Marks) -> Vec<String> {
    let pair = |(from, to): &(f64, f64)| format!("[\"{from} s\", \"{to} s\"]");
    let list = |pairs: &[(f64, f64)]| {
        let all: Vec<String> = pairs.iter().map(pair).collect();
        format!("[{}]", all.join(", "))
    };
    let mut out = Vec::new();
    out.extend(
        marks
            .crop
            .as_ref()
            .map(|crop| format!("crop = {}\n", pair(crop))),
    );
    if !marks.fit.is_empty() {
        out.push(format!("fit = {}\n", list(&marks.fit)));
    }
    match (marks.validate_all, marks.validate.is_empty()) {
        (true, _) => out.push("validate = \"all\"\n".into()),
        (false, false) => out.push(format!("validate = {}\n", list(&marks.validate))),
        (false, true) => {}
    }
    out
}

/// Where the tables of this header are, headers included.
fn tables(text: &str, header: &str) -> Vec<Range<usize>> {
    let mut out: Vec<Range<usize>> = Vec::new();
    let mut inside = false;
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let end = at + line.len();
        let trimmed = line.trim_start();
        if trimmed.starts_with('[') {
            inside = trimmed.starts_with(header);
            if inside {
                out.push(at..end);
            }
        } else if let Some(last) = out.last_mut().filter(|_| inside) {
            last.end = end;
        }
        at = end;
    }
    out
}

/// Whether a `[[log]]` is that of a file.
fn names(entry: &str, file: &str) -> bool {
    let mut lines = entry.lines().filter(|line| key(line) == "file");
    let parsed = lines
        .next()
        .and_then(|line| line.parse::<toml::Table>().ok());
    parsed.is_some_and(|own| own.get("file").and_then(toml::Value::as_str) == Some(file))
}

/// The key of a line.
fn key(line: &str) -> &str {
    match line.split_once('=') {
        Some((key, _)) => key.trim(),
        None => "",
    }
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.into()).to_string()
}

#[cfg(test)]
mod tests {
    use super::{Axis, Marks, mark};
    use std::path::Path;

    fn marks() -> Marks {
        Marks {
            crop: Some((0.5, 30.0)),
            fit: vec![(1.0, 10.25), (12.0, 20.0)],
            validate: vec![(20.0, 30.0)],
            validate_all: false,
        }
    }

    #[test]
    fn parts_are_written_and_the_rest_stays() {
        let file = "# mine\nkind = \"linear\"\n\n[columns]\nforce = \"F\"\n\n[log] # of the drive\nresolution = \"1 um\"\n# crop\n\n[terms]\ndelay = \"none\"\n";
        let marked = mark(file, "run 1.csv", &marks()).unwrap();
        let expected = "# mine\nkind = \"linear\"\n\n[columns]\nforce = \"F\"\n\n[[log]] # of the drive\nfile = \"run 1.csv\"\n\
                        crop = [\"0.5 s\", \"30 s\"]\nfit = [[\"1 s\", \"10.25 s\"], [\"12 s\", \"20 s\"]]\n\
                        validate = [[\"20 s\", \"30 s\"]]\nresolution = \"1 um\"\n# crop\n\n[terms]\ndelay = \"none\"\n";
        assert_eq!(marked, expected);
        // Twice is once, and what is taken back is gone.
        assert_eq!(mark(&marked, "run 1.csv", &marks()).unwrap(), marked);
        let none = mark(&marked, "run 1.csv", &Marks::default()).unwrap();
        assert!(
            !none.contains("fit =") && none.contains("resolution"),
            "{none}"
        );
    }

    #[test]
    fn a_second_log_has_an_entry_of_its_own() {
        let first = mark("", "a.csv", &marks()).unwrap();
        let all = Marks {
            validate_all: true,
            ..Marks::default()
        };
        let both = mark(&first, "in/b.csv", &all).unwrap();
        let axis = Axis::parse(&both).unwrap();
        assert_eq!(axis.marks(Path::new("a.csv")), marks());
        assert_eq!(axis.marks(Path::new("in/b.csv")), all);
        assert_eq!(
            axis.of_whole(Path::new("a.csv")).marks(Path::new("a.csv")),
            Marks::default()
        );
    }

    #[test]
    fn parts_that_no_file_may_have_are_not_written() {
        let meets = Marks {
            fit: vec![(1.0, 3.0)],
            validate: vec![(2.0, 4.0)],
            ..Marks::default()
        };
        assert_eq!(mark("", "a.csv", &meets), None);
    }
}
