//! Numbers of a message in CDR, the encoding of DDS.
//!
//! Format: "DDS-XTypes 1.3", clause 7.4: four bytes say order and version, then every number lies at a multiple of its size
//! from there (of 4 at most in version 2). A text has its length with its final zero in front, a sequence its number of elements.

use crate::binary::{ByteOrder, Class, Number, Values};

/// What is left of a message.
pub(super) struct Cdr<'a> {
    bytes: &'a [u8],
    at: usize,
    order: ByteOrder,
    most: usize,
}

impl<'a> Cdr<'a> {
    /// A message whose first four bytes are of a kind that is read.
    pub(super) fn new(bytes: &'a [u8]) -> Option<Self> {
        let (&[_, kind, _, _], rest) = bytes.split_first_chunk::<4>()?;
        let (order, most) = match kind {
            0 => (ByteOrder::Big, 8),
            1 => (ByteOrder::Little, 8),
            6 => (ByteOrder::Big, 4),
            7 => (ByteOrder::Little, 4),
            _ => return None,
        };
        Some(Self {
            bytes: rest,
            at: 0,
            order,
            most,
        })
    }

    pub(super) fn left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    /// The next number, and whether it is an integer that `f64` cannot hold.
    pub(super) fn number(&mut self, class: Class, width: usize) -> Option<(f64, bool)> {
        let number = Number::new(class, width, self.order)?;
        let start = self.at.next_multiple_of(width.min(self.most));
        let bytes = self.bytes.get(start..)?.get(..width)?;
        self.at = start + width;
        let mut values = Values::default();
        number.decode(bytes, &mut values);
        Some((values.samples[0], values.rounded))
    }

    /// A count or the length of a text.
    pub(super) fn count(&mut self) -> Option<usize> {
        self.number(Class::Unsigned, 4)
            .map(|(count, _)| count as usize)
    }

    /// Nanoseconds of seconds and nanoseconds.
    pub(super) fn nanoseconds(&mut self) -> Option<i64> {
        let (seconds, _) = self.number(Class::Signed, 4)?;
        let (rest, _) = self.number(Class::Unsigned, 4)?;
        Some(seconds as i64 * 1_000_000_000 + rest as i64)
    }

    pub(super) fn text(&mut self, width: usize) -> Option<&'a [u8]> {
        let length = self.count()?.checked_mul(width)?;
        let text = self.bytes.get(self.at..)?.get(..length)?;
        self.at += length;
        Some(text.strip_suffix(&[0]).unwrap_or(text))
    }
}
