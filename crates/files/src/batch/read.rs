//! The logs of a `results.parquet` that is there.

use super::row::{LogRow, ParameterRow};
use super::summary::SCHEMA;
use super::table::{COLUMNS, KINDS, Kind};
use crate::error::Error;
use crate::hash::{Hash, sha256_of};
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_formats::{Cells, Limits, read_cells};

/// The tables of a path: itself, or where it is a folder those in it, as [`crate::batch`] names and orders them.
///
/// # Errors
/// Where the folder cannot be read or holds no table.
fn tables(path: &Path) -> Result<Vec<PathBuf>, Error> {
    if !path.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let refused = |found: String| Error::Config {
        file: path.to_path_buf(),
        place: String::new(),
        found,
        allowed:
            "a table that stiction batch writes, or a folder of tables that stiction.fleet writes"
                .into(),
    };
    let entries = std::fs::read_dir(path).map_err(|e| refused(format!("cannot be read ({e})")))?;
    let is_table = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().as_encoded_bytes();
        path.extension().is_some_and(|end| end == "parquet") && !name.starts_with(b".")
    };
    let mut all: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(is_table)
        .collect();
    if all.is_empty() {
        return Err(refused("holds no table (*.parquet)".into()));
    }
    all.sort();
    Ok(all)
}

/// Refuses a file that is no table of a batch by its first bytes.
fn refuse_other(file: &Path) -> Result<(), Error> {
    let is_text = || crate::looks(file).filter(|_| !stiction_formats::is_binary_recording(file));
    let Some(looks) = is_text() else {
        return Ok(());
    };
    Err(Error::OtherForm {
        file: file.to_path_buf(),
        found: looks.what().into(),
        wanted: "the results.parquet of stiction batch",
        instead: None,
    })
}

/// Reads the table of an earlier batch, or those of a folder, and hands on their logs in their order; gives the SHA-256 of what
/// was read, of a folder of tables that of theirs, one after the other.
///
/// # Errors
/// Where one cannot be read or is no table of a batch, and what `take` refuses.
pub fn read_results(
    path: &Path,
    take: impl FnMut(LogRow) -> Result<(), Error>,
) -> Result<String, Error> {
    Ok(read_results_while(path, || true, take)?.expect("goes on"))
}

/// The same for as long as `goes_on` says so, which is asked before each part of a column and each log; else `None`.
///
/// # Errors
/// As of [`read_results`].
pub fn read_results_while(
    path: &Path,
    mut goes_on: impl FnMut() -> bool,
    mut take: impl FnMut(LogRow) -> Result<(), Error>,
) -> Result<Option<String>, Error> {
    let mut hashes = String::new();
    for table in tables(path)? {
        refuse_other(&table)?;
        let mut hash = Hash::default();
        let bytes = |bytes: &[u8]| hash.take(bytes);
        let columns = read_cells(&table, &COLUMNS, Limits::default(), &mut goes_on, bytes)?;
        let Some(columns) = columns else {
            return Ok(None);
        };
        if !rows_while(&table, &columns, &mut goes_on, &mut take)? {
            return Ok(None);
        }
        hashes += &hash.finish();
    }
    Ok(Some(match path.is_dir() {
        true => sha256_of(hashes.as_bytes()),
        false => hashes,
    }))
}

/// Hands on the logs of columns that are in memory already, in the order of [`COLUMNS`] and all of one length; `path` is what
/// errors call them. For as long as `goes_on` says so, which is asked before each log; whether it did to the end.
///
/// # Errors
/// Where they are no table of a batch, and what `take` refuses.
pub fn rows_while(
    path: &Path,
    columns: &[Option<Cells>],
    mut goes_on: impl FnMut() -> bool,
    mut take: impl FnMut(LogRow) -> Result<(), Error>,
) -> Result<bool, Error> {
    let columns = checked(path, columns)?;
    let of = |name: &str| {
        let place = COLUMNS.iter().position(|column| *column == name);
        columns[place.expect("a name of the columns")]
    };
    let (paths, keys) = (of("path"), of("key"));
    let text = |name: &str, row: usize| of(name).text(row).map(String::from);
    let number = |name: &str, row: usize| of(name).number(row);
    let flag = |name: &str, row: usize| of(name).flag(row);
    let same = |a: usize, b: usize| paths.text(a) == paths.text(b) && keys.text(a) == keys.text(b);
    let mut first = 0;
    while first < paths.len() {
        if !goes_on() {
            return Ok(false);
        }
        let rest = first + 1..paths.len();
        let end = rest
            .into_iter()
            .find(|row| !same(first, *row))
            .unwrap_or(paths.len());
        let parameters = (first..end).filter_map(|row| {
            Some(ParameterRow {
                name: text("parameter", row)?,
                value: number("value", row),
                unit: text("unit", row).unwrap_or_default(),
                std: number("std", row),
                low: number("low", row),
                high: number("high", row),
                identifiable: flag("identifiable", row).unwrap_or_default(),
                origin: text("origin", row).unwrap_or_default(),
            })
        });
        let warnings = text("warnings", first).unwrap_or_default();
        let warnings = warnings.split_whitespace().filter_map(Code::from_name);
        take(LogRow {
            path: text("path", first).unwrap_or_default(),
            sha256: text("sha256", first),
            machine: text("machine", first),
            time: number("time", first),
            temperature: number("temperature", first),
            axis: text("axis", first),
            law: text("law", first),
            asymmetric: flag("asymmetric", first),
            method: text("method", first),
            trustworthy: flag("trustworthy", first),
            relative_error_percent: number("relative_error_percent", first),
            samples: number("samples", first).map(|n| n as u64),
            warnings: warnings.collect(),
            error: text("error", first).and_then(|code| Code::from_name(&code)),
            message: text("message", first),
            report: text("report", first),
            version: text("version", first).unwrap_or_default(),
            seed: number("seed", first).unwrap_or_default() as u64,
            key: text("key", first).unwrap_or_default(),
            parameters: parameters.collect(),
        })?;
        first = end;
    }
    Ok(true)
}

