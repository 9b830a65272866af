//! FlatBuffers, as far as Arrow's metadata needs them: every offset is checked, none is followed twice by itself.
//!
//! Layout: "FlatBuffer Internals", <https://flatbuffers.dev/internals/>. A table begins with the distance back to its vtable,
//! which has, for each field, the distance from the table to its value, or 0 where it has its default.

/// A table in a buffer. Reading what lies outside of the buffer gives `None`.
#[derive(Clone, Copy)]
pub(super) struct Table<'a> {
    bytes: &'a [u8],
    at: usize,
}

/// A vector in a buffer: where its elements begin, and how many there are.
#[derive(Clone, Copy)]
pub(super) struct Vector<'a> {
    bytes: &'a [u8],
    at: usize,
    pub(super) len: usize,
}

fn array<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..)?.first_chunk().copied()
}

fn word(bytes: &[u8], at: usize) -> Option<usize> {
    array(bytes, at).map(|word| u32::from_le_bytes(word) as usize)
}

/// Where the offset that stands here leads.
fn follow(bytes: &[u8], at: usize) -> Option<usize> {
    at.checked_add(word(bytes, at)?)
        .filter(|&to| to < bytes.len())
}

impl<'a> Table<'a> {
    /// The table that the buffer is of.
    pub(super) fn root(bytes: &'a [u8]) -> Option<Self> {
        let at = follow(bytes, 0)?;
        Some(Self { bytes, at })
    }

    /// Where the value of a field stands; `Some(None)` where it has its default.
    fn place(self, field: usize) -> Option<Option<usize>> {
        let back = i32::from_le_bytes(array(self.bytes, self.at)?);
        let vtable = usize::try_from(i64::try_from(self.at).ok()? - i64::from(back)).ok()?;
        let half = |at| array(self.bytes, at).map(|half| usize::from(u16::from_le_bytes(half)));
        let length = half(vtable)?;
        let entry = 4 + 2 * field;
        if entry + 2 > length {
            return Some(None);
        }
        Some(match half(vtable + entry)? {
            0 => None,
            distance => Some(self.at.checked_add(distance)?),
        })
    }

    pub(super) fn byte(self, field: usize) -> Option<u8> {
        match self.place(field)? {
            None => Some(0),
            Some(at) => self.bytes.get(at).copied(),
        }
    }

    pub(super) fn short(self, field: usize, default: i16) -> Option<i16> {
        match self.place(field)? {
            None => Some(default),
            Some(at) => array(self.bytes, at).map(i16::from_le_bytes),
        }
    }

    pub(super) fn int(self, field: usize, default: i32) -> Option<i32> {
        match self.place(field)? {
            None => Some(default),
            Some(at) => array(self.bytes, at).map(i32::from_le_bytes),
        }
    }

    pub(super) fn long(self, field: usize) -> Option<i64> {
        match self.place(field)? {
            None => Some(0),
            Some(at) => array(self.bytes, at).map(i64::from_le_bytes),
        }
    }

    /// A table; `Some(None)` where there is none.
    pub(super) fn table(self, field: usize) -> Option<Option<Table<'a>>> {
        let Some(at) = self.place(field)? else {
            return Some(None);
        };
        let at = follow(self.bytes, at)?;
        Some(Some(Table {
            bytes: self.bytes,
            at,
        }))
    }

    /// A vector of elements of this many bytes; an empty one where there is none.
    pub(super) fn vector(self, field: usize, width: usize) -> Option<Vector<'a>> {
        let bytes = self.bytes;
        let Some(at) = self.place(field)? else {
            return Some(Vector {
                bytes,
                at: 0,
                len: 0,
            });
        };
        let at = follow(bytes, at)?;
        let (len, at) = (word(bytes, at)?, at + 4);
        let end = len.checked_mul(width)?.checked_add(at)?;
        (end <= bytes.len()).then_some(Vector { bytes, at, len })
    }

    pub(super) fn text(self, field: usize) -> Option<String> {
        let text = self.vector(field, 1)?;
        let bytes = self.bytes.get(text.at..text.at + text.len)?;
        Some(String::from_utf8_lossy(bytes).into_owned())
    }
}

impl<'a> Vector<'a> {
    /// A table of a vector of tables.
    pub(super) fn table(self, index: usize) -> Option<Table<'a>> {
        let at = follow(self.bytes, self.at + 4 * index)?;
        Some(Table {
            bytes: self.bytes,
            at,
        })
    }

    /// A number of a vector of such.
    pub(super) fn long(self, index: usize) -> Option<i64> {
        (index < self.len).then_some(())?;
        array(self.bytes, self.at + 8 * index).map(i64::from_le_bytes)
    }

    /// The two numbers of a structure in a vector of such.
    pub(super) fn pair(self, index: usize) -> Option<(i64, i64)> {
        let at = self.at + 16 * index;
        let number = |at| array(self.bytes, at).map(i64::from_le_bytes);
        (index < self.len).then_some(())?;
        Some((number(at)?, number(at + 8)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_outside_of_the_buffer_is_read() {
        for bytes in [
            &[][..],
            &[4],
            &[4, 0, 0, 0],
            &[255; 16],
            &[4, 0, 0, 0, 255, 255, 255, 127, 0],
        ] {
            let table = Table::root(bytes);
            assert!(table.and_then(|table| table.byte(0)).is_none(), "{bytes:?}");
        }
        // A table at 8 with a vtable at 4 that has no field, and one whose vtable has one at 100.
        let none = [8, 0, 0, 0, 4, 0, 4, 0, 4, 0, 0, 0];
        assert_eq!(Table::root(&none).unwrap().int(0, 7), Some(7));
        let far = [10, 0, 0, 0, 6, 0, 4, 0, 100, 0, 6, 0, 0, 0];
        assert!(Table::root(&far).unwrap().int(0, 7).is_none());
        assert!(Table::root(&far).unwrap().vector(0, 8).is_none());
    }
}
