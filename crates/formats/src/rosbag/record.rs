//! Records of SQLite: the values of a row.

/// Where a value of a record lies, and what it is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    /// What SQLite calls the serial type; 0 is NULL.
    kind: u64,
    at: u64,
}

/// A number of one to nine bytes; of a negative one these are its bits.
pub(super) fn varint(bytes: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for index in 0..9 {
        let (&byte, rest) = bytes.split_first()?;
        *bytes = rest;
        if index == 8 {
            return Some(value << 8 | u64::from(byte));
        }
        value = value << 7 | u64::from(byte & 0x7f);
        if byte < 0x80 {
            break;
        }
    }
    Some(value)
}

/// Bytes of a value of this kind.
fn width(kind: u64) -> u64 {
    match kind {
        0 | 8..=11 => 0,
        1..=4 => kind,
        5 => 6,
        6 | 7 => 8,
        kind => (kind - 12) / 2,
    }
}

/// Where the values of these columns are in a record whose beginning is given; a column that it does not have is NULL. `None` where
/// the record is damaged or more of it is needed.
pub(super) fn places<const N: usize>(record: &[u8], columns: [usize; N]) -> Option<[Place; N]> {
    let mut rest = record;
    let length = varint(&mut rest)?;
    let mut head = record.get(..usize::try_from(length).ok()?)?;
    head = head.get(record.len() - rest.len()..)?;
    let mut places = [Place::default(); N];
    let (mut at, mut index) = (length, 0);
    while !head.is_empty() {
        let kind = varint(&mut head)?;
        for (place, _) in places.iter_mut().zip(columns).filter(|(_, c)| *c == index) {
            *place = Place { kind, at };
        }
        at = at.checked_add(width(kind))?;
        index += 1;
    }
    Some(places)
}

impl Place {
    fn of<'r>(&self, record: &'r [u8]) -> Option<&'r [u8]> {
        let rest = record.get(usize::try_from(self.at).ok()?..)?;
        rest.get(..usize::try_from(width(self.kind)).ok()?)
    }

    /// An integer; `None` where it is something else or lies outside of what is given of the record.
    pub(super) fn integer(&self, record: &[u8]) -> Option<i64> {
        match self.kind {
            1..=6 => {
                let bytes = self.of(record)?;
                let sign = if bytes[0] >= 0x80 { -1 } else { 0 };
                let join = |value: i64, byte: &u8| value << 8 | i64::from(*byte);
                Some(bytes.iter().fold(sign, join))
            }
            8 => Some(0),
            9 => Some(1),
            _ => None,
        }
    }

    /// A text.
    pub(super) fn text<'r>(&self, record: &'r [u8]) -> Option<&'r str> {
        match self.kind {
            kind if kind >= 13 && kind % 2 == 1 => std::str::from_utf8(self.of(record)?).ok(),
            _ => None,
        }
    }

    /// Bytes, or those of a text.
    pub(super) fn bytes<'r>(&self, record: &'r [u8]) -> Option<&'r [u8]> {
        match self.kind >= 12 {
            true => self.of(record),
            false => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_one_to_nine_bytes() {
        // As SQLite writes them.
        for (bytes, value) in [
            (&[0x7f][..], 127),
            (&[0x81, 0x00], 128),
            (&[0xff, 0x7f], 16_383),
            (&[0xff; 9], u64::MAX),
            (&[0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 1], 1),
        ] {
            let mut rest = bytes;
            assert_eq!(varint(&mut rest), Some(value));
            assert!(rest.is_empty());
        }
        assert_eq!(varint(&mut &[0x80, 0x80][..]), None);
    }

    #[test]
    fn values_by_their_column() {
        // NULL, 1, -2 in two bytes, -1 in six, "ab", a blob of one byte.
        let record = [
            7, 0, 9, 2, 5, 17, 14, 0xff, 0xfe, 255, 255, 255, 255, 255, 255, b'a', b'b', 7,
        ];
        let [null, one, minus, six, text, blob, none] =
            places(&record, [0, 1, 2, 3, 4, 5, 6]).unwrap();
        assert_eq!((null.kind, none.kind), (0, 0));
        let integers = [one, minus, six].map(|place| place.integer(&record));
        assert_eq!(integers, [Some(1), Some(-2), Some(-1)]);
        assert_eq!(text.text(&record), Some("ab"));
        assert_eq!(blob.bytes(&record), Some(&[7][..]));
        // What lies behind the part of a record that is given.
        assert_eq!(text.text(&record[..16]), None);
        assert!(places(&record[..5], [0]).is_none());
    }
}