/// The columns, all of them there, each with what belongs into it, and of this schema.
fn checked<'a>(path: &Path, columns: &'a [Option<Cells>]) -> Result<Vec<&'a Cells>, Error> {
    let refused = |place: String, found: String, allowed: &str| Error::Config {
        file: path.to_path_buf(),
        place,
        found,
        allowed: allowed.into(),
    };
    let one = |((name, kind), cells): ((&str, Kind), &'a Option<Cells>)| {
        let Some(cells) = cells else {
            let allowed = "the whole table that stiction batch writes";
            return Err(refused(
                format!("column {name}: "),
                "is not there".into(),
                allowed,
            ));
        };
        let (fits, allowed) = match kind {
            Kind::Text => (matches!(cells, Cells::Text { .. }), "text"),
            Kind::Real | Kind::Whole => (matches!(cells, Cells::Numbers(_)), "numbers"),
            Kind::Flag => (matches!(cells, Cells::Flags(_)), "yes or no"),
        };
        // A column without any value has no type of its own after some programs.
        match first_of(cells).filter(|_| !fits) {
            Some((row, found)) => Err(refused(
                format!("row {}, column {name}: ", row + 1),
                found,
                allowed,
            )),
            None => Ok(cells),
        }
    };
    let columns: Result<Vec<&Cells>, Error> = COLUMNS
        .into_iter()
        .zip(KINDS)
        .zip(columns)
        .map(one)
        .collect();
    let columns = columns?;
    let schemas = columns[COLUMNS.len() - 1];
    let other = (0..schemas.len()).find(|row| schemas.text(*row) != Some(SCHEMA));
    match other {
        None => Ok(columns),
        Some(row) => Err(refused(
            format!("row {}, column schema: ", row + 1),
            schemas
                .text(row)
                .map_or("nothing".into(), |s| format!("{s:?}")),
            SCHEMA,
        )),
    }
}

