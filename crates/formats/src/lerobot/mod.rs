//! Data sets of LeRobot, of its versions 2.0 to 3.0: `meta/info.json`, and episodes in `data/*/*.parquet`.
//!
//! In version 2 each file is an episode, in version 3 a file holds many. Elements of a list have the names that `info.json` gives
//! them: `observation.state.elbow.pos`, which is `observation.state(:,3)` too. Time goes on from episode to episode, one frame
//! apart, and each begins as a recording of its own ([`Table::starts`]). Videos are left out and named.

mod info;

use std::fs::{File, Metadata};
use std::path::{Path, PathBuf};

use crate::open::not_opened;
use crate::regular::{is_regular, regular};
use crate::{Error, Kind, Limits, Table};
use info::Info;

/// Where a data set says what it holds.
const INFO: [&str; 2] = ["meta", "info.json"];

/// The folder of its data.
const DATA: &str = "data";

/// Seconds of each row from the first of its episode.
const TIME: &str = "timestamp";

/// The episode of each row.
const EPISODE: &str = "episode_index";

/// Most episodes whose times are listed.
const LISTED: usize = 8;

/// A file of a data set, and what was known of it before it was read.
pub(crate) type Part = (PathBuf, Metadata);

/// The `meta/info.json` of a data set in a folder; `None` of other folders and of files.
pub fn data_set_of(folder: &Path) -> Option<PathBuf> {
    let path = folder.join(INFO[0]).join(INFO[1]);
    let is_one = is_regular(&path) && folder.join(DATA).is_dir() && Info::read(&path).is_ok();
    is_one.then_some(path)
}

/// The data set that a file, which may be its `meta/info.json`, is of: its folder.
fn root(path: &Path) -> Option<PathBuf> {
    let whole = std::path::absolute(path).ok()?;
    let up = match path.ends_with(INFO.iter().collect::<PathBuf>()) {
        true => 2,
        // data/chunk-000/episode_000000.parquet
        false => 3,
    };
    let root = whole.ancestors().nth(up)?;
    data_set_of(root).map(|_| root.to_path_buf())
}

/// The list of episodes that a path leads to as a whole: that of the folder of a data set, or the list itself.
pub(crate) fn whole(path: &Path) -> Option<PathBuf> {
    data_set_of(path).or_else(|| {
        let named = path.ends_with(INFO.iter().collect::<PathBuf>());
        root(path).filter(|_| named).map(|_| path.to_path_buf())
    })
}

/// Reads all episodes of a data set by the path of its `meta/info.json`; also gives the files.
pub(crate) fn read(path: &Path, limits: Limits) -> Result<(Table, Vec<Part>), Error> {
    let info = Info::read(path)?;
    let root = path.parent().and_then(Path::parent).unwrap_or(path);
    let mut parts: Vec<Part> = Vec::new();
    let mut table = Table::default();
    for file in files(&root.join(DATA))? {
        let name = file
            .strip_prefix(root)
            .unwrap_or(&file)
            .display()
            .to_string();
        let at = |mut error: Error| {
            error.found = format!("in {name}: {}", error.found);
            error
        };
        let about = regular(&file).map_err(|e| at(not_opened(e, "files of a data set")))?;
        let part = part(&file, about.len(), &table, limits).map_err(at)?;
        append(&mut table, part, &info).map_err(at)?;
        parts.push((file, about));
    }
    if parts.is_empty() {
        let found = format!("no file {DATA}/*/*.parquet beside meta/info.json");
        let allowed = "a data set of LeRobot 2.0 or later, with its data";
        return Err(Error::new(Kind::Missing, found, allowed));
    }
    if parts.len() > 1 {
        let said = format!("{} files, read as one recording", parts.len());
        table.detected.insert(0, said);
    }
    finish(&mut table, &info);
    Ok((table, parts))
}

/// Gives the table of one Parquet file what the data set says of it, where it is of one. A file by itself still begins anew where its
/// episodes change.
pub(crate) fn complete(path: &Path, mut table: Table) -> Result<Table, Error> {
    let Some(root) = root(path) else {
        if table.columns.iter().any(|column| column.name == EPISODE) {
            let begins = episodes(&table);
            table
                .starts
                .extend(begins.into_iter().filter(|row| *row > 0));
        }
        return Ok(table);
    };
    let info = Info::read(&root.join(INFO[0]).join(INFO[1]))?;
    let mut whole = Table::default();
    append(&mut whole, table, &info)?;
    whole.detected.push(format!(
        "a file of the LeRobot data set {}, whose folder leads to all of them",
        root.file_name().unwrap_or_default().display()
    ));
    finish(&mut whole, &info);
    Ok(whole)
}

/// The files of the data in the order of their numbers.
fn files(data: &Path) -> Result<Vec<PathBuf>, Error> {
    let io = |error| Error::new(Kind::Io, format!("{DATA} cannot be read ({error})"), "");
    let listed = |folder: &Path| -> Result<Vec<PathBuf>, Error> {
        let entries = std::fs::read_dir(folder).map_err(io)?;
        let mut paths = Vec::new();
        for entry in entries {
            paths.push(entry.map_err(io)?.path());
        }
        // Numbers have leading zeros as long as they are short.
        paths.sort_by_cached_key(|path| (path.as_os_str().len(), path.clone()));
        Ok(paths)
    };
    let mut all = Vec::new();
    for chunk in listed(data)?.into_iter().filter(|path| path.is_dir()) {
        let mut own = listed(&chunk)?;
        own.retain(|path| path.extension().is_some_and(|end| end == "parquet"));
        all.append(&mut own);
    }
    Ok(all)
}

