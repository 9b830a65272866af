//! Tables of records (structured arrays, compound types): fields at fixed offsets of a row.

use super::{Collector, Number, Order, Values};
use crate::Error;

/// One field of a record.
#[derive(Clone, Debug)]
pub(crate) struct Field {
    pub(crate) name: String,
    /// Bytes from the start of the record.
    pub(crate) offset: usize,
    pub(crate) cell: Cell,
}

/// What a field holds.
#[derive(Clone, Debug)]
pub(crate) enum Cell {
    Number(Number),
    /// Anything else, and what it is.
    Other(String),
}

/// Most bytes of one record: the size of one read buffer, and far more than any recording needs.
const MAX_BYTES: usize = 1 << 20;

/// The layout of one record.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    bytes: usize,
    fields: Vec<Field>,
}

impl Record {
    /// A record of this many bytes, if it is of a sane size and its numbers lie inside it, each in bytes of its own.
    pub(crate) fn new(bytes: usize, fields: Vec<Field>) -> Option<Self> {
        let width = |field: &Field| match field.cell {
            Cell::Number(number) => number.width(),
            Cell::Other(_) => 0,
        };
        let inside = |field: &Field| match width(field) {
            0 => true,
            width => (field.offset.checked_add(width)).is_some_and(|end| end <= bytes),
        };
        let taken = fields.iter().map(width).sum::<usize>();
        let sane = (1..=MAX_BYTES).contains(&bytes) && taken <= bytes;
        let sane = sane && fields.iter().all(inside);
        sane.then_some(Self { bytes, fields })
    }

    /// Bytes of one record.
    pub(crate) fn bytes(&self) -> usize {
        self.bytes
    }

    /// Reads `rows` records, `next` filling the buffer it is given with the bytes that follow, and
    /// adds one column for each field that holds numbers, named `prefix.field`. Where no field
    /// does, nothing is read and the answer is `false`.
    pub(crate) fn columns(
        &self,
        prefix: &str,
        rows: u64,
        collector: &mut Collector,
        mut next: impl FnMut(&mut [u8]) -> Result<(), Error>,
    ) -> Result<bool, Error> {
        let mut columns = Vec::new();
        for field in &self.fields {
            collector.entry()?;
            let name = join(prefix, &field.name);
            match &field.cell {
                Cell::Number(number) => {
                    collector.reserve(&name, &[rows])?;
                    columns.push((name, field.offset, *number, Values::default()));
                }
                Cell::Other(what) => collector.skip(&name, what),
            }
        }
        let at_once = (1 << 16) / self.bytes as u64;
        let mut buffer = Vec::new();
        if columns.is_empty() {
            return Ok(false);
        }
        let mut left = rows;
        while left > 0 {
            let now = left.min(at_once.max(1));
            buffer.resize(now as usize * self.bytes, 0);
            next(&mut buffer)?;
            for row in buffer.chunks_exact(self.bytes) {
                for (_, offset, number, values) in &mut columns {
                    number.decode(&row[*offset..][..number.width()], values);
                }
            }
            left -= now;
        }
        for (name, _, _, values) in columns {
            collector.array(&name, None, &[rows], Order::Row, values);
        }
        Ok(true)
    }
}

/// `prefix.name`, or just `name`.
pub(crate) fn join(prefix: &str, name: &str) -> String {
    match prefix {
        "" => name.to_owned(),
        prefix => format!("{prefix}.{name}"),
    }
}
