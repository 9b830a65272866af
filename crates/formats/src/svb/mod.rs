//! SVB, the binary export of TwinCAT Scope.
//!
//! Format: Beckhoff, TE13xx TC3 Scope View, "Export to svb", "Format description for developers"
//! (<https://infosys.beckhoff.com/content/1033/te13xx_tc3_scopeview/6193066251.html>): a header, a header for each channel with
//! the place of its data, and the data of one channel after the other, little-endian, times in 100 ns. A channel has the time
//! stamp of each sample, in 32 bits that overflow after 429.5 s, or none; then its sample time holds. As in the text export, channels
//! with the same stamps share a column of time, and neither offset nor scale factor is applied to the samples.

mod header;

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};

use crate::binary::{ByteOrder, Class, Collector, Number, Values};
use crate::text::{Group, Scope};
use crate::{Error, Kind, Limits, Table};

pub(crate) use header::starts;
use header::{Channel, channels};

/// Bytes of a time stamp.
const STAMP: u64 = 4;
/// Time stamps in a second.
const TICKS: f64 = 1e7;
/// Samples that are read at once.
const AT_ONCE: u64 = 4096;

/// Reads every channel of a file of this many bytes.
pub(crate) fn read(file: File, bytes: u64, limits: Limits) -> Result<Table, Error> {
    let mut file = BufReader::with_capacity(1 << 16, file);
    let mut collector = Collector::new(limits);
    let mut scope = Scope::default();
    let mut not_applied = [Vec::new(), Vec::new()];
    // Channels follow one another, so together they are no larger than the file.
    let mut left = bytes;
    for channel in channels(&mut file, bytes)? {
        collector.entry()?;
        let name = channel.name.as_str();
        let Some(number) = number(&channel) else {
            let of = match channel.kind.as_str() {
                "" => "an unnamed type",
                kind => kind,
            };
            collector.skip(name, &format!("values of {of} in {} bytes", channel.size));
            continue;
        };
        if channel.samples == 0 {
            collector.skip(name, "empty");
            continue;
        }
        let stamped = stamped(&channel)?;
        let end = channel.start.checked_add(channel.bytes);
        left = match (end, left.checked_sub(channel.bytes)) {
            (Some(end), Some(left)) if end <= bytes => left,
            _ => return Err(cut(&channel)),
        };
        for (key, value, neutral, said) in [
            ("Offset", channel.offset, 0.0, 0),
            ("ScaleFactor", channel.scale, 1.0, 1),
        ] {
            if value != neutral {
                not_applied[said].push((key, format!("`{name}` {value}")));
            }
        }
        collector.reserve(name, &[channel.samples, if stamped { 2 } else { 1 }])?;
        let (time, values) = samples(&mut file, &channel, number, stamped)?;
        if values.rounded {
            collector.rounded(name);
        }
        let mut group = Group::default();
        if stamped {
            group.time = Some(scope.sample_times.len());
            scope.sample_times.push(None);
            collector.column("time", Some("s".to_owned()), time);
        }
        group.channels.push(scope.sample_times.len());
        scope.sample_times.push(channel.sample_time_ms);
        collector.column(name, None, values.samples);
        scope.groups.push(group);
    }
    for said in not_applied {
        if let Some((key, _)) = said.first() {
            let of: Vec<String> = said.iter().map(|(_, of)| of.clone()).collect();
            collector.detected(format!("display {key} not applied: {}", of.join(", ")));
        }
    }
    let mut table = collector.finish();
    scope.finish(&mut table);
    Ok(table)
}

