//! Recognises the format of a file by its first bytes.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

/// What to do with a recording in MDF that is not read.
pub(crate) const MDF_AS_TABLES: &str = "have it written as one table for each clock in it, after pip install asammdf: python3 -c 'from asammdf import MDF; \
     MDF(\"log.mf4\").export(\"csv\", \"log.csv\", add_units=True)'";

/// First bytes of MCAP and of SQLite.
const MCAP: &[u8] = b"\x89MCAP0\r\n";
pub(crate) const SQLITE: &[u8] = b"SQLite format 3\0";

/// First bytes of pcapng, and of pcap in both byte orders and in micro- and nanoseconds.
const PCAP: [[u8; 4]; 5] = [
    [0x0a, 0x0d, 0x0d, 0x0a],
    [0xd4, 0xc3, 0xb2, 0xa1],
    [0xa1, 0xb2, 0xc3, 0xd4],
    [0x4d, 0x3c, 0xb2, 0xa1],
    [0xa1, 0xb2, 0x3c, 0x4d],
];

/// The formats that are recognised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Matlab4,
    Matlab5,
    Hdf5,
    Npy,
    Npz,
    Parquet,
    Json,
    Arrow,
    Mcap,
    Rosbag,
    /// A text that lists the files of a recording.
    #[cfg_attr(not(feature = "rosbag"), allow(dead_code))]
    Split,
    Tdms,
    Mdf,
    /// Told from text by reading its header, which its reader does.
    #[cfg_attr(not(feature = "svb"), allow(dead_code))]
    Svb,
    /// Told from NPZ by looking into the archive, which its reader does.
    #[cfg_attr(not(feature = "xlsx"), allow(dead_code))]
    Xlsx,
    Ethercat,
    /// A known format that is not read, and what to do instead.
    Foreign(&'static str, &'static str),
    Text,
}

impl Format {
    /// Its usual name.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Format::Matlab4 => "MATLAB version 4",
            Format::Matlab5 => "MATLAB version 5",
            Format::Hdf5 => "HDF5",
            Format::Npy => "NumPy NPY",
            Format::Npz => "NumPy NPZ",
            Format::Parquet => "Parquet",
            Format::Json => "JSON",
            Format::Arrow => "Arrow IPC",
            Format::Mcap => "MCAP",
            Format::Rosbag => "rosbag2 in SQLite",
            Format::Split => "rosbag2",
            Format::Tdms => "TDMS",
            Format::Mdf => "ASAM MDF",
            Format::Svb => "TwinCAT Scope SVB",
            Format::Xlsx => "Excel workbook",
            Format::Ethercat => "EtherCAT capture",
            Format::Foreign(what, _) => what,
            Format::Text => "text",
        }
    }
}

/// An object with a quoted key, or a list of objects, lists, texts or of several numbers; no text table begins like that.
fn is_json(start: &[u8]) -> bool {
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    let mut bytes = start.iter().filter(|byte| !byte.is_ascii_whitespace());
    let opening = (bytes.next(), bytes.next());
    let next = bytes.find(|byte| matches!(byte, b',' | b']'));
    match opening {
        (Some(b'{'), Some(b'"')) | (Some(b'['), Some(b'{' | b'[')) => true,
        (Some(b'['), Some(b'"' | b'-' | b'0'..=b'9')) => next == Some(&b','),
        _ => false,
    }
}

