//! A log file, read, hashed and mapped.

use crate::error::Error;
use crate::wording::{Setting, TOGETHER_WITH};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_files::axis::{JoinedColumn, ListedLog, OtherFile, Use};
use stiction_files::result::{AssumedEntry, ExcludedEntry, Input, JoinedEntry, NotEnabledEntry};
use stiction_files::{Axis, Hash};
use stiction_formats::{Column, Kind, ReadOptions, Table, read_table, read_wanted};
use stiction_identify::{Samples, Terms};
use stiction_log::{Joined, Log, Mapping, Role};

/// Beginning of an entry of `detected` about a column that was not read.
const LEFT_OUT: &str = "left out: ";

/// A log with the file it came from.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path as given.
    pub path: PathBuf,
    /// The part of it that this is, in words; `None` where it is all that the axis file keeps.
    pub part: Option<String>,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
    /// What the reader detected, and what it left out.
    pub detected: Vec<String>,
    /// The log in SI units.
    pub log: Log,
    /// Columns of it that come from other files.
    pub joined: Vec<JoinedEntry>,
    /// Whether the axis file lists the log, and fits nothing of it.
    pub never_fitted: bool,
    /// By how much the external force may be wrong: of each of some independent errors one standard deviation, a value for each
    /// sample of the log.
    pub external_deviations: Vec<Vec<f64>>,
}

/// Reads the columns of a file, without mapping them.
///
/// # Errors
/// With file, place, what was found and what is allowed.
pub fn table(path: impl AsRef<Path>, axis: &Axis) -> Result<Table, Error> {
    let path = path.as_ref();
    stiction_files::refuse_as_log(path)?;
    read_table(path, &options(axis)).map_err(|e| at_entry(path, axis, e))
}

/// The refusal of a recording, at the key of the axis file that it is about, or that lists a file which is not there.
fn at_entry(path: &Path, axis: &Axis, mut error: stiction_formats::Error) -> Error {
    let listed = axis.listed(path);
    if let Some(log) = listed.filter(|_| error.kind == Kind::Io) {
        let allowed = "a recording that is there, from the folder of the axis file";
        error.allowed = allowed.into();
        return axis.at(&format!("{}.file", log.key), error).into();
    }
    axis.at_key(error).into()
}

fn options(axis: &Axis) -> ReadOptions {
    ReadOptions {
        text: axis.text,
        ethercat: axis.ethercat.clone(),
        ..ReadOptions::default()
    }
}

/// The columns of a log that the axis file may take, with the SHA-256 of exactly the bytes that they were read from.
fn hashed(path: &Path, axis: &Axis) -> Result<(Table, String), Error> {
    let wanted = |heads: &Table| {
        let mut wanted = axis.mapping.wanted(heads);
        for joined in &axis.joined {
            let own = joined.from.wanted_of_log(heads);
            wanted
                .iter_mut()
                .zip(own)
                .for_each(|(all, own)| *all |= own);
        }
        let own: Vec<&JoinedColumn> = axis.joined.iter().filter(|j| j.file.is_none()).collect();
        let own = wanted_by(&own, &axis.mapping, heads);
        wanted
            .iter_mut()
            .zip(own)
            .for_each(|(all, own)| *all |= own);
        wanted
    };
    stiction_files::refuse_as_log(path)?;
    hashed_of(path, axis, &wanted).map_err(|e| at_entry(path, axis, e))
}

/// All columns of a log, with the SHA-256 of exactly the bytes that they were read from.
pub(crate) fn whole(path: &Path, axis: &Axis) -> Result<(Table, String), Error> {
    stiction_files::refuse_as_log(path)?;
    let all = |heads: &Table| vec![true; heads.columns.len()];
    hashed_of(path, axis, &all).map_err(|e| at_entry(path, axis, e))
}

