//! The blocks of a file: a mark, a length, links to other blocks, data.
//!
//! Every block that is one of its kind (groups, channels, data) is claimed: whoever links to it a second time, in a loop or from
//! elsewhere, or to one that lies within another, is refused, so that no file leads to more than it holds. Only texts and
//! conversions may be shared; what they take is counted each time.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use crate::binary::Collector;
use crate::{Error, Kind, Limits};

/// Bytes of the head of a block.
pub(super) const HEAD: u64 = 24;
/// Links of a block that are looked at, but for those of lists.
const LINKS: usize = 8;
/// Bytes of the data of a block that are looked at, but for those of data blocks.
const DATA: usize = 72;
/// Longest name or unit, bytes.
const MAX_TEXT: u64 = 4096;
/// Most memory that the place of a block takes, bytes.
const CLAIM: u64 = 96;

/// A file, what has been claimed of it, and the table in the making.
pub(super) struct Source<'a> {
    pub(super) file: &'a File,
    bytes: u64,
    /// Beginnings and ends of the blocks that are claimed.
    claimed: BTreeMap<u64, u64>,
    /// Bytes of the largest block that has to be held unpacked.
    unpacked: u64,
    pub(super) collector: Collector,
}

/// What is looked at of a block.
#[derive(Debug)]
pub(super) struct Block {
    pub(super) at: u64,
    /// The two letters behind `##`.
    pub(super) mark: [u8; 2],
    /// All bytes, with the head.
    pub(super) length: u64,
    /// How many links it has.
    pub(super) links: u64,
    link: [u64; LINKS],
    data: Vec<u8>,
}

impl Block {
    /// A link, counted from 0; 0, which is no place of a block, where it has none.
    pub(super) fn link(&self, number: usize) -> u64 {
        self.link.get(number).copied().unwrap_or(0)
    }

    /// Bytes of its data; zeros where it has none there.
    pub(super) fn part<const N: usize>(&self, at: usize) -> [u8; N] {
        let mut part = [0; N];
        let there = self.data.get(at..).unwrap_or_default();
        part.iter_mut()
            .zip(there)
            .for_each(|(to, from)| *to = *from);
        part
    }

    pub(super) fn byte(&self, at: usize) -> u8 {
        u8::from_le_bytes(self.part(at))
    }

    pub(super) fn half(&self, at: usize) -> u16 {
        u16::from_le_bytes(self.part(at))
    }

    pub(super) fn word(&self, at: usize) -> u32 {
        u32::from_le_bytes(self.part(at))
    }

    pub(super) fn long(&self, at: usize) -> u64 {
        u64::from_le_bytes(self.part(at))
    }

    pub(super) fn float(&self, at: usize) -> f64 {
        f64::from_le_bytes(self.part(at))
    }
}

/// A refusal of the block at a place.
pub(super) fn bad(at: u64, found: impl Into<String>) -> Error {
    let allowed = "a whole MDF 4 file, as the recorder or asammdf writes it";
    Error::new(Kind::Format, found, allowed).at_byte(at)
}

impl<'a> Source<'a> {
    /// A file of this many bytes.
    pub(super) fn new(file: &'a File, bytes: u64, limits: Limits) -> Self {
        Self {
            file,
            bytes,
            claimed: BTreeMap::new(),
            unpacked: 0,
            collector: Collector::new(limits),
        }
    }

    /// Bytes from a place on.
    pub(super) fn bytes(&self, at: u64, buffer: &mut [u8]) -> Result<(), Error> {
        let mut file = self.file;
        let read = file.seek(SeekFrom::Start(at));
        read.and_then(|_| file.read_exact(buffer))
            .map_err(|error| match error.kind() {
                io::ErrorKind::UnexpectedEof => bad(at, "the file ends here; was it cut off?"),
                _ => Error::new(Kind::Io, format!("cannot be read ({error})"), "").at_byte(at),
            })
    }

    /// Whatever block is at a place.
    pub(super) fn block(&self, at: u64) -> Result<Block, Error> {
        if at < 64 || at.checked_add(HEAD).is_none_or(|end| end > self.bytes) {
            return Err(bad(
                at,
                "a link to a block that is not there; was the file cut off?",
            ));
        }
        let mut start = [0; HEAD as usize + 8 * LINKS + DATA];
        let near = (self.bytes - at).min(start.len() as u64) as usize;
        self.bytes(at, &mut start[..near])?;
        let long = |from: usize| {
            let bytes = start[from..].first_chunk::<8>();
            bytes.map_or(0, |bytes| u64::from_le_bytes(*bytes))
        };
        let (length, links) = (long(8), long(16));
        let data = links
            .checked_mul(8)
            .and_then(|links| links.checked_add(HEAD));
        let Some(data) = data.filter(|&data| start.starts_with(b"##") && data <= length) else {
            return Err(bad(at, "a link to what is no block"));
        };
        if length > self.bytes - at {
            let (mark, left) = (start[2..4].escape_ascii(), self.bytes - at);
            let found = format!(
                "a block {mark} of {length} bytes where {left} are left; was the file cut off?"
            );
            return Err(bad(at, found));
        }
        let mut link = [0; LINKS];
        for (number, link) in link.iter_mut().enumerate().take(links.min(8) as usize) {
            *link = long(HEAD as usize + 8 * number);
        }
        let mut rest = vec![0; (length - data).min(DATA as u64) as usize];
        match start.get(data as usize..data as usize + rest.len()) {
            Some(near) => rest.copy_from_slice(near),
            None => self.bytes(at + data, &mut rest)?,
        }
        Ok(Block {
            at,
            mark: [start[2], start[3]],
            length,
            links,
            link,
            data: rest,
        })
    }

