//! Arrow IPC: files (Feather version 2) and streams, uncompressed, or with LZ4 or Zstandard.
//!
//! Format: "Arrow Columnar Format", version 1.5, <https://arrow.apache.org/docs/format/Columnar.html>. Fields of structures are
//! `struct.field`, lists of one length `field(:,1)`, `field(:,2)` ...; a missing value is NaN. Time stamps become seconds
//! from the first. The metadata `unit` or `units` of a field is its unit. Text, categories, lists and unions are named in
//! [`Table::skipped`].

mod batch;
mod flat;
mod schema;

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

use batch::{Batch, Samples, Trouble};
use flat::Table as Flat;
use schema::{Field, Kind};

use crate::binary::{Collector, Order, guard, seconds};
use crate::{Error, Limits, Table};

/// How a file begins, and ends without the blanks; a stream has no such mark.
pub(crate) const MAGIC: &[u8] = b"ARROW1";

/// Largest metadata of one message in bytes.
const MAX_METADATA: u64 = 64 << 20;

/// Reads every column of numbers of a file of this many bytes.
pub(crate) fn read(file: File, bytes: u64, limits: Limits) -> Result<Table, Error> {
    guard("Arrow", || {
        let mut reader = Reader {
            file,
            bytes,
            at: 0,
            collector: Collector::new(limits),
        };
        let mut start = [0; 8];
        let is_file = reader.exact(0, &mut start).is_ok() && start.starts_with(MAGIC);
        let batches = match is_file {
            true => Some(reader.footer()?),
            false => None,
        };
        reader.at = if is_file { 8 } else { 0 };
        reader.messages(batches)
    })
}

struct Reader {
    file: File,
    bytes: u64,
    at: u64,
    collector: Collector,
}

impl Reader {
    fn broken(&self, found: impl Into<String>) -> Error {
        let allowed = "a whole Arrow file or stream, as pyarrow writes it";
        Error::new(crate::Kind::Format, found, allowed).at_byte(self.at)
    }

    fn exact(&mut self, at: u64, buffer: &mut [u8]) -> std::io::Result<()> {
        self.file.seek(SeekFrom::Start(at))?;
        self.file.read_exact(buffer)
    }

    fn take(&mut self, length: u64) -> Result<Vec<u8>, Error> {
        if length > MAX_METADATA || length > self.bytes.saturating_sub(self.at) {
            let left = self.bytes.saturating_sub(self.at);
            return Err(self.broken(format!("a message of {length} bytes where {left} are left")));
        }
        let mut bytes = vec![0; length as usize];
        let read = self.exact(self.at, &mut bytes);
        read.map_err(|error| self.broken(error.to_string()))?;
        self.at += length;
        Ok(bytes)
    }

    /// How many batches the footer counts: a message that was damaged must not pass for the last one.
    fn footer(&mut self) -> Result<usize, Error> {
        let mut end = [0; 10];
        let start = self.bytes.saturating_sub(10);
        let read = self.exact(start, &mut end);
        if read.is_err() || !end.ends_with(MAGIC) {
            return Err(self.broken("the file does not end in ARROW1; was it cut off?"));
        }
        let length = u64::from(u32::from_le_bytes([end[0], end[1], end[2], end[3]]));
        let at = start.checked_sub(length).filter(|&at| at >= 8);
        self.at = at.ok_or_else(|| self.broken("a footer longer than the file"))?;
        let bytes = self.take(length)?;
        let count = Flat::root(&bytes).and_then(|footer| Some(footer.vector(3, 24)?.len));
        count.ok_or_else(|| self.broken("a damaged footer"))
    }

