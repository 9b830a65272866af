//! A fit as its folder keeps it.

use crate::bundle::fit_columns;
use serde_json::Value;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use stiction_files::result::{ResultFile, SCHEMA};
use stiction_files::{Bundle, Error as FileError, ModelFile, check_folder};
use stiction_log::Column;
use stiction_parameters::LawKind;
use stiction_workflows::Error;

/// Its files; the last two are not in every folder.
const NAMES: [&str; 5] = [
    "result.json",
    "model.toml",
    "report.html",
    "fit.csv",
    "study.toml",
];
/// How many of them there must be.
const NEEDED: usize = 3;
/// Largest file that is read, bytes.
const MOST_BYTES: u64 = 1 << 30;

/// What `stiction identify` left in a folder: all that was found, without the logs.
#[derive(Clone, Debug)]
pub struct SavedFit {
    folder: PathBuf,
    files: Vec<(&'static str, Vec<u8>)>,
    model: ModelFile,
    result: Box<ResultFile>,
}

impl SavedFit {
    /// Reads the files of a folder.
    ///
    /// # Errors
    /// Where a file is missing, cannot be read, or is none of a fit: `result.json` lacks a key, or holds something else in one, or its
    /// law is none that this version knows.
    pub fn read(folder: impl AsRef<Path>) -> Result<Self, Error> {
        let folder = folder.as_ref();
        let mut files = Vec::new();
        for (k, name) in NAMES.into_iter().enumerate() {
            let path = folder.join(name);
            if k >= NEEDED && !path.exists() {
                continue;
            }
            let refused =
                |found: String| refused(&path, "", found, "a folder that stiction identify wrote");
            let file = File::open(&path).map_err(|e| refused(e.to_string()))?;
            let mut bytes = Vec::new();
            let read = file.take(MOST_BYTES + 1).read_to_end(&mut bytes);
            read.map_err(|e| refused(e.to_string()))?;
            if bytes.len() as u64 > MOST_BYTES {
                return Err(refused(format!("more than {MOST_BYTES} bytes")));
            }
            files.push((name.to_string(), bytes));
        }
        Self::of(folder, files)
    }

    /// The same of files that are in memory, by their names; `folder` is for messages. Other files are left aside.
    ///
    /// # Errors
    /// As [`SavedFit::read`].
    pub fn of(
        folder: &Path,
        given: impl IntoIterator<Item = (String, Vec<u8>)>,
    ) -> Result<Self, Error> {
        let mut files: Vec<(&'static str, Vec<u8>)> = Vec::new();
        for (name, bytes) in given {
            let mut names = NAMES.into_iter();
            files.extend(names.find(|own| *own == name).map(|own| (own, bytes)));
        }
        let content = |name: &str| files.iter().find(|(own, _)| *own == name).map(|(_, b)| b);
        for name in &NAMES[..NEEDED] {
            if content(name).is_none() {
                let allowed = "a folder that stiction identify wrote";
                return Err(refused(&folder.join(name), "", "no such file", allowed));
            }
        }
        let text = |name: &str| String::from_utf8_lossy(content(name).map_or(&[], Vec::as_slice));
        let path = folder.join(NAMES[0]);
        let own = text(NAMES[0]);
        let no_result = |e: serde_json::Error| {
            let place = format!("line {}, column {}: ", e.line(), e.column());
            refused(&path, &place, e.to_string(), "a result that stiction wrote")
        };
        let schema: Value = serde_json::from_str(&own).map_err(no_result)?;
        let schema = schema.get("schema").and_then(Value::as_str);
        if schema != Some(SCHEMA) {
            let found = schema.map_or("no schema".into(), |s| format!("schema {s:?}"));
            return Err(refused(&path, "", found, SCHEMA));
        }
        let result: Box<ResultFile> = serde_json::from_str(&own).map_err(no_result)?;
        let known = result.law.parse::<LawKind>();
        known.map_err(|e| refused(&path, "law: ", e.to_string(), "a law of this version"))?;
        let model = ModelFile::parse(&text(NAMES[1]))?;
        Ok(Self {
            folder: folder.to_path_buf(),
            files,
            model,
            result,
        })
    }

    /// The folder that it was read from.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The law as `model.toml` has it.
    pub fn model(&self) -> &ModelFile {
        &self.model
    }

    /// Everything that was found.
    pub fn result(&self) -> &ResultFile {
        &self.result
    }

    /// Text of a file; empty where there is none.
    pub fn text(&self, name: &str) -> String {
        let file = self.files.iter().find(|(own, _)| *own == name);
        file.map_or(String::new(), |(_, bytes)| {
            String::from_utf8_lossy(bytes).into_owned()
        })
    }

    /// The rows of `fit.csv`; `None` where there is no such file.
    pub fn series(&self) -> Option<Vec<Column>> {
        fit_columns(&self.text("fit.csv"))
    }

    /// Its files, as they were read.
    pub fn bundle(&self) -> Bundle {
        let mut bundle = Bundle::default();
        // The one that marks a folder of this kind comes last.
        for name in NAMES.into_iter().rev() {
            match self.files.iter().find(|(own, _)| *own == name) {
                Some((_, bytes)) => bundle.add(name, bytes.clone()),
                None => bundle.lacks(name),
            }
        }
        bundle
    }

    /// Writes the files into another folder, whole or not at all.
    ///
    /// # Errors
    /// Where the folder cannot be written, or holds something that stiction did not write.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, Error> {
        check_folder(folder.as_ref(), false)?;
        Ok(self.bundle().write(folder)?)
    }
}

fn refused(path: &Path, place: &str, found: impl Into<String>, allowed: &str) -> Error {
    Error::File(FileError::Config {
        file: path.to_path_buf(),
        place: place.into(),
        found: found.into(),
        allowed: allowed.into(),
    })
}
