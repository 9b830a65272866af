//! `[ethercat]`: which process data of a capture are columns.

use crate::config::Table;
use crate::error::Error;
use stiction_formats::ethercat::{Address, Direction, Entry, ProcessData, Type, object};

/// Most entries of a map.
const MOST: usize = 1024;
/// Last byte of the data of a datagram, which has 11 bits for their number.
const LAST_BYTE: u64 = 2046;

/// The process data of an axis file.
pub(super) fn process_data(root: &Table<'_>) -> Result<ProcessData, Error> {
    let Some(table) = root.table("ethercat")? else {
        return Ok(ProcessData::default());
    };
    let usual = address(&table)?;
    let entries = table.tables("map", MOST)?;
    let entries = entries.iter().map(|table| entry(table, usual));
    let entries: Vec<Entry> = entries.collect::<Result<_, _>>()?;
    table.end()?;
    if entries.is_empty() {
        let example = "a list such as [{ object = 0x6064, byte = 2 }]";
        return Err(table.refuse("map", "has no entry".into(), &format!("give {example}")));
    }
    for (n, entry) in entries.iter().enumerate() {
        if entries[..n].iter().any(|other| other.name == entry.name) {
            let found = format!("two entries are called {:?}", entry.name);
            return Err(table.refuse("map", found, "a name for each: name = \"...\""));
        }
    }
    Ok(ProcessData { entries })
}

/// Where a datagram begins: in logical memory, or in that of a station.
fn address(table: &Table<'_>) -> Result<Option<Address>, Error> {
    let station = table.count("station", 0, u64::from(u16::MAX))?;
    let most = match station {
        Some(_) => u64::from(u16::MAX),
        None => u64::from(u32::MAX),
    };
    let address = table.count("address", 0, most)?;
    Ok(match (station, address) {
        (Some(station), address) => {
            let address =
                table.required("address", address, "the place in the station's memory")?;
            Some(Address::Physical {
                station: station as u16,
                offset: address as u16,
            })
        }
        (None, address) => address.map(|address| Address::Logical(address as u32)),
    })
}

/// One column.
fn entry(table: &Table<'_>, usual: Option<Address>) -> Result<Entry, Error> {
    let index = table.count("object", 0, u64::from(u16::MAX))?;
    let known = index.and_then(|index| object(index as u16));
    let words: Vec<&str> = Type::ALL.iter().map(|(_, word, _)| *word).collect();
    let kind = table.choice("type", &words)?.and_then(Type::named);
    let name = table.line("name")?.map(str::to_owned);
    let direction = match table.choice("direction", &["in", "out"])? {
        Some("in") => Some(Direction::In),
        Some(_) => Some(Direction::Out),
        None => None,
    };
    let byte = table.count("byte", 0, LAST_BYTE)?;
    let bit = table.count("bit", 0, 7)?;
    let own = address(table)?;
    table.end()?;
    let kind = kind.or(known.map(|known| known.kind));
    let kind = table.required("type", kind, "one of the types, such as \"i32\"")?;
    let unnamed = index.map(|index| format!("{index:04X}h"));
    let name = name
        .or(known.map(|known| known.name.to_owned()))
        .or(unnamed);
    Ok(Entry {
        name: table.required("name", name, "a name, or the object of CiA 402")?,
        unit: known.and_then(|known| known.unit).map(str::to_owned),
        address: own.or(usual),
        byte: table.required("byte", byte, "the byte of the datagram's data, from 0")? as usize,
        bit: bit.unwrap_or(0) as u8,
        kind,
        direction: direction
            .or(known.map(|known| known.direction))
            .unwrap_or(Direction::In),
    })
}