    fn messages(mut self, batches: Option<usize>) -> Result<Table, Error> {
        let mut fields = Vec::new();
        let mut columns: Vec<Samples> = Vec::new();
        let mut count = 0;
        let mut whole = false;
        while self.at < self.bytes {
            let first = self.word()?;
            // Before version 0.15 the length stood first.
            let length = if first == u32::MAX {
                self.word()?
            } else {
                first
            };
            if length == 0 {
                whole = true;
                break;
            }
            let metadata = self.take(u64::from(length))?;
            let damaged = |reader: &Self| reader.broken("damaged metadata of a message");
            let message = Flat::root(&metadata).ok_or_else(|| damaged(&self))?;
            let body = message.long(3).and_then(|bytes| u64::try_from(bytes).ok());
            let body = body.filter(|&bytes| bytes <= self.bytes - self.at);
            let body = body.ok_or_else(|| {
                self.broken("a message that ends behind the file; was it cut off?")
            })?;
            let header = message.table(2).flatten().ok_or_else(|| damaged(&self))?;
            match message.byte(1).ok_or_else(|| damaged(&self))? {
                1 if fields.is_empty() => {
                    let read = schema::fields(header, &mut self.collector);
                    fields = read.ok_or_else(|| self.broken("a damaged or unknown schema"))??;
                    columns.resize_with(stored(&fields), Samples::default);
                }
                3 => {
                    let Self {
                        file,
                        collector,
                        at,
                        ..
                    } = &mut self;
                    let batch = Batch::new(file, header, *at, body);
                    let read = match batch {
                        None => Err(Trouble::Broken("damaged metadata of a batch".to_owned())),
                        Some(batch) => batch.read(&fields, &mut columns, collector),
                    };
                    count += 1;
                    read.map_err(|trouble| match trouble {
                        Trouble::Broken(found) => self.broken(format!("{found} (batch {count})")),
                        Trouble::Error(error) => error,
                    })?;
                }
                // A dictionary, whose columns are left out; other messages have no rows.
                _ => {}
            }
            self.at += body;
        }
        if let Some(expected) = batches.filter(|&expected| expected != count) {
            return Err(self.broken(format!(
                "{count} batches of rows where the footer counts {expected}"
            )));
        }
        if !whole && batches.is_none() {
            self.collector.detected("the stream has no mark at its end");
        }
        let mut columns = columns.into_iter();
        for field in &fields {
            give(field, 1, &mut columns, &mut self.collector);
        }
        Ok(self.collector.finish())
    }

    fn word(&mut self) -> Result<u32, Error> {
        let bytes = self.take(4)?;
        Ok(bytes
            .iter()
            .rev()
            .fold(0, |word, &byte| word << 8 | u32::from(byte)))
    }
}

/// How many columns the fields are stored in, apart from those that are left out.
fn stored(fields: &[Field]) -> usize {
    let one = |field: &Field| match field.kind {
        Kind::Structure | Kind::Fixed(_) => stored(&field.children),
        Kind::Other(..) | Kind::View(_) => 0,
        _ => 1,
    };
    fields.iter().map(one).sum()
}

/// Adds the columns of a field, each row of which has so many values.
fn give(
    field: &Field,
    every: u64,
    columns: &mut impl Iterator<Item = Samples>,
    collector: &mut Collector,
) {
    let name = match every {
        1 => field.name.as_str(),
        // The element of a list has a name of its own that says nothing.
        _ => field
            .name
            .rsplit_once('.')
            .map_or(field.name.as_str(), |(list, _)| list),
    };
    match &field.kind {
        Kind::Other(what, ..) | Kind::View(what) => collector.skip_column(name, what),
        Kind::Structure => {
            for child in &field.children {
                give(child, every, columns, collector);
            }
        }
        Kind::Fixed(size) => {
            for child in &field.children {
                give(child, *size, columns, collector);
            }
        }
        kind => {
            let Some(samples) = columns.next() else {
                return;
            };
            let (rows, unit) = (samples.rows, field.unit.clone());
            match *kind {
                Kind::List(_) => match samples.lengths {
                    [Some(one), Some(other)] => {
                        let why = format!("lists of different lengths, {one} and {other}");
                        collector.skip_column(name, &why);
                    }
                    [Some(length), None] => {
                        let dims = [rows, length];
                        collector.array(name, unit, &dims, Order::Row, samples.values);
                    }
                    [None, _] => collector.skip_column(name, "empty"),
                },
                _ if rows == 0 || every == 0 => collector.skip_column(name, "empty"),
                Kind::Ticks(..) if every > 1 => {
                    collector.skip_column(name, "several time stamps in every row")
                }
                Kind::Ticks(_, period, clock) => {
                    let (values, done) = seconds(&samples.ticks, period, clock);
                    collector.detected(format!("{name}: {done}"));
                    collector.stamps(name, values);
                }
                _ if rows == 1 && every == 1 => {
                    collector.column(name, unit, samples.values.samples)
                }
                _ => collector.array(name, unit, &[rows, every], Order::Row, samples.values),
            }
        }
    }
}
