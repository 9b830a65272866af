//! Pages of an SQLite database file: its header, and each page at most once.
//!
//! Format: <https://www.sqlite.org/fileformat2.html>.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use crate::binary::Collector;
use crate::sniff::SQLITE;
use crate::{Error, Kind};

/// Bytes that are read at once: pages of a table mostly follow each other.
const WINDOW: u64 = 1 << 16;

/// Bytes of a part of an unpacked file: a multiple of every size of pages.
const PART: usize = 1 << 20;

/// Where the bytes of pages come from.
pub(super) enum Source {
    /// A file, and the bytes of it from an offset on that were read last.
    File {
        file: File,
        window: Vec<u8>,
        from: u64,
    },
    /// An unpacked file in parts of [`PART`] bytes.
    Memory(Vec<Vec<u8>>),
}

impl Source {
    pub(super) fn file(file: File) -> Self {
        let window = Vec::new();
        let from = 0;
        Source::File { file, window, from }
    }

    /// Holds all of a stream that unpacks a file, within what is allowed.
    pub(super) fn unpacked(
        stream: &mut dyn Read,
        collector: &mut Collector,
    ) -> Result<(Self, u64), Error> {
        let (mut parts, mut bytes) = (Vec::new(), 0);
        loop {
            let mut part = Vec::new();
            collector.hold(PART as u64)?;
            let read = stream.take(PART as u64).read_to_end(&mut part);
            read.map_err(|error| {
                let found = format!("the packed data are damaged ({error})");
                Error::new(Kind::Format, found, WHOLE)
            })?;
            if part.is_empty() {
                return Ok((Source::Memory(parts), bytes));
            }
            if !collector.unpacks(part.len() as u64) {
                let found = "the file unpacks to more than such a recording has";
                return Err(Error::new(Kind::Limit, found, "unpack it first: zstd -d"));
            }
            bytes += part.len() as u64;
            parts.push(part);
        }
    }

    /// Copies the bytes from an offset on that fill the buffer.
    fn read(&mut self, at: u64, into: &mut [u8]) -> io::Result<()> {
        let (bytes, from) = match self {
            Source::Memory(parts) => {
                let part = usize::try_from(at).ok().and_then(|at| parts.get(at / PART));
                (part.map_or(&[][..], Vec::as_slice), at - at % PART as u64)
            }
            Source::File { file, window, from } => {
                let end = at + into.len() as u64;
                if at < *from || end > *from + window.len() as u64 {
                    window.clear();
                    *from = at;
                    file.seek(SeekFrom::Start(at))?;
                    file.take(WINDOW.max(into.len() as u64))
                        .read_to_end(window)?;
                }
                (window.as_slice(), *from)
            }
        };
        let there = bytes.get((at - from) as usize..);
        let there = there.and_then(|bytes| bytes.get(..into.len()));
        into.copy_from_slice(there.ok_or(io::ErrorKind::UnexpectedEof)?);
        Ok(())
    }
}

/// What is allowed instead of a damaged file.
const WHOLE: &str = "a whole recording; `sqlite3 bag.db3 .recover | sqlite3 saved.db3` saves what a broken one holds";

/// The pages of a database.
pub(super) struct Pages {
    source: Source,
    /// Bytes of the file.
    bytes: u64,
    /// Bytes of a page.
    size: usize,
    /// Bytes of a page without those that are reserved at its end.
    pub(super) usable: usize,
    /// Whether changes may stand in a file of their own, the write-ahead log.
    pub(super) logs_ahead: bool,
    /// A bit for each page that was read: each belongs to one place.
    used: Vec<u64>,
}

impl Pages {
    /// Reads the header of a file of this many bytes.
    pub(super) fn new(
        mut source: Source,
        bytes: u64,
        collector: &mut Collector,
    ) -> Result<Self, Error> {
        let mut head = [0; 100];
        let bad = |found: String| Error::new(Kind::Format, found, WHOLE).at_byte(0);
        let read = source.read(0, &mut head);
        read.map_err(|_| bad("the file ends within its header".to_owned()))?;
        let size = match u16::from_be_bytes([head[16], head[17]]) {
            1 => 1 << 16,
            size => usize::from(size),
        };
        let usable = size.saturating_sub(usize::from(head[20]));
        if &head[..16] != SQLITE || !size.is_power_of_two() || size < 512 || usable < 480 {
            return Err(bad(format!("a database with pages of {size} bytes")));
        }
        if !(1..=2).contains(&head[19]) {
            return Err(bad(format!("a database of version {}", head[19])));
        }
        let encoding = u32::from_be_bytes([head[56], head[57], head[58], head[59]]);
        if encoding > 1 {
            return Err(bad(
                "a database with texts in UTF-16, not in UTF-8".to_owned()
            ));
        }
        let words = (bytes / size as u64).div_ceil(64);
        collector.hold(8 * words)?;
        Ok(Self {
            source,
            bytes,
            size,
            usable,
            logs_ahead: head[19] == 2,
            used: vec![0; words as usize],
        })
    }

    /// What is wrong with a page, counted from 1.
    pub(super) fn bad(&self, page: u32, found: impl Into<String>) -> Error {
        let at = u64::from(page).saturating_sub(1) * self.size as u64;
        Error::new(Kind::Format, found, WHOLE).at_byte(at)
    }

    /// Copies a page, counted from 1, into a buffer.
    pub(super) fn read(&mut self, page: u32, into: &mut Vec<u8>) -> Result<(), Error> {
        let index = u64::from(page).wrapping_sub(1);
        if page == 0 {
            return Err(self.bad(1, "a row that ends too early"));
        }
        if index >= self.bytes / self.size as u64 {
            let found = format!("the file ends before page {page}; was it cut off?");
            return Err(self.bad(page, found));
        }
        let (word, bit) = ((index / 64) as usize, 1 << (index % 64));
        if self.used[word] & bit != 0 {
            return Err(self.bad(page, format!("page {page} is used twice")));
        }
        self.used[word] |= bit;
        into.resize(self.size, 0);
        let read = self.source.read(index * self.size as u64, into);
        read.map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => self.bad(page, "the file has become shorter"),
            _ => Error::new(Kind::Io, format!("cannot be read ({error})"), ""),
        })
    }
}
