//! What the metadata of a segment say: objects, how their raw data lie, properties.

use crate::binary::{ByteOrder, Class, Number};

/// What is left of the metadata of a segment.
pub(super) struct Metadata<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) order: ByteOrder,
}

/// What the values of a channel are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Type {
    Number(Number),
    /// Seconds since 1904 and a fraction of 2^-64 s, 16 bytes.
    Stamp(ByteOrder),
    /// Not numbers, and what it is instead; so many bytes each.
    Other(&'static str, u64),
    /// Texts, whose bytes are told for all of them.
    Text,
}

impl Type {
    fn new(code: u32, order: ByteOrder) -> Option<Self> {
        let number = |class, width| Number::new(class, width, order).map(Type::Number);
        match code {
            1 => number(Class::Signed, 1),
            2 => number(Class::Signed, 2),
            3 => number(Class::Signed, 4),
            4 => number(Class::Signed, 8),
            5 => number(Class::Unsigned, 1),
            6 => number(Class::Unsigned, 2),
            7 => number(Class::Unsigned, 4),
            8 => number(Class::Unsigned, 8),
            9 | 0x19 => number(Class::Float, 4),
            10 | 0x1a => number(Class::Float, 8),
            0x20 => Some(Type::Text),
            0x21 => number(Class::Bool, 1),
            0x44 => Some(Type::Stamp(order)),
            0x08_000c => Some(Type::Other("complex numbers", 8)),
            0x10_000d => Some(Type::Other("complex numbers", 16)),
            _ => None,
        }
    }

    /// Bytes of one value; none for texts.
    pub(super) fn width(self) -> u64 {
        match self {
            Type::Number(number) => number.width() as u64,
            Type::Stamp(_) => 16,
            Type::Other(_, width) => width,
            Type::Text => 0,
        }
    }
}

/// How the raw data of an object lie in a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Index {
    None,
    /// As in the segment before.
    Same,
    /// In a form that only the driver of the card knows.
    DaqMx,
    /// So many values and bytes in each chunk.
    Plain(Type, u64, u64),
}

/// A property that matters here.
pub(super) enum Property {
    Number(f64),
    Text(String),
    Other,
}

impl Metadata<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.bytes.split_first_chunk()?;
        self.bytes = rest;
        let mut first = *first;
        if self.order == ByteOrder::Big {
            first.reverse();
        }
        Some(first)
    }

    pub(super) fn word(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub(super) fn long(&mut self) -> Option<u64> {
        self.take().map(u64::from_le_bytes)
    }

    pub(super) fn text(&mut self) -> Option<String> {
        let length = self.word()? as usize;
        let text = self.bytes.get(..length)?;
        self.bytes = &self.bytes[length..];
        Some(String::from_utf8_lossy(text).into_owned())
    }

    pub(super) fn index(&mut self) -> Option<Index> {
        Some(match self.word()? {
            u32::MAX => Index::None,
            0 => Index::Same,
            0x6912_0000 | 0x6913_0000 => Index::DaqMx,
            _ => {
                let kind = Type::new(self.word()?, self.order)?;
                let dimensions = self.word()?;
                let count = self.long()?;
                let bytes = match kind {
                    Type::Text => self.long()?,
                    kind => count.checked_mul(kind.width())?,
                };
                (dimensions == 1).then_some(Index::Plain(kind, count, bytes))?
            }
        })
    }

    /// A property: its name and value.
    pub(super) fn property(&mut self) -> Option<(String, Property)> {
        let name = self.text()?;
        let code = self.word()?;
        let value = match Type::new(code, self.order) {
            Some(Type::Text) => Property::Text(self.text()?),
            Some(Type::Number(number)) => {
                let (bytes, rest) = self.bytes.split_at_checked(number.width())?;
                self.bytes = rest;
                let mut values = crate::binary::Values::default();
                number.decode(bytes, &mut values);
                Property::Number(values.samples[0])
            }
            Some(other) => {
                self.bytes = self.bytes.get(other.width() as usize..)?;
                Property::Other
            }
            None if code == 0 => Property::Other,
            None => return None,
        };
        Some((name, value))
    }
}

/// Group and channel of the path `/'group'/'channel'`, in which quotes are doubled.
pub(super) fn parts(path: &str) -> Vec<String> {
    let mut parts = Vec::new();
    let mut rest = path;
    while let Some(inside) = rest.strip_prefix("/'") {
        let mut part = String::new();
        let mut letters = inside.char_indices().peekable();
        let mut end = inside.len();
        while let Some((at, letter)) = letters.next() {
            if letter == '\'' && letters.next_if(|(_, next)| *next == '\'').is_none() {
                end = at + 1;
                break;
            }
            part.push(letter);
        }
        parts.push(part);
        rest = &inside[end..];
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::parts;

    #[test]
    fn paths() {
        assert!(parts("/").is_empty());
        assert_eq!(parts("/'a b'"), ["a b"]);
        assert_eq!(parts("/'a''s'/'x/y'"), ["a's", "x/y"]);
        assert_eq!(parts("/'open"), ["open"]);
    }
}
