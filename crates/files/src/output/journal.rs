//! Pieces of work that are kept as they are done, each under a key of all that it depends on: a later call, also one for more or
//! other pieces, takes those that it needs.
//!
//! As [`runs`](super::runs) in all else. What was kept stays on disk: of each piece only its place in the file is in memory.

use super::runs::{LONGEST, NAME, SUM, Work, begun, held, opened};
use crate::error::Error;
use crate::hash::sha256_of;
use std::collections::HashMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Pieces of work that are done, by their keys.
pub struct Journal {
    path: PathBuf,
    open: Mutex<Open>,
}

struct Open {
    file: File,
    /// Bytes that the file has.
    end: u64,
    /// Where each piece stands.
    places: HashMap<String, (u64, usize)>,
    fault: Option<Error>,
}

impl Journal {
    /// Begins anew, in place of what an earlier call has left.
    ///
    /// # Errors
    /// Where the folder cannot be written, or another call is at work in it.
    pub fn begin(dir: &Path, kind: &str) -> Result<Self, Error> {
        let work = work(kind);
        let (path, file) = begun(dir, &work)?;
        let open = Open {
            file,
            end: work.line().len() as u64 + 1,
            places: HashMap::new(),
            fault: None,
        };
        Ok(Self {
            path,
            open: Mutex::new(open),
        })
    }

    /// Goes on with what an earlier call has left; begins anew where there is nothing.
    ///
    /// # Errors
    /// As [`Journal::begin`], and where it is not of this kind of work or of another version.
    pub fn resume(dir: &Path, kind: &str) -> Result<Self, Error> {
        let path = dir.join(NAME);
        let fail = |e: std::io::Error| Error::io(&path, &e);
        let Some(file) = opened(&path)? else {
            return Self::begin(dir, kind);
        };
        let mut file = held(file, &path)?;
        let mut lines = BufReader::new(&file);
        let mut line = Vec::new();
        let mut next = |line: &mut Vec<u8>| -> Option<u64> {
            line.clear();
            let read = (&mut lines).take(LONGEST).read_until(b'\n', line).ok()?;
            (line.pop() == Some(b'\n')).then_some(read as u64)
        };
        let read = next(&mut line);
        let ours = work(kind);
        let head = std::str::from_utf8(&line).ok().and_then(Work::read);
        if head.as_ref() != Some(&ours) {
            let found = match head {
                Some(head) if head.kind != kind => {
                    format!("holds runs of a {}, this is a {kind}", head.kind)
                }
                Some(head) => format!(
                    "holds logs of version {}, this is {}",
                    head.version, ours.version
                ),
                None => "holds nothing that can be taken".into(),
            };
            return Err(Error::Runs { path, found });
        }
        let mut end = read.unwrap_or_default();
        let mut places = HashMap::new();
        while let Some(read) = next(&mut line) {
            let Some((key, from)) = whole(&line) else {
                break;
            };
            places.insert(key.to_string(), (end + from as u64, line.len() - from));
            end += read;
        }
        // What was being written when the call ended.
        file.set_len(end).map_err(fail)?;
        file.seek(SeekFrom::End(0)).map_err(fail)?;
        let open = Open {
            file,
            end,
            places,
            fault: None,
        };
        Ok(Self {
            path,
            open: Mutex::new(open),
        })
    }

    fn open(&self) -> std::sync::MutexGuard<'_, Open> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How many pieces are kept.
    pub fn len(&self) -> usize {
        self.open().places.len()
    }

    /// Whether none is.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the piece of that key is kept.
    pub fn has(&self, key: &str) -> bool {
        self.open().places.contains_key(key)
    }

    /// The piece of that key as it was added; `None` where it was not, or can no longer be read.
    pub fn taken(&self, key: &str) -> Option<String> {
        let mut open = self.open();
        let (from, length) = *open.places.get(key)?;
        let mut bytes = vec![0; length];
        let end = open.end;
        open.file.seek(SeekFrom::Start(from)).ok()?;
        let read = open.file.read_exact(&mut bytes);
        open.file.seek(SeekFrom::Start(end)).ok()?;
        read.ok()?;
        String::from_utf8(bytes).ok()
    }

