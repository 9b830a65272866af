//! The log on disk: rows go to a file beside the final one, and it gets its name at the end.
//!
//! The rows are text whatever the final form is, so that what a power failure leaves (`NAME.csv.part`) can be read to its last
//! second. Nothing that exists is ever replaced.

use crate::error::Error;
use crate::source::{Column, Sample};
use crate::table;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Time between two writes, s of the device.
const BETWEEN: f64 = 1.0;
/// Rows wait for the next write in at most this many bytes.
const MOST_PENDING: usize = 1 << 20;

/// A log in the making.
pub(crate) struct LogFile {
    path: PathBuf,
    part: PathBuf,
    header: String,
    columns: usize,
    file: Option<File>,
    /// Bytes and rows that are in the file.
    end: u64,
    rows: u64,
    pending: Vec<u8>,
    /// Time stamps of the rows that wait.
    waiting: Vec<f64>,
    /// Those of the first and the last row in the file.
    stamps: Option<(f64, f64)>,
    due: f64,
}

impl LogFile {
    /// A log that is going to be `path`; nothing is written before the first row.
    pub fn new(path: &Path, columns: &[Column]) -> Result<Self, Error> {
        let part = path.with_extension("csv.part");
        let is_form = |form: &str| path.extension().is_some_and(|end| end == form);
        if !is_form("csv") && !is_form("parquet") {
            return Err(Error::usage(
                format!("{} is neither .csv nor .parquet", path.display()),
                "the log is written as the one or the other: --out log.csv",
            ));
        }
        let fail = |path: &Path, what| Err(Error::file(path, io::Error::other(what)));
        if path.symlink_metadata().is_ok() {
            return fail(path, "exists already and is kept; name another file");
        }
        if part.symlink_metadata().is_ok() {
            let what = "is left of a recording that was ended by force, or one is running; rename it to end in .csv to keep it, \
                or delete it";
            return fail(&part, what);
        }
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if !folder.is_dir() {
            return Err(Error::file(path, ErrorKind::NotFound.into()));
        }
        let titles = columns.iter().map(title);
        let titles: Vec<String> = std::iter::once("time [s]".into()).chain(titles).collect();
        Ok(Self {
            path: path.into(),
            part,
            header: titles.join(","),
            columns: titles.len(),
            file: None,
            end: 0,
            rows: 0,
            pending: Vec::new(),
            waiting: Vec::new(),
            stamps: None,
            due: f64::INFINITY,
        })
    }

    /// Adds a row; it is on its way to the disk within a second of the device's time.
    pub fn add(&mut self, sample: &Sample) -> Result<(), Error> {
        if self.file.is_none() {
            let made = File::options()
                .write(true)
                .create_new(true)
                .open(&self.part);
            self.file = Some(made.map_err(|e| Error::file(&self.part, e))?);
            self.pending.extend_from_slice(self.header.as_bytes());
            self.pending.push(b'\n');
            self.due = sample.time + BETWEEN;
        }
        row(&mut self.pending, sample);
        self.waiting.push(sample.time);
        if sample.time >= self.due || self.pending.len() >= MOST_PENDING {
            self.due = sample.time + BETWEEN;
            self.flush()?;
        }
        Ok(())
    }

    /// Writes the rows that wait. Where that fails, the file ends with the last whole row, and the others are gone.
    pub fn flush(&mut self) -> Result<(), Error> {
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        let result = write_rows(file, &self.pending);
        let (kept, rows) = match &result {
            Ok(()) => (self.pending.len(), self.waiting.len()),
            Err((kept, _)) => {
                let lines = self.pending[..*kept].iter().filter(|b| **b == b'\n');
                // The header is a line too.
                (
                    *kept,
                    lines.count().saturating_sub(usize::from(self.end == 0)),
                )
            }
        };
        self.end += kept as u64;
        self.rows += rows as u64;
        if let Some(last) = rows.checked_sub(1) {
            let first = self.stamps.map_or(self.waiting[0], |(first, _)| first);
            self.stamps = Some((first, self.waiting[last]));
        }
        self.pending.clear();
        self.waiting.clear();
        result.map_err(|(_, e)| {
            // A row that was begun is no row. Where even that fails, so does the reader, at that row.
            let _ = file.set_len(self.end);
            Error::file(&self.part, e)
        })
    }

