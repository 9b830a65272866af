//! A batch before it runs: its logs, their axes, and what makes a log one that need not be identified again.

use super::found::found;
use crate::error::Error;
use crate::identify::Options;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};
use stiction_files::batch::BatchFile;
use stiction_files::batch::{Listed, RESULTS, SCHEMA, SUMMARY, read_results};
use stiction_files::{Axis, Journal, sha256, sha256_of, shell, visible, write_atomic};

/// Logs that are identified one by one.
pub struct Batch {
    pub(super) logs: Vec<Entry>,
    pub(super) axes: Vec<OfAxis>,
    pub(super) options: Options,
    /// Whether a report is written for each log.
    pub(super) reports: bool,
    /// SHA-256 of version and options, and of the files that these name.
    settings: String,
    /// What the logs were found by.
    inputs: Vec<String>,
    /// Logs in folders of results, which are left out.
    beside: Vec<PathBuf>,
}

/// One log.
pub(super) struct Entry {
    pub listed: Listed,
    /// Place of its axis.
    pub axis: usize,
    /// What the row calls the files, where they are copies of others.
    pub called: Called,
}

impl Entry {
    /// What the row calls the log.
    pub fn name(&self) -> String {
        let own = || shell::text(&self.listed.path);
        self.called.log.clone().unwrap_or_else(own)
    }
}

/// What the row of a log calls files that were fetched to be read: their addresses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Called {
    /// The log.
    pub log: Option<String>,
    /// The axis file.
    pub axis: Option<String>,
}

/// An axis file, or that there is none.
pub(super) struct OfAxis {
    pub file: Option<PathBuf>,
    /// What stands in it, where it could be read.
    pub axis: Option<Axis>,
    /// SHA-256 of it and the files that it names, but for those that belong to one log each.
    digest: String,
}

impl OfAxis {
    /// The axis, and what is wrong with its file.
    fn read(file: Option<PathBuf>) -> (Self, Option<Error>) {
        let Some(path) = &file else {
            let of = Self {
                file,
                axis: Some(Axis::default()),
                digest: "none".into(),
            };
            return (of, None);
        };
        let (axis, fault) = match Axis::read(path) {
            Ok(axis) => (Some(axis), None),
            Err(e) => (None, Some(e.into())),
        };
        let digest = digest_of(path, &axis);
        (Self { file, axis, digest }, fault)
    }

    /// Whether the files are not those any more that were read.
    pub fn has_changed(&self) -> bool {
        let now = self.file.as_ref().map(|path| digest_of(path, &self.axis));
        now.is_some_and(|now| now != self.digest)
    }

    /// The files that belong to a log by its name.
    fn of_log(&self, log: &Path) -> Vec<PathBuf> {
        let joined = self.axis.iter().flat_map(|axis| &axis.joined);
        let others = joined.filter_map(|column| column.file.as_ref());
        let of_each = others.filter(|other| other.of_one_log().is_none());
        // One that names the log itself is refused where the log is read.
        of_each
            .map(|other| other.of(log))
            .filter(|other| other != log)
            .collect()
    }
}

/// SHA-256 of an axis file and the files that it names, but for those that belong to one log each.
fn digest_of(path: &Path, axis: &Option<Axis>) -> String {
    let joined = axis.iter().flat_map(|axis| &axis.joined);
    let others = joined.filter_map(|column| column.file.as_ref()?.of_one_log());
    others.fold(hash_of(path), |digest, other| {
        sha256_of(format!("{digest} {}", hash_of(other)).as_bytes())
    })
}

/// SHA-256 of a file, or that it cannot be read.
fn hash_of(path: &Path) -> String {
    // Opening a pipe would wait for ever.
    let hash = stiction_formats::is_regular(path)
        .then(|| sha256(path).ok())
        .flatten();
    hash.unwrap_or_else(|| "unreadable".into())
}

/// What the pieces of a batch are kept as.
const KIND: &str = "batch";

impl Batch {
    /// The logs of folders, patterns, lists and files, but for those in `out`; `axis` is for those to which a list gives none.
    /// Each is identified with the same options.
    ///
    /// # Errors
    /// Where an input is not there or holds no logs, a list or the axis file is refused, or the options are of one search alone.
    pub fn new(
        inputs: &[PathBuf],
        axis: Option<&Path>,
        options: &Options,
        reports: bool,
        out: &Path,
    ) -> Result<Self, Error> {
        if options.searching.checkpoint.is_some() || options.searching.resume.is_some() {
            return Err(Error::usage(
                "the state of one search for many logs",
                "no checkpoint: logs that are done are kept in the folder of the batch",
            ));
        }
        let (common, fault) = OfAxis::read(axis.map(PathBuf::from));
        if let Some(fault) = fault {
            return Err(fault);
        }
        let mut axes = vec![common];
        let mut places: HashMap<PathBuf, usize> = HashMap::new();
        let mut logs = Vec::new();
        let mut beside = Vec::new();
        for listed in found(inputs, out, &mut beside)? {
            let place = match &listed.axis {
                None => 0,
                Some(file) => *places.entry(file.clone()).or_insert_with(|| {
                    // What is wrong with it is said of each of its logs.
                    axes.push(OfAxis::read(Some(file.clone())).0);
                    axes.len() - 1
                }),
            };
            logs.push(Entry {
                listed,
                axis: place,
                called: Called::default(),
            });
        }
        // What belongs to another log is none itself.
        let others = |entry: &Entry| axes[entry.axis].of_log(&entry.listed.path);
        let others: HashSet<PathBuf> = logs.iter().flat_map(others).collect();
        logs.retain(|entry| !others.contains(&entry.listed.path));
        let inputs = inputs.iter().map(|input| shell::text(input)).collect();
        Ok(Self {
            beside,
            ..Self::of(logs, axes, options, reports, inputs)
        })
    }

