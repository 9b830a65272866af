//! From records to columns.

use std::collections::HashMap;
use std::io::{self, BufReader, Read};

use super::column::{Column, Invalid, Records};
use super::data::{Packing, Parts, length, parts};
use super::group::{Data, Group};
use super::pieces::Pieces;
use super::source::{Source, bad};
use super::stream::Stream;
use crate::{Error, Kind};

/// Bytes of records that are read at once.
const AT_ONCE: usize = 1 << 16;

/// The columns of a group.
type Columns = Vec<Column>;

/// Fills the columns of groups that share their data, of each group its own, in order.
pub(super) fn read(source: &mut Source, data: &Data, columns: &mut [Columns]) -> Result<(), Error> {
    if columns.iter().all(Vec::is_empty) {
        return Ok(());
    }
    let filled = data.groups.iter().find(|group| group.records > 0);
    let bytes = filled.map_or((0, 0), |group| group.bytes);
    let parts = parts(source, data.first, bytes)?;
    let turned = parts.records.iter().chain(&parts.invalid);
    let turned = turned.filter(|part| matches!(part.packing, Packing::Transposed(_)));
    if let Some(largest) = turned.map(|part| part.length).max() {
        source.unpacked(largest)?;
    }
    match data.id_bytes {
        0 => sorted(source, data, parts, columns),
        _ if parts.apart => Err(bad(
            data.at,
            "values without record numbers in groups that need them",
        )),
        _ => mixed(source, data, parts, columns),
    }
}

/// What a failure to read data is.
pub(super) fn trouble(at: u64, error: &io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => bad(at, "data that end before their records do"),
        io::ErrorKind::OutOfMemory => Error::new(Kind::Limit, "no memory is left", "").at_byte(at),
        _ => bad(at, format!("the data are damaged ({error})")),
    }
}

/// Records of one group, one after the other.
fn sorted(
    source: &mut Source,
    data: &Data,
    parts: Parts,
    columns: &mut [Columns],
) -> Result<(), Error> {
    let mut filled = data
        .groups
        .iter()
        .zip(columns)
        .filter(|(group, _)| group.records > 0);
    let (Some((group, columns)), None) = (filled.next(), filled.next()) else {
        return Err(bad(data.at, "several groups whose records have no numbers"));
    };
    let own = match parts.apart {
        true => group.bytes.0,
        false => group.bytes.0 + group.bytes.1,
    };
    enough(source, group, own, length(&parts.records))?;
    if !parts.invalid.is_empty() {
        enough(source, group, group.bytes.1, length(&parts.invalid))?;
    }
    let mut pieces = Pieces::new(source.file, parts, group.bytes);
    let (mut before, mut scratch) = (0, Vec::new());
    while before < group.records {
        let count = (group.records - before).min(pieces.at_once());
        let records = pieces.next(count as usize, before)?;
        for column in columns.iter_mut() {
            let taken = column.take(&records, &mut scratch);
            taken.map_err(|error| trouble(group.at, &error))?;
        }
        before += count;
    }
    Ok(())
}

/// Refuses less data than records of this size need, and says where there are more.
fn enough(source: &mut Source, group: &Group, size: u64, there: u64) -> Result<(), Error> {
    let (records, needed) = (group.records, group.records.checked_mul(size));
    match needed {
        Some(needed) if needed <= there => {
            if size > 0 && there - needed >= size {
                beyond(source, group);
            }
            Ok(())
        }
        _ => Err(bad(
            group.at,
            format!(
                "{records} records of {size} bytes in {there} bytes of data; was the file cut off?"
            ),
        )),
    }
}

/// Says that a group has data beyond its last record.
fn beyond(source: &mut Source, group: &Group) {
    let (label, records) = (&group.label, group.records);
    source.collector.detected(format!(
        "{label}: {records} records, and data beyond them that belong to none"
    ));
}

/// Records of several groups, each with the number of its group before it.
fn mixed(
    source: &mut Source,
    data: &Data,
    parts: Parts,
    columns: &mut [Columns],
) -> Result<(), Error> {
    let mut places = HashMap::new();
    for (place, group) in data.groups.iter().enumerate() {
        if places.insert(group.id, place).is_some() {
            let found = format!("two groups whose records have the number {}", group.id);
            return Err(bad(group.at, found));
        }
    }
    let mut stream = BufReader::with_capacity(AT_ONCE, Stream::new(source.file, parts.records));
    let mut seen = vec![0; data.groups.len()];
    let (mut record, mut scratch) = (Vec::new(), Vec::new());
    loop {
        let next =
            next(&mut stream, data.id_bytes).map_err(|e| trouble(stream.get_ref().at, &e))?;
        let Some(id) = next else {
            break;
        };
        let at = stream.get_ref().at;
        let Some(&place) = places.get(&id) else {
            return Err(bad(
                at,
                format!("a record with the number {id}, which no group has"),
            ));
        };
        let (group, columns) = (&data.groups[place], &mut columns[place]);
        let taken = one(
            &mut stream,
            group,
            columns,
            seen[place],
            (&mut record, &mut scratch),
        );
        taken.map_err(|error| trouble(stream.get_ref().at, &error))?;
        seen[place] += 1;
    }
    for ((group, seen), columns) in data.groups.iter().zip(seen).zip(columns) {
        if columns.is_empty() {
            continue;
        }
        if seen < group.records {
            let found = format!(
                "{seen} records of a group of {}; was the file cut off?",
                group.records
            );
            return Err(bad(group.at, found));
        }
        if seen > group.records {
            beyond(source, group);
        }
    }
    Ok(())
}

/// The number before the next record, little end first; `None` at the end.
fn next(stream: &mut impl Read, bytes: usize) -> io::Result<Option<u64>> {
    let mut id = [0; 8];
    if stream.read(&mut id[..1])? == 0 {
        return Ok(None);
    }
    stream.read_exact(&mut id[1..bytes])?;
    Ok(Some(u64::from_le_bytes(id)))
}

/// Takes or passes over one record of a group, of which so many came before.
fn one(
    stream: &mut impl Read,
    group: &Group,
    columns: &mut Columns,
    before: u64,
    (record, scratch): (&mut Vec<u8>, &mut Vec<u8>),
) -> io::Result<()> {
    if group.of_lengths {
        let mut length = [0; 4];
        stream.read_exact(&mut length)?;
        return pass(stream, u64::from(u32::from_le_bytes(length)));
    }
    let (data, invalid) = (group.bytes.0 as usize, group.bytes.1 as usize);
    if columns.is_empty() || before >= group.records {
        return pass(stream, group.bytes.0 + group.bytes.1);
    }
    record.resize(data + invalid, 0);
    stream.read_exact(record)?;
    let records = Records {
        count: 1,
        before,
        bytes: record,
        size: data + invalid,
        invalid: (invalid > 0).then_some(Invalid {
            bytes: record,
            size: data + invalid,
            from: data,
        }),
    };
    let mut columns = columns.iter_mut();
    columns.try_for_each(|column| column.take(&records, scratch))
}

/// Reads bytes that nobody asks for.
fn pass(stream: &mut impl Read, bytes: u64) -> io::Result<()> {
    match io::copy(&mut stream.take(bytes), &mut io::sink())? == bytes {
        true => Ok(()),
        false => Err(io::ErrorKind::UnexpectedEof.into()),
    }
}
