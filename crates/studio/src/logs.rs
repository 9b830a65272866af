//! Recordings and other tables as the page draws them: read once by the engine, kept with a pyramid for each channel, the least
//! recently used let go of.

mod columns;
mod drawn;
mod runs;
mod series;

pub use columns::{Correction, correct};
pub use drawn::{MAPPED, map, tiles};
pub use runs::runs;
pub use series::{Channel, Series};

use crate::held::held;
use crate::named::read_axis;
use crate::refused::Refused;
use crate::workspace::Workspace;
use serde::Serialize;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::SystemTime;
use stiction_files::Axis;
use stiction_files::axis::Marks;
use stiction_log::Severity;
use stiction_workflows::source::{Source, load, table};

/// Most that are kept.
const MOST: usize = 4;
/// Most findings and left-out stretches that are told of, each.
const MOST_TOLD: usize = 200;

/// What was read: name, size and time of the file, and how: the hash of the axis file, or the run of a table.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    name: String,
    bytes: u64,
    modified: Option<SystemTime>,
    how: Option<String>,
}

/// The tables that are kept, the latest last.
#[derive(Debug, Default)]
pub struct Logs(Mutex<Vec<(Key, Arc<Loaded>)>>);

/// A recording with what was found in it, or another table.
#[derive(Debug)]
pub struct Loaded {
    /// What is drawn.
    pub series: Series,
    /// What is told.
    pub about: About,
}

/// What is told of a log.
#[derive(Clone, Debug, Default, Serialize)]
pub struct About {
    /// SHA-256 of the file, hexadecimal; empty where it could not be read.
    pub sha256: String,
    pub samples: usize,
    pub rate_hz: f64,
    pub seconds: f64,
    /// `linear` or `rotary`.
    pub motion: String,
    pub force_unit: String,
    /// How the file was understood.
    pub detected: Vec<String>,
    pub findings: Vec<Found>,
    /// Stretches that are not fitted.
    pub excluded: Vec<LeftOut>,
    pub columns: Vec<Column>,
    pub channels: Vec<Drawable>,
    /// First and last time, and what it is called: of a log that could not be read rows where no column is the time.
    pub span: (f64, f64),
    pub over: String,
    pub marks: Marks,
    /// Why it could not be read, if so; then only columns are known, and drawn by their numbers.
    pub refused: Option<String>,
}

/// A channel that can be drawn.
#[derive(Clone, Debug, Serialize)]
pub struct Drawable {
    pub name: String,
    /// The unit in which it is drawn.
    pub unit: String,
    /// Whether it follows from another one.
    pub derived: bool,
}

/// Something found, with its time where it has one.
#[derive(Clone, Debug, Serialize)]
pub struct Found {
    pub code: String,
    pub severity: &'static str,
    pub message: String,
    pub at_s: Option<f64>,
}

/// A stretch that is not fitted.
#[derive(Clone, Debug, Serialize)]
pub struct LeftOut {
    pub code: String,
    pub from_s: f64,
    pub to_s: f64,
}

/// A column of the file.
#[derive(Clone, Debug, Serialize)]
pub struct Column {
    /// Counted from 1.
    pub number: usize,
    pub name: String,
    /// What it is taken for.
    pub role: Option<String>,
    /// The unit that it is read in; before it is understood, that in the file.
    pub unit: String,
    pub reason: String,
    /// Whether nothing gave the unit.
    pub assumed: bool,
    /// Lowest and highest number of a column that is not understood, in the unit of the file.
    pub range: Option<(f64, f64)>,
}

