//! ASAM MDF 4 (`.mf4`), as test benches and vehicles log, version 4.00 to 4.20.
//!
//! Format: "ASAM MDF, Programmers Guide", version 4.1.0, and the block layouts of 4.2.0. Channels of a group share records and
//! time; a file has several groups. Columns are called as their channels, `group.channel` where several channels have one name.
//! Numbers are integers of any width and floats of 16, 32 and 64 bits, converted linearly or by a quotient of polynomials; values
//! that are marked as invalid are NaN. Text, arrays, structures, tables of conversion and messages of a bus are named in
//! [`Table::skipped`].
//!
//! All that a file says of its channels is read before any of its data: [`source`] counts it against the memory that is allowed,
//! and refuses what is linked twice. Data are unpacked as they are read.

mod bits;
mod channel;
mod column;
mod conversion;
mod data;
mod group;
mod names;
mod pieces;
mod records;
mod source;
mod stream;

use std::fs::File;

use channel::Numbers;
use column::Column;
use group::{Data, Group};
use source::{Source, bad};

use crate::binary::guard;
use crate::open::{Wanted, take_units_of_names};
use crate::sniff::MDF_AS_TABLES;
use crate::{Error, Kind, Limits, Table, stamps};

/// Reads the channels of a file of this many bytes; samples of those alone that are wanted.
pub(crate) fn read(
    file: &File,
    bytes: u64,
    limits: Limits,
    wanted: Wanted,
) -> Result<Table, Error> {
    guard("MDF", || {
        let mut source = Source::new(file, bytes, limits);
        head(&mut source)?;
        let mut all = group::read(&mut source)?;
        names::tell_apart(&mut all);
        let mut kept = kept(&all, wanted).into_iter();
        for data in all {
            columns(&mut source, data, &mut kept)?;
        }
        Ok(source.collector.finish())
    })
}

/// The block that every file begins with.
fn head(source: &mut Source) -> Result<(), Error> {
    let mut head = [0; 64];
    source.bytes(0, &mut head)?;
    let half = |at: usize| u16::from_le_bytes([head[at], head[at + 1]]);
    let version = half(28);
    let (major, minor) = (version / 100, version % 100);
    if major != 4 {
        let found = format!("version {major}.{minor:02} in a file that begins as one of 4");
        return Err(bad(28, found));
    }
    if half(60) != 0 {
        let found = "a recording in ASAM MDF that was never closed";
        return Err(Error::new(Kind::Format, found, MDF_AS_TABLES));
    }
    source
        .collector
        .detected(format!("version {major}.{minor:02}"));
    Ok(())
}

/// Of every column, whether its samples are asked for.
fn kept(all: &[Data], wanted: Wanted) -> Vec<bool> {
    let mut heads = Table::default();
    let mut counted = Vec::new();
    let groups = all.iter().flat_map(|data| &data.groups);
    for (group, channel) in groups.flat_map(|group| group.channels.iter().map(move |c| (group, c)))
    {
        match group.left_out(channel) {
            Some(_) => {
                let number = heads.columns.len() + heads.left_out.len() + 1;
                heads.left_out.push(number);
            }
            None => {
                heads.columns.push(crate::Column {
                    name: channel.name.clone(),
                    unit: channel.unit.clone(),
                    stamps: channel.seconds,
                    values: Vec::new(),
                });
                let numbers = channel.content.as_ref().map(|content| content.numbers);
                // The length of a count is only what the file says: what is kept of it is bounded.
                let count = matches!(numbers, Ok(Numbers::Counted));
                counted.push(count || stamps::is_part(&channel.name));
            }
        }
    }
    take_units_of_names(&mut heads);
    let wanted = wanted(&heads).into_iter().chain(std::iter::repeat(true));
    counted
        .into_iter()
        .zip(wanted)
        .map(|(own, wanted)| own || wanted)
        .collect()
}

/// Reads groups that share their data, and adds their columns.
fn columns(
    source: &mut Source,
    data: Data,
    kept: &mut dyn Iterator<Item = bool>,
) -> Result<(), Error> {
    let mut columns = Vec::new();
    for group in &data.groups {
        columns.push(begun(source, group, kept)?);
    }
    records::read(source, &data, &mut columns)?;
    for (group, columns) in data.groups.into_iter().zip(columns) {
        finish(source, group, columns);
    }
    Ok(())
}

/// The columns of a group, without samples.
fn begun(
    source: &mut Source,
    group: &Group,
    kept: &mut dyn Iterator<Item = bool>,
) -> Result<Vec<Column>, Error> {
    let mut columns = Vec::new();
    for channel in &group.channels {
        let (None, Ok(content)) = (group.left_out(channel), &channel.content) else {
            continue;
        };
        let kept = kept.next().unwrap_or(true);
        if kept {
            source.collector.reserve(&channel.name, &[group.records])?;
        }
        columns.push(Column::new(*content, kept, group.records));
    }
    Ok(columns)
}

/// Adds the columns of a group, and says what is left out of it.
fn finish(source: &mut Source, group: Group, columns: Vec<Column>) {
    let collector = &mut source.collector;
    if let Some(why) = group.why {
        collector.skip(&group.label, why);
    }
    let mut columns = columns.into_iter();
    for channel in &group.channels {
        let name = &channel.name;
        if let Some(why) = group.left_out(channel) {
            collector.skip_column(name, why);
            continue;
        }
        let Some(column) = columns.next() else {
            continue;
        };
        if column.values.rounded {
            collector.rounded(name);
        }
        let (place, unit) = (collector.columns(), channel.unit.clone());
        match column.kept {
            true => collector.column(name, unit, column.values.samples),
            false => collector.passed(name, unit, column.passed),
        }
        if channel.seconds {
            collector.are_stamps(place);
        }
    }
}
