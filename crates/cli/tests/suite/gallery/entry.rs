//! One entry of the gallery made from its recordings: its section of the page, and its picture.

use super::entries::Entry;
use std::collections::HashMap;
use std::collections::hash_map::Entry::{Occupied, Vacant};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// The style of the figures of a report.
const STYLE: &str = include_str!("../../../../report/src/figure/figure.css");
/// Rows of parameters that are shown.
const MOST_ROWS: usize = 3;
/// Names of exported files that are shown.
const MOST_FILES: usize = 4;
/// What a command printed, kept for the next entry of the same command.
const PRINTED: &str = "printed.txt";

/// Where the inputs are.
pub struct Inputs<'a> {
    pub program: &'a Path,
    pub workspace: &'a Path,
    /// The recordings.
    pub data: &'a Path,
    /// The robots of example-robot-data.
    pub urdfs: Option<&'a Path>,
}

/// A folder for each command and its recordings.
#[derive(Default)]
pub struct Folders(HashMap<(&'static str, &'static [&'static str]), TempDir>);

impl Folders {
    /// That of an entry.
    pub fn of(&mut self, entry: &Entry) -> Result<&Path, String> {
        let folder = match self.0.entry((entry.command, entry.recordings)) {
            Occupied(folder) => folder.into_mut(),
            Vacant(place) => place.insert(tempfile::tempdir().map_err(|e| e.to_string())?),
        };
        Ok(folder.path())
    }
}

/// What an entry becomes.
pub struct Made {
    /// Markdown.
    pub section: String,
    pub svg: String,
}

/// Runs the commands of an entry in a folder, which entries of the same command share.
pub fn make(entry: &Entry, inputs: &Inputs, work: &Path) -> Result<Made, String> {
    let kept_text = work.join(PRINTED);
    if !kept_text.is_file() {
        prepare(entry, inputs, work)?;
        let printed = run(inputs.program, work, entry.command)?;
        fs::write(&kept_text, printed).map_err(|e| e.to_string())?;
    }
    let printed = fs::read_to_string(&kept_text).map_err(|e| e.to_string())?;
    let out = entry.command.rsplit(' ').next().unwrap_or_default();
    let out = work.join(out);
    let report = fs::read_to_string(out.join("report.html")).map_err(|e| e.to_string())?;
    let which = entry.joint.map_or(0, |(_, which)| which);
    let svg = figure(&report, entry.figure, which)
        .ok_or(format!("{}: no figure `{}`", entry.name, entry.figure))?;

    let Entry {
        title,
        note,
        origin,
        name,
        ..
    } = entry;
    let axis = entry
        .axis
        .map(|axis| format!(" Axis file: [`{axis}`](../{axis})."));
    let mut section = format!("## {title}\n\n{note}{}\n\n", axis.unwrap_or_default());
    let lines = match entry.joint {
        Some((joint, _)) => of_joint(&printed, joint, &out)?,
        None => kept(&printed),
    };
    let _ = write!(section, "```\n$ {}\n{lines}", entry.command);
    if let Some(export) = entry.export {
        let written = run(inputs.program, work, export)?;
        let files = written.lines().find(|line| line.starts_with("written to "));
        let files = files.ok_or(format!("{export}: {written}"))?;
        let _ = write!(section, "$ {export}\n{}\n", shortened(files));
    }
    let alt = if entry.is_in_time() {
        "Force in time"
    } else {
        "Friction over velocity"
    };
    let _ = write!(
        section,
        "```\n\n![{alt}](gallery/{name}.svg)\n\nData: [{}]({}), {}.\n",
        origin.source.trim_start_matches("https://github.com/"),
        origin.source,
        origin.licence
    );
    Ok(Made {
        section,
        svg: svg_file(&svg, entry),
    })
}

/// Puts recordings, axis file and URDF into the folder.
fn prepare(entry: &Entry, inputs: &Inputs, work: &Path) -> Result<(), String> {
    let put = |from: &Path, name: &str| {
        // The recordings may be write-protected, and a copy of that kind would be too.
        let bytes = fs::read(from).map_err(|e| format!("{}: {e}", from.display()))?;
        fs::write(work.join(name), bytes).map_err(|e| e.to_string())
    };
    let last = |path: &'static str| path.rsplit('/').next().unwrap_or_default();
    for recording in entry.recordings {
        put(&inputs.data.join(recording), last(recording))?;
    }
    if let Some(axis) = entry.axis {
        put(&inputs.workspace.join(axis), "axis.toml")?;
    }
    if let Some(urdf) = entry.urdf {
        let folder = inputs.urdfs;
        let folder = folder.ok_or("no folder with the URDFs of example-robot-data")?;
        put(&folder.join(urdf), last(urdf))?;
    }
    Ok(())
}

/// The first files of a list.
fn shortened(files: &str) -> String {
    let names: Vec<&str> = files.split(", ").collect();
    match names.len() > MOST_FILES {
        true => format!("{}, …", names[..MOST_FILES].join(", ")),
        false => files.into(),
    }
}

/// What a command prints; 1 is a verdict.
fn run(program: &Path, folder: &Path, line: &str) -> Result<String, String> {
    let words = line.split_whitespace().skip(1);
    let ran = Command::new(program)
        .args(words)
        .current_dir(folder)
        .output();
    let ran = ran.map_err(|e| e.to_string())?;
    if !matches!(ran.status.code(), Some(0 | 1)) {
        return Err(format!("{line}: {}", String::from_utf8_lossy(&ran.stderr)));
    }
    String::from_utf8(ran.stdout).map_err(|e| e.to_string())
}

/// Law, determined parameters, friction by speed, verdict, and after a refusal what to do next.
fn kept(printed: &str) -> String {
    let is_robot = printed.contains("\nfor feedforward");
    let starts = [
        "friction  ",
        "friction alone",
        "simulators",
        "for ",
        "rigid body",
        "joint ",
    ];
    let (mut out, mut rows, mut header) = (String::new(), 0, None);
    let mut lines = printed.lines().peekable();
    while let Some(line) = lines.next() {
        let is_row = line.contains(" ± ") && !line.contains("NOT IDENTIFIABLE");
        let is_joint = is_robot && (line.ends_with("  yes") || line.ends_with("  no"));
        if line.starts_with("parameter ") {
            header = Some(line);
        } else if starts.iter().any(|start| line.starts_with(start))
            || is_joint
            || line.contains("): held-out error")
        {
            let _ = writeln!(out, "{line}");
            if line.starts_with("for compensation")
                && let Some(more) = lines.next_if(|line| line.starts_with(' '))
            {
                let _ = writeln!(out, "{more}");
            }
        } else if is_row && header.is_some() && rows < MOST_ROWS && !line.starts_with(' ') {
            if rows == 0 {
                let _ = writeln!(out, "{}", header.unwrap_or_default());
            }
            let _ = writeln!(out, "{line}");
            rows += 1;
        } else if line.starts_with("next: ") && printed.contains("compensation  NO") {
            let _ = writeln!(out, "{line}");
        }
    }
    out
}

/// The row of a joint, and its own verdict.
fn of_joint(printed: &str, joint: &str, out: &Path) -> Result<String, String> {
    let rows = printed
        .lines()
        .filter(|line| line.starts_with("joint ") || line.starts_with(&format!("{joint} ")));
    let mut text: String = rows.flat_map(|row| [row, "\n"]).collect();
    let file = out.join("joints").join(joint).join("result.json");
    let result = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    let result: serde_json::Value = serde_json::from_str(&result).map_err(|e| e.to_string())?;
    let trust = &result["trust"];
    let reasons = trust["reasons"].as_array().into_iter().flatten();
    let reasons: Vec<&str> = reasons
        .filter_map(|reason| reason["text"].as_str().or(reason.as_str()))
        .collect();
    let verdict = if reasons.is_empty() {
        "yes".to_string()
    } else {
        format!("NO: {}", reasons.join("; "))
    };
    let _ = writeln!(text, "friction alone, for compensation: {verdict}");
    Ok(text)
}

/// A figure of a report by its title, of those with that title the one with that number.
fn figure(report: &str, title: &str, which: usize) -> Option<String> {
    let title = format!("<title>{title}</title>");
    let found = report
        .match_indices("<svg class=\"fig\"")
        .map(|(at, _)| &report[at..]);
    let start = found
        .filter(|text| {
            text.find("</title>")
                .is_some_and(|end| text[..end + 8].ends_with(&title))
        })
        .nth(which)?;
    // Panels are drawings in the drawing.
    let (mut depth, mut at) = (0, 0);
    loop {
        let rest = &start[at..];
        let close = rest.find("</svg>")?;
        match rest.find("<svg").filter(|open| *open < close) {
            Some(open) => (depth, at) = (depth + 1, at + open + 4),
            None => (depth, at) = (depth - 1, at + close + 6),
        }
        if depth == 0 {
            return Some(start[..at].into());
        }
    }
}

/// A figure that stands by itself.
fn svg_file(figure: &str, entry: &Entry) -> String {
    let (open, rest) = figure.split_once('>').unwrap_or((figure, ""));
    let classes: Vec<&str> = rest
        .split("class=\"")
        .skip(1)
        .filter_map(|part| part.split('"').next())
        .collect();
    let is_used = |line: &&str| {
        let named = line
            .split_once(".fig .")
            .and_then(|(_, rest)| rest.split([' ', ',', '{']).next());
        named.is_none_or(|name| {
            classes
                .iter()
                .any(|own| own.split(' ').any(|word| word == name))
                || name == "paper"
        })
    };
    let style: Vec<&str> = STYLE.lines().filter(is_used).collect();
    let size = open
        .split("viewBox=\"0 0 ")
        .nth(1)
        .and_then(|text| text.split('"').next())
        .unwrap_or("860 400");
    let (width, height) = size.split_once(' ').unwrap_or(("860", "400"));
    let open = open.replace(
        "<svg ",
        &format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" "
        ),
    );
    format!(
        "{open}>\n<!-- {}: {}, {}. Drawn by `cargo xtask gallery`. -->\n<style>\n{}\n</style>\n<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>{rest}\n",
        entry.title,
        entry.origin.source,
        entry.origin.licence,
        style.join("\n")
    )
}