    /// Rows that are in the file.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Time from the first to the last of them, s.
    pub fn span(&self) -> f64 {
        self.stamps.map_or(0.0, |(first, last)| last - first)
    }

    /// Gives the log its name: where it is, and what went wrong on the way, after which it is CSV. Without a row there is none.
    pub fn finish(mut self) -> (Option<PathBuf>, Option<Error>) {
        let mut fault = self.flush().err();
        let Some(file) = self.file.take() else {
            return (None, fault);
        };
        if self.rows == 0 {
            drop(file);
            let _ = fs::remove_file(&self.part);
            return (None, fault);
        }
        if let Err(e) = file.sync_all() {
            fault = fault.or(Some(Error::file(&self.part, e)));
        }
        drop(file);
        let mut name = self.path.clone();
        if name.extension().is_some_and(|end| end == "parquet") {
            let whole = name.with_extension("parquet.part");
            let made = table::write(&self.part, &whole, self.columns)
                .and_then(|()| rename(&whole, &name))
                .and_then(|()| fs::remove_file(&self.part));
            match made {
                Ok(()) => return (Some(name), fault),
                Err(e) => {
                    let _ = fs::remove_file(&whole);
                    fault = fault.or(Some(Error::file(&name, e)));
                    name.set_extension("csv");
                }
            }
        }
        match rename(&self.part, &name) {
            Ok(()) => (Some(name), fault),
            Err(e) => {
                let fault = fault.or(Some(Error::file(&name, e)));
                (Some(self.part), fault)
            }
        }
    }
}

/// Renames a file onto nothing.
fn rename(from: &Path, to: &Path) -> io::Result<()> {
    match to.symlink_metadata() {
        Ok(_) => Err(io::Error::other("was made meanwhile and is kept")),
        Err(_) => fs::rename(from, to),
    }
}

/// Name and unit as the reader splits them.
fn title(column: &Column) -> String {
    let title = match &column.unit {
        Some(unit) => format!("{} [{unit}]", column.name),
        None => column.name.clone(),
    };
    match title.contains([',', '"']) {
        true => format!("\"{}\"", title.replace('"', "\"\"")),
        false => title,
    }
}

/// A line; every finite number is written so that it is read back bit for bit.
fn row(out: &mut Vec<u8>, sample: &Sample) {
    let mut digits = zmij::Buffer::new();
    out.extend_from_slice(digits.format(sample.time).as_bytes());
    for value in &sample.values {
        out.push(b',');
        if value.is_finite() {
            out.extend_from_slice(digits.format(*value).as_bytes());
        }
    }
    out.push(b'\n');
}

/// Writes lines; where that fails, how many bytes of whole lines were written, and why.
fn write_rows(out: &mut impl Write, mut lines: &[u8]) -> Result<(), (usize, io::Error)> {
    let all = lines;
    while !lines.is_empty() {
        let fault = match out.write(lines) {
            Ok(0) => ErrorKind::WriteZero.into(),
            Ok(written) => {
                lines = &lines[written..];
                continue;
            }
            Err(e) if e.kind() == ErrorKind::Interrupted => continue,
            Err(e) => e,
        };
        let written = &all[..all.len() - lines.len()];
        let whole = written
            .iter()
            .rposition(|b| *b == b'\n')
            .map_or(0, |at| at + 1);
        return Err((whole, fault));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::write_rows;
    use std::io::{ErrorKind, Result, Write};

    /// A disk with room for so many bytes.
    struct Disk(usize);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> Result<usize> {
            let room = bytes.len().min(self.0).min(5);
            self.0 -= room;
            match room {
                0 => Err(ErrorKind::StorageFull.into()),
                _ => Ok(room),
            }
        }

        fn flush(&mut self) -> Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_keeps_whole_rows() {
        let lines = b"0.1,2\n0.2,3\n0.3,4\n";
        for (room, whole) in [(0, 0), (5, 0), (6, 6), (11, 6), (17, 12)] {
            let (kept, e) = write_rows(&mut Disk(room), lines).unwrap_err();
            assert_eq!((kept, e.kind()), (whole, ErrorKind::StorageFull), "{room}");
        }
        assert!(write_rows(&mut Disk(18), lines).is_ok());
    }
}
