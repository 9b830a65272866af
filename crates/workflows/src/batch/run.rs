//! A batch on all threads, and what is written of it.

use super::one::{Became, Memory, Report, begun, one, text};
use super::prepare::Batch;
use crate::error::Error;
use crate::identify::Outcome;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError, RwLock};
use stiction_files::batch::{BatchFile, Failure, Levels, LogRow, Named, RESULTS, Results};
use stiction_files::{Error as FileError, Journal};
use stiction_formats::allowed_memory;
use stiction_search::{Control, Observer, Progress, Shared};

/// The logs of a batch that are done.
pub struct Done {
    /// What each is kept under; none of one that was not begun, or stopped.
    keys: Vec<Option<String>>,
    /// How many of them were done before this call.
    taken: usize,
}

impl Done {
    /// Whether all are.
    pub fn is_whole(&self) -> bool {
        self.keys.iter().all(Option::is_some)
    }
}

impl Batch {
    /// Identifies the logs that are not kept yet and keeps them, as many at the same time as there are threads, each on one thread
    /// (on several where there are more threads than logs). The rows do not depend on the number of threads. The observer is told
    /// how many logs are done, and may stop the work: logs that are not done then are not kept. `report` writes the report of a
    /// log into the folder of that name, where reports are wanted.
    ///
    /// # Errors
    /// Where what is done can no longer be kept, or a report cannot be written. What fails with a log is in its row.
    pub fn run(
        &self,
        journal: &Journal,
        report: &(dyn Fn(&Outcome, &str) -> Result<(), Error> + Sync),
        observer: &mut dyn Observer,
    ) -> Result<Done, Error> {
        let threads = rayon::current_num_threads();
        let workers = threads.min(self.logs.len()).max(1);
        let all = allowed_memory();
        let memory = Memory {
            share: all / workers as u64,
            all,
            turns: RwLock::new(()),
        };
        let watch = Shared::of_logs(observer, self.logs.len());
        watch.go_on();
        let crew = Crew {
            batch: self,
            journal,
            memory: &memory,
            report,
            watch: &watch,
            next: AtomicUsize::new(0),
            taken: AtomicUsize::new(0),
            own: Mutex::default(),
            keys: self.logs.iter().map(|_| OnceLock::new()).collect(),
            fault: Mutex::new(None),
        };
        std::thread::scope(|scope| {
            for _ in 0..workers {
                scope.spawn(|| crew.work(threads / workers));
            }
        });
        let fault = crew
            .fault
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        match fault {
            Some(e) => Err(e),
            None => Ok(Done {
                keys: crew.keys.into_iter().map(OnceLock::into_inner).collect(),
                taken: crew.taken.into_inner(),
            }),
        }
    }

