//! Checks the sizes that a Parquet file claims before the library allocates memory for them.
//!
//! The library trusts the number of children of a schema element, the size of an unpacked page and
//! the length of a dictionary; a few bytes in a small file could ask for gigabytes.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

use super::thrift::{Compact, I32, LIST, NO, STRUCT, YES};

/// Largest footer in bytes; 64 MiB describe a million column chunks.
const MAX_FOOTER: u64 = 64 << 20;

/// Largest header of one page in bytes, statistics included.
const MAX_PAGE_HEADER: u64 = 1 << 20;

/// Deepest nesting of groups in the schema.
const MAX_DEPTH: usize = 32;

/// Checks the footer of a file of this many bytes; the error says what is wrong with it.
pub(super) fn footer(file: &mut File, bytes: u64) -> Result<(), String> {
    let mut end = [0; 8];
    let start = bytes.checked_sub(8).ok_or("the file is too short")?;
    read_at(file, start, &mut end)?;
    let [a, b, c, d, magic @ ..] = end;
    match &magic {
        b"PAR1" => {}
        b"PARE" => return Err("the footer is encrypted".to_owned()),
        _ => return Err("the file does not end in PAR1; was it cut off?".to_owned()),
    }
    let length = u64::from(u32::from_le_bytes([a, b, c, d]));
    if length > MAX_FOOTER {
        return Err(format!(
            "a footer of {length} bytes, more than {MAX_FOOTER}"
        ));
    }
    let start = start
        .checked_sub(length)
        .ok_or("the footer is longer than the file")?;
    let mut text = vec![0; length as usize];
    read_at(file, start, &mut text)?;
    let children = children(&text).ok_or("the footer is damaged")?;
    tree(&children).ok_or_else(|| "the schema is damaged".to_owned())
}

/// Number of children of every schema element.
fn children(footer: &[u8]) -> Option<Vec<i64>> {
    let mut all = Vec::new();
    Compact::new(footer).structure(0, |compact, id, kind| {
        if (id, kind) != (2, LIST) {
            return Some(false);
        }
        let (elements, kind) = compact.list()?;
        if kind != STRUCT {
            return None;
        }
        for _ in 0..elements {
            let mut children = 0;
            compact.structure(1, |compact, id, kind| {
                if (id, kind) == (5, I32) {
                    children = compact.integer()?;
                }
                Some((id, kind) == (5, I32))
            })?;
            all.push(children);
        }
        Some(true)
    })?;
    Some(all)
}

/// Whether these numbers of children, depth first, make one tree of sane depth.
fn tree(children: &[i64]) -> Option<()> {
    let total = i64::try_from(children.len()).ok()?;
    let mut missing: Vec<i64> = vec![1];
    for &own in children {
        while missing.last() == Some(&0) {
            missing.pop();
        }
        *missing.last_mut()? -= 1;
        if !(0..=total).contains(&own) || missing.len() > MAX_DEPTH {
            return None;
        }
        if own > 0 {
            missing.push(own);
        }
    }
    missing.iter().all(|&left| left == 0).then_some(())
}

/// Checks the pages between two offsets of the file, and gives the bytes of the largest, unpacked, and how many values all of them
/// claim to have. `most` is how many bytes a packed number of them can become.
pub(super) fn pages(
    file: &mut File,
    start: u64,
    end: u64,
    most: impl Fn(u64) -> u64,
) -> Result<(u64, u64), String> {
    let mut at = start;
    let (mut largest, mut values) = (0, 0u64);
    let mut window = Vec::new();
    while at < end {
        let page = header(file, at, end, &mut window)?;
        let packed = page.sizes(at, end)?;
        let unpacked = u64::try_from(page.unpacked)
            .ok()
            .filter(|&size| size <= most(packed));
        let unpacked = unpacked
            .ok_or_else(|| format!("a page at byte {at} that unpacks to an impossible size"))?;
        let is_dictionary = matches!(page.kind, Kind::Dictionary);
        if is_dictionary && page.values > i64::try_from(unpacked).unwrap_or(i64::MAX) {
            return Err(format!("a dictionary at byte {at} of impossible length"));
        }
        if let Kind::Data { .. } | Kind::Data2 { .. } = page.kind {
            values = values.saturating_add(u64::try_from(page.values).unwrap_or(u64::MAX));
        }
        at += page.bytes + packed;
        largest = largest.max(unpacked);
    }
    Ok((largest, values))
}

/// The header of a page.
pub(super) struct Header {
    /// Bytes of the header itself.
    pub(super) bytes: u64,
    pub(super) packed: i64,
    pub(super) unpacked: i64,
    pub(super) values: i64,
    pub(super) encoding: i64,
    pub(super) kind: Kind,
}

