//! The one entry point for every format: looks at the first bytes and calls the reader.

use std::fs::{File, Metadata};
use std::io::{self, Read, Seek};
use std::path::Path;

#[cfg(feature = "parquet")]
use crate::lerobot;
use crate::regular::{Irregular, regular};
#[cfg(feature = "rosbag")]
use crate::ros::split;
use crate::sniff::{Format, sniff};
use crate::text::{self, TextOptions, unit};
use crate::{Error, Kind, Limits, Table, stamps, watch};

/// How a file is to be read, where that does not follow from the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// What the user states about a text file.
    pub text: TextOptions,
    /// Which process data of an EtherCAT capture are columns.
    #[cfg(feature = "ethercat")]
    pub ethercat: crate::ethercat::ProcessData,
    /// How much memory it may take.
    pub limits: Limits,
}

/// Reads a recording in any of the formats that the features of this crate name, or text.
///
/// The format is recognised by the first bytes of the file, never by its name. Columns are in the order
/// of the file; HDF5 keeps no order, so its columns are sorted by name.
///
/// # Errors
///
/// [`Error`] with the file, the place in it, what was found and what is allowed.
pub fn read_table(path: &Path, options: &ReadOptions) -> Result<Table, Error> {
    opened(path, options, None, &everything)
}

/// As [`read_table`], and hands on the bytes that were read, in order, for a hash of exactly these: a text may grow while it is
/// read.
///
/// # Errors
///
/// As [`read_table`], and where a file that is not text has changed since it was opened.
pub fn read_table_with(
    path: &Path,
    options: &ReadOptions,
    mut bytes: impl FnMut(&[u8]),
) -> Result<Table, Error> {
    opened(path, options, Some(&mut bytes), &everything)
}

/// As [`read_table_with`], and keeps the samples of those columns of a text, or of MDF, alone that `wanted` names: of every column it says
/// whether it is, from a table that has names and units only. Cells of the other columns are checked all the same, and
/// [`Table::passed`] says what they are. A mapping understands such a table as it understands the whole one.
///
/// Other formats are read whole, and so are exports of TwinCAT Scope.
///
/// # Errors
///
/// As [`read_table_with`].
pub fn read_wanted(
    path: &Path,
    options: &ReadOptions,
    mut bytes: impl FnMut(&[u8]),
    wanted: &dyn Fn(&Table) -> Vec<bool>,
) -> Result<Table, Error> {
    opened(path, options, Some(&mut bytes), wanted)
}

/// Whether a file is a recording by its first bytes: MATLAB, HDF5, Parquet and the like. A text or JSON may be anything, and is none.
pub fn is_binary_recording(path: &Path) -> bool {
    let format = regular(path).ok().and_then(|about| {
        let mut file = File::open(path).ok()?;
        sniff(&mut file, about.len()).ok()
    });
    !matches!(
        format,
        None | Some(Format::Text | Format::Json | Format::Foreign(..))
    )
}

/// Which columns of a table are to be kept, of which names and units are known.
pub(crate) type Wanted<'a> = &'a dyn Fn(&Table) -> Vec<bool>;

/// Every column.
pub(crate) fn everything(heads: &Table) -> Vec<bool> {
    vec![true; heads.columns.len()]
}

/// Whom the bytes are handed to, if anyone.
type Bytes<'a> = Option<&'a mut dyn FnMut(&[u8])>;

fn opened(
    path: &Path,
    options: &ReadOptions,
    bytes: Bytes<'_>,
    wanted: Wanted,
) -> Result<Table, Error> {
    read(path, options, bytes, wanted).map_err(|error| error.in_file(path))
}

/// The refusal of what is no regular file.
pub(crate) fn not_opened(irregular: Irregular, allowed: &'static str) -> Error {
    match irregular {
        Irregular::Io(error) => io(error),
        Irregular::Other(what) => Error::new(Kind::Io, what, allowed),
    }
}

fn io(error: io::Error) -> Error {
    Error::new(Kind::Io, format!("cannot be read ({error})"), "")
}

