//! Numbers in a saved state, as the hexadecimal digits of their bits.
//!
//! Decimal text keeps neither infinities nor, in every reader, the last bit; a resumed search needs
//! both.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number, or a row of them.
pub trait Bits: Sized {
    /// Adds the digits to a text.
    fn write(&self, text: &mut String);
    /// The numbers of digits that [`Bits::write`] wrote; `None` where they are none.
    fn read(text: &str) -> Option<Self>;
}

impl Bits for f64 {
    fn write(&self, text: &mut String) {
        text.push_str(&format!("{:016x}", self.to_bits()));
    }

    fn read(text: &str) -> Option<Self> {
        let digits = text.len() == 16 && text.bytes().all(|c| c.is_ascii_hexdigit());
        digits
            .then(|| u64::from_str_radix(text, 16).ok())
            .flatten()
            .map(f64::from_bits)
    }
}

impl Bits for Vec<f64> {
    fn write(&self, text: &mut String) {
        for x in self {
            x.write(text);
        }
    }

    fn read(text: &str) -> Option<Self> {
        if !text.len().is_multiple_of(16) {
            return None;
        }
        (0..text.len() / 16)
            .map(|i| f64::read(text.get(16 * i..16 * (i + 1))?))
            .collect()
    }
}

impl Bits for Vec<[f64; 2]> {
    fn write(&self, text: &mut String) {
        for x in self.as_flattened() {
            x.write(text);
        }
    }

    fn read(text: &str) -> Option<Self> {
        let flat = Vec::<f64>::read(text)?;
        let (pairs, rest) = flat.as_chunks::<2>();
        rest.is_empty().then(|| pairs.to_vec())
    }
}

impl Bits for Option<f64> {
    fn write(&self, text: &mut String) {
        if let Some(x) = self {
            x.write(text);
        }
    }

    fn read(text: &str) -> Option<Self> {
        match text {
            "" => Some(None),
            _ => f64::read(text).map(Some),
        }
    }
}

/// For `#[serde(with = "bits")]`.
///
/// # Errors
/// Those of the format.
pub fn serialize<T: Bits, S: Serializer>(value: &T, to: S) -> Result<S::Ok, S::Error> {
    let mut text = String::new();
    value.write(&mut text);
    text.serialize(to)
}

/// For `#[serde(with = "bits")]`.
///
/// # Errors
/// Those of the format, and where there are other digits.
pub fn deserialize<'de, T: Bits, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
    let text = String::deserialize(from)?;
    T::read(&text).ok_or_else(|| D::Error::custom("not the bits of numbers: 16 digits 0-f each"))
}

#[cfg(test)]
mod tests {
    use super::Bits;

    #[test]
    fn every_number_survives() {
        let all = vec![0.0, -0.0, 1.0 / 3.0, f64::INFINITY, f64::MIN_POSITIVE / 8.0];
        let mut text = String::new();
        all.write(&mut text);
        let back = Vec::read(&text).expect("written above");
        assert_eq!(
            all.iter().map(|x: &f64| x.to_bits()).collect::<Vec<_>>(),
            back.iter().map(|x: &f64| x.to_bits()).collect::<Vec<_>>()
        );
        assert!(f64::read("3ff").is_none());
        assert!(f64::read("+ff0000000000000").is_none());
        assert!(Vec::<f64>::read("3ff000000000000\u{e4}").is_none());
    }
}