/// Reads the samples of a channel, and the times of those that have them, in seconds from the start of the recording.
fn samples(
    file: &mut BufReader<File>,
    channel: &Channel,
    number: Number,
    stamped: bool,
) -> Result<(Vec<f64>, Values), Error> {
    let io = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::UnexpectedEof => cut(channel),
        _ => Error::new(Kind::Io, format!("cannot be read ({error})"), ""),
    };
    file.seek(SeekFrom::Start(channel.start)).map_err(io)?;
    let (mut time, mut values) = (Vec::new(), Values::default());
    // Their bytes are known to be in the file.
    values.samples.reserve_exact(channel.samples as usize);
    time.reserve_exact(if stamped { channel.samples as usize } else { 0 });
    let (mut buffer, mut bare) = (Vec::new(), Vec::new());
    let width = number.width();
    let row = width + if stamped { STAMP as usize } else { 0 };
    let mut clock = Clock::default();
    let mut left = channel.samples;
    while left > 0 {
        let now = left.min(AT_ONCE);
        buffer.resize(now as usize * row, 0);
        file.read_exact(&mut buffer).map_err(io)?;
        if stamped {
            bare.clear();
            for row in buffer.chunks_exact(row) {
                let (stamp, value) = row.split_at(STAMP as usize);
                time.push(clock.seconds(stamp));
                bare.extend_from_slice(value);
            }
            number.decode(&bare, &mut values);
        } else {
            number.decode(&buffer, &mut values);
        }
        left -= now;
    }
    Ok((time, values))
}

/// The clock of a channel, which goes on where its 32 bits overflow.
#[derive(Default)]
struct Clock {
    ticks: i64,
    last: Option<u32>,
}

impl Clock {
    fn seconds(&mut self, stamp: &[u8]) -> f64 {
        let stamp = stamp
            .iter()
            .rev()
            .fold(0, |all, &b| all << 8 | u32::from(b));
        self.ticks += match self.last {
            None => i64::from(stamp),
            // A step of less than half of the range is that, forward or back.
            Some(last) => i64::from(stamp.wrapping_sub(last) as i32),
        };
        self.last = Some(stamp);
        self.ticks as f64 / TICKS
    }
}

/// The format of the samples of a channel, where they are numbers of the size that it states.
fn number(channel: &Channel) -> Option<Number> {
    let (class, width) = match channel.kind.trim_start_matches("ADST_") {
        "REAL64" => (Class::Float, 8),
        "REAL32" => (Class::Float, 4),
        "INT64" => (Class::Signed, 8),
        "INT32" => (Class::Signed, 4),
        "INT16" => (Class::Signed, 2),
        "INT8" => (Class::Signed, 1),
        "UINT64" => (Class::Unsigned, 8),
        "UINT32" | "BITARR32" => (Class::Unsigned, 4),
        "UINT16" | "BITARR16" => (Class::Unsigned, 2),
        "UINT8" | "BITARR8" => (Class::Unsigned, 1),
        "BIT" | "BIT8" => (Class::Bool, 1),
        _ => return None,
    };
    let number = Number::new(class, width, ByteOrder::Little);
    number.filter(|number| number.width() as u64 == channel.size)
}

/// Whether samples have time stamps, as the size of the data tells.
fn stamped(channel: &Channel) -> Result<bool, Error> {
    let size = |each: u64| channel.samples.checked_mul(each);
    if size(channel.size + STAMP) == Some(channel.bytes) {
        return Ok(true);
    }
    if size(channel.size) == Some(channel.bytes) {
        return Ok(false);
    }
    Err(Error::new(
        Kind::Format,
        format!(
            "{} bytes for {} samples of {} bytes",
            channel.bytes, channel.samples, channel.size
        ),
        format!(
            "{} bytes a sample, or {STAMP} more with time stamps",
            channel.size
        ),
    )
    .in_column(&*channel.name))
}

fn cut(channel: &Channel) -> Error {
    Error::new(
        Kind::Format,
        format!(
            "{} bytes of data from byte {}, which is past the end of the file",
            channel.bytes, channel.start
        ),
        "a whole file with headers and data in one, as the export dialog of TwinCAT Scope lets you choose",
    )
    .in_column(&*channel.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_goes_on() {
        let mut clock = Clock::default();
        let stamps = [4_294_960_000_u32, 4_294_967_295, 4, 10_000, 9_000];
        let seconds = stamps.map(|stamp| clock.seconds(&stamp.to_le_bytes()));
        let ticks = [
            4_294_960_000_u64,
            4_294_967_295,
            4_294_967_300,
            4_294_977_296,
            4_294_976_296,
        ];
        assert_eq!(seconds, ticks.map(|ticks| ticks as f64 / 1e7));
    }
}