/// The first cell that is not empty: its row and what stands there.
fn first_of(cells: &Cells) -> Option<(usize, String)> {
    (0..cells.len()).find_map(|row| {
        let text = cells.text(row).map(|text| format!("{text:?}"));
        let number = || cells.number(row).map(stiction_number::full);
        let flag = || cells.flag(row).map(|flag| flag.to_string());
        Some((row, text.or_else(number).or_else(flag)?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::Results;
    use proptest::prelude::*;

    fn some<T: std::fmt::Debug>(of: impl Strategy<Value = T>) -> impl Strategy<Value = Option<T>> {
        proptest::option::of(of)
    }

    prop_compose! {
        fn parameter()(
            name in "[a-z0-9_]{1,12}",
            value in some(-1e12..1e12),
            unit in "[a-zA-Z·/]{1,6}",
            ends in some((-1e3..1e3, 0.0..1e3)),
            low_open in any::<bool>(),
            identifiable in any::<bool>(),
        ) -> ParameterRow {
            ParameterRow {
                name,
                value,
                unit,
                std: ends.map(|(_, width)| width / 4.0),
                low: ends.map(|(low, _)| low).filter(|_| !low_open),
                high: ends.map(|(low, width)| low + width),
                identifiable,
                origin: "identified".into(),
            }
        }
    }

    prop_compose! {
        fn log()(
            path in "\\PC{1,12}",
            machine in some("\\PC{1,6}"),
            time in some(-1e10..1e10),
            failed in any::<bool>(),
            parameters in prop::collection::vec(parameter(), 1..6),
            seed in 0u64..1 << 50,
            key in "[0-9a-f]{64}",
        ) -> LogRow {
            LogRow {
                path,
                machine,
                time,
                sha256: (!failed).then(|| "ab".repeat(32)),
                error: failed.then_some(Code::LogFormat),
                message: failed.then(|| "was refused".into()),
                law: (!failed).then(|| "lugre".into()),
                trustworthy: (!failed).then_some(true),
                samples: (!failed).then_some(30_001),
                warnings: if failed { vec![] } else { vec![Code::Gap, Code::Jitter] },
                parameters: if failed { vec![] } else { parameters },
                version: "0".into(),
                seed,
                key,
                ..LogRow::default()
            }
        }
    }

    /// The same table with every one of these words changed into another of the same length.
    fn said_with(words: &str, others: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.parquet");
        let mut out = Results::begin(&path).unwrap();
        let row = LogRow {
            path: "a".into(),
            key: "k".into(),
            ..LogRow::default()
        };
        out.add(&row).unwrap();
        out.end().unwrap();
        let mut bytes = std::fs::read(&path).unwrap();
        let (words, others) = (words.as_bytes(), others.as_bytes());
        while let Some(at) = bytes.windows(words.len()).position(|part| part == words) {
            bytes[at..at + words.len()].copy_from_slice(others);
        }
        std::fs::write(&path, &bytes).unwrap();
        let refused = read_results(&path, |_| Ok(())).unwrap_err().to_string();
        refused.replace(&folder.path().display().to_string(), "DIR")
    }

    #[test]
    fn a_table_of_another_kind_is_refused_with_its_place() {
        let said = [
            said_with("identifiable", "identifiabel"),
            said_with("stiction.batch/1", "stiction.batch/2"),
        ];
        insta::assert_snapshot!(said.join("\n"));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        /// What is read is what was written, bit for bit, and the same logs give the same bytes.
        #[test]
        fn logs_come_back_as_they_were_written(logs in prop::collection::vec(log(), 0..12)) {
            let folder = tempfile::tempdir().unwrap();
            let write = |name: &str| {
                let path = folder.path().join(name);
                let mut out = Results::begin(&path).unwrap();
                logs.iter().for_each(|log| out.add(log).unwrap());
                out.end().unwrap();
                path
            };
            let path = write("a.parquet");
            let mut read = Vec::new();
            let hash = read_results(&path, |log| { read.push(log); Ok(()) }).unwrap();
            prop_assert_eq!(&read, &logs);
            prop_assert_eq!(hash, sha256_of(&std::fs::read(&path).unwrap()));
            let other = write("b.parquet");
            prop_assert_eq!(std::fs::read(path).unwrap(), std::fs::read(other).unwrap());
        }

        /// A folder is read as its tables one after the other, by name.
        #[test]
        fn a_folder_is_its_tables(logs in prop::collection::vec(log(), 1..8), cut in 0.0..1.0f64) {
            let folder = tempfile::tempdir().unwrap();
            let (first, rest) = logs.split_at((cut * logs.len() as f64) as usize);
            for (name, logs) in [("part-000010.parquet", rest), ("part-000002.parquet", first)] {
                let mut out = Results::begin(&folder.path().join(name)).unwrap();
                logs.iter().for_each(|log| out.add(log).unwrap());
                out.end().unwrap();
            }
            std::fs::write(folder.path().join(".part-000003.parquet"), "half").unwrap();
            std::fs::write(folder.path().join("drift.json"), "{}").unwrap();
            let mut read = Vec::new();
            read_results(folder.path(), |log| { read.push(log); Ok(()) }).unwrap();
            prop_assert_eq!(&read, &logs);
        }

        /// Told to stop at any moment, it asks no more and gives nothing.
        #[test]
        fn a_table_is_read_only_while_it_is_wanted(logs in prop::collection::vec(log(), 1..8), part in 0.0..1.0f64) {
            let folder = tempfile::tempdir().unwrap();
            let mut out = Results::begin(&folder.path().join("part-000001.parquet")).unwrap();
            logs.iter().for_each(|log| out.add(log).unwrap());
            out.end().unwrap();
            let asked = |most: usize| {
                let mut asked = 0;
                let goes_on = || { asked += 1; asked <= most };
                let hash = read_results_while(folder.path(), goes_on, |_| Ok(())).unwrap();
                (asked, hash)
            };
            let (all, hash) = asked(usize::MAX);
            prop_assert!(hash.is_some());
            // Each column and each log at least.
            prop_assert!(all >= COLUMNS.len() + logs.len());
            let most = (part * all as f64) as usize;
            prop_assert_eq!(asked(most), (most + 1, None));
        }

        /// Cut or changed anywhere, a table is read or refused.
        #[test]
        fn a_damaged_table_is_no_fault(part in 0.0..1.0f64, flip in 0.0..1.0f64, cut in any::<bool>()) {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("results.parquet");
            let mut out = Results::begin(&path).unwrap();
            let row = LogRow { path: "a".into(), key: "k".into(), ..LogRow::default() };
            (0..20).for_each(|_| out.add(&row).unwrap());
            out.end().unwrap();
            let mut bytes = std::fs::read(&path).unwrap();
            if cut {
                bytes.truncate((part * bytes.len() as f64) as usize);
            } else {
                let at = (flip * bytes.len() as f64) as usize;
                bytes[at] ^= 0x55;
            }
            std::fs::write(&path, &bytes).unwrap();
            let _ = read_results(&path, |_| Ok(()));
        }
    }
}
