//! A column in the making.

use std::io;

use super::channel::{Content, Numbers};
use crate::Passed;
use crate::binary::{Values, grow};

/// Records that are taken at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Records<'a> {
    /// How many there are, and how many came before.
    pub(super) count: usize,
    pub(super) before: u64,
    /// Their bytes, so many each.
    pub(super) bytes: &'a [u8],
    pub(super) size: usize,
    /// Where what says which values are none stands, if it does.
    pub(super) invalid: Option<Invalid<'a>>,
}

/// Bits that say which values of records are none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Invalid<'a> {
    pub(super) bytes: &'a [u8],
    /// Bytes for each record, and how many of these stand before the bits.
    pub(super) size: usize,
    pub(super) from: usize,
}

/// What is read of a channel, and what has been.
#[derive(Debug)]
pub(super) struct Column {
    content: Content,
    /// Whether its samples are asked for; if not, only what they are is kept.
    pub(super) kept: bool,
    /// How many there will be.
    all: usize,
    pub(super) values: Values,
    pub(super) passed: Passed,
}

impl Column {
    pub(super) fn new(content: Content, kept: bool, all: u64) -> Self {
        Self {
            content,
            kept,
            all: all as usize,
            values: Values::default(),
            passed: Passed::default(),
        }
    }

    /// Takes the numbers of some records; `scratch` is for whatever is needed meanwhile.
    pub(super) fn take(&mut self, records: &Records, scratch: &mut Vec<u8>) -> io::Result<()> {
        let samples = &mut self.values.samples;
        match self.kept {
            true => grow(samples, records.count, self.all)?,
            false => samples.clear(),
        }
        let before = samples.len();
        match self.content.numbers {
            Numbers::Stored(bits) => {
                bits.decode(records.bytes, records.size, scratch, &mut self.values);
            }
            Numbers::Counted => {
                let counts = records.before..records.before + records.count as u64;
                samples.extend(counts.map(|count| count as f64));
            }
        }
        let new = &mut self.values.samples[before..];
        self.content.conversion.apply(new);
        if let (Some(bit), Some(invalid)) = (self.content.invalid, records.invalid) {
            invalid.blank(bit, new);
        }
        if !self.kept {
            new.iter().for_each(|&value| self.passed.see(value));
        }
        Ok(())
    }
}

impl Invalid<'_> {
    /// Makes values missing whose bit is set.
    fn blank(&self, bit: u32, values: &mut [f64]) {
        let at = self.from + bit as usize / 8;
        for (value, bytes) in values.iter_mut().zip(self.bytes.chunks_exact(self.size)) {
            if bytes[at] >> (bit % 8) & 1 == 1 {
                *value = f64::NAN;
            }
        }
    }
}