/// The same of the columns of a file that are wanted.
fn hashed_of(
    path: &Path,
    axis: &Axis,
    wanted: &dyn Fn(&Table) -> Vec<bool>,
) -> Result<(Table, String), stiction_formats::Error> {
    let mut hash = Hash::default();
    let take = |bytes: &[u8]| hash.take(bytes);
    let table = read_wanted(path, &options(axis), take, wanted)?;
    Ok((table, hash.finish()))
}

/// Reads a file and maps it by the axis. Of a log that the axis file lists it is what is fitted, or where nothing is, what is
/// validated on.
///
/// # Errors
/// As [`table`], and where columns or units are missing or ambiguous.
pub fn load(path: impl AsRef<Path>, axis: &Axis) -> Result<Source, Error> {
    let path = path.as_ref();
    let (table, sha256) = hashed(path, axis)?;
    let listed = axis.listed(path);
    let fitted = listed.is_none_or(|log| log.mapping(Use::Fitted).is_some());
    let part = if fitted { Use::Fitted } else { Use::Validated };
    mapped(path, sha256, Cow::Owned(table), axis, (listed, part))
}

/// Logs as they are used.
#[derive(Default)]
pub(crate) struct Used {
    pub fitted: Vec<Source>,
    pub held_out: Vec<Source>,
}

impl Used {
    /// Reads logs, each used as the axis file says, and is fitted where it says nothing.
    pub fn load(paths: &[PathBuf], axis: &Axis) -> Result<Self, Error> {
        let mut out = Self::default();
        for path in paths {
            let Some(listed) = axis.listed(path) else {
                out.fitted.push(load(path, axis)?);
                continue;
            };
            let (table, sha256) = hashed(path, axis)?;
            for (part, sources) in [
                (Use::Fitted, &mut out.fitted),
                (Use::Validated, &mut out.held_out),
            ] {
                if listed.mapping(part).is_some() {
                    let sha256 = sha256.clone();
                    let table = Cow::Borrowed(&table);
                    sources.push(mapped(path, sha256, table, axis, (Some(listed), part))?);
                }
            }
        }
        Ok(out)
    }
}

/// Reads logs to validate on.
pub(crate) fn load_held_out(paths: &[PathBuf], axis: &Axis) -> Result<Vec<Source>, Error> {
    let one = |path: &PathBuf| {
        let listed = axis.listed(path).filter(|log| log.has_parts());
        let Some(listed) = listed else {
            return load(path, axis);
        };
        if listed.mapping(Use::Validated).is_some() {
            let (table, sha256) = hashed(path, axis)?;
            let part = (Some(listed), Use::Validated);
            return mapped(path, sha256, Cow::Owned(table), axis, part);
        }
        Err(Error::usage(
            [
                Setting::Validate.into(),
                TOGETHER_WITH.into(),
                format!("fit of {} under [[log]] of the axis file", path.display()).into(),
            ],
            "one of the two: validate under [[log]] names the stretches of a log that are validated on",
        ))
    };
    paths.iter().map(one).collect()
}

/// Maps columns that are in memory by the axis. `name` stands in messages where a file has its path; the hash is that
/// of the columns' names, units and samples.
///
/// # Errors
/// Where columns or units are missing or ambiguous, or the samples do not form a record; the column is named.
pub fn in_memory(name: &str, columns: Vec<Column>, axis: &Axis) -> Result<Source, Error> {
    let table = Table {
        columns,
        ..Table::default()
    };
    let sha256 = stiction_files::sha256_of(&bytes(&table.columns));
    mapped(
        Path::new(name),
        sha256,
        Cow::Owned(table),
        axis,
        (None, Use::Fitted),
    )
}