fn read(
    path: &Path,
    options: &ReadOptions,
    seen: Bytes<'_>,
    wanted: Wanted,
) -> Result<Table, Error> {
    #[cfg(feature = "rosbag")]
    let metadata = bag_of(path);
    #[cfg(feature = "rosbag")]
    let path = metadata.as_deref().unwrap_or(path);
    #[cfg(feature = "parquet")]
    if let Some(info) = lerobot::whole(path) {
        return data_set(&info, options, seen);
    }
    let about = regular(path).map_err(|e| not_opened(e, "a recording has to be a regular file"))?;
    let bytes = about.len();
    if bytes == 0 {
        return Err(Error::new(Kind::Format, "the file is empty", ""));
    }
    let mut file = File::open(path).map_err(io)?;
    let format = sniff(&mut file, bytes).map_err(io)?;
    file.rewind().map_err(io)?;
    watch::tell(path, 0, bytes);
    let table = match format {
        Format::Text => {
            let read = Watched {
                file,
                path,
                seen,
                done: 0,
                all: bytes,
            };
            text::read_sized(read, Some(bytes), &options.text, options.limits, wanted)
        }
        #[cfg(feature = "rosbag")]
        Format::Split => split::read(path, options.limits).and_then(|(table, parts)| {
            if let Some(seen) = seen {
                hand_on(path, &about, seen)?;
                for (part, about) in &parts {
                    hand_on(part, about, seen)?;
                }
            }
            whole(table, format)
        }),
        format => binary(format, file, path, bytes, options, wanted).and_then(|table| {
            if let Some(seen) = seen {
                hand_on(path, &about, seen)?;
            }
            Ok(table)
        }),
    };
    watch::tell(path, bytes, bytes);
    let mut table = table?;
    if format != Format::Text {
        take_units_of_names(&mut table);
    }
    stamps::join(&mut table);
    Ok(table)
}

/// The episodes of a data set of LeRobot, by its list of what they hold.
#[cfg(feature = "parquet")]
fn data_set(info: &Path, options: &ReadOptions, seen: Bytes<'_>) -> Result<Table, Error> {
    let about = regular(info).map_err(|e| not_opened(e, "a recording has to be a regular file"))?;
    watch::tell(info, 0, about.len());
    let (table, parts) = lerobot::read(info, options.limits)?;
    if let Some(seen) = seen {
        hand_on(info, &about, seen)?;
        for (part, about) in &parts {
            hand_on(part, about, seen)?;
        }
    }
    watch::tell(info, about.len(), about.len());
    let mut table = whole(table, Format::Parquet)?;
    take_units_of_names(&mut table);
    stamps::join(&mut table);
    Ok(table)
}

/// A table that was written as it stood in a program has its units where a text has them: `Position [mm]`.
pub(crate) fn take_units_of_names(table: &mut Table) {
    for column in table.columns.iter_mut().filter(|c| c.unit.is_none()) {
        if let (name, Some(unit)) = unit::split(&column.name)
            && unit::is_known(&unit)
        {
            (column.name, column.unit) = (name, Some(unit));
        }
    }
}

/// The file of a text, of which every byte is handed on as it is read.
struct Watched<'p, 's> {
    file: File,
    path: &'p Path,
    seen: Bytes<'s>,
    done: u64,
    all: u64,
}

impl Read for Watched<'_, '_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(buffer)?;
        if let Some(seen) = &mut self.seen {
            seen(&buffer[..read]);
        }
        self.done += read as u64;
        watch::tell(self.path, self.done.min(self.all), self.all);
        Ok(read)
    }
}

/// Hands on the bytes of a file that was not read in order, which must be the same as before.
pub(crate) fn hand_on(
    path: &Path,
    before: &Metadata,
    seen: &mut dyn FnMut(&[u8]),
) -> Result<(), Error> {
    let mut file = File::open(path).map_err(io)?;
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer).map_err(io)? {
            0 => break,
            read => seen(&buffer[..read]),
        }
    }
    let after = std::fs::metadata(path).map_err(io)?;
    let same = after.len() == before.len() && after.modified().ok() == before.modified().ok();
    if same {
        return Ok(());
    }
    Err(Error::new(
        Kind::Io,
        format!(
            "the file changed while it was read: it had {} bytes, and has {}",
            before.len(),
            after.len()
        ),
        "a recording that is closed, or a copy of it",
    ))
}

