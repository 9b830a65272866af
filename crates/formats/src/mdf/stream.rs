//! The bytes of records, one after the other, whatever parts they lie in.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

use flate2::bufread::ZlibDecoder;

use super::data::{Packing, Part};

/// Bytes that are read at once.
const AT_ONCE: u64 = 1 << 16;
/// Rows of a transposed part that are put back at once, so that they stay in the cache.
const ROWS: usize = 64;

/// What parts hold, unpacked as it is read.
pub(super) struct Stream<'a> {
    file: &'a File,
    parts: std::vec::IntoIter<Part>,
    now: Box<dyn Read + 'a>,
    left: u64,
    /// Whether the part that is read is not in the file.
    zeros: bool,
    /// Where the part begins that is read.
    pub(super) at: u64,
}

impl<'a> Stream<'a> {
    pub(super) fn new(file: &'a File, parts: Vec<Part>) -> Self {
        Self {
            file,
            at: parts.first().map_or(0, |part| part.at),
            parts: parts.into_iter(),
            now: Box::new(io::empty()),
            left: 0,
            zeros: false,
        }
    }

    /// The bytes of a part.
    fn opened(&self, part: Part) -> io::Result<Box<dyn Read + 'a>> {
        let from = From {
            file: self.file,
            at: part.at,
        };
        let buffer = part.stored.clamp(1, AT_ONCE) as usize;
        let stored = BufReader::with_capacity(buffer, from).take(part.stored);
        Ok(match part.packing {
            Packing::Plain => Box::new(stored),
            Packing::Deflated => Box::new(ZlibDecoder::new(stored)),
            Packing::Zeros => Box::new(io::repeat(0)),
            Packing::Transposed(row) => {
                let mut turned = Vec::new();
                let unpacked = ZlibDecoder::new(stored).take(part.length);
                { unpacked }.read_to_end(&mut turned)?;
                Box::new(io::Cursor::new(turned_back(&turned, row as usize)))
            }
        })
    }
}

impl Stream<'_> {
    /// Goes on to a part that has bytes left; whether there is one.
    fn go_on(&mut self) -> io::Result<bool> {
        while self.left == 0 {
            let Some(part) = self.parts.next() else {
                return Ok(false);
            };
            self.at = part.at;
            self.zeros = part.packing == Packing::Zeros;
            self.now = self.opened(part)?;
            self.left = part.length;
        }
        Ok(true)
    }

    /// Passes over bytes that all are zeros, and not in the file; whether they are.
    pub(super) fn pass_zeros(&mut self, bytes: u64) -> io::Result<bool> {
        let zeros = self.go_on()? && self.zeros && self.left >= bytes;
        if zeros {
            self.left -= bytes;
        }
        Ok(zeros)
    }
}

impl Read for Stream<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if !self.go_on()? {
            return Ok(0);
        }
        let most = (buffer.len() as u64).min(self.left) as usize;
        let read = self.now.read(&mut buffer[..most])?;
        if read == 0 && most > 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        self.left -= read as u64;
        Ok(read)
    }
}

/// A file from a place on, whoever else reads it in between.
struct From<'a> {
    file: &'a File,
    at: u64,
}

impl Read for From<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut file = self.file;
        file.seek(SeekFrom::Start(self.at))?;
        let read = file.read(buffer)?;
        self.at += read as u64;
        Ok(read)
    }
}

/// Rows of so many bytes from their columns; what is left beyond whole rows stands as it is.
fn turned_back(columns: &[u8], row: usize) -> Vec<u8> {
    let rows = columns.len() / row;
    let mut out = columns.to_vec();
    for first in (0..rows).step_by(ROWS) {
        let last = rows.min(first + ROWS);
        for column in 0..row {
            let from = &columns[column * rows..][first..last];
            let to = out[first * row + column..].iter_mut().step_by(row);
            to.zip(from).for_each(|(to, from)| *to = *from);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::turned_back;

    #[test]
    fn columns_become_rows() {
        assert_eq!(turned_back(b"adbecfxy", 3), b"abcdefxy");
        assert_eq!(turned_back(b"xy", 3), b"xy");
        let rows: Vec<u8> = (0..200u16).flat_map(|n| [n as u8, 255 - n as u8]).collect();
        let columns: Vec<u8> = [0, 1]
            .into_iter()
            .flat_map(|at| rows.iter().skip(at).step_by(2).copied())
            .collect();
        assert_eq!(turned_back(&columns, 2), rows);
    }
}