pub(crate) fn mapped(
    path: &Path,
    sha256: String,
    table: Cow<'_, Table>,
    axis: &Axis,
    (listed, part): (Option<&ListedLog>, Use),
) -> Result<Source, Error> {
    let own = listed.and_then(|log| log.mapping(part));
    let mapping = own.as_ref().unwrap_or(&axis.mapping);
    let refused =
        |e: stiction_formats::Error| Error::from(axis.at_listed(e.in_file(path), listed, part));
    let left_out: Vec<String> = table
        .skipped
        .iter()
        .map(|s| format!("{LEFT_OUT}{s}"))
        .collect();
    let (log, joined) = match (axis.joined.is_empty(), table) {
        (true, Cow::Owned(table)) => (Log::of_table(table, mapping), Vec::new()),
        (true, Cow::Borrowed(table)) => (Log::from_table(table, mapping), Vec::new()),
        (false, table) => {
            let (log, entries) = joined(path, table.into_owned(), (mapping, axis), refused)?;
            (Ok(log), entries)
        }
    };
    let mut log = log.map_err(refused)?;
    for finding in &mut log.findings {
        finding.name_axis_file(axis.named("axis.toml"));
    }
    let mut detected = log.detected.clone();
    detected.extend(left_out);
    Ok(Source {
        path: path.to_path_buf(),
        part: listed.and_then(|log| log.words(part)),
        sha256,
        detected,
        log,
        joined,
        never_fitted: listed.is_some_and(|log| log.mapping(Use::Fitted).is_none()),
        external_deviations: Vec::new(),
    })
}

/// The log of a table with the columns that come from other files.
fn joined(
    path: &Path,
    table: Table,
    (mapping, axis): (&Mapping, &Axis),
    refused: impl Fn(stiction_formats::Error) -> Error,
) -> Result<(Log, Vec<JoinedEntry>), Error> {
    let own: Vec<&JoinedColumn> = axis.joined.iter().filter(|j| j.file.is_none()).collect();
    // Rows may be thinned, and columns with stamps of their own have others.
    let stamped = table.only(&wanted_by(&own, mapping, &table));
    let mut out = Joined::new(table, mapping);
    for column in own {
        out.join("the log itself", &stamped, &column.from)
            .map_err(&refused)?;
    }
    drop(stamped);
    let mut entries = Vec::new();
    let mut before: Option<(&OtherFile, (Table, String))> = None;
    for column in &axis.joined {
        let Some(given) = &column.file else {
            continue;
        };
        let file = given.of(path);
        if file == path {
            return Err(itself(axis, column.from.role, path));
        }
        let other = match before.take() {
            Some((last, read)) if last == given => read,
            _ => {
                let wanted = |heads: &Table| wanted_of(axis, given, heads);
                hashed_of(&file, axis, &wanted)
                    .map_err(|e| axis.at_key(named_by(column.from.role, e)))?
            }
        };
        let name = stiction_files::shell::text(&file);
        out.join(&name, &other.0, &column.from).map_err(&refused)?;
        entries.push(JoinedEntry {
            column: column.from.role.to_string(),
            sha256: other.1.clone(),
            path: name,
        });
        before = Some((given, other));
    }
    let mut log = Log::from_joined(&out).map_err(refused)?;
    // The line that gives a unit is that of the other file.
    for column in &mut log.columns {
        let mut joined = axis.joined.iter();
        let own = joined.find(|j| Some(j.from.role) == column.role);
        if let (Some(own), Some(assumed)) = (own, &mut column.assumed) {
            assumed.line = own.line(&assumed.line);
        }
    }
    Ok((log, entries))
}

/// The refusal of a file that is to be another one and is the log.
fn itself(axis: &Axis, role: Role, log: &Path) -> Error {
    let key = format!("columns.{role}.file");
    let found = format!("{} is the log itself", log.display());
    let allowed = "another file; a column of the log itself goes without file";
    usage_at(axis, &key, found, allowed)
}

/// An error of usage at a key of the axis file, where that has one.
pub(crate) fn usage_at(axis: &Axis, key: &str, found: String, allowed: &'static str) -> Error {
    match axis.refuse(key, found.clone(), allowed, Code::Usage) {
        Some(error) => error.into(),
        None => Error::usage(found, allowed),
    }
}