    /// One log by itself, for whoever spreads logs over processes and machines. What is wrong with it, or with its axis file, is
    /// said in its row.
    pub fn single(listed: Listed, called: Called, options: &Options) -> Self {
        let axes = vec![OfAxis::read(listed.axis.clone()).0];
        let inputs = vec![shell::text(&listed.path)];
        let entry = Entry {
            listed,
            axis: 0,
            called,
        };
        Self::of(vec![entry], axes, options, false, inputs)
    }

    fn of(
        logs: Vec<Entry>,
        axes: Vec<OfAxis>,
        options: &Options,
        reports: bool,
        inputs: Vec<String>,
    ) -> Self {
        let procedures = &options.procedures;
        let files = procedures
            .statics
            .iter()
            .chain(&procedures.model)
            .chain(&procedures.break_away);
        let files: Vec<String> = files.map(|file| hash_of(file)).collect();
        let version = env!("CARGO_PKG_VERSION");
        let settings = format!("{version}\n{options:?}\n{}", files.join("\n"));
        Self {
            logs,
            axes,
            options: options.clone(),
            reports,
            settings: sha256_of(settings.as_bytes()),
            inputs,
            beside: Vec::new(),
        }
    }

    /// The logs with what is known of them, in their order.
    pub fn logs(&self) -> impl Iterator<Item = &Listed> {
        self.logs.iter().map(|entry| &entry.listed)
    }

    /// Logs that lie beside the result of an earlier command and are left out unless they are named.
    pub fn beside_results(&self) -> &[PathBuf] {
        &self.beside
    }

    /// How many logs there are.
    pub fn len(&self) -> usize {
        self.logs.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.logs.is_empty()
    }

    /// The files that the batch reads beside the logs, and the logs.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        let axes = self.axes.iter().filter_map(|axis| axis.file.as_deref());
        self.logs
            .iter()
            .map(|entry| entry.listed.path.as_path())
            .chain(axes)
    }

    /// Keeps logs in a folder as they are done; `resume` takes those that an earlier call has left there, done or not to its end.
    /// With how many logs of an earlier table are none of this batch.
    ///
    /// # Errors
    /// Where the folder cannot be written, another call is at work in it, or what is in it cannot be taken.
    pub fn keep(&self, dir: &Path, resume: bool) -> Result<(Journal, usize), Error> {
        let journal = match resume {
            true => Journal::resume(dir, KIND)?,
            false => Journal::begin(dir, KIND)?,
        };
        let earlier = dir.join(RESULTS);
        let mut gone = 0;
        if resume && earlier.is_file() {
            let own: HashSet<String> = self.logs.iter().map(Entry::name).collect();
            read_results(&earlier, |row| {
                gone += usize::from(!own.contains(&row.path));
                if !row.key.is_empty() && !journal.has(&row.key) {
                    journal.add(&row.key, &super::one::text(&row));
                }
                Ok(())
            })?;
        }
        // What is said of an earlier table stays with it until there is another one.
        if !earlier.is_file() {
            self.write_summary(dir, &self.summary("running"))?;
        }
        Ok((journal, gone))
    }

    /// What the batch is, before anything of it is done.
    pub(super) fn summary(&self, status: &str) -> BatchFile {
        let options = &self.options;
        let law = options.law.map_or("auto", |law| law.name());
        let mut said = BTreeMap::from([
            ("law".to_string(), law.to_string()),
            ("asymmetric".into(), options.asymmetric.to_string()),
            (
                "method".into(),
                options.procedures.method.name().to_string(),
            ),
            ("seed".into(), options.seed.to_string()),
        ]);
        if let Some(split) = options.split {
            said.insert("split".into(), stiction_number::full(split));
        }
        if let Some(axis) = &self.axes[0].file {
            said.insert("axis".into(), shell::text(axis));
        }
        if self.reports {
            said.insert("reports".into(), "true".into());
        }
        BatchFile {
            schema: SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            status: status.into(),
            options: said,
            inputs: self.inputs.clone(),
            logs: self.logs.len(),
            identified: 0,
            trustworthy: 0,
            doubted: None,
            taken: 0,
            copies: 0,
            failed: Vec::new(),
            apart: Vec::new(),
        }
    }

    pub(super) fn write_summary(&self, dir: &Path, file: &BatchFile) -> Result<(), Error> {
        let text = serde_json::to_string_pretty(file).expect("plain data") + "\n";
        Ok(write_atomic(
            dir.join(SUMMARY),
            visible::json(text).as_bytes(),
        )?)
    }

    /// What a log of these bytes is kept under: the hash of all that its identification depends on.
    pub(super) fn key(&self, entry: &Entry, sha256: &str) -> String {
        let axis = &self.axes[entry.axis];
        // Of a log that the axis file lists it may be a part; a report tells the path.
        let listed = axis
            .axis
            .as_ref()
            .is_some_and(|axis| axis.listed(&entry.listed.path).is_some());
        let path = match listed || self.reports {
            true => entry.name(),
            false => String::new(),
        };
        let given = entry.listed.temperature.is_some();
        let (settings, digest, reports) = (&self.settings, &axis.digest, self.reports);
        let others = axis.of_log(&entry.listed.path);
        let others: Vec<String> = others.iter().map(|file| hash_of(file)).collect();
        let others = others.concat();
        let all = format!("{sha256}\n{settings}\n{digest}{others}\n{given}\n{reports}\n{path}");
        sha256_of(all.as_bytes())
    }

    /// The same of a log that failed, whose error names its path.
    pub(super) fn key_of_failure(&self, entry: &Entry, key: &str) -> String {
        let path = entry.name();
        sha256_of(format!("failed\n{key}\n{path}").as_bytes())
    }
}
