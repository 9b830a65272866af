//! Runs of long work as they are done, in a file of the folder that the outcome goes to: where the work is ended by force, a
//! later call takes them from there.
//!
//! The first line says what work they belong to; each further one is a run, with a check sum. A line is added when its run is
//! done, and nothing else of the file changes, so that all but its last line is whole wherever the program is ended.

use super::staged;
use super::taken::writable_above;
use crate::error::Error;
use crate::hash::sha256_of;
use std::fs::{self, File, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The file's name in the folder.
pub(super) const NAME: &str = ".stiction-runs";
/// What its first line begins with.
const SCHEMA: &str = "stiction.runs/1";
/// Longest line that is read, bytes: the course of a run and its pictures are below a megabyte.
pub(super) const LONGEST: u64 = 1 << 24;
/// Characters of a check sum that are kept with a run.
pub(super) const SUM: usize = 16;

/// What runs belong to; others are not taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Work {
    /// `study` or `comparison`.
    pub kind: String,
    /// Version of stiction.
    pub version: String,
    /// SHA-256 of all that the runs depend on.
    pub of: String,
    /// How many runs it is made of.
    pub runs: usize,
    /// Further runs beside these, of which each says by itself what else it depends on: another call may have more or fewer.
    pub beside: usize,
}

impl Work {
    /// The first line of the file.
    pub(super) fn line(&self) -> String {
        let Work {
            kind,
            version,
            of,
            runs,
            beside: _,
        } = self;
        format!("{SCHEMA}\t{kind}\t{version}\t{of}\t{runs}")
    }

    pub(super) fn read(line: &str) -> Option<Self> {
        let mut cells = line.split('\t');
        let mut next = || cells.next().map(String::from);
        let schema = next()?;
        let work = Work {
            kind: next()?,
            version: next()?,
            of: next()?,
            runs: next()?.parse().ok()?,
            beside: 0,
        };
        (schema == SCHEMA && next().is_none()).then_some(work)
    }
}

/// The runs of a work that are done, kept as they are added.
pub struct Runs {
    path: PathBuf,
    /// What was done before, by the place of the run.
    taken: Vec<Option<String>>,
    open: Mutex<Open>,
}

struct Open {
    file: File,
    fault: Option<Error>,
}

impl Runs {
    /// Begins anew, in place of what an earlier call has left.
    ///
    /// # Errors
    /// Where the folder cannot be written, or another call is at work in it.
    pub fn begin(dir: &Path, work: &Work) -> Result<Self, Error> {
        let (path, file) = begun(dir, work)?;
        Ok(Self {
            path,
            taken: vec![None; work.runs + work.beside],
            open: Mutex::new(Open { file, fault: None }),
        })
    }

    /// Goes on with what an earlier call of the same work has left; begins anew where there is nothing.
    ///
    /// # Errors
    /// As [`Runs::begin`], and where the runs are of other work.
    pub fn resume(dir: &Path, work: &Work) -> Result<Self, Error> {
        let path = dir.join(NAME);
        let fail = |e: std::io::Error| Error::io(&path, &e);
        let Some(file) = opened(&path)? else {
            return Self::begin(dir, work);
        };
        let mut file = held(file, &path)?;
        let refused = |found: String| Error::Runs {
            path: path.clone(),
            found,
        };
        let mut lines = BufReader::new(&file);
        let (mut line, mut whole) = (String::new(), 0);
        let mut next = |line: &mut String| -> Option<u64> {
            line.clear();
            // What is no text is no whole line, as what has no end.
            let read = (&mut lines).take(LONGEST).read_line(line).ok()?;
            (line.pop() == Some('\n')).then_some(read as u64)
        };
        let read = next(&mut line);
        let head = read.and_then(|_| Work::read(&line));
        let head = head.ok_or_else(|| refused("holds no runs that can be taken".into()))?;
        if let Some(other) = other(&head, work) {
            return Err(refused(other));
        }
        whole += read.unwrap_or_default();
        let mut taken = vec![None; work.runs + work.beside];
        while let Some(read) = next(&mut line) {
            let Some((place, run)) = run_of(&line) else {
                break;
            };
            if let Some(slot) = taken.get_mut(place) {
                *slot = Some(run.to_string());
            }
            whole += read;
        }
        // What was being written when the call ended.
        file.set_len(whole).map_err(fail)?;
        file.seek(std::io::SeekFrom::End(0)).map_err(fail)?;
        Ok(Self {
            path,
            taken,
            open: Mutex::new(Open { file, fault: None }),
        })
    }