/// The refusal of another file, at the key that names it where it is not of one of its own.
fn named_by(role: Role, mut error: stiction_formats::Error) -> stiction_formats::Error {
    if error.allowed.is_empty() {
        error.allowed = "name a recording that is there, from the folder of the axis file, or with {log} from that of the log".into();
    }
    match error.setting() {
        Some(_) => error,
        None => error.of_setting(format!("columns.{role}.file")),
    }
}

/// Which columns of another file may be needed for what is joined from it.
fn wanted_of(axis: &Axis, file: &OtherFile, heads: &Table) -> Vec<bool> {
    let joined = axis.joined.iter();
    let joined = joined.filter(|column| column.file.as_ref() == Some(file));
    wanted_by(&joined.collect::<Vec<_>>(), &axis.mapping, heads)
}

/// Which columns these may need.
fn wanted_by(joined: &[&JoinedColumn], mapping: &Mapping, heads: &Table) -> Vec<bool> {
    let mut wanted = vec![false; heads.columns.len()];
    for column in joined {
        let Some(channel) = mapping.channel(column.from.role) else {
            continue;
        };
        let own = column.from.wanted(channel, heads);
        wanted
            .iter_mut()
            .zip(own)
            .for_each(|(all, own)| *all |= own);
    }
    wanted
}

/// Refuses several logs where a column comes from one other file, which belongs to one of them.
pub(crate) fn refuse_several(axis: &Axis, logs: usize) -> Result<(), Error> {
    let mut joined = axis.joined.iter().filter(|_| logs > 1);
    let Some((joined, file)) = joined.find_map(|j| Some((j, j.file.as_ref()?.of_one_log()?)))
    else {
        return Ok(());
    };
    let found = format!(
        "{} comes from {}, and there are {logs} logs",
        joined.from.role,
        file.display()
    );
    let allowed = "a file for each log by its name, such as \"{log}_force.csv\" in the folder of log.csv, or one log";
    let key = format!("columns.{}.file", joined.from.role);
    Err(usage_at(axis, &key, found, allowed))
}

/// Reads every file of a list and maps it by the axis.
pub(crate) fn load_all(paths: &[PathBuf], axis: &Axis) -> Result<Vec<Source>, Error> {
    refuse_several(axis, paths.len())?;
    paths.iter().map(|path| load(path, axis)).collect()
}

/// Columns as bytes: each name and unit ended by a zero, then the number of samples and the samples, little-endian.
fn bytes(columns: &[Column]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for column in columns {
        for text in [&column.name, column.unit.as_ref().unwrap_or(&String::new())] {
            bytes.extend(text.as_bytes());
            bytes.push(0);
        }
        bytes.extend((column.values.len() as u64).to_le_bytes());
        bytes.extend(column.values.iter().flat_map(|x| x.to_le_bytes()));
    }
    bytes
}

impl Source {
    /// The path as given, and the part of the log that this is: what it is called where no command is made of it.
    pub fn name(&self) -> String {
        let path = stiction_files::shell::text(&self.path);
        let path = stiction_files::shell::shown(&path);
        match &self.part {
            Some(part) => format!("{path}, {part}"),
            None => path,
        }
    }

