//! The data elements a MATLAB v5 file is made of: a tag with type and size, then the bytes.

use std::io::{self, Read};

use crate::binary::{ByteOrder, Class, Number};
use crate::{Error, Kind};

/// Element types of the format that are not numbers.
pub(super) const MATRIX: u32 = 14;
pub(super) const COMPRESSED: u32 = 15;

/// Part of a file: what is left of it, and where it stands.
pub(super) struct Stream<'a> {
    inner: &'a mut dyn Read,
    left: u64,
    at: u64,
    /// Offset of the compressed element that this is the content of.
    packed_at: Option<u64>,
    order: ByteOrder,
}

impl<'a> Stream<'a> {
    pub(super) fn new(inner: &'a mut dyn Read, left: u64, at: u64, order: ByteOrder) -> Self {
        Self {
            inner,
            left,
            at,
            packed_at: None,
            order,
        }
    }

    /// The content of a compressed element that stands at this offset; its length is not known.
    pub(super) fn unpacked(inner: &'a mut dyn Read, at: u64, order: ByteOrder) -> Self {
        Self {
            packed_at: Some(at),
            ..Self::new(inner, u64::MAX, 0, order)
        }
    }

    /// The next `bytes` bytes as a stream of their own.
    pub(super) fn part(&mut self, bytes: u64) -> Result<Stream<'_>, Error> {
        if bytes > self.left {
            return Err(self.bad(format!(
                "an element of {bytes} bytes where {} are left",
                self.left
            )));
        }
        Ok(Stream {
            left: bytes,
            at: self.at,
            packed_at: self.packed_at,
            order: self.order,
            inner: self,
        })
    }

    /// Reads and forgets what is left.
    pub(super) fn drain(mut self) -> Result<(), Error> {
        let left = self.left;
        let read = io::copy(&mut (&mut self).take(left), &mut io::sink());
        match read {
            Ok(read) if read == left => Ok(()),
            Ok(_) => Err(self.cut()),
            Err(error) => Err(self.io(error)),
        }
    }

    /// After the last byte of compressed content: reads on to its checksum, which is then verified.
    pub(super) fn verify_end(mut self) -> Result<(), Error> {
        match self.read(&mut [0]) {
            Ok(0) => Ok(()),
            Ok(_) => Err(self.bad("compressed data that are longer than their variable")),
            Err(error) => Err(self.io(error)),
        }
    }

    pub(super) fn order(&self) -> ByteOrder {
        self.order
    }

    pub(super) fn left(&self) -> u64 {
        self.left
    }

    /// Offset in the file that an error names.
    pub(super) fn at(&self) -> u64 {
        self.packed_at.unwrap_or(self.at)
    }

    pub(super) fn bad(&self, found: impl Into<String>) -> Error {
        let allowed = "a MAT file of version 5 as MATLAB or scipy.io.savemat writes it";
        Error::new(Kind::Format, found, allowed).at_byte(self.at())
    }

    pub(super) fn cut(&self) -> Error {
        self.bad("the file ends inside a variable")
    }

    /// The error of this crate for an error of reading.
    pub(super) fn io(&self, error: io::Error) -> Error {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => self.cut(),
            _ if self.packed_at.is_some() => self.bad(format!("broken compressed data ({error})")),
            _ => Error::new(Kind::Io, format!("cannot be read ({error})"), "").at_byte(self.at()),
        }
    }

    pub(super) fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let mut bytes = [0; N];
        self.read_exact(&mut bytes)
            .map_err(|error| self.io(error))?;
        Ok(bytes)
    }

    pub(super) fn word(&mut self) -> Result<u32, Error> {
        let bytes = self.bytes()?;
        Ok(match self.order {
            ByteOrder::Little => u32::from_le_bytes(bytes),
            ByteOrder::Big => u32::from_be_bytes(bytes),
        })
    }

    pub(super) fn tag(&mut self) -> Result<Tag, Error> {
        let word = self.word()?;
        // A small element has its size in the upper half of the type, and its bytes in the tag.
        if word >> 16 != 0 {
            return Ok(Tag {
                kind: word & 0xffff,
                size: u64::from(word >> 16),
                small: true,
            });
        }
        Ok(Tag {
            kind: word,
            size: u64::from(self.word()?),
            small: false,
        })
    }

    /// Calls `read` on the bytes of the element with this tag, and leaves what it left.
    pub(super) fn element<T>(
        &mut self,
        tag: Tag,
        read: impl FnOnce(&mut Stream<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        if tag.small && tag.size > 4 {
            return Err(self.bad(format!("a small element of {} bytes", tag.size)));
        }
        let padded = if tag.small {
            4
        } else {
            tag.size.next_multiple_of(8)
        };
        let mut part = self.part(tag.size)?;
        let out = read(&mut part)?;
        part.drain()?;
        // The last element may lack its padding.
        let padding = (padded - tag.size).min(self.left);
        self.part(padding)?.drain()?;
        Ok(out)
    }

    /// A whole element of at most `most` bytes, and its type.
    pub(super) fn small_element(&mut self, most: u64) -> Result<(u32, Vec<u8>), Error> {
        let tag = self.tag()?;
        if tag.size > most {
            return Err(self.bad(format!(
                "{} bytes where at most {most} are plausible",
                tag.size
            )));
        }
        self.element(tag, |part| {
            let mut bytes = Vec::new();
            part.read_to_end(&mut bytes)
                .map_err(|error| part.io(error))?;
            if bytes.len() as u64 != tag.size {
                return Err(part.cut());
            }
            Ok((tag.kind, bytes))
        })
    }
}

impl Read for Stream<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let most = buffer
            .len()
            .min(usize::try_from(self.left).unwrap_or(usize::MAX));
        let read = self.inner.read(&mut buffer[..most])?;
        self.left -= read as u64;
        self.at += read as u64;
        Ok(read)
    }
}

/// What precedes the bytes of an element.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tag {
    pub(super) kind: u32,
    pub(super) size: u64,
    small: bool,
}

/// The number format of an element type; `None` where it is not one of numbers.
pub(super) fn number(kind: u32, order: ByteOrder) -> Option<Number> {
    let (class, width) = match kind {
        1 => (Class::Signed, 1),
        2 => (Class::Unsigned, 1),
        3 => (Class::Signed, 2),
        4 => (Class::Unsigned, 2),
        5 => (Class::Signed, 4),
        6 => (Class::Unsigned, 4),
        7 => (Class::Float, 4),
        9 => (Class::Float, 8),
        12 => (Class::Signed, 8),
        13 => (Class::Unsigned, 8),
        _ => return None,
    };
    Number::new(class, width, order)
}
