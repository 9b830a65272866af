//! TDMS, the format of LabVIEW and DIAdem.
//!
//! Format: "TDMS File Format Internal Structure", NI. A channel is `group.channel`, its property `unit_string` its unit; numbers
//! among the properties of groups and of the file are scalars. Waveforms state the time between samples (`wf_increment`), which
//! is the sample time where all of them agree. Time stamps become seconds from the first. Text, complex numbers, counts that
//! a scale of DAQmx makes forces of, and raw data of DAQmx are named in [`Table::skipped`].

mod metadata;

use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};

use metadata::{Index, Metadata, Property, Type, parts};

use crate::binary::{ByteOrder, Collector, Order, Values, read_numbers};
use crate::{Error, Kind, Limits, Table};

/// Bytes before the metadata of a segment.
const LEAD_IN: u64 = 28;

/// Largest metadata of one segment in bytes.
const MAX_METADATA: u64 = 64 << 20;

/// Reads every channel of a file of this many bytes.
pub(crate) fn read(file: File, bytes: u64, limits: Limits) -> Result<Table, Error> {
    let mut reader = Reader {
        file: BufReader::with_capacity(1 << 16, file),
        at: 0,
        collector: Collector::new(limits),
        channels: Vec::new(),
        by_path: HashMap::new(),
        list: Vec::new(),
        scalars: BTreeMap::new(),
    };
    while reader.at < bytes {
        reader.segment(bytes)?;
    }
    reader.finish()
}

/// A channel, or a group, in the making.
struct Channel {
    name: String,
    unit: Option<String>,
    increment: Option<f64>,
    index: Index,
    /// Whether it is in the list of the segment.
    listed: bool,
    /// Why it is left out.
    refused: Option<&'static str>,
    values: Values,
    /// The first time stamp, in 2^-64 s.
    first: Option<i128>,
}

struct Reader {
    file: BufReader<File>,
    /// Where the segment begins.
    at: u64,
    collector: Collector,
    channels: Vec<Channel>,
    by_path: HashMap<String, usize>,
    /// Channels with raw data in the segment, in their order.
    list: Vec<usize>,
    /// In the order of their names.
    scalars: BTreeMap<String, f64>,
}

impl Reader {
    fn bad(&self, found: impl Into<String>) -> Error {
        let allowed = "a whole TDMS file, as LabVIEW or nptdms writes it";
        Error::new(Kind::Format, found, allowed).at_byte(self.at)
    }

    fn cut(&self, error: std::io::Error) -> Error {
        match error.kind() {
            std::io::ErrorKind::UnexpectedEof => {
                self.bad("the file ends within a segment; was it cut off?")
            }
            _ => Error::new(Kind::Io, format!("cannot be read ({error})"), "").at_byte(self.at),
        }
    }

    fn segment(&mut self, bytes: u64) -> Result<(), Error> {
        let mut lead = [0; LEAD_IN as usize];
        let at = self.file.seek(SeekFrom::Start(self.at));
        at.and_then(|_| self.file.read_exact(&mut lead))
            .map_err(|error| self.cut(error))?;
        if !lead.starts_with(b"TDSm") {
            return Err(self.bad("a segment that does not begin with TDSm"));
        }
        let flags = u32::from_le_bytes([lead[4], lead[5], lead[6], lead[7]]);
        let flag = |bit: u32| flags >> bit & 1 == 1;
        let order = if flag(6) {
            ByteOrder::Big
        } else {
            ByteOrder::Little
        };
        let mut head = Metadata {
            bytes: &lead[12..],
            order,
        };
        let (Some(next), Some(raw)) = (head.long(), head.long()) else {
            return Err(self.bad("a damaged segment"));
        };
        let start = self.at + LEAD_IN;
        if next == u64::MAX {
            return Err(
                self.bad("a segment that was never closed: the program that wrote it was stopped")
            );
        }
        let left = bytes - start;
        if next > left || raw > next || raw > MAX_METADATA {
            return Err(self.bad(format!(
                "a segment of {next} bytes where {left} are left; was the file cut off?"
            )));
        }
        if flag(1) {
            let mut text = vec![0; raw as usize];
            self.file
                .read_exact(&mut text)
                .map_err(|error| self.cut(error))?;
            if flag(2) {
                for here in self.list.drain(..) {
                    self.channels[here].listed = false;
                }
            }
            self.objects(Metadata {
                bytes: &text,
                order,
            })?
            .ok_or_else(|| self.bad("damaged metadata, or values of an unknown type"))?;
        }
        if flag(3) {
            // Only what has data, so that no chunk costs more than its bytes.
            let channels = &mut self.channels;
            self.list.retain(|&here| {
                let index = channels[here].index;
                let stored = matches!(index, Index::Plain(_, 1.., _) | Index::DaqMx);
                channels[here].listed = stored;
                stored
            });
            let at = self.file.seek(SeekFrom::Start(start + raw));
            at.map_err(|error| self.cut(error))?;
            if flag(7)
                || self
                    .list
                    .iter()
                    .any(|&n| self.channels[n].index == Index::DaqMx)
            {
                self.list.iter().for_each(|&n| {
                    self.channels[n].refused = Some("raw data of DAQmx; export them scaled")
                });
            } else if flag(5) {
                self.interleaved(next - raw)?;
            } else {
                self.chunks(next - raw)?;
            }
        }
        self.at = start + next;
        Ok(())
    }