    /// How the log goes into `result.json`; `whole_record` where the whole record is fitted, without rests at the ends.
    pub fn input(&self, whole_record: bool) -> Input {
        let rests = self.log.excluded.iter();
        let rests =
            rests.filter(|e| whole_record && matches!(e.code, Code::RestAtEnd | Code::RestBetween));
        let excluded = rests.filter_map(|e| {
            let time = self.log.time.get(e.samples.clone())?;
            Some(ExcludedEntry {
                code: e.code,
                from_s: *time.first()?,
                to_s: *time.last()?,
                samples: e.samples.len(),
            })
        });
        let assumed = self.log.columns.iter().filter_map(|column| {
            let assumed = column.assumed.as_ref()?;
            Some(AssumedEntry {
                column: column.role?.to_string(),
                unit: assumed.unit.clone(),
                line: assumed.line.clone(),
            })
        });
        let not_enabled = self.log.not_enabled.as_ref();
        let not_enabled = not_enabled.map(|left_out| NotEnabledEntry {
            column: left_out.column.clone(),
            rows: left_out.rows,
            of: left_out.of,
        });
        Input {
            excluded: excluded.collect(),
            joined: self.joined.clone(),
            not_enabled,
            assumed: assumed.collect(),
            path: stiction_files::shell::text(&self.path),
            part: self.part.clone(),
            sha256: self.sha256.clone(),
            samples: self.log.time.len(),
            rate_hz: self.log.rate_hz,
            detected: self.detected.clone(),
        }
    }

    /// Whether the log has every column that the terms need.
    ///
    /// # Errors
    /// When one is missing, with the term that needs it.
    pub fn check_channels(&self, terms: &Terms) -> Result<(), Error> {
        match self.missing_channel(terms) {
            Some((_, error)) => Err(error.into()),
            None => Ok(()),
        }
    }

    /// Whether the log has what the axis file names, in units that fit: columns of its terms, terms, gains.
    ///
    /// # Errors
    /// With the key of the axis file.
    pub fn check_axis(&self, axis: &Axis) -> Result<(), Error> {
        if let Some((term, error)) = self.missing_channel(&axis.terms) {
            return Err(axis.at(&format!("terms.{term}"), error).into());
        }
        axis.terms_for(&self.log, false)?;
        axis.controller_for(&self.log)?;
        Ok(())
    }

    /// The first term that lacks its column, and what to say of it.
    fn missing_channel(&self, terms: &Terms) -> Option<(&'static str, stiction_formats::Error)> {
        let lacks = |channel: &&str| match *channel {
            "load" => self.log.load.is_none(),
            "temperature" => self.log.temperature.is_none(),
            "external" => self.log.external.is_none(),
            _ => self.log.position.is_none(),
        };
        let mut each = terms.dependences.iter();
        let (name, channel) =
            each.find_map(|term| Some((term.name(), terms.channel(term).filter(lacks)?)))?;
        // A column that was found and is not in the log is no use, and says why.
        let mut columns = self.log.columns.iter();
        let useless = columns.find(|c| c.role.is_some_and(|role| role.name() == channel));
        let (found, allowed) = match useless {
            Some(column) => (
                format!(
                    "[terms] {name} needs the {channel}, and column {} is {}",
                    column.column, column.reason
                ),
                format!("record it whole, or take {name} out of [terms]"),
            ),
            None if channel == "external" => (
                format!("no external column, and [terms] {name} needs the torque that is transmitted"),
                "set gravity = true under [terms], or name a column of what acts from outside: [columns] external = \"...\""
                    .into(),
            ),
            None => (
                format!("no {channel} column, and [terms] {name} needs one"),
                format!("name it in the axis file: [columns] {channel} = \"...\""),
            ),
        };
        let error = stiction_formats::Error::new(stiction_formats::Kind::Missing, found, allowed);
        Some((name, error.in_file(&self.path)))
    }

    /// Columns of the file that were not read, and why.
    fn left_out(&self) -> impl Iterator<Item = &str> {
        self.detected
            .iter()
            .filter_map(|text| text.strip_prefix(LEFT_OUT))
    }

    /// What a fit of the whole record needs of it: as [`samples`](Self::samples), without rests at the ends.
    ///
    /// # Errors
    /// When the log has no force, or neither position nor velocity.
    pub fn fitted(&self) -> Result<Samples, Error> {
        let mut samples = self.samples()?;
        samples.valid = self.log.valid_in_motion();
        samples.at_rest = self.log.at_rest();
        samples.keep(self.log.fitted());
        Ok(samples)
    }