    /// How many runs were done before.
    pub fn before(&self) -> usize {
        self.taken.iter().flatten().count()
    }

    /// How many there are in all.
    pub fn all(&self) -> usize {
        self.taken.len()
    }

    /// The run of that place, as it was added before; `None` where it was not.
    pub fn taken(&self, place: usize) -> Option<&str> {
        self.taken.get(place)?.as_deref()
    }

    /// Keeps a run, a text of one line. Where that fails no more are kept: [`Runs::fault`] says why, and the work goes on.
    pub fn add(&self, place: usize, run: &str) {
        let line = format!("{place}\t{}\t{run}\n", sum(place, run));
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        if open.fault.is_none()
            && let Err(e) = open.file.write_all(line.as_bytes())
        {
            open.fault = Some(Error::io(&self.path, &e));
        }
    }

    /// Why runs could not be kept, where that is so.
    pub fn fault(&self) -> Option<String> {
        let open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        open.fault.as_ref().map(Error::to_string)
    }

    /// Removes what was kept: the outcome of the whole work is written.
    pub fn end(self) {
        // What cannot be removed is replaced by the next call.
        let _ = fs::remove_file(&self.path);
    }
}

/// Whether a folder holds runs that a call has left.
pub fn has_runs(dir: &Path) -> bool {
    dir.join(NAME).is_file()
}

/// The file with its first line alone, in place of what an earlier call has left.
pub(super) fn begun(dir: &Path, work: &Work) -> Result<(PathBuf, File), Error> {
    let path = dir.join(NAME);
    let fail = |e: std::io::Error| Error::io(&path, &e);
    writable_above(dir)?;
    fs::create_dir_all(dir).map_err(fail)?;
    if let Some(before) = opened(&path)? {
        held(before, &path)?;
    }
    let staged = staged::stage(&path, format!("{}\n", work.line()).as_bytes())?;
    let file = staged.persist(&path).map_err(|e| fail(e.error))?;
    Ok((path, file))
}

/// The file of that name, if there is one.
pub(super) fn opened(path: &Path) -> Result<Option<File>, Error> {
    // Opening a pipe of this name would wait for ever.
    match path.symlink_metadata() {
        Err(_) => return Ok(None),
        Ok(there) if !there.is_file() => {
            return Err(Error::output(path, "is not a file; remove it"));
        }
        Ok(_) => {}
    }
    let file = File::options().read(true).write(true).open(path);
    file.map(Some).map_err(|e| Error::io(path, &e))
}

/// The file, which no other program works on.
pub(super) fn held(file: File, path: &Path) -> Result<File, Error> {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(Error::output(
            path,
            "another call is at work in this folder; wait for it, or choose another folder",
        )),
        // Some file systems have no locks.
        _ => Ok(file),
    }
}

fn sum(place: usize, run: &str) -> String {
    let mut sum = sha256_of(format!("{place}\t{run}").as_bytes());
    sum.truncate(SUM);
    sum
}

/// The place and the text of a run, if its line is whole.
fn run_of(line: &str) -> Option<(usize, &str)> {
    let mut cells = line.splitn(3, '\t');
    let place = cells.next()?.parse().ok()?;
    let (kept, run) = (cells.next()?, cells.next()?);
    (sum(place, run) == kept).then_some((place, run))
}

