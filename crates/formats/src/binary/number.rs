//! Numbers as they lie in a file, turned into `f64` without changing a bit where `f64` can hold them.

use std::io::{self, Read};

/// Which end of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ByteOrder {
    Little,
    Big,
}

/// What the bits of a number mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    Signed,
    Unsigned,
    Float,
    /// One byte, any bit pattern but zero is true.
    Bool,
}

/// A number format: meaning, width and byte order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number {
    class: Class,
    width: usize,
    order: ByteOrder,
}

/// Decoded samples, and whether an integer among them was too large for `f64` to hold exactly.
#[derive(Debug, Default)]
pub(crate) struct Values {
    pub(crate) samples: Vec<f64>,
    pub(crate) rounded: bool,
}

impl Number {
    /// A format that this crate can decode; `None` for the others (an 80-bit float, say).
    pub(crate) fn new(class: Class, width: usize, order: ByteOrder) -> Option<Self> {
        let known = match class {
            Class::Signed | Class::Unsigned => matches!(width, 1 | 2 | 4 | 8),
            Class::Float => matches!(width, 2 | 4 | 8),
            Class::Bool => width == 1,
        };
        known.then_some(Self {
            class,
            width,
            order,
        })
    }

    /// Bytes of one number.
    pub(crate) fn width(self) -> usize {
        self.width
    }

    /// Decodes whole numbers from `bytes`, whose length is a multiple of the width.
    pub(crate) fn decode(self, bytes: &[u8], out: &mut Values) {
        match (self.class, self.width) {
            (Class::Signed, 1) => self.plain(bytes, out, |[b]| f64::from(b as i8)),
            (Class::Signed, 2) => self.plain(bytes, out, |b| f64::from(i16::from_le_bytes(b))),
            (Class::Signed, 4) => self.plain(bytes, out, |b| f64::from(i32::from_le_bytes(b))),
            (Class::Signed, _) => self.wide(bytes, out, |b| {
                let integer = i64::from_le_bytes(b);
                let real = integer as f64;
                (real, real as i128 != i128::from(integer))
            }),
            (Class::Unsigned, 1) => self.plain(bytes, out, |[b]| f64::from(b)),
            (Class::Unsigned, 2) => self.plain(bytes, out, |b| f64::from(u16::from_le_bytes(b))),
            (Class::Unsigned, 4) => self.plain(bytes, out, |b| f64::from(u32::from_le_bytes(b))),
            (Class::Unsigned, _) => self.wide(bytes, out, |b| {
                let integer = u64::from_le_bytes(b);
                let real = integer as f64;
                (real, real as i128 != i128::from(integer))
            }),
            (Class::Float, 2) => self.plain(bytes, out, |b| half(u16::from_le_bytes(b))),
            (Class::Float, 4) => self.plain(bytes, out, |b| f64::from(f32::from_le_bytes(b))),
            (Class::Float, _) => self.plain(bytes, out, f64::from_le_bytes),
            (Class::Bool, _) => self.plain(bytes, out, |[b]| f64::from(u8::from(b != 0))),
        }
    }

    fn plain<const N: usize>(self, bytes: &[u8], out: &mut Values, to: impl Fn([u8; N]) -> f64) {
        let (chunks, _) = bytes.as_chunks::<N>();
        out.samples
            .extend(chunks.iter().map(|&chunk| to(self.little(chunk))));
    }

    fn wide(self, bytes: &[u8], out: &mut Values, to: impl Fn([u8; 8]) -> (f64, bool)) {
        let (chunks, _) = bytes.as_chunks::<8>();
        for &chunk in chunks {
            let (real, rounded) = to(self.little(chunk));
            out.samples.push(real);
            out.rounded |= rounded;
        }
    }

    fn little<const N: usize>(self, mut chunk: [u8; N]) -> [u8; N] {
        if self.order == ByteOrder::Big {
            chunk.reverse();
        }
        chunk
    }
}