    /// What an identification needs of it.
    ///
    /// # Errors
    /// When the log has no force, or neither position nor velocity.
    pub fn samples(&self) -> Result<Samples, Error> {
        let left_out: Vec<&str> = self.left_out().take(4).collect();
        let left_out = match left_out.as_slice() {
            [] => String::new(),
            columns => format!(" (left out is {})", columns.join(", ")),
        };
        let missing = |what: &str, key: &str| {
            let error = stiction_formats::Error::new(
                stiction_formats::Kind::Missing,
                format!("no {what} column{left_out}"),
                format!("name it in the axis file: [columns] {key} = \"...\""),
            );
            Error::from(error.in_file(&self.path))
        };
        let mut force = self
            .log
            .force
            .clone()
            .ok_or_else(|| missing("force", "force"))?;
        for (force, external) in force.iter_mut().zip(self.log.external.iter().flatten()) {
            *force += external;
        }
        if self.log.position.is_none() && self.log.velocity.is_none() {
            return Err(missing("position or velocity", "position"));
        }
        Ok(Samples {
            time: self.log.time.clone(),
            position: self.log.position.clone(),
            velocity: self.log.velocity.clone(),
            acceleration: self.log.acceleration.clone(),
            force,
            load: self.log.load.clone(),
            temperature: self.log.temperature.clone(),
            external: self.log.external.clone(),
            external_deviations: self.external_deviations.clone(),
            valid: self.log.valid(),
            at_rest: Vec::new(),
            breaks: self.log.segments.iter().skip(1).map(|s| s.start).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::init;
    use std::fmt::Write;

    /// A state of a joint at 333 Hz with an effort at 1 kHz beside it, each with its time, in one file.
    fn robot() -> String {
        let list = |rate: f64, of: &dyn Fn(f64) -> f64| -> String {
            let mut out = String::new();
            for n in 0..(4.0 * rate) as usize {
                let _ = write!(
                    out,
                    "{}{}",
                    if n == 0 { "" } else { "," },
                    of(n as f64 / rate)
                );
            }
            format!("[{out}]")
        };
        let angle = |t: f64| (3.0 * t).sin() * (1.0 + 0.1 * t);
        let effort = |t: f64| 0.4 * (3.0 * t).cos() + 0.1 * (3.0 * t).sin();
        let stamp = |t: f64| t;
        format!(
            "{{\"joint_state\": {{\"time\": {}, \"position\": {}}}, \"effort\": {{\"time\": {}, \"torque\": {}}}}}",
            list(333.0, &stamp),
            list(333.0, &angle),
            list(1000.0, &stamp),
            list(1000.0, &effort)
        )
    }

    #[test]
    fn columns_of_one_file_with_several_bases_are_joined_by_the_lines_that_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let log = folder.path().join("robot.json");
        std::fs::write(&log, robot()).unwrap();
        let refused = load(&log, &Axis::default()).unwrap_err().to_string();
        let line = "force = { column = \"effort.torque\", time = \"effort.time\" }";
        assert!(refused.contains(line), "{refused}");
        let started = init(&log, None).unwrap();
        assert_eq!(started.undecided, None);
        let axis = folder.path().join("axis.toml");
        std::fs::write(&axis, &started.text).unwrap();
        let axis = Axis::read(&axis).unwrap();
        let log = load(&log, &axis).unwrap().log;
        assert!((log.rate_hz - 333.0).abs() < 0.1, "{}", log.rate_hz);
        let force = log.force.unwrap();
        for (t, force) in log.time.iter().zip(&force) {
            let effort = 0.4 * (3.0 * t).cos() + 0.1 * (3.0 * t).sin();
            assert!((force - effort).abs() < 1e-4, "{force} is not {effort}");
        }
    }
}