/// What makes the runs of one work no runs of another.
fn other(theirs: &Work, ours: &Work) -> Option<String> {
    let short = |hash: &str| hash.get(..12).unwrap_or(hash).to_string();
    if theirs.kind != ours.kind {
        return Some(format!(
            "holds runs of a {}, this is a {}",
            theirs.kind, ours.kind
        ));
    }
    if theirs.version != ours.version {
        return Some(format!(
            "holds runs of version {}, this is {}",
            theirs.version, ours.version
        ));
    }
    (theirs.line() != ours.line()).then(|| {
        format!(
            "holds runs of another {}: SHA-256 of all that they depend on {}, of this {}",
            ours.kind,
            short(&theirs.of),
            short(&ours.of)
        )
    })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Cuts a file somewhere behind its first line, and changes a byte.
    pub(crate) fn damaged(path: &Path, part: f64, damage: Option<f64>) {
        let mut bytes = fs::read(path).unwrap();
        let head = bytes.iter().position(|b| *b == b'\n').unwrap() + 1;
        bytes.truncate(head + (part * (bytes.len() - head) as f64) as usize);
        if let Some(at) = damage
            && bytes.len() > head
        {
            let at = head + (at * (bytes.len() - head) as f64) as usize;
            bytes[at] ^= 1;
        }
        fs::write(path, &bytes).unwrap();
    }

    fn work(of: &str) -> Work {
        Work {
            kind: "study".into(),
            version: "1".into(),
            of: of.into(),
            runs: 5,
            beside: 0,
        }
    }

    fn taken(runs: &Runs) -> Vec<Option<u32>> {
        let number = |i| runs.taken(i).map(|run| run.parse().unwrap());
        (0..5).map(number).collect()
    }

    proptest! {
        /// Cut anywhere, and with a changed byte anywhere, what is taken is what was added.
        #[test]
        fn a_file_that_is_cut_or_damaged_gives_what_is_whole(part in 0.0..1.0, damage in proptest::option::of(0.0..1.0)) {
            let dir = tempfile::tempdir().unwrap();
            let runs = Runs::begin(dir.path(), &work("a")).unwrap();
            for i in [3, 0, 4] {
                runs.add(i, &(i + 10).to_string());
            }
            drop(runs);
            damaged(&dir.path().join(NAME), part, damage);
            let runs = Runs::resume(dir.path(), &work("a")).unwrap();
            for (i, found) in taken(&runs).into_iter().enumerate() {
                prop_assert!(found.is_none_or(|found| found == i as u32 + 10));
            }
            let before = runs.before();
            runs.add(1, "11");
            drop(runs);
            // What is added after a line that was cut is taken as well.
            let runs = Runs::resume(dir.path(), &work("a")).unwrap();
            prop_assert_eq!(runs.before(), before + 1);
            prop_assert_eq!(runs.taken(1), Some("11"));
        }
    }

    #[test]
    fn runs_beside_the_work_are_kept_for_calls_that_have_them() {
        let dir = tempfile::tempdir().unwrap();
        let with = Work {
            beside: 2,
            ..work("a")
        };
        let runs = Runs::begin(dir.path(), &with).unwrap();
        assert_eq!(runs.all(), 7);
        runs.add(6, "16");
        runs.add(1, "11");
        drop(runs);
        let runs = Runs::resume(dir.path(), &work("a")).unwrap();
        assert_eq!(
            (runs.all(), runs.before(), runs.taken(1)),
            (5, 1, Some("11"))
        );
        runs.add(2, "12");
        drop(runs);
        let runs = Runs::resume(dir.path(), &with).unwrap();
        assert_eq!((runs.before(), runs.taken(6)), (3, Some("16")));
    }

    #[test]
    fn runs_of_other_work_are_not_taken_and_those_of_nobody_are_replaced() {
        let dir = tempfile::tempdir().unwrap();
        let runs = Runs::begin(dir.path(), &work("a")).unwrap();
        runs.add(2, "12");
        let held = Runs::resume(dir.path(), &work("a")).err().unwrap();
        assert!(
            held.to_string().contains("another call is at work"),
            "{held}"
        );
        drop(runs);
        let said = |work: &Work| Runs::resume(dir.path(), work).err().unwrap().to_string();
        assert!(
            said(&work("b")).contains("another study"),
            "{}",
            said(&work("b"))
        );
        let newer = Work {
            version: "2".into(),
            ..work("a")
        };
        assert!(said(&newer).contains("of version 1, this is 2"));
        assert_eq!(Runs::resume(dir.path(), &work("a")).unwrap().before(), 1);
        Runs::begin(dir.path(), &work("b")).unwrap();
        let runs = Runs::resume(dir.path(), &work("b")).unwrap();
        assert_eq!(runs.before(), 0);
        runs.end();
        assert!(!has_runs(dir.path()));
    }
}