/// IEEE 754 half precision, exact in `f64`.
pub(crate) fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let fraction = f64::from(bits & 0x3ff);
    match i32::from(bits >> 10 & 0x1f) {
        0 => sign * fraction * f64::from_bits((1023 - 24) << 52),
        31 if fraction == 0.0 => sign * f64::INFINITY,
        31 => f64::NAN.copysign(sign),
        exponent => {
            let scale = f64::from_bits(((1023 - 25 + exponent) as u64) << 52);
            sign * (1024.0 + fraction) * scale
        }
    }
}

/// A decimal number of so many places, at most 38: correctly rounded up to 2^53 and 22 places, both operands being exact; else
/// within 1 in 2^52.
pub(crate) fn decimal(integer: i128, scale: u32) -> f64 {
    integer as f64 / 10u128.pow(scale) as f64
}

/// Reads `count` numbers; memory grows with the bytes that really arrive, not with `count`.
pub(crate) fn read_numbers(
    reader: &mut (impl Read + ?Sized),
    number: Number,
    count: u64,
    out: &mut Values,
) -> io::Result<()> {
    // 64 KiB of doubles: large enough that the calls do not count, small enough for the cache.
    const BATCH_NUMBERS: usize = 8192;
    let mut buffer = vec![0; count.min(BATCH_NUMBERS as u64) as usize * number.width()];
    let mut left = count;
    while left > 0 {
        let now = left.min(BATCH_NUMBERS as u64) as usize;
        let bytes = &mut buffer[..now * number.width()];
        reader.read_exact(bytes)?;
        number.decode(bytes, out);
        left -= now as u64;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(class: Class, order: ByteOrder, bytes: &[u8]) -> (f64, bool) {
        let mut out = Values::default();
        let number = Number::new(class, bytes.len(), order).unwrap();
        number.decode(bytes, &mut out);
        assert_eq!(out.samples.len(), 1);
        (out.samples[0], out.rounded)
    }

    #[test]
    fn both_byte_orders_and_signs() {
        use ByteOrder::{Big, Little};
        assert_eq!(one(Class::Signed, Little, &[0xfe, 0xff]).0, -2.0);
        assert_eq!(one(Class::Signed, Big, &[0xff, 0xfe]).0, -2.0);
        assert_eq!(one(Class::Unsigned, Big, &[0x01, 0x00]).0, 256.0);
        assert_eq!(one(Class::Bool, Little, &[7]).0, 1.0);
        assert_eq!(one(Class::Float, Big, &1.5f64.to_be_bytes()).0, 1.5);
    }

    #[test]
    fn integers_that_do_not_fit_are_told() {
        let limit = 1i64 << 53;
        assert!(!one(Class::Signed, ByteOrder::Little, &limit.to_le_bytes()).1);
        assert!(one(Class::Signed, ByteOrder::Little, &(limit + 1).to_le_bytes()).1);
        assert!(one(Class::Unsigned, ByteOrder::Little, &u64::MAX.to_le_bytes()).1);
        assert!(!one(Class::Signed, ByteOrder::Little, &i64::MIN.to_le_bytes()).1);
        assert!(one(Class::Signed, ByteOrder::Little, &i64::MAX.to_le_bytes()).1);
    }

    #[test]
    fn halves_from_the_standard() {
        // IEEE 754-2019, binary16: largest, smallest normal, smallest subnormal.
        assert_eq!(half(0x7bff), 65504.0);
        assert_eq!(half(0x0400), 2f64.powi(-14));
        assert_eq!(half(0x0001), 2f64.powi(-24));
        assert_eq!(half(0xc000), -2.0);
        assert_eq!(half(0xfc00), f64::NEG_INFINITY);
        assert!(half(0x7e00).is_nan());
        assert_eq!(half(0x8000).to_bits(), (-0.0f64).to_bits());
    }
}