    /// Reads the objects of a segment; `None` where the metadata are damaged.
    fn objects(&mut self, mut metadata: Metadata<'_>) -> Result<Option<()>, Error> {
        let Some(count) = metadata.word() else {
            return Ok(None);
        };
        for _ in 0..count {
            let (Some(path), Some(index)) = (metadata.text(), metadata.index()) else {
                return Ok(None);
            };
            let here = match self.by_path.get(&path) {
                Some(&here) => here,
                None => {
                    self.collector.entry()?;
                    self.channels.push(Channel {
                        name: parts(&path).join("."),
                        unit: None,
                        increment: None,
                        index: Index::None,
                        listed: false,
                        refused: None,
                        values: Values::default(),
                        first: None,
                    });
                    self.by_path.insert(path.clone(), self.channels.len() - 1);
                    self.channels.len() - 1
                }
            };
            let channel = &mut self.channels[here];
            if index != Index::Same {
                if let (Index::Plain(old, ..), Index::Plain(new, ..)) = (channel.index, index)
                    && std::mem::discriminant(&old) != std::mem::discriminant(&new)
                {
                    channel.refused = Some("values of more than one kind");
                }
                channel.index = index;
            }
            if !channel.listed {
                channel.listed = true;
                self.list.push(here);
            }
            let Some(properties) = metadata.word() else {
                return Ok(None);
            };
            let is_channel = parts(&path).len() > 1;
            for _ in 0..properties {
                match metadata.property() {
                    None => return Ok(None),
                    Some((name, value)) => self.property(here, is_channel, &name, value)?,
                }
            }
        }
        Ok(Some(()))
    }

