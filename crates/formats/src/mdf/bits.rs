//! Numbers in the bits of a record.

use crate::binary::{ByteOrder, Class, Number, Values};

/// Where in a record a number is, and how it is written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bits {
    /// Bytes before it.
    at: usize,
    /// Bytes that it has a part in.
    bytes: usize,
    how: How,
}

#[derive(Clone, Copy, Debug)]
enum How {
    /// In bytes of its own.
    Whole(Number),
    /// An integer among other bits, so many of them above those that are not its own.
    Among {
        signed: bool,
        order: ByteOrder,
        shift: u32,
        count: u32,
    },
}

impl Bits {
    /// Of a data type of a channel, so many bytes and bits from the start of the record; what it is where it is no number.
    pub(super) fn new(kind: u8, at: u32, shift: u8, count: u32) -> Result<Self, String> {
        let (class, order) = match kind {
            0 => (Class::Unsigned, ByteOrder::Little),
            1 => (Class::Unsigned, ByteOrder::Big),
            2 => (Class::Signed, ByteOrder::Little),
            3 => (Class::Signed, ByteOrder::Big),
            4 => (Class::Float, ByteOrder::Little),
            5 => (Class::Float, ByteOrder::Big),
            6..=9 => return Err("text".to_owned()),
            10..=12 => return Err("bytes".to_owned()),
            13 | 14 => return Err("dates of CANopen".to_owned()),
            15 | 16 => return Err("complex numbers".to_owned()),
            other => return Err(format!("values of the unknown type {other}")),
        };
        let whole = (shift == 0 && count.is_multiple_of(8))
            .then(|| Number::new(class, count as usize / 8, order))
            .flatten();
        let how = match whole {
            Some(number) => How::Whole(number),
            None if class == Class::Float => return Err(format!("floats of {count} bits")),
            None if !(1..=64).contains(&count) || shift > 7 => {
                return Err(format!("integers of {count} bits from bit {shift} on"));
            }
            None => How::Among {
                signed: class == Class::Signed,
                order,
                shift: u32::from(shift),
                count,
            },
        };
        Ok(Self {
            at: at as usize,
            bytes: (u32::from(shift) + count).div_ceil(8) as usize,
            how,
        })
    }

    /// Bytes that a record needs to hold it.
    pub(super) fn end(&self) -> u64 {
        self.at as u64 + self.bytes as u64
    }

    /// Appends the number of each record; `scratch` is for whatever is needed meanwhile.
    pub(super) fn decode(
        &self,
        records: &[u8],
        size: usize,
        scratch: &mut Vec<u8>,
        out: &mut Values,
    ) {
        match self.how {
            How::Whole(number) => {
                scratch.resize(records.len() / size * self.bytes, 0);
                match self.bytes {
                    1 => self.gather::<1>(records, size, scratch),
                    2 => self.gather::<2>(records, size, scratch),
                    4 => self.gather::<4>(records, size, scratch),
                    _ => self.gather::<8>(records, size, scratch),
                }
                number.decode(scratch, out);
            }
            How::Among {
                signed,
                order,
                shift,
                count,
            } => {
                for record in records.chunks_exact(size) {
                    let raw = self.raw(&record[self.at..][..self.bytes], order);
                    let (real, rounded) = integer(raw >> shift, count, signed);
                    out.samples.push(real);
                    out.rounded |= rounded;
                }
            }
        }
    }

    /// The bytes of each record, one after the other.
    fn gather<const N: usize>(&self, records: &[u8], size: usize, out: &mut [u8]) {
        let (out, _) = out.as_chunks_mut::<N>();
        for (to, record) in out.iter_mut().zip(records.chunks_exact(size)) {
            if let Some(own) = record[self.at..].first_chunk() {
                *to = *own;
            }
        }
    }

    /// The bytes as one number; at most nine of them.
    fn raw(&self, bytes: &[u8], order: ByteOrder) -> u128 {
        let add = |sum: u128, byte: &u8| sum << 8 | u128::from(*byte);
        match order {
            ByteOrder::Little => bytes.iter().rev().fold(0, add),
            ByteOrder::Big => bytes.iter().fold(0, add),
        }
    }
}

/// The lowest bits as an integer, and whether a float cannot hold it.
fn integer(raw: u128, count: u32, signed: bool) -> (f64, bool) {
    let above = 64 - count;
    let bits = (raw as u64) << above;
    if signed {
        let value = bits as i64 >> above;
        (value as f64, value as f64 as i128 != i128::from(value))
    } else {
        let value = bits >> above;
        (value as f64, value as f64 as u128 != u128::from(value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(kind: u8, shift: u8, count: u32, bytes: &[u8]) -> f64 {
        let bits = Bits::new(kind, 0, shift, count).unwrap();
        let mut out = Values::default();
        bits.decode(bytes, bytes.len(), &mut Vec::new(), &mut out);
        out.samples[0]
    }

    #[test]
    fn integers_of_any_width_in_both_byte_orders() {
        assert_eq!(read(0, 4, 12, &[0x30, 0x12]), f64::from(0x123));
        assert_eq!(read(1, 4, 12, &[0x12, 0x30]), f64::from(0x123));
        assert_eq!(read(2, 4, 12, &[0xf0, 0xff]), -1.0);
        assert_eq!(read(3, 1, 2, &[0b0000_0100]), -2.0);
        // Nine bytes, of which the outer ones have other bits too.
        assert_eq!(
            read(0, 7, 64, &[0x80, 0, 0, 0, 0, 0, 0, 0, 0x40]),
            2f64.powi(63) + 1.0
        );
        assert_eq!(
            read(
                2,
                7,
                64,
                &[0x80, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f]
            ),
            -1.0
        );
    }

    #[test]
    fn what_is_no_number_is_named() {
        for (kind, count, why) in [
            (4, 24, "floats of 24 bits"),
            (7, 8, "text"),
            (0, 65, "integers of 65 bits"),
            (2, 0, "integers of 0 bits"),
            (99, 8, "unknown type 99"),
        ] {
            let found = Bits::new(kind, 0, 0, count).unwrap_err();
            assert!(found.contains(why), "{found}");
        }
    }
}