/// Reads one file beside the columns of those before it.
fn part(path: &Path, bytes: u64, before: &Table, limits: Limits) -> Result<Table, Error> {
    let samples: usize = before.columns.iter().map(|c| c.values.len()).sum();
    let io = |error| Error::new(Kind::Io, format!("cannot be read ({error})"), "");
    let file = File::open(path).map_err(io)?;
    crate::parquet::read(file, bytes, limits, samples as u64)
}

/// Puts the rows of a file behind those of the files before it.
fn append(table: &mut Table, mut part: Table, info: &Info) -> Result<(), Error> {
    let before = table.rows();
    let names =
        |table: &Table| -> Vec<String> { table.columns.iter().map(|c| c.name.clone()).collect() };
    if before > 0 && names(table) != names(&part) {
        let found = format!(
            "its columns are {}, and those of the files before it {}",
            names(&part).join(", "),
            names(table).join(", ")
        );
        return Err(Error::new(
            Kind::Format,
            found,
            "the same columns in all files",
        ));
    }
    let begins = episodes(&part);
    if let Some(time) = part.columns.iter().position(|c| c.name == TIME) {
        let mut last = table.columns.get(time).and_then(|c| last(&c.values));
        let values = &mut part.columns[time].values;
        for (n, from) in begins.iter().enumerate() {
            let to = begins.get(n + 1).copied().unwrap_or(values.len());
            let own = &mut values[*from..to];
            if let (Some(last), Some(first)) = (last, own.first().copied()) {
                let shift = last + 1.0 / info.frames_per_second - first;
                own.iter_mut().for_each(|t| *t += shift);
            }
            last = self::last(own).or(last);
        }
    }
    let begins = begins.iter().map(|row| before + row);
    table.starts.extend(begins.filter(|row| *row > 0));
    if before == 0 {
        *table = Table {
            starts: std::mem::take(&mut table.starts),
            ..part
        };
        return Ok(());
    }
    for (all, own) in table.columns.iter_mut().zip(part.columns) {
        all.values.extend(own.values);
    }
    for (all, own) in [
        (&mut table.detected, part.detected),
        (&mut table.skipped, part.skipped),
    ] {
        for said in own {
            if !all.contains(&said) {
                all.push(said);
            }
        }
    }
    Ok(())
}

/// The last time that is a number, s.
fn last(times: &[f64]) -> Option<f64> {
    times.iter().copied().rfind(|t| t.is_finite())
}

/// The rows of a file with which its episodes begin, the first of them 0: by their numbers, else where time goes back.
fn episodes(part: &Table) -> Vec<usize> {
    let values = |name: &str| {
        let mut columns = part.columns.iter();
        columns.find(|c| c.name == name).map(|c| &c.values[..])
    };
    let changes = |values: &[f64], is: fn(f64, f64) -> bool| -> Vec<usize> {
        let pairs = (1..values.len()).filter(|row| is(values[row - 1], values[*row]));
        std::iter::once(0).chain(pairs).collect()
    };
    match (values(EPISODE), values(TIME)) {
        (Some(numbers), _) => changes(numbers, |a, b| a != b),
        (None, Some(times)) => changes(times, |a, b| b < a),
        (None, None) => vec![0],
    }
}

/// Names elements and units, and says what there is.
fn finish(table: &mut Table, info: &Info) {
    info.name(table);
    info.leave_out(table);
    if let Some(time) = table.columns.iter_mut().find(|c| c.name == TIME) {
        time.unit = Some("s".to_owned());
        time.stamps = true;
    } else {
        table.sample_time = Some(1.0 / info.frames_per_second);
    }
    table
        .detected
        .insert(0, format!("LeRobot data set {}", info.version));
    let values = |name: &str| table.columns.iter().find(|c| c.name == name);
    let (episode, time) = (values(EPISODE), values(TIME));
    let begins: Vec<usize> = std::iter::once(0)
        .chain(table.starts.iter().copied())
        .collect();
    let one = |row: &usize| {
        let number = episode.and_then(|c| c.values.get(*row).copied());
        let at = match time.and_then(|c| Some(c.values.get(*row)? - c.values.first()?)) {
            Some(seconds) => format!("{seconds:.3} s"),
            None => format!("row {}", row + 1),
        };
        match number {
            Some(number) => format!("{number} from {at}"),
            None => format!("from {at}"),
        }
    };
    let mut each: Vec<String> = begins.iter().take(LISTED).map(one).collect();
    if begins.len() > LISTED {
        each.push("...".to_owned());
        each.extend(begins.last().map(one));
    }
    table.detected.push(match begins.len() {
        1 => "one episode".to_owned(),
        n => format!("{n} episodes, split between them: {}", each.join(", ")),
    });
}
