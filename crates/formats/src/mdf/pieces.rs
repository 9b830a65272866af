//! Records of one group in pieces, with what says which of their values are none.

use std::fs::File;
use std::io::{self, Read};

use super::column::{Invalid, Records};
use super::data::Parts;
use super::records::trouble;
use super::stream::Stream;
use crate::Error;

/// Bytes of records that are taken at once.
const AT_ONCE: usize = 1 << 16;

/// The records of a group, read piece by piece.
pub(super) struct Pieces<'a> {
    records: Stream<'a>,
    /// What says which values are none, where it is in parts of its own.
    apart: Option<Stream<'a>>,
    /// Bytes of a record with values, and of what says which of them are none.
    bytes: (usize, usize),
    buffer: Vec<u8>,
    bits: Vec<u8>,
}

impl<'a> Pieces<'a> {
    /// Of parts that are long enough, with records of so many bytes.
    pub(super) fn new(file: &'a File, parts: Parts, bytes: (u64, u64)) -> Self {
        let apart = parts.apart && !parts.invalid.is_empty();
        let bytes = match parts.apart && !apart {
            // Nothing says that any value is none.
            true => (bytes.0, 0),
            false => bytes,
        };
        Self {
            records: Stream::new(file, parts.records),
            apart: apart.then(|| Stream::new(file, parts.invalid)),
            bytes: (bytes.0 as usize, bytes.1 as usize),
            buffer: Vec::new(),
            bits: Vec::new(),
        }
    }

    /// How many records are a piece.
    pub(super) fn at_once(&self) -> u64 {
        (AT_ONCE / (self.bytes.0 + self.bytes.1).max(8)).max(1) as u64
    }

    /// The next records, of which so many came before.
    pub(super) fn next(&mut self, count: usize, before: u64) -> Result<Records<'_>, Error> {
        let (data, invalid) = self.bytes;
        let size = data + if self.apart.is_some() { 0 } else { invalid };
        self.buffer.resize(count * size, 0);
        let read = self.records.read_exact(&mut self.buffer);
        read.map_err(|error| trouble(self.records.at, &error))?;
        let mut marked = invalid > 0;
        if let Some(apart) = &mut self.apart {
            let bits = bits(apart, count * invalid, &mut self.bits);
            marked = bits.map_err(|error| trouble(apart.at, &error))?;
        }
        let (bytes, size_of_bits, from) = match self.apart {
            Some(_) => (&self.bits, invalid, 0),
            None => (&self.buffer, size, data),
        };
        Ok(Records {
            count,
            before,
            bytes: &self.buffer,
            size,
            invalid: marked.then_some(Invalid {
                bytes,
                size: size_of_bits,
                from,
            }),
        })
    }
}

/// Reads what says which values are none; whether there is anything to say.
fn bits(apart: &mut Stream, bytes: usize, buffer: &mut Vec<u8>) -> io::Result<bool> {
    if apart.pass_zeros(bytes as u64)? {
        return Ok(false);
    }
    buffer.resize(bytes, 0);
    apart.read_exact(buffer)?;
    Ok(true)
}