    /// Keeps a piece, a text of one line, under a key without tabs; one that is added again takes the place of the earlier. Where
    /// that fails [`Journal::fault`] says why.
    pub fn add(&self, key: &str, text: &str) {
        let line = format!("{key}\t{}\t{text}\n", sum(key, text));
        let mut open = self.open();
        if open.fault.is_some() {
            return;
        }
        match open.file.write_all(line.as_bytes()) {
            Ok(()) => {
                let from = open.end + (line.len() - 1 - text.len()) as u64;
                open.end += line.len() as u64;
                open.places.insert(key.into(), (from, text.len()));
            }
            Err(e) => open.fault = Some(Error::io(&self.path, &e)),
        }
    }

    /// Why a piece could not be kept, where that is so; said once.
    pub fn fault(&self) -> Option<Error> {
        let mut open = self.open();
        open.fault.take()
    }

    /// Removes what was kept: the outcome of the whole work is written.
    pub fn end(self) {
        // What cannot be removed is replaced by the next call.
        let _ = fs::remove_file(&self.path);
    }
}

/// The first line of the file: of which work they are stands in the keys.
fn work(kind: &str) -> Work {
    Work {
        kind: kind.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        of: "keys".into(),
        runs: 0,
        beside: 0,
    }
}

fn sum(key: &str, text: &str) -> String {
    let mut sum = sha256_of(format!("{key}\t{text}").as_bytes());
    sum.truncate(SUM);
    sum
}

/// The key of a whole line, and where the text begins in it.
fn whole(line: &[u8]) -> Option<(&str, usize)> {
    let line = std::str::from_utf8(line).ok()?;
    let mut cells = line.splitn(3, '\t');
    let (key, kept, text) = (cells.next()?, cells.next()?, cells.next()?);
    (sum(key, text) == kept).then(|| (key, line.len() - text.len()))
}

#[cfg(test)]
mod tests {
    use super::super::runs::tests::damaged;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Cut anywhere, and with a changed byte anywhere, what is taken is what was added.
        #[test]
        fn a_journal_that_is_cut_or_damaged_gives_what_is_whole(part in 0.0..1.0, damage in proptest::option::of(0.0..1.0)) {
            let dir = tempfile::tempdir().unwrap();
            let journal = Journal::begin(dir.path(), "batch").unwrap();
            for key in ["a", "b", "c", "b"] {
                journal.add(key, &format!("{{\"of {key}\": 1}}"));
            }
            let all = journal.len();
            drop(journal);
            damaged(&dir.path().join(NAME), part, damage);
            let journal = Journal::resume(dir.path(), "batch").unwrap();
            prop_assert!(journal.len() <= all);
            for key in ["a", "b", "c"] {
                let taken = journal.taken(key);
                prop_assert_eq!(journal.has(key), taken.is_some());
                let added = format!("{{\"of {key}\": 1}}");
                prop_assert!(taken.is_none_or(|text| text == added));
            }
            journal.add("d", "new");
            prop_assert_eq!(journal.taken("d"), Some("new".to_string()));
            drop(journal);
            let journal = Journal::resume(dir.path(), "batch").unwrap();
            prop_assert_eq!(journal.taken("d"), Some("new".to_string()));
        }
    }

    #[test]
    fn a_journal_is_held_and_of_one_kind() {
        let dir = tempfile::tempdir().unwrap();
        let journal = Journal::begin(dir.path(), "batch").unwrap();
        let said = |kind: &str| Journal::resume(dir.path(), kind).err().unwrap().to_string();
        assert!(said("batch").contains("another call is at work"));
        drop(journal);
        assert!(said("study").contains("holds runs of a batch, this is a study"));
        Journal::resume(dir.path(), "batch").unwrap().end();
        assert!(!super::super::has_runs(dir.path()));
    }
}
