//! One log of a batch: identified, or the reason why not.

use super::prepare::{Batch, Entry};
use crate::error::Error;
use crate::identify::{Files, Outcome, identify};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::RwLock;
use stiction_codes::Code;
use stiction_files::batch::LogRow;
use stiction_files::{sha256, shell};
use stiction_formats::{is_regular, within_memory};
use stiction_search::Observer;

/// Where the report of a log is put.
pub(super) type Report<'a> = &'a (dyn Fn(&Outcome, &str) -> Result<(), Error> + Sync);

/// Memory that logs share which are read at the same time.
pub(super) struct Memory {
    /// Bytes for each of those that are read beside others.
    pub share: u64,
    /// Bytes for one that is read alone.
    pub all: u64,
    /// Held for writing by one that is read alone.
    pub turns: RwLock<()>,
}

/// What became of a log.
pub(super) enum Became {
    /// Its row, to be kept under that key.
    Row(String, Box<LogRow>),
    /// A row that is kept already, under that key.
    Taken(String),
    /// Nothing: the work was stopped.
    Stopped,
}

/// A row as it is kept.
pub(super) fn text(row: &LogRow) -> String {
    serde_json::to_string(row).expect("plain data")
}

/// Identifies a log, unless `has` says that it was before.
///
/// # Errors
/// Where its report cannot be written.
pub(super) fn one(
    batch: &Batch,
    entry: &Entry,
    has: &dyn Fn(&str) -> bool,
    memory: &Memory,
    report: Report,
    observer: &mut dyn Observer,
    stopped: &dyn Fn() -> bool,
) -> Result<Became, Error> {
    let path = &entry.listed.path;
    // What is no file the reader refuses.
    let before = is_regular(path).then(|| sha256(path).ok()).flatten();
    let mut row = begun(batch, entry);
    let key = batch.key(entry, before.as_deref().unwrap_or("unread"));
    let failed = batch.key_of_failure(entry, &key);
    if before.is_some()
        && let Some(key) = [&key, &failed].into_iter().find(|key| has(key))
    {
        return Ok(Became::Taken(key.clone()));
    }
    row.sha256.clone_from(&before);
    let files = Files {
        logs: vec![path.clone()],
        axis: batch.axes[entry.axis].file.clone(),
        validate: Vec::new(),
    };
    let outcome = guarded(|| within(memory, || identify(&files, &batch.options, observer)));
    if stopped() {
        return Ok(Became::Stopped);
    }
    let refused = match outcome {
        Ok(Ok(outcome)) => {
            let read = outcome.sources.first().map(|source| &source.sha256);
            // What was identified belongs to the key only where its files are still those of which it was made.
            let same = read == before.as_ref()
                && !batch.axes[entry.axis].has_changed()
                && batch.key(entry, before.as_deref().unwrap_or("unread")) == key;
            if same {
                row.take(&outcome.result);
                row.temperature = row.temperature.or_else(|| mean_temperature(&outcome));
                if batch.reports {
                    let name = folder_of(path, &key);
                    report(&outcome, &name)?;
                    row.report = Some(name);
                }
                row.key.clone_from(&key);
                return Ok(Became::Row(key, Box::new(row)));
            }
            row.sha256 = None;
            (
                Code::LogIo,
                format!(
                    "{}: the file, its axis file or one that is joined changed while it was read; files that stay as they are, or copies of \
                     them",
                    path.display()
                ),
            )
        }
        Ok(Err(e)) => (e.code(), e.to_string()),
        Err(panic) => (
            Code::Internal,
            format!(
                "{}: stiction itself failed on this log ({panic}); please report it with the log if you can",
                path.display()
            ),
        ),
    };
    row.error = Some(refused.0);
    row.message = Some(called(entry, &batch.axes[entry.axis].file, refused.1));
    row.key.clone_from(&failed);
    Ok(Became::Row(failed, Box::new(row)))
}

/// What is known of a log before it is read.
pub(super) fn begun(batch: &Batch, entry: &Entry) -> LogRow {
    let axis = &batch.axes[entry.axis];
    let name = axis.axis.as_ref().and_then(|axis| axis.name.clone());
    LogRow {
        path: entry.name(),
        machine: entry.listed.machine.clone().or(name),
        time: entry.listed.time,
        temperature: entry.listed.temperature,
        axis: entry
            .called
            .axis
            .clone()
            .or(axis.file.as_deref().map(shell::text)),
        version: env!("CARGO_PKG_VERSION").into(),
        seed: batch.options.seed,
        ..LogRow::default()
    }
}

/// What is said of copies, as said of what they are copies of.
fn called(entry: &Entry, axis: &Option<PathBuf>, message: String) -> String {
    let copies = [
        (Some(&entry.listed.path), &entry.called.log),
        (axis.as_ref(), &entry.called.axis),
    ];
    copies.into_iter().fold(message, |said, pair| match pair {
        (Some(copy), Some(name)) => said
            .replace(&copy.display().to_string(), name)
            .replace(&shell::text(copy), name),
        _ => said,
    })
}

/// Reads a log within its share of the memory, and where that is too little alone, with all that is allowed.
fn within(
    memory: &Memory,
    mut identified: impl FnMut() -> Result<Outcome, Error>,
) -> Result<Outcome, Error> {
    // A panic that leaves a lock poisoned has changed nothing that it guards.
    let shared = memory.turns.read().unwrap_or_else(|e| e.into_inner());
    let outcome = within_memory(memory.share, &mut identified);
    drop(shared);
    let is_large = |e: &Error| e.code() == Code::LogLimit && memory.share < memory.all;
    if !outcome.as_ref().is_err_and(is_large) {
        return outcome;
    }
    let _alone = memory.turns.write().unwrap_or_else(|e| e.into_inner());
    within_memory(memory.all, identified)
}

/// Does something whose panic is no end of the batch; what the panic said.
fn guarded<T>(does: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(does)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        text.unwrap_or("no reason is known").to_string()
    })
}

/// Mean of the log's own temperature, in its unit; none where it has none.
fn mean_temperature(outcome: &Outcome) -> Option<f64> {
    let temperature = outcome.sources.first()?.log.temperature.as_ref()?;
    let known = temperature.iter().filter(|t| t.is_finite());
    let (sum, count) = known.fold((0.0, 0u32), |(sum, count), t| (sum + t, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

/// Longest part of a name that the folder of a report has from its log.
const LONGEST_STEM: usize = 60;

/// The folder of a report below that of the batch.
fn folder_of(path: &Path, key: &str) -> String {
    let stem = path
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned());
    let plain = |c: char| {
        if c.is_alphanumeric() || "-_".contains(c) {
            c
        } else {
            '_'
        }
    };
    let stem: String = stem
        .unwrap_or_default()
        .chars()
        .take(LONGEST_STEM)
        .map(plain)
        .collect();
    format!("reports/{stem}-{}", &key[..12])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_told_and_a_folder_has_a_plain_name() {
        assert_eq!(guarded(|| 1), Ok(1));
        let said = guarded(|| panic!("sample {} of 3", 4)).map(|(): ()| 0);
        assert_eq!(said, Err("sample 4 of 3".to_string()));
        let key = "0123456789abcdef";
        let name = folder_of(Path::new("a/../b c\u{1b}.tar.csv"), key);
        assert_eq!(name, "reports/b_c__tar-0123456789ab");
    }
}