/// The format of a file of this many bytes.
pub(crate) fn sniff(file: &mut File, bytes: u64) -> io::Result<Format> {
    let mut start = Vec::new();
    file.by_ref().take(512).read_to_end(&mut start)?;
    let starts = |magic: &[u8]| start.starts_with(magic);
    if starts(b"\x89HDF\r\n\x1a\n") {
        return Ok(Format::Hdf5);
    }
    if starts(b"\x93NUMPY") {
        return Ok(Format::Npy);
    }
    if starts(b"PK\x03\x04") || starts(b"PK\x05\x06") {
        #[cfg(feature = "xlsx")]
        if crate::xlsx::is_workbook(file) {
            return Ok(Format::Xlsx);
        }
        return Ok(Format::Npz);
    }
    if starts(b"PAR1") || starts(b"PARE") {
        return Ok(Format::Parquet);
    }
    if PCAP.iter().any(|magic| starts(magic)) {
        return Ok(Format::Ethercat);
    }
    if starts(b"MDF     4") {
        return Ok(Format::Mdf);
    }
    if starts(b"TDSm") {
        return Ok(Format::Tdms);
    }
    if starts(MCAP) {
        return Ok(Format::Mcap);
    }
    if starts(SQLITE) {
        return Ok(Format::Rosbag);
    }
    if starts(b"ARROW1\0\0") || is_arrow_stream(&start) {
        return Ok(Format::Arrow);
    }
    if let Some([0, 1, b'I', b'M'] | [1, 0, b'M', b'I']) = start.get(124..128) {
        return Ok(Format::Matlab5);
    }
    // HDF5 may stand behind a user block of 512 bytes times a power of two, as MATLAB writes it.
    let mut at = 512;
    while at < bytes.min(1 << 20) {
        let mut magic = Vec::new();
        file.seek(SeekFrom::Start(at))?;
        file.by_ref().take(8).read_to_end(&mut magic)?;
        if magic == b"\x89HDF\r\n\x1a\n" {
            return Ok(Format::Hdf5);
        }
        at *= 2;
    }
    #[cfg(feature = "mcap")]
    if let Some(format) = packed_bag(file, &start)? {
        return Ok(format);
    }
    let compressed = "unpack it first";
    Ok(match start[..] {
        [0x1f, 0x8b, ..] => Format::Foreign("a gzip archive", compressed),
        [0x28, 0xb5, 0x2f, 0xfd, ..] => Format::Foreign("a Zstandard archive", compressed),
        [b'B', b'Z', b'h', ..] => Format::Foreign("a bzip2 archive", compressed),
        [0xfd, b'7', b'z', b'X', b'Z', ..] => Format::Foreign("an xz archive", compressed),
        _ if starts(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1") => Format::Foreign(
            "an old Excel workbook",
            "save it as .xlsx or the sheet as CSV",
        ),
        _ if starts(b"MDF     ") => Format::Foreign(
            "a recording in ASAM MDF of a version before 4 (.mdf, .dat)",
            MDF_AS_TABLES,
        ),
        _ if starts(b"UnFinMF ") => Format::Foreign(
            "a recording in ASAM MDF that was never closed",
            MDF_AS_TABLES,
        ),
        _ if starts(b"FEA1") => Format::Foreign(
            "a Feather file of version 1",
            "write it again with version 2, as pyarrow and pandas do by themselves",
        ),
        _ if is_matlab4(&start) => Format::Matlab4,
        #[cfg(feature = "svb")]
        _ if crate::svb::starts(&start) => Format::Svb,
        #[cfg(feature = "rosbag")]
        _ if crate::ros::split::is_metadata(&start) => Format::Split,
        _ if is_json(&start) => Format::Json,
        _ => Format::Text,
    })
}

/// The format of a recording of rosbag2 that was packed as a whole (`.db3.zstd`, `.mcap.zstd`).
#[cfg(feature = "mcap")]
fn packed_bag(file: &mut File, start: &[u8]) -> io::Result<Option<Format>> {
    if !start.starts_with(&crate::ros::ZSTD) {
        return Ok(None);
    }
    file.rewind()?;
    let mut inside = Vec::new();
    let unpacked = crate::binary::zstd(&*file, 0);
    // What cannot be unpacked is no recording that is known.
    let _ = unpacked.and_then(|stream| stream.take(16).read_to_end(&mut inside));
    Ok(match &inside[..] {
        SQLITE => Some(Format::Rosbag),
        inside if inside.starts_with(MCAP) => Some(Format::Mcap),
        _ => None,
    })
}

/// Whether a message of Arrow IPC begins here: its mark, and a length of metadata that is a multiple of 8.
fn is_arrow_stream(start: &[u8]) -> bool {
    match start.first_chunk() {
        Some(&[0xff, 0xff, 0xff, 0xff, a, b, c, d]) => {
            let length = u32::from_le_bytes([a, b, c, d]);
            length > 0 && length.is_multiple_of(8) && length < 1 << 26
        }
        _ => false,
    }
}

/// Whether these bytes are the header of a variable in a MAT file of version 4, which has no magic:
/// a type below 5000 with a zero in the hundreds, sizes, a flag, and a short name that ends in NUL.
fn is_matlab4(start: &[u8]) -> bool {
    let (words, _) = start.as_chunks::<4>();
    let [kind, rows, columns, imaginary, length, ..] = *words else {
        return false;
    };
    let check = |read: fn([u8; 4]) -> u32, orders: &[u32]| {
        let kind = read(kind);
        let length = read(length) as usize;
        let name = start.get(20..).and_then(|rest| rest.get(..length));
        orders.contains(&(kind / 1000))
            && (kind / 100).is_multiple_of(10)
            && kind / 10 % 10 <= 5
            && kind % 10 <= 2
            && read(imaginary) <= 1
            && read(rows) < 1 << 31
            && read(columns) < 1 << 31
            && name.is_some_and(|name| {
                let letter = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_';
                matches!(name, [text @ .., 0] if !text.is_empty() && text.iter().all(letter))
            })
    };
    check(u32::from_le_bytes, &[0]) || check(u32::from_be_bytes, &[1])
}

#[cfg(test)]
mod tests {
    use super::is_json;

    #[test]
    fn json_is_told_from_text() {
        for text in [
            "{\"mass\": 0.49, \"entries\": [",
            "{\n  \"t\": [0",
            " [ {\"t\": 0}",
            "[[0.0, 1.0],\n",
            "[1, 2]\n[3, 4]\n",
            "\u{feff}{\"t\": 0}",
        ] {
            assert!(is_json(text.as_bytes()), "{text}");
        }
        for text in [
            "",
            "[header]\n0 1\n",
            "{name}\n0 1\n",
            "\"t\",\"x\"\n0,1\n",
            "[1] 0.5, 2\n",
        ] {
            assert!(!is_json(text.as_bytes()), "{text}");
        }
    }
}
