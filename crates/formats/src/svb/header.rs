//! The headers of the file and of its channels.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};

use crate::{Error, Kind};

/// FILETIME (100 ns since 1601) of 1990 and 2200, between which a recording lies.
const DATES: std::ops::Range<i64> = 122_752_512_000_000_000..189_025_056_000_000_000;
/// Largest name of a recording in bytes by which a file is still recognised.
const MAX_TITLE: usize = 400;
/// Largest text of a channel in bytes.
const MAX_TEXT: u32 = 1 << 16;
/// Bytes that all headers stay below in a file that is recognised.
const MAX_HEADERS: u64 = 1 << 32;
/// Most channels of a file.
const MAX_CHANNELS: u32 = 65_536;

/// A channel, and where its data are.
pub(super) struct Channel {
    pub name: String,
    /// `REAL64`, `INT16`, ...
    pub kind: String,
    /// Bytes of one value.
    pub size: u64,
    pub samples: u64,
    /// Bytes of the data of all samples, and where in the file they start.
    pub bytes: u64,
    pub start: u64,
    pub sample_time_ms: Option<f64>,
    pub offset: f64,
    pub scale: f64,
}

/// Whether a file begins with a header. It has no mark: what stands in it must be possible, a name in UTF-8 and two dates above
/// all.
pub(crate) fn starts(start: &[u8]) -> bool {
    let Some(main) = main(start) else {
        return false;
    };
    let [from, to] = main.dates;
    let name = std::str::from_utf8(main.name);
    (main.end as u64..MAX_HEADERS).contains(&main.size)
        && name.is_ok_and(|name| !name.contains(char::is_control))
        && DATES.contains(&from)
        && DATES.contains(&to)
        && from <= to
        && (1..=MAX_CHANNELS).contains(&main.channels)
}

struct Main<'a> {
    size: u64,
    name: &'a [u8],
    dates: [i64; 2],
    channels: u32,
    end: usize,
}

fn main(start: &[u8]) -> Option<Main<'_>> {
    let (size, rest) = start.split_first_chunk()?;
    let (length, rest) = rest.split_first_chunk()?;
    let length = u32::from_le_bytes(*length) as usize;
    let (name, rest) = rest
        .split_at_checked(length)
        .filter(|_| length <= MAX_TITLE)?;
    let (from, rest) = rest.split_first_chunk()?;
    let (to, rest) = rest.split_first_chunk()?;
    let (channels, rest) = rest.split_first_chunk()?;
    Some(Main {
        size: u64::from_le_bytes(*size),
        name,
        dates: [from, to].map(|date| i64::from_le_bytes(*date)),
        channels: u32::from_le_bytes(*channels),
        end: start.len() - rest.len(),
    })
}

/// Reads all headers of a file of so many bytes.
pub(super) fn channels(file: &mut BufReader<File>, bytes: u64) -> Result<Vec<Channel>, Error> {
    let mut start = Vec::new();
    let read = file.by_ref().take(512).read_to_end(&mut start);
    read.map_err(|error| failed(&error, 0))?;
    let main = main(&start).ok_or_else(|| bad("a damaged header", 0))?;
    let mut at = main.end as u64;
    let mut channels = Vec::new();
    for _ in 0..main.channels {
        let mut fields = Fields { file, at };
        let (channel, size) = fields.seek().and_then(|()| fields.channel())?;
        let end = fields.at;
        // Later versions may say more about a channel than is known here, at the end.
        let next = at
            .checked_add(size)
            .filter(|next| (end..=bytes).contains(next));
        let Some(next) = next else {
            let read = end - at;
            return Err(bad(
                format!("a channel header of {size} bytes, which says {read}"),
                at,
            ));
        };
        at = next;
        channels.push(channel);
    }
    Ok(channels)
}

/// The fields of a header, one after the other.
struct Fields<'a> {
    file: &'a mut BufReader<File>,
    at: u64,
}

impl Fields<'_> {
    fn seek(&mut self) -> Result<(), Error> {
        let moved = self.file.seek(SeekFrom::Start(self.at));
        moved.map(drop).map_err(|error| failed(&error, self.at))
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let mut bytes = [0; N];
        let read = self.file.read_exact(&mut bytes);
        read.map_err(|error| failed(&error, self.at))?;
        self.at += N as u64;
        Ok(bytes)
    }

    fn word(&mut self) -> Result<u32, Error> {
        self.bytes().map(u32::from_le_bytes)
    }

    fn long(&mut self) -> Result<u64, Error> {
        self.bytes().map(u64::from_le_bytes)
    }

    fn real(&mut self) -> Result<f64, Error> {
        self.bytes().map(f64::from_le_bytes)
    }

    fn text(&mut self) -> Result<String, Error> {
        let length = self.word()?;
        if length > MAX_TEXT {
            return Err(bad(format!("a text of {length} bytes"), self.at));
        }
        let mut text = vec![0; length as usize];
        let read = self.file.read_exact(&mut text);
        read.map_err(|error| failed(&error, self.at))?;
        self.at += u64::from(length);
        Ok(String::from_utf8_lossy(&text)
            .trim_end_matches('\0')
            .to_owned())
    }

    /// A channel, and the size of its header.
    fn channel(&mut self) -> Result<(Channel, u64), Error> {
        let size = self.long()?;
        let mut name = self.text()?;
        let _net_id = self.text()?;
        let _port = self.word()?;
        let sample_time = self.long()?;
        let [_symbol_based] = self.bytes()?;
        let symbol = self.text()?;
        let _comment = self.text()?;
        let _index_group = self.long()?;
        let _index_offset = self.long()?;
        let kind = self.text()?;
        let _kind_id = self.word()?;
        let value = self.word()?;
        let [samples, bytes, start] = [self.long()?, self.long()?, self.long()?];
        let [offset, scale] = [self.real()?, self.real()?];
        let _mask = self.long()?;
        if name.is_empty() {
            name = symbol;
        }
        // 100 ns.
        let sample_time_ms = (1..1_u64 << 53).contains(&sample_time);
        let channel = Channel {
            name,
            kind,
            size: u64::from(value),
            samples,
            bytes,
            start,
            sample_time_ms: sample_time_ms.then_some(sample_time as f64 / 1e4),
            offset,
            scale,
        };
        Ok((channel, size))
    }
}

fn bad(found: impl Into<String>, at: u64) -> Error {
    let allowed = "a whole SVB file, as TwinCAT Scope exports it";
    Error::new(Kind::Format, found, allowed).at_byte(at)
}

fn failed(error: &std::io::Error, at: u64) -> Error {
    match error.kind() {
        ErrorKind::UnexpectedEof => bad("the file ends within its headers; was it cut off?", at),
        _ => Error::new(Kind::Io, format!("cannot be read ({error})"), "").at_byte(at),
    }
}
