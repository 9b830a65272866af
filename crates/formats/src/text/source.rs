//! The bytes of a file: byte order marks, the head that is looked at, then block after block.

use super::limits::MAX_ROW_BYTES;
use super::problem;
use super::split::Ends;
use super::utf16::Utf16;
use crate::{Error, Kind};
use std::io::{Cursor, Read};

/// Size of the head in bytes; the 17 header rows of a TwinCAT export with 4096 channels fit in.
const HEAD_BYTES: usize = 4 << 20;
/// Size of one block of rows in bytes.
const BLOCK_BYTES: usize = 512 << 10;

/// A text file as UTF-8 (or at least ASCII) bytes.
pub(super) struct Source<'a> {
    reader: Box<dyn Read + 'a>,
    /// The first bytes without byte order mark.
    pub head: Vec<u8>,
    /// Whether the head is the whole file.
    pub whole: bool,
    /// Byte that ends a row: LF, or CR in a file without LF.
    pub row_end: u8,
    /// The encoding as its byte order mark states it.
    mark: Option<&'static str>,
    /// Bytes of the file, where known and not recoded.
    pub size: Option<u64>,
    /// How much of the head has been handed out.
    taken: usize,
    /// Start of a row that the last block cut.
    carry: Vec<u8>,
}

impl<'a> Source<'a> {
    pub(super) fn open(mut reader: impl Read + 'a, size: Option<u64>) -> Result<Self, Error> {
        let mut mark = Vec::new();
        reader
            .by_ref()
            .take(3)
            .read_to_end(&mut mark)
            .map_err(|e| problem::io(&e))?;
        let (stated, rest) = match mark[..] {
            [0xEF, 0xBB, 0xBF] => (Some("UTF-8 with byte order mark"), mark.len()),
            [0xFF, 0xFE, ..] => (Some("UTF-16 LE"), 2),
            [0xFE, 0xFF, ..] => (Some("UTF-16 BE"), 2),
            _ => (None, 0),
        };
        let plain = Cursor::new(mark.split_off(rest)).chain(reader);
        let mut reader: Box<dyn Read + 'a> = match stated {
            Some("UTF-16 LE") => Box::new(Utf16::new(plain, false)),
            Some("UTF-16 BE") => Box::new(Utf16::new(plain, true)),
            _ => Box::new(plain),
        };
        let mut head = Vec::new();
        fill(&mut reader, &mut head, HEAD_BYTES)?;
        if let Some(at) = memchr::memchr(0, &head) {
            return Err(Error::new(
                Kind::Format,
                "a zero byte, which is not text",
                "text has none (UTF-16 needs its byte order mark); every other format is recognised by its first bytes, whatever its name is: docs/formats.md",
            )
            .at_byte(at as u64));
        }
        let row_end = match memchr::memchr2(b'\n', b'\r', &head) {
            Some(at) if head[at] == b'\r' && memchr::memchr(b'\n', &head).is_none() => b'\r',
            _ => b'\n',
        };
        let whole = head.len() < HEAD_BYTES;
        let size = size.filter(|_| rest != 2);
        Ok(Self {
            reader,
            head,
            whole,
            row_end,
            mark: stated,
            size,
            taken: 0,
            carry: Vec::new(),
        })
    }

    /// The encoding, where it is not plain ASCII or UTF-8 above the first sample.
    pub(super) fn encoding(&self, first_row: usize) -> Option<&'static str> {
        let latin = std::str::from_utf8(&self.head[..first_row]).is_err();
        self.mark.or(latin.then_some("encoding ISO-8859-1"))
    }

    /// Lets the blocks start here in the head.
    pub(super) fn start_at(&mut self, offset: usize) {
        self.taken = offset;
    }

    /// The next block of whole rows; `None` at the end. A row that is longer than allowed comes
    /// unfinished, for the parser to refuse.
    pub(super) fn next_block(&mut self, ends: &Ends) -> Result<Option<Vec<u8>>, Error> {
        let mut block = std::mem::take(&mut self.carry);
        loop {
            let before = block.len();
            self.more(&mut block)?;
            if block.len() == before {
                return Ok(Some(block).filter(|b| !b.is_empty()));
            }
            if let Some(cut) = ends.last_row_end(&block) {
                self.carry.extend_from_slice(&block[cut..]);
                block.truncate(cut);
                return Ok(Some(block));
            }
            if block.len() > MAX_ROW_BYTES {
                return Ok(Some(block));
            }
        }
    }

    /// Appends up to one block's worth of bytes.
    fn more(&mut self, block: &mut Vec<u8>) -> Result<(), Error> {
        if self.taken < self.head.len() {
            let end = self.head.len().min(self.taken + BLOCK_BYTES);
            block.extend_from_slice(&self.head[self.taken..end]);
            self.taken = end;
            return Ok(());
        }
        // The head is not needed any more.
        self.head = Vec::new();
        self.taken = 0;
        fill(&mut self.reader, block, BLOCK_BYTES)
    }
}

fn fill(reader: &mut impl Read, to: &mut Vec<u8>, count: usize) -> Result<(), Error> {
    to.reserve(count.min(BLOCK_BYTES));
    reader
        .take(count as u64)
        .read_to_end(to)
        .map(|_| ())
        .map_err(|e| problem::io(&e))
}
