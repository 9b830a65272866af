//! The C in a folder, and the program around it that reads inputs and writes forces.

use crate::compile;
use std::fmt::Write;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use stiction_files::sha256_of;
use stiction_files::study::result::StudyInput;
use tempfile::TempDir;

/// Ends of the names of header and source in double precision; those of single precision end in `_f32_friction`.
const HEADER: &str = "_friction.h";
const SINGLE: &str = "_f32_friction.h";

/// Largest header and source, bytes: those that are written have some ten thousand.
const MOST_BYTES: u64 = 1 << 20;

/// The program: its names are put in for the words in capitals.
const PROGRAM: &str = include_str!("program.c.in");

/// What may come in beside velocity, error and enable, in the order of the numbers that the program reads.
const EXTRAS: [&str; 7] = [
    "drive_force",
    "learn",
    "reference_acceleration",
    "position",
    "load",
    "temperature",
    "transmitted",
];

/// Exported C.
pub(super) struct Source {
    /// Header and source, each as it was read.
    files: [(PathBuf, String); 2],
    /// What its names begin with.
    prefix: String,
    /// Which extras it has.
    extras: [bool; EXTRAS.len()],
    /// The parts that it feeds forward beside friction.
    parts: Vec<String>,
    /// Whether its levels follow the machine.
    pub adapts: bool,
    /// The model that it was written from.
    pub model_sha256: Option<String>,
}

impl Source {
    /// The C in `folder`; an error says what is missing.
    pub fn find(folder: &Path) -> Result<Self, String> {
        let entries = std::fs::read_dir(folder).map_err(|e| format!("the folder: {e}"))?;
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let mut headers: Vec<String> = names
            .filter(|name| name.ends_with(HEADER) && !name.ends_with(SINGLE))
            .collect();
        headers.sort();
        let name = match headers.as_slice() {
            [name] => name,
            [] => return Err(format!("no header NAME{HEADER}")),
            several => return Err(format!("several headers: {}", several.join(", "))),
        };
        let header = folder.join(name);
        let code = header.with_extension("c");
        if !code.is_file() {
            let stem = name.trim_end_matches('h');
            return Err(format!("{name} without {stem}c"));
        }
        let files = [read(header)?, read(code)?];
        let text = &files[0].1;
        let prefix = prefix(text).ok_or_else(|| format!("{name} has no type NAME_params_t"))?;
        let end = format!("}} {prefix}_input_t;");
        let input = text
            .split_once(&end)
            .and_then(|(before, _)| Some(before.rsplit_once("typedef struct {")?.1))
            .ok_or_else(|| format!("{name} has no type {prefix}_input_t"))?;
        let has = |text: &str, field: &str| text.contains(&format!(" {field};"));
        let parts = ["mass", "gravity", "cogging"];
        let parts = parts
            .into_iter()
            .filter(|p| has(text, &format!("part_{p}")));
        Ok(Source {
            extras: EXTRAS.map(|extra| has(input, extra)),
            parts: parts.map(str::to_string).collect(),
            adapts: has(input, "learn"),
            model_sha256: text
                .split_once("Model file: sha256 ")
                .and_then(|(_, rest)| Some(rest.split_whitespace().next()?.to_string())),
            prefix: prefix.to_string(),
            files,
        })
    }

    /// Whether a part beside friction is fed forward.
    pub fn feeds(&self, part: &str) -> bool {
        self.parts.iter().any(|p| p == part)
    }

    /// The files with the hashes of what was read, which is what is compiled.
    pub fn inputs(&self) -> Vec<StudyInput> {
        let input = |(file, text): &(PathBuf, String)| StudyInput {
            path: file.display().to_string(),
            sha256: sha256_of(text.as_bytes()),
        };
        self.files.iter().map(input).collect()
    }

    /// A folder with the program of the C.
    pub fn compile(&self) -> Result<TempDir, String> {
        let place = tempfile::tempdir().map_err(|e| format!("a folder for the program: {e}"))?;
        let name = |file: &Path| {
            let name = file.file_name().unwrap_or_default();
            name.to_string_lossy().into_owned()
        };
        let names = self.files.each_ref().map(|(file, _)| name(file));
        for ((_, text), name) in self.files.iter().zip(&names) {
            std::fs::write(place.path().join(name), text).map_err(|e| format!("{name}: {e}"))?;
        }
        let mut fields = String::new();
        for (k, extra) in EXTRAS.iter().enumerate().filter(|(k, _)| self.extras[*k]) {
            let value = match *extra {
                "learn" => format!("in[{}] != 0.0", k + 3),
                _ => format!("in[{}]", k + 3),
            };
            let _ = writeln!(fields, "        input.{extra} = {value};");
        }
        let main = PROGRAM
            .replace("HEADER", &names[0])
            .replace("NAME", &self.prefix)
            .replace("        FIELDS\n", &fields)
            .replace("COUNT", &(EXTRAS.len() + 3).to_string());
        std::fs::write(place.path().join("beside.c"), main)
            .map_err(|e| format!("a file for the program: {e}"))?;
        compile::program(
            place.path(),
            super::process::PROGRAM,
            &["beside.c", &names[1]],
        )?;
        Ok(place)
    }
}

/// A file of C with its text.
fn read(file: PathBuf) -> Result<(PathBuf, String), String> {
    let fault = |e: std::io::Error| format!("{}: {e}", file.display());
    if !file.is_file() {
        return Err(format!("{} is not a file", file.display()));
    }
    let mut text = String::new();
    let open = File::open(&file).map_err(fault)?;
    open.take(MOST_BYTES + 1)
        .read_to_string(&mut text)
        .map_err(fault)?;
    if text.len() as u64 > MOST_BYTES {
        return Err(format!("{} of more than 1 MiB", file.display()));
    }
    Ok((file, text))
}

/// What the names in a header begin with.
fn prefix(header: &str) -> Option<&str> {
    let (before, _) = header.split_once("_params_t;")?;
    let prefix = before.rsplit_once("} ")?.1;
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
    (!prefix.is_empty() && prefix.chars().all(plain)).then_some(prefix)
}
