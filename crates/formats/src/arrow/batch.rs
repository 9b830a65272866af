//! The rows of one record batch: which buffer of the file is which column's, unpacked as a stream.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use super::flat::Table;
use super::schema::{Field, Kind};
use crate::Error;
use crate::binary::{Collector, Values, decimal, lz4, read_numbers, zstd};

/// What was read of a stored column so far.
#[derive(Default)]
pub(super) struct Samples {
    pub(super) values: Values,
    pub(super) ticks: Vec<Option<i64>>,
    pub(super) rows: u64,
    /// Numbers of every list, as far as any has some; and another number of them, where one has it.
    pub(super) lengths: [Option<u64>; 2],
}

/// How the buffers of a batch are compressed.
#[derive(Clone, Copy, PartialEq)]
enum Codec {
    None,
    Lz4,
    Zstd,
}

/// A batch whose body begins at a byte of the file.
pub(super) struct Batch<'a> {
    file: &'a mut File,
    header: Table<'a>,
    body: u64,
    bytes: u64,
    codec: Codec,
    node: usize,
    buffer: usize,
    view: usize,
}

/// Why a batch cannot be read.
pub(super) enum Trouble {
    /// It is damaged, in these words.
    Broken(String),
    Error(Error),
}

impl From<Error> for Trouble {
    fn from(error: Error) -> Self {
        Trouble::Error(error)
    }
}

fn broken(found: impl Into<String>) -> Trouble {
    Trouble::Broken(found.into())
}

impl<'a> Batch<'a> {
    pub(super) fn new(
        file: &'a mut File,
        header: Table<'a>,
        body: u64,
        bytes: u64,
    ) -> Option<Self> {
        let codec = match header.table(3)? {
            None => Codec::None,
            Some(codec) => match codec.byte(0)? {
                0 => Codec::Lz4,
                1 => Codec::Zstd,
                _ => return None,
            },
        };
        Some(Self {
            file,
            header,
            body,
            bytes,
            codec,
            node: 0,
            buffer: 0,
            view: 0,
        })
    }

    /// Appends the rows of all columns; `columns` are those that are stored, in the order of the schema.
    pub(super) fn read(
        mut self,
        fields: &[Field],
        columns: &mut [Samples],
        collector: &mut Collector,
    ) -> Result<(), Trouble> {
        let rows = self
            .header
            .long(0)
            .and_then(|rows| u64::try_from(rows).ok());
        let rows = rows.ok_or_else(|| broken("a batch without a number of rows"))?;
        let mut columns = columns.iter_mut();
        for field in fields {
            let rows = Rows {
                rows,
                every: 1,
                valid: &None,
            };
            self.field(field, rows, &mut columns, collector)?;
        }
        Ok(())
    }