    fn property(
        &mut self,
        here: usize,
        is_channel: bool,
        name: &str,
        value: Property,
    ) -> Result<(), Error> {
        let channel = &mut self.channels[here];
        match (name, value) {
            ("unit_string", Property::Text(unit)) if is_channel => {
                channel.unit = Some(unit.trim().to_owned()).filter(|unit| !unit.is_empty());
            }
            ("wf_increment", Property::Number(step)) if is_channel => {
                channel.increment = Some(step).filter(|step| *step > 0.0);
            }
            ("NI_Number_Of_Scales", Property::Number(1.0..)) if is_channel => {
                channel.refused = Some("counts with a scale of DAQmx; export them scaled");
            }
            (name, Property::Number(value)) if !is_channel => {
                let name = match channel.name.as_str() {
                    "" => name.to_owned(),
                    group => format!("{group}.{name}"),
                };
                if self.scalars.insert(name, value).is_none() {
                    self.collector.entry()?;
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn plain(&self, channel: usize) -> (Type, u64, u64) {
        match self.channels[channel].index {
            Index::Plain(kind, count, bytes) => (kind, count, bytes),
            _ => (Type::Text, 0, 0),
        }
    }

    /// Channel after channel, chunk after chunk.
    fn chunks(&mut self, bytes: u64) -> Result<(), Error> {
        let list = self.list.clone();
        let chunk = list.iter().try_fold(0_u64, |sum, &channel| {
            sum.checked_add(self.plain(channel).2)
        });
        let chunk = chunk.filter(|&chunk| chunk <= bytes || bytes == 0);
        let chunk = chunk.ok_or_else(|| self.bad("less data than its metadata say"))?;
        if chunk == 0 || bytes == 0 {
            return Ok(());
        }
        if !bytes.is_multiple_of(chunk) {
            return Err(self.bad(format!(
                "{bytes} bytes of data that are no whole number of chunks of {chunk}"
            )));
        }
        for _ in 0..bytes / chunk {
            for &here in &list {
                let (kind, count, size) = self.plain(here);
                match kind {
                    Type::Number(_) | Type::Stamp(_) if self.channels[here].refused.is_none() => {
                        self.values(here, kind, count)?;
                    }
                    _ => {
                        let skip = i64::try_from(size).unwrap_or(i64::MAX);
                        self.file
                            .seek_relative(skip)
                            .map_err(|error| self.cut(error))?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Reads values of a channel that follow one another.
    fn values(&mut self, here: usize, kind: Type, count: u64) -> Result<(), Error> {
        let channel = &mut self.channels[here];
        self.collector.reserve(&channel.name, &[count])?;
        let read = match kind {
            Type::Number(number) => {
                read_numbers(&mut self.file, number, count, &mut channel.values)
            }
            Type::Stamp(order) => (0..count).try_for_each(|_| {
                let mut bytes = [0; 16];
                self.file.read_exact(&mut bytes)?;
                stamp(channel, bytes, order);
                Ok(())
            }),
            _ => Ok(()),
        };
        read.map_err(|error| self.cut(error))
    }

    /// A value of each channel in turn.
    fn interleaved(&mut self, bytes: u64) -> Result<(), Error> {
        let list = self.list.clone();
        let mut row = 0;
        for &here in &list {
            let (kind, count, _) = self.plain(here);
            if kind == Type::Text || count != self.plain(list[0]).1 {
                return Err(self.bad("interleaved channels that are not of one length"));
            }
            row += kind.width();
        }
        if row == 0 || !bytes.is_multiple_of(row) {
            return Err(self.bad(format!(
                "{bytes} bytes of data that are no whole number of rows of {row}"
            )));
        }
        let mut left = bytes / row;
        for &here in &list {
            self.collector.reserve(&self.channels[here].name, &[left])?;
        }
        let mut buffer = Vec::new();
        while left > 0 {
            let now = left.min((1 << 16) / row + 1);
            buffer.resize((now * row) as usize, 0);
            self.file
                .read_exact(&mut buffer)
                .map_err(|error| self.cut(error))?;
            for row in buffer.chunks_exact(row as usize) {
                let mut row = row;
                for &here in &list {
                    let kind = self.plain(here).0;
                    let (value, rest) = row.split_at(kind.width() as usize);
                    row = rest;
                    let channel = &mut self.channels[here];
                    match kind {
                        Type::Number(number) => number.decode(value, &mut channel.values),
                        Type::Stamp(order) => {
                            if let Ok(bytes) = value.try_into() {
                                stamp(channel, bytes, order);
                            }
                        }

                        _ => {}
                    }
                }
            }
            left -= now;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Table, Error> {
        let mut steps: Vec<f64> = Vec::new();
        for channel in self.channels {
            let name = &channel.name;
            let kind = match channel.index {
                Index::Plain(kind, ..) => Some(kind),
                _ => None,
            };
            let why = match (channel.refused, kind) {
                (Some(why), _) => Some(why),
                (None, Some(Type::Text)) => Some("text"),
                (None, Some(Type::Other(what, _))) => Some(what),
                (None, Some(_)) if channel.values.samples.is_empty() => Some("empty"),
                (None, Some(_)) => None,
                (None, None) if channel.values.samples.is_empty() => continue,
                (None, None) => None,
            };
            if let Some(why) = why {
                self.collector.skip_column(name, why);
                continue;
            }
            steps.extend(channel.increment);
            let rows = channel.values.samples.len() as u64;
            let mut unit = channel.unit;
            let first = self.collector.columns();
            let stamps = channel.first.is_some();
            if stamps {
                self.collector.detected(format!(
                    "{name}: time stamps, converted to seconds from the first"
                ));
                unit = Some("s".to_owned());
            }
            match rows {
                1 => self.collector.column(name, unit, channel.values.samples),
                rows => self
                    .collector
                    .array(name, unit, &[rows, 1], Order::Row, channel.values),
            }
            if stamps {
                self.collector.are_stamps(first);
            }
        }
        for (name, value) in self.scalars {
            self.collector.scalar(&name, value);
        }
        match steps[..] {
            [first, ref others @ ..] if others.iter().all(|&step| step == first) => {
                self.collector.detected(format!("wf_increment {first} s"));
                self.collector.sample_time(first);
            }
            [] => {}
            _ => self
                .collector
                .detected("channels whose wf_increment differ: no common sample time"),
        }
        Ok(self.collector.finish())
    }
}

/// Appends a time stamp: a fraction of 2^-64 s below whole seconds, in the order that the numbers of the segment have.
fn stamp(channel: &mut Channel, bytes: [u8; 16], order: ByteOrder) {
    let ticks = match order {
        ByteOrder::Little => i128::from_le_bytes(bytes),
        ByteOrder::Big => i128::from_be_bytes(bytes),
    };
    let first = *channel.first.get_or_insert(ticks);
    channel
        .values
        .samples
        .push(ticks.wrapping_sub(first) as f64 / 2f64.powi(64));
}