/// What a page is.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Dictionary,
    /// With the encodings of its definition and repetition levels.
    Data {
        levels: [i64; 2],
    },
    /// Of the second version, with the bytes of its definition and repetition levels.
    Data2 {
        nulls: u32,
        rows: u32,
        levels: [u32; 2],
        packed: bool,
    },
    /// An index, or what is not known.
    Other,
}

impl Header {
    /// Bytes that follow the header, which begins at `at`, of what ends at `end`.
    pub(super) fn sizes(&self, at: u64, end: u64) -> Result<u64, String> {
        let left = (end - at).saturating_sub(self.bytes);
        let packed = u64::try_from(self.packed).ok().filter(|&size| size <= left);
        packed.ok_or_else(|| format!("a page at byte {at} larger than its column"))
    }
}

/// Reads the header of the page at a place, of what ends at `end`.
pub(super) fn header(
    file: &mut File,
    at: u64,
    end: u64,
    window: &mut Vec<u8>,
) -> Result<Header, String> {
    // Nearly every header is far below 1 KiB; statistics may make one longer.
    for size in [1 << 10, MAX_PAGE_HEADER] {
        window.resize(size.min(end - at) as usize, 0);
        read_at(file, at, window)?;
        if let Some(page) = parse(window) {
            return Ok(page);
        }
    }
    Err(format!("a damaged page header at byte {at}"))
}

/// Fields of the structures of Apache Parquet's parquet.thrift.
fn parse(bytes: &[u8]) -> Option<Header> {
    let mut page = Header {
        bytes: 0,
        packed: -1,
        unpacked: -1,
        values: 0,
        encoding: -1,
        kind: Kind::Other,
    };
    let mut compact = Compact::new(bytes);
    compact.structure(0, |compact, id, kind| {
        match (id, kind) {
            (2, I32) => page.unpacked = compact.integer()?,
            (3, I32) => page.packed = compact.integer()?,
            (5, STRUCT) => {
                let ([values, encoding, definition, repetition, ..], _) = fields(compact)?;
                (page.values, page.encoding) = (values, encoding);
                page.kind = Kind::Data {
                    levels: [definition, repetition],
                };
            }
            (7, STRUCT) => {
                let ([values, encoding, ..], _) = fields(compact)?;
                (page.values, page.encoding) = (values, encoding);
                page.kind = Kind::Dictionary;
            }
            (8, STRUCT) => {
                let ([values, nulls, rows, encoding, definition, repetition], packed) =
                    fields(compact)?;
                (page.values, page.encoding) = (values, encoding);
                let whole = |number: i64| u32::try_from(number).ok();
                page.kind = Kind::Data2 {
                    nulls: whole(nulls)?,
                    rows: whole(rows)?,
                    levels: [whole(definition)?, whole(repetition)?],
                    packed: packed.unwrap_or(true),
                };
            }
            _ => return Some(false),
        }
        Some(true)
    })?;
    page.bytes = compact.at() as u64;
    Some(page)
}

/// The first six fields of a structure, where they are whole numbers, and the seventh, where it is yes or no.
fn fields(compact: &mut Compact) -> Option<([i64; 6], Option<bool>)> {
    let mut numbers = [0; 6];
    let mut flag = None;
    compact.structure(1, |compact, id, kind| {
        match (usize::try_from(id), kind) {
            (Ok(id @ 1..=6), I32) => numbers[id - 1] = compact.integer()?,
            (Ok(7), YES | NO) => {
                flag = Some(kind == YES);
                return Some(false);
            }
            _ => return Some(false),
        }
        Some(true)
    })?;
    Some((numbers, flag))
}

pub(super) fn read_at(file: &mut File, at: u64, into: &mut [u8]) -> Result<(), String> {
    file.seek(SeekFrom::Start(at))
        .and_then(|_| file.read_exact(into))
        .map_err(|error| format!("cannot be read at byte {at} ({error})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trees() {
        assert!(tree(&[2, 0, 0]).is_some());
        assert!(tree(&[2, 1, 0, 0]).is_some());
        assert!(tree(&[0]).is_some());
        assert!(tree(&[]).is_none());
        assert!(tree(&[2, 0]).is_none());
        assert!(tree(&[1, 0, 0]).is_none());
        assert!(tree(&[i64::MAX, 0]).is_none());
        assert!(tree(&[-1]).is_none());
        let deep = [vec![1; 5000], vec![0]].concat();
        assert!(tree(&deep).is_none());
    }
}