    /// Writes `results.parquet` and `batch.json` of a batch that is done as a whole; of one that was stopped `batch.json` alone,
    /// and what was done stays kept.
    ///
    /// # Errors
    /// Where they cannot be written, or what was kept is no longer there.
    pub fn write(&self, dir: &Path, journal: &Journal, done: &Done) -> Result<BatchFile, Error> {
        let mut file = self.summary(if done.is_whole() {
            "complete"
        } else {
            "interrupted"
        });
        file.taken = done.taken;
        let mut recordings = HashSet::new();
        let mut table = done
            .is_whole()
            .then(|| Results::begin(&dir.join(RESULTS)))
            .transpose()?;
        let mut levels = Levels::default();
        let mut failed: BTreeMap<&str, Failure> = BTreeMap::new();
        for (entry, key) in self.logs.iter().zip(&done.keys) {
            let Some(key) = key else {
                continue;
            };
            let kept = journal
                .taken(key)
                .and_then(|row| serde_json::from_str::<LogRow>(&row).ok());
            let lost = || {
                FileError::output(
                    dir,
                    "what was kept of logs that are done can no longer be read",
                )
            };
            let mut row = kept.ok_or_else(lost)?;
            // A log that was taken may have another name by now, or more may be known of it.
            let known = begun(self, entry);
            row.path = known.path;
            row.machine = known.machine;
            row.time = known.time;
            row.temperature = known.temperature.or(row.temperature);
            row.axis = known.axis;
            if let Some(bytes) = &row.sha256 {
                let is_new = recordings.insert((bytes.clone(), row.axis.clone()));
                file.copies += usize::from(!is_new);
            }
            let named = || Named {
                path: row.path.clone(),
                axis: row.axis.clone(),
            };
            match (row.error, row.trustworthy) {
                (Some(code), _) => {
                    let first = || Failure {
                        code,
                        logs: 0,
                        log: named(),
                        first: row.message.clone().unwrap_or_default(),
                    };
                    failed.entry(code.as_str()).or_insert_with(first).logs += 1;
                }
                (None, trustworthy) => {
                    file.identified += 1;
                    match trustworthy {
                        Some(true) => file.trustworthy += 1,
                        _ => file.doubted = file.doubted.or_else(|| Some(named())),
                    }
                }
            }
            levels.take(&row);
            if let Some(table) = &mut table {
                table.add(&row)?;
            }
        }
        file.apart = levels.apart();
        file.failed = failed.into_values().collect();
        file.failed
            .sort_by_key(|failure| std::cmp::Reverse(failure.logs));
        let is_whole = table.is_some();
        if let Some(table) = table {
            // An earlier batch.json that says complete would say it of this table where the program is killed between the two.
            self.write_summary(dir, &self.summary("running"))?;
            table.end()?;
        }
        if is_whole || !dir.join(RESULTS).is_file() {
            self.write_summary(dir, &file)?;
        }
        Ok(file)
    }
}

/// What the threads of a batch share.
struct Crew<'a, 'o> {
    batch: &'a Batch,
    journal: &'a Journal,
    memory: &'a Memory,
    report: Report<'a>,
    watch: &'a Shared<'o>,
    next: AtomicUsize,
    taken: AtomicUsize,
    /// What this call has identified.
    own: Mutex<HashSet<String>>,
    keys: Vec<OnceLock<String>>,
    fault: Mutex<Option<Error>>,
}

impl Crew<'_, '_> {
    /// Takes logs until none is left, each on so many threads.
    fn work(&self, threads: usize) {
        // A pool of its own: in a common one a thread that waits for a part of its log would begin another log meanwhile.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = match pool {
            Ok(pool) => pool,
            Err(e) => {
                let said = format!("no thread can be started ({e})");
                return self.end(Error::usage(said, "fewer threads"));
            }
        };
        while !self.is_over() {
            let place = self.next.fetch_add(1, Ordering::SeqCst);
            let Some(entry) = self.batch.logs.get(place) else {
                return;
            };
            let mut observer = |_: &Progress| match self.watch.go_on() {
                true => Control::Continue,
                false => Control::Stop,
            };
            let has = |key: &str| self.journal.has(key);
            let stopped = || self.watch.is_stopped();
            let became = pool.install(|| {
                let (memory, report) = (self.memory, self.report);
                one(
                    self.batch,
                    entry,
                    &has,
                    memory,
                    report,
                    &mut observer,
                    &stopped,
                )
            });
            let key = match became {
                Ok(Became::Row(key, row)) => {
                    self.journal.add(&key, &text(&row));
                    if let Some(e) = self.journal.fault() {
                        return self.end(e.into());
                    }
                    self.own().insert(key.clone());
                    key
                }
                Ok(Became::Taken(key)) => {
                    if !self.own().contains(&key) {
                        self.taken.fetch_add(1, Ordering::SeqCst);
                    }
                    key
                }
                Ok(Became::Stopped) => return,
                Err(e) => return self.end(e),
            };
            // Each place is taken once.
            let _ = self.keys[place].set(key);
            self.watch.one_more();
            self.watch.go_on();
        }
    }

    fn own(&self) -> MutexGuard<'_, HashSet<String>> {
        self.own.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_over(&self) -> bool {
        let fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner);
        self.watch.is_stopped() || fault.is_some()
    }

    fn end(&self, error: Error) {
        let mut fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner);
        fault.get_or_insert(error);
    }
}
