//! Where the records of groups lie: in one block, or in the blocks of a list, plain or packed.

use super::source::{Block, HEAD, Source, bad};
use crate::Error;

/// Bytes of the head of a packed block, behind that of every block.
const PACKED_HEAD: u64 = 24;

/// How the bytes of a part are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Packing {
    Plain,
    /// As zlib packs them.
    Deflated,
    /// The same of rows of so many bytes, of which all first bytes come first, then all second ones.
    Transposed(u32),
    /// All of them 0, and not in the file.
    Zeros,
}

/// Bytes that follow those of the part before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Where they begin in the file.
    pub(super) at: u64,
    /// How many there are in the file.
    pub(super) stored: u64,
    /// How many they are, as the file says.
    pub(super) length: u64,
    pub(super) packing: Packing,
}

/// The parts of the records of a group, or of several among each other.
#[derive(Debug, Default)]
pub(super) struct Parts {
    pub(super) records: Vec<Part>,
    /// Whether records are their values alone, and what says which are none is in parts of its own.
    pub(super) apart: bool,
    pub(super) invalid: Vec<Part>,
}

/// Bytes of all parts.
pub(super) fn length(parts: &[Part]) -> u64 {
    parts
        .iter()
        .fold(0, |sum, part| sum.saturating_add(part.length))
}

/// The parts that a link leads to; `bytes` are those of a record with values, and with what says which are none.
pub(super) fn parts(source: &mut Source, at: u64, bytes: (u64, u64)) -> Result<Parts, Error> {
    let mut parts = Parts::default();
    if at == 0 {
        return Ok(parts);
    }
    let mut block = source.claim(at)?;
    if block.mark == *b"HL" {
        block = source.claim(block.link(0))?;
    }
    match &block.mark {
        b"DL" | b"LD" => {
            parts.apart = block.mark == *b"LD";
            list(source, block, bytes, &mut parts)?;
        }
        mark => {
            parts.apart = *mark == *b"DV" || *mark == *b"DZ" && &block.part(0) == b"DV";
            let part = part(source, &block)?;
            parts.records.push(part);
        }
    }
    Ok(parts)
}

/// Adds the parts of a list, and of those that follow it.
fn list(
    source: &mut Source,
    mut block: Block,
    bytes: (u64, u64),
    parts: &mut Parts,
) -> Result<(), Error> {
    let mark = block.mark;
    loop {
        let count = u64::from(block.word(4));
        let own = source.links(&block, 1, count)?;
        let invalid = match parts.apart && block.word(0) >> 31 == 1 {
            true => source.links(&block, 1 + count, count)?,
            false => Vec::new(),
        };
        for (number, at) in own.into_iter().enumerate() {
            let data = source.claim(at)?;
            let data = part(source, &data)?;
            parts.records.push(data);
            if parts.apart && bytes.1 > 0 {
                let at = invalid.get(number).copied().unwrap_or(0);
                let part = match at {
                    0 => valid(data, bytes),
                    at => {
                        let block = source.claim(at)?;
                        part(source, &block)?
                    }
                };
                parts.invalid.push(part);
            }
        }
        match block.link(0) {
            0 => return Ok(()),
            next => block = source.claim_of(next, &mark)?,
        }
    }
}

/// What stands for a part whose values all are some.
fn valid(data: Part, bytes: (u64, u64)) -> Part {
    let records = data.length / bytes.0.max(1);
    Part {
        at: data.at,
        stored: 0,
        length: records.saturating_mul(bytes.1),
        packing: Packing::Zeros,
    }
}

/// The part that a block of data is.
fn part(source: &mut Source, block: &Block) -> Result<Part, Error> {
    source.collector.hold(3 * size_of::<Part>() as u64)?;
    match &block.mark {
        b"DT" | b"DV" | b"DI" => Ok(Part {
            at: block.at + HEAD + 8 * block.links,
            stored: block.length - HEAD - 8 * block.links,
            length: block.length - HEAD - 8 * block.links,
            packing: Packing::Plain,
        }),
        b"DZ" => packed(block),
        mark => {
            let mark = mark.escape_ascii();
            Err(bad(block.at, format!("a block {mark} where data belong")))
        }
    }
}

fn packed(block: &Block) -> Result<Part, Error> {
    let (stored, start) = (block.long(16), HEAD + 8 * block.links + PACKED_HEAD);
    let packing = match block.byte(2) {
        0 => Packing::Deflated,
        1 if block.word(4) > 0 => Packing::Transposed(block.word(4)),
        1 => return Err(bad(block.at, "packed data whose rows have no bytes")),
        2..=5 => {
            let found = "data that are packed with Zstandard or LZ4";
            let allowed = "data packed with deflate, which versions up to 4.20 have: write the file again as one of these";
            return Err(Error::new(crate::Kind::Format, found, allowed).at_byte(block.at));
        }
        other => {
            let found = format!("data that are packed in the unknown way {other}");
            return Err(bad(block.at, found));
        }
    };
    if start
        .checked_add(stored)
        .is_none_or(|end| end > block.length)
    {
        return Err(bad(block.at, "packed data that go beyond their block"));
    }
    Ok(Part {
        at: block.at + start,
        stored,
        length: block.long(8),
        packing,
    })
}