    fn field<'s>(
        &mut self,
        field: &Field,
        rows: Rows<'_>,
        columns: &mut impl Iterator<Item = &'s mut Samples>,
        collector: &mut Collector,
    ) -> Result<(), Trouble> {
        let node = self
            .header
            .vector(1, 16)
            .and_then(|nodes| nodes.pair(self.node));
        let (length, _) = node.ok_or_else(|| broken("a batch without the length of a column"))?;
        self.node += 1;
        let first = self.buffer;
        self.buffer += field.kind.buffers();
        match &field.kind {
            Kind::View(_) => return self.view(),
            Kind::Other(..) => {
                return field.children.iter().try_for_each(|child| self.pass(child));
            }
            _ => {}
        }
        if u64::try_from(length).ok() != rows.rows.checked_mul(rows.every) {
            return Err(broken(format!(
                "{length} values of {} in a batch of {} rows",
                field.name, rows.rows
            )));
        }
        if let Kind::Structure | Kind::Fixed(_) = field.kind {
            // One bit for each row, which is no more than is kept of any column below.
            collector.fits(&field.name, &[rows.rows, rows.every])?;
            let valid = self.validity(first, &rows)?;
            let every = match field.kind {
                Kind::Fixed(size) if rows.every == 1 => size,
                Kind::Fixed(_) => return Err(broken("lists within lists")),
                _ => rows.every,
            };
            for child in &field.children {
                let rows = Rows {
                    rows: rows.rows,
                    every,
                    valid: &valid,
                };
                self.field(child, rows, columns, collector)?;
            }
            return Ok(());
        }
        if let (Kind::List(width), [child]) = (&field.kind, &field.children[..]) {
            let Some(samples) = columns.next() else {
                return Err(broken("more columns than the schema has"));
            };
            return self.lists((field, child, *width), first, &rows, samples, collector);
        }
        let count = collector.reserve(&field.name, &[rows.rows, rows.every])?;
        let Some(samples) = columns.next() else {
            return Err(broken("more columns than the schema has"));
        };
        samples.rows += rows.rows;
        let valid = self.validity(first, &rows)?;
        self.values(&field.kind, first + 1, count, valid, samples)
            .map_err(|error| broken(format!("{}: {error}", field.name)))
    }

    /// Appends the numbers of lists, NaN for those of a row without any, as long as all others have one length.
    fn lists(
        &mut self,
        (field, child, width): (&Field, &Field, usize),
        buffer: usize,
        rows: &Rows<'_>,
        samples: &mut Samples,
        collector: &mut Collector,
    ) -> Result<(), Trouble> {
        let name = &field.name;
        if rows.every != 1 {
            return Err(broken("lists within lists"));
        }
        let node = self
            .header
            .vector(1, 16)
            .and_then(|nodes| nodes.pair(self.node));
        let count = node.and_then(|(length, _)| u64::try_from(length).ok());
        let count = count.ok_or_else(|| broken("a batch without the length of a column"))?;
        self.node += 1;
        let inside = self.buffer;
        self.buffer += child.kind.buffers();
        // The offsets, then the numbers as they are stored and as they are kept.
        collector.reserve(name, &[rows.rows])?;
        collector.reserve(name, &[count])?;
        let damaged = |error: io::Error| broken(format!("{name}: {error}"));
        let there = self.validity(buffer, rows)?;
        let offsets = match rows.rows {
            0 => Vec::new(),
            rows => self.offsets(buffer + 1, rows + 1, width).map_err(damaged)?,
        };
        let all = Rows {
            rows: count,
            every: 1,
            valid: &None,
        };
        let valid = self.validity(inside, &all)?;
        let mut stored = Samples::default();
        self.values(&child.kind, inside + 1, count, valid, &mut stored)
            .map_err(damaged)?;
        samples.values.rounded |= stored.values.rounded;
        for (row, pair) in offsets.windows(2).enumerate() {
            let numbers = stored.values.samples.get(pair[0]..pair[1]);
            let numbers =
                numbers.ok_or_else(|| broken(format!("{name}: a list outside of its numbers")))?;
            let present = there.as_ref().is_none_or(|there| there[row]) && !numbers.is_empty();
            let length = match samples.lengths[0] {
                Some(known) => known,
                None if present => {
                    // Rows before the first list are missing in all of its columns.
                    let length = numbers.len() as u64;
                    samples.lengths[0] = Some(length);
                    let before = collector.reserve(name, &[samples.rows, length])?;
                    samples.values.samples.resize(before as usize, f64::NAN);
                    length
                }
                None => 0,
            };
            samples.rows += 1;
            collector.reserve(name, &[length])?;
            match present {
                true if numbers.len() as u64 == length => {
                    samples.values.samples.extend_from_slice(numbers);
                }
                true => samples.lengths[1] = Some(numbers.len() as u64),
                false => {
                    let end = samples.values.samples.len() + length as usize;
                    samples.values.samples.resize(end, f64::NAN);
                }
            }
        }
        Ok(())
    }

    /// Offsets of this many bytes each, of which there are so many.
    fn offsets(&mut self, buffer: usize, count: u64, width: usize) -> io::Result<Vec<usize>> {
        let bytes = count.saturating_mul(width as u64);
        let mut stream = self.stream(buffer, bytes)?;
        let mut offsets = Vec::new();
        for _ in 0..count {
            let mut bytes = [0; 8];
            stream.read_exact(&mut bytes[..width])?;
            let offset = usize::try_from(u64::from_le_bytes(bytes));
            offsets.push(offset.map_err(|_| io::Error::other("an offset without end"))?);
        }
        Ok(offsets)
    }

    /// Passes over the buffers of fields that are not read.
    fn pass(&mut self, field: &Field) -> Result<(), Trouble> {
        self.node += 1;
        self.buffer += field.kind.buffers();
        if let Kind::View(_) = field.kind {
            self.view()?;
        }
        field.children.iter().try_for_each(|child| self.pass(child))
    }

    /// Passes over the buffers of which there are as many as the batch says.
    fn view(&mut self) -> Result<(), Trouble> {
        let counts = self.header.vector(4, 8);
        let count = counts.and_then(|counts| counts.long(self.view));
        let count = count.and_then(|count| usize::try_from(count).ok());
        let count = count.filter(|&count| count < 1 << 24);
        self.buffer += count.ok_or_else(|| broken("a batch without its numbers of buffers"))?;
        self.view += 1;
        Ok(())
    }

    fn values(
        &mut self,
        kind: &Kind,
        buffer: usize,
        count: u64,
        valid: Option<Vec<bool>>,
        samples: &mut Samples,
    ) -> io::Result<()> {
        if count == 0 {
            return Ok(());
        }
        let width = match *kind {
            Kind::Number(number) => number.width(),
            Kind::Truth => 1,
            Kind::Ticks(width, ..) => width,
            _ => 16,
        };
        let mut stream = self.stream(buffer, count.saturating_mul(width as u64))?;
        let Samples { values, ticks, .. } = samples;
        let start = values.samples.len();
        let there = |index: usize| valid.as_ref().is_none_or(|valid| valid[index]);
        match *kind {
            Kind::Number(number) => read_numbers(&mut *stream, number, count, values)?,
            Kind::Truth => {
                let bits = bits(&mut *stream, count)?;
                values
                    .samples
                    .extend(bits.iter().map(|&bit| f64::from(u8::from(bit))));
            }
            Kind::Decimal(scale) => {
                for _ in 0..count {
                    let mut bytes = [0; 16];
                    stream.read_exact(&mut bytes)?;
                    values
                        .samples
                        .push(decimal(i128::from_le_bytes(bytes), scale));
                }
            }
            Kind::Ticks(width, ..) => {
                for index in 0..count as usize {
                    let mut bytes = [0; 8];
                    stream.read_exact(&mut bytes[..width.min(8)])?;
                    let tick = match width {
                        4 => {
                            i64::from(i32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
                        }
                        _ => i64::from_le_bytes(bytes),
                    };
                    ticks.push(Some(tick).filter(|_| there(index)));
                }
            }
            _ => {}
        }
        for (index, value) in values.samples[start..].iter_mut().enumerate() {
            if !there(index) {
                *value = f64::NAN;
            }
        }
        Ok(())
    }

    /// Which values of a column are there, those above it included; `None` where all are.
    fn validity(&mut self, buffer: usize, rows: &Rows<'_>) -> Result<Option<Vec<bool>>, Trouble> {
        let above = rows.valid.as_ref().map(|valid| {
            let each = valid
                .iter()
                .flat_map(|&bit| std::iter::repeat_n(bit, rows.every as usize));
            each.collect::<Vec<bool>>()
        });
        let (_, length) = self
            .extent(buffer)
            .map_err(|error| broken(error.to_string()))?;
        let count = rows.rows * rows.every;
        if length == 0 || count == 0 {
            return Ok(above);
        }
        let read = self
            .stream(buffer, count)
            .and_then(|mut stream| bits(&mut *stream, count));
        let mut own = read.map_err(|error| broken(error.to_string()))?;
        for (own, above) in own.iter_mut().zip(above.into_iter().flatten()) {
            *own &= above;
        }
        Ok(Some(own))
    }

    /// Where a buffer stands within the body, and its length.
    fn extent(&self, buffer: usize) -> io::Result<(u64, u64)> {
        let buffers = self.header.vector(2, 16);
        let pair = buffers.and_then(|buffers| buffers.pair(buffer));
        let pair = pair
            .and_then(|(at, length)| Some((u64::try_from(at).ok()?, u64::try_from(length).ok()?)));
        pair.filter(|(at, length)| at.checked_add(*length).is_some_and(|end| end <= self.bytes))
            .ok_or_else(|| io::Error::other("a buffer outside of its batch"))
    }

    /// The unpacked bytes of a buffer, of which so many are wanted.
    fn stream(&mut self, buffer: usize, wanted: u64) -> io::Result<Box<dyn Read + '_>> {
        let (at, length) = self.extent(buffer)?;
        self.file.seek(SeekFrom::Start(self.body + at))?;
        let packed = |length| io::BufReader::with_capacity(1 << 16, (&*self.file).take(length));
        if self.codec == Codec::None {
            return Ok(Box::new(packed(length)));
        }
        let mut size = [0; 8];
        (&*self.file).read_exact(&mut size)?;
        let length = length
            .checked_sub(8)
            .ok_or_else(|| io::Error::other("a buffer without its length"))?;
        // A buffer that would grow is stored as it is.
        if i64::from_le_bytes(size) == -1 {
            return Ok(Box::new(packed(length)));
        }
        Ok(match self.codec {
            Codec::Zstd => Box::new(zstd(packed(length), wanted)?),
            _ => Box::new(lz4(packed(length))),
        })
    }
}

/// The rows that a field has: of each so many values, of which those that are not valid are missing.
struct Rows<'v> {
    rows: u64,
    every: u64,
    valid: &'v Option<Vec<bool>>,
}

/// Reads this many bits, the lowest of a byte first.
fn bits(stream: &mut dyn Read, count: u64) -> io::Result<Vec<bool>> {
    let mut out = Vec::new();
    let mut left = count;
    let mut buffer = [0; 4096];
    while left > 0 {
        let now = left.min(8 * buffer.len() as u64);
        let bytes = &mut buffer[..now.div_ceil(8) as usize];
        stream.read_exact(bytes)?;
        out.extend((0..now as usize).map(|bit| bytes[bit / 8] >> (bit % 8) & 1 == 1));
        left -= now;
    }
    Ok(out)
}
