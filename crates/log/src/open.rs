//! The one entry point for every format: looks at the first bytes and calls the reader.

use std::fs::File;
use std::io::Seek;
use std::path::Path;

use crate::sniff::{Format, sniff};
use crate::text::{self, TextOptions};
use crate::{Error, Kind, Table};

/// How large a file may be before it is refused with [`Kind::Limit`].
///
/// A compressed file can claim a thousand times its size; nothing is allocated for more than this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Size of the file in bytes; 4 GiB unless told otherwise.
    pub file_bytes: u64,
    /// Samples over all columns of a file that is not text; 2^28 (2 GiB in memory) unless told otherwise, and no more than
    /// half of the memory that this machine has or allows holds. While reading they take at most three times that, those of
    /// arrays (MATLAB, HDF5, NumPy) 9/8, beside what a decoder holds: a chunk, or the file itself (HDF5).
    /// Text, which cannot claim more than it holds, has limits of its own, see [`text`].
    pub samples: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            file_bytes: 1 << 32,
            samples: (1 << 28).min(half_of_memory() / size_of::<f64>() as u64),
        }
    }
}

/// Half of the memory of this machine in bytes, or of what its control group may take; without end where neither is told.
fn half_of_memory() -> u64 {
    let read = |file: &str| std::fs::read_to_string(file).unwrap_or_default();
    let about = read("/proc/meminfo");
    let total = about.lines().find_map(|line| {
        let kibibytes = line.strip_prefix("MemTotal:")?.trim().strip_suffix("kB")?;
        kibibytes.trim().parse::<u64>().ok()?.checked_mul(1024)
    });
    let group = read("/sys/fs/cgroup/memory.max").trim().parse().ok();
    total.unwrap_or(u64::MAX).min(group.unwrap_or(u64::MAX)) / 2
}

/// How a file is to be read, where that does not follow from the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// What the user states about a text file.
    pub text: TextOptions,
    /// How large the file may be.
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
    read(path, options).map_err(|error| error.in_file(path))
}

fn read(path: &Path, options: &ReadOptions) -> Result<Table, Error> {
    let io = |error: std::io::Error| Error::new(Kind::Io, format!("cannot be read ({error})"), "");
    // Looked at before it is opened: opening a pipe that nobody writes to would wait forever.
    let about = std::fs::metadata(path).map_err(io)?;
    if !about.is_file() {
        let what = if about.is_dir() {
            "a directory"
        } else {
            "not a regular file"
        };
        return Err(Error::new(
            Kind::Io,
            what,
            "a recording has to be a regular file",
        ));
    }
    let bytes = about.len();
    if bytes == 0 {
        return Err(Error::new(Kind::Format, "the file is empty", ""));
    }
    if bytes > options.limits.file_bytes {
        return Err(Error::new(
            Kind::Limit,
            format!("a file of {bytes} bytes"),
            format!("at most {} bytes", options.limits.file_bytes),
        ));
    }
    let mut file = File::open(path).map_err(io)?;
    let format = sniff(&mut file, bytes).map_err(io)?;
    file.rewind().map_err(io)?;
    #[cfg_attr(not(feature = "all"), allow(unused_variables))]
    let limits = options.limits;
    let mut table: Table = match format {
        Format::Text => return text::read_file(path, &options.text),
        Format::Foreign(what, instead) => Err(Error::new(Kind::Format, what, instead)),
        #[cfg(feature = "matlab")]
        Format::Matlab4 => crate::matlab4::read(file, bytes, limits),
        #[cfg(feature = "matlab")]
        Format::Matlab5 => crate::matlab5::read(file, bytes, limits),
        #[cfg(feature = "hdf5")]
        Format::Hdf5 => crate::hdf5::read(path, limits),
        #[cfg(feature = "numpy")]
        Format::Npy => crate::numpy::read_npy(file, limits),
        #[cfg(feature = "numpy")]
        Format::Npz => crate::numpy::read_npz(file, limits),
        #[cfg(feature = "parquet")]
        Format::Parquet => crate::parquet::read(file, bytes, limits),
        #[cfg(feature = "json")]
        Format::Json => crate::json::read(file, limits),
        #[cfg(feature = "arrow")]
        Format::Arrow => crate::arrow::read(file, bytes, limits),
        #[cfg(feature = "mcap")]
        Format::Mcap => crate::mcap::read(file, limits),
        #[cfg(feature = "tdms")]
        Format::Tdms => crate::tdms::read(file, bytes, limits),
        #[cfg(feature = "svb")]
        Format::Svb => crate::svb::read(file, bytes, limits),
        #[cfg(feature = "xlsx")]
        Format::Xlsx => crate::xlsx::read(file, limits),
        #[cfg(not(feature = "all"))]
        other => Err(Error::new(
            Kind::Format,
            format!("this build has no {} reader", other.words()),
            "build with the feature of that format, or save the recording as text",
        )),
    }?;
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

/// Enough of a long list for one line.
fn shorten(text: &str) -> String {
    match text.char_indices().nth(200) {
        Some((end, _)) => format!("{} ...", &text[..end]),
        None => text.to_owned(),
    }
}