#[cfg_attr(not(feature = "all"), allow(unused_variables, unused_mut))]
fn binary(
    format: Format,
    file: File,
    path: &Path,
    bytes: u64,
    options: &ReadOptions,
    wanted: Wanted,
) -> Result<Table, Error> {
    let limits = options.limits;
    let mut table: Table = match format {
        Format::Text | Format::Split => return Err(io(io::ErrorKind::InvalidInput.into())),
        Format::Foreign(what, instead) => Err(Error::new(Kind::Format, what, instead)),
        #[cfg(feature = "matlab")]
        Format::Matlab4 => crate::matlab4::read(file, bytes, limits),
        #[cfg(feature = "matlab")]
        Format::Matlab5 => crate::matlab5::read(file, bytes, limits),
        #[cfg(feature = "hdf5")]
        Format::Hdf5 => crate::hdf5::read(path, bytes, limits),
        #[cfg(feature = "numpy")]
        Format::Npy => crate::numpy::read_npy(file, limits),
        #[cfg(feature = "numpy")]
        Format::Npz => crate::numpy::read_npz(file, limits),
        #[cfg(feature = "parquet")]
        Format::Parquet => {
            let table = crate::parquet::read(file, bytes, limits, 0);
            table.and_then(|table| lerobot::complete(path, table))
        }
        #[cfg(feature = "json")]
        Format::Json => crate::json::read(file, limits),
        #[cfg(feature = "arrow")]
        Format::Arrow => crate::arrow::read(file, bytes, limits),
        #[cfg(feature = "mcap")]
        Format::Mcap => crate::ros::read("MCAP", bytes, limits, |bag| crate::mcap::read(file, bag)),
        #[cfg(feature = "rosbag")]
        Format::Rosbag => crate::ros::read("rosbag2", bytes, limits, |bag| {
            crate::rosbag::read(file, path, bytes, limits, bag)
        }),
        #[cfg(feature = "tdms")]
        Format::Tdms => crate::tdms::read(file, bytes, limits),
        #[cfg(feature = "mdf")]
        Format::Mdf => crate::mdf::read(&file, bytes, limits, wanted),
        #[cfg(feature = "svb")]
        Format::Svb => crate::svb::read(file, bytes, limits),
        #[cfg(feature = "ethercat")]
        Format::Ethercat => crate::ethercat::read(&file, path, limits, &options.ethercat),
        #[cfg(feature = "xlsx")]
        Format::Xlsx => crate::xlsx::read(file, limits),
        #[cfg(not(feature = "all"))]
        other => Err(Error::new(
            Kind::Format,
            format!("this build has no {} reader", other.words()),
            "build with the feature of that format, or save the recording as text",
        )),
    }?;
    #[cfg(feature = "rosbag")]
    if let (Format::Rosbag | Format::Mcap, Some(files)) = (format, split::is_part(path)) {
        table.detected.push(format!(
            "one of {files} files of a recording: its {} leads to all of them",
            split::NAME
        ));
    }
    whole(table, format)
}

/// The same table with the name of its format, unless it has no column.
fn whole(mut table: Table, format: Format) -> Result<Table, Error> {
    if table.columns.is_empty() {
        let skipped = match table.skipped.join(", ") {
            text if text.is_empty() => "nothing else".to_owned(),
            text => text,
        };
        return Err(Error::new(
            Kind::Missing,
            format!("no numeric column; left out: {}", shorten(&skipped)),
            "a recording needs at least one numeric column",
        ));
    }
    table.detected.insert(0, format.words().to_owned());
    Ok(table)
}

/// The list of its files in the folder of a recording of rosbag2; `None` of other folders and of files.
#[cfg(feature = "rosbag")]
pub fn bag_of(folder: &Path) -> Option<std::path::PathBuf> {
    let metadata = folder.join(split::NAME);
    let mut file = regular(&metadata)
        .ok()
        .and_then(|_| File::open(&metadata).ok())?;
    let is_split = matches!(sniff(&mut file, 0), Ok(Format::Split));
    is_split.then_some(metadata)
}

/// Whether a folder is one recording as a whole: of rosbag2, or a data set of LeRobot.
pub fn is_recording_folder(folder: &Path) -> bool {
    #[cfg(feature = "rosbag")]
    if bag_of(folder).is_some() {
        return true;
    }
    #[cfg(feature = "parquet")]
    if lerobot::data_set_of(folder).is_some() {
        return true;
    }
    let _ = folder;
    false
}

/// Enough of a long list for one line.
fn shorten(text: &str) -> String {
    match text.char_indices().nth(200) {
        Some((end, _)) => format!("{} ...", &text[..end]),
        None => text.to_owned(),
    }
}