    /// The block at a place, which nobody else may link to.
    pub(super) fn claim(&mut self, at: u64) -> Result<Block, Error> {
        let block = self.block(at)?;
        let end = at + block.length;
        let before = self.claimed.range(..end).next_back();
        if before.is_some_and(|(_, &other)| other > at) {
            return Err(bad(
                at,
                "a block that is linked twice, or lies within another",
            ));
        }
        self.collector.hold(CLAIM)?;
        self.claimed.insert(at, end);
        Ok(block)
    }

    /// The same, of one kind.
    pub(super) fn claim_of(&mut self, at: u64, mark: &[u8; 2]) -> Result<Block, Error> {
        let block = self.claim(at)?;
        match block.mark == *mark {
            true => Ok(block),
            false => {
                let (found, wanted) = (block.mark.escape_ascii(), mark.escape_ascii());
                Err(bad(
                    at,
                    format!("a block {found} where one of {wanted} belongs"),
                ))
            }
        }
    }

    /// Counts what unpacking a block of so many bytes takes that has to be held whole.
    pub(super) fn unpacked(&mut self, bytes: u64) -> Result<(), Error> {
        let more = bytes.saturating_sub(self.unpacked);
        self.unpacked = self.unpacked.max(bytes);
        // Growing it takes twice as much, and putting it in order as much again.
        self.collector.hold(more.saturating_mul(3))
    }

    /// Links of a list, from one on.
    pub(super) fn links(
        &mut self,
        block: &Block,
        from: u64,
        count: u64,
    ) -> Result<Vec<u64>, Error> {
        if from.checked_add(count).is_none_or(|end| end > block.links) {
            let found = format!("a list of {count} blocks that has {} links", block.links);
            return Err(bad(block.at, found));
        }
        self.collector.hold(2 * 8 * count)?;
        let mut bytes = vec![0; 8 * count as usize];
        self.bytes(block.at + HEAD + 8 * from, &mut bytes)?;
        let links = bytes.as_chunks::<8>().0.iter();
        Ok(links.map(|bytes| u64::from_le_bytes(*bytes)).collect())
    }

    /// The text that a link leads to: a block of text, or the `TX` of one of XML. `None` for none, and for an empty one.
    pub(super) fn text(&mut self, at: u64) -> Result<Option<String>, Error> {
        if at == 0 {
            return Ok(None);
        }
        let block = self.block(at)?;
        let start = HEAD + 8 * block.links;
        let length = block.length - start;
        let is_text = match &block.mark {
            b"TX" => true,
            b"MD" => false,
            _ => return Err(bad(at, "a link to a text that is none")),
        };
        if is_text && length > MAX_TEXT {
            let found = format!("a name or unit of {length} bytes");
            let allowed = format!("at most {MAX_TEXT} bytes");
            return Err(Error::new(Kind::Limit, found, allowed).at_byte(at));
        }
        let mut bytes = vec![0; length.min(MAX_TEXT) as usize];
        self.bytes(at + start, &mut bytes)?;
        let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
        let text = String::from_utf8_lossy(&bytes[..end]);
        let text = match is_text {
            true => text.trim(),
            false => inside(&text).unwrap_or_default().trim(),
        };
        // It is copied for names that are longer and for what is said of it.
        self.collector.hold(4 * text.len() as u64)?;
        Ok(Some(text.to_owned()).filter(|text| !text.is_empty()))
    }
}

/// What stands in the first `TX` of a comment in XML.
fn inside(xml: &str) -> Option<&str> {
    let (_, rest) = xml.split_once("<TX")?;
    let (_, rest) = rest.split_once('>')?;
    rest.split_once("</TX>").map(|(text, _)| text)
}

#[cfg(test)]
mod tests {
    use super::inside;

    #[test]
    fn texts_in_comments() {
        let xml = "<CNunit xmlns='http://www.asam.net/mdf/v4'><TX>N m</TX></CNunit>";
        assert_eq!(inside(xml), Some("N m"));
        assert_eq!(inside("<TX xml:lang='en'>rpm</TX><TX>x</TX>"), Some("rpm"));
        assert_eq!(inside("<TX/>"), None);
    }
}