impl Logs {
    /// A log of the workspace as an axis file of it says, or as it is found.
    pub fn log(
        &self,
        workspace: &Workspace,
        name: &str,
        axis: Option<&str>,
    ) -> Result<Arc<Loaded>, Refused> {
        let path = workspace.file(name)?;
        let read = axis
            .map(|axis| read_axis(workspace, axis, &[&path]))
            .transpose()?;
        let text = read.as_ref().and_then(|axis| axis.sha256());
        let key = Key::of(name, &path, Some(text.unwrap_or_default().to_string()))?;
        self.kept(key, || {
            let axis = read.unwrap_or_default();
            let marks = axis.marks(&path);
            let whole = axis.of_whole(&path);
            Ok(match load(&path, &whole) {
                Ok(source) => loaded(source, marks),
                Err(e) => {
                    let about = About {
                        marks,
                        refused: Some(Refused::from(e).message().to_string()),
                        ..About::default()
                    };
                    undecided(table(&path, &whole)?, about)
                }
            })
        })
    }

    /// A run of a table that stiction wrote, such as `fit.csv`.
    pub fn table(
        &self,
        workspace: &Workspace,
        name: &str,
        run: usize,
    ) -> Result<Arc<Loaded>, Refused> {
        let path = workspace.file(name)?;
        let key = Key::of(name, &path, Some(format!("run {run}")))?;
        self.kept(key, || {
            let table = table(&path, &Axis::default())?;
            let series = Series::of_table(table, run);
            let about = About {
                samples: series.time.len(),
                channels: series.about(),
                ..About::default()
            };
            Ok(Loaded { series, about })
        })
    }

    fn kept(
        &self,
        key: Key,
        read: impl FnOnce() -> Result<Loaded, Refused>,
    ) -> Result<Arc<Loaded>, Refused> {
        {
            let mut kept = held(&self.0);
            if let Some(at) = kept.iter().position(|(own, _)| *own == key) {
                let found = kept.remove(at);
                kept.push(found.clone());
                return Ok(found.1);
            }
            // What the file held before is no use any more, and its memory is needed.
            kept.retain(|(own, _)| own.name != key.name);
            while kept.len() >= MOST {
                kept.remove(0);
            }
        }
        let found = Arc::new(read()?);
        held(&self.0).push((key, found.clone()));
        Ok(found)
    }
}

impl Key {
    fn of(name: &str, path: &Path, how: Option<String>) -> Result<Self, Refused> {
        let about = std::fs::metadata(path)?;
        Ok(Self {
            name: name.into(),
            bytes: about.len(),
            modified: about.modified().ok(),
            how,
        })
    }
}

/// The columns of a file of which something has to be said before it is a log.
fn undecided(table: stiction_log::Table, mut about: About) -> Loaded {
    about.columns = columns::unread(&table);
    let (series, over) = Series::of_undecided(table, &about.columns);
    let time = &series.time;
    about.over = over;
    about.span = (
        time.first().copied().unwrap_or(0.0),
        time.last().copied().unwrap_or(0.0),
    );
    about.channels = series.about();
    Loaded { series, about }
}

fn loaded(source: Source, marks: Marks) -> Loaded {
    let log = &source.log;
    let at = |sample: usize| log.time.get(sample).copied();
    let findings = log.findings.iter().take(MOST_TOLD).map(|found| Found {
        code: found.code().to_string(),
        severity: match found.severity {
            Severity::Note => "note",
            Severity::Warning => "warning",
        },
        message: found.to_string(),
        at_s: found.at.and_then(at),
    });
    let excluded = log.excluded.iter().take(MOST_TOLD).filter_map(|out| {
        Some(LeftOut {
            code: out.code.to_string(),
            from_s: at(out.samples.start)?,
            to_s: at(out.samples.end.saturating_sub(1))?,
        })
    });
    let mut about = About {
        sha256: source.sha256.clone(),
        samples: log.time.len(),
        rate_hz: log.rate_hz,
        seconds: log.time.last().copied().unwrap_or(0.0),
        motion: log.motion.to_string(),
        force_unit: log.force_unit.clone(),
        detected: source.detected.clone(),
        findings: findings.collect(),
        excluded: excluded.collect(),
        columns: log.columns.iter().map(columns::understood).collect(),
        channels: Vec::new(),
        span: (0.0, log.time.last().copied().unwrap_or(0.0)),
        over: "time [s]".into(),
        marks,
        refused: None,
    };
    let series = Series::of_log(source.log);
    about.channels = series.about();
    Loaded { series, about }
}
