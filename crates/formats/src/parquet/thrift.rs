//! The part of Thrift's compact protocol that is needed to check sizes before memory is allocated for them.

/// Most items of one list; a recording has far fewer columns, row groups or page statistics.
const MAX_ITEMS: u64 = 65_536;

/// Deepest nesting of structs.
const MAX_DEPTH: usize = 32;

/// Wire types that the scan distinguishes; those of a flag are its value.
pub(super) const YES: u8 = 1;
pub(super) const NO: u8 = 2;
pub(super) const I32: u8 = 5;
pub(super) const LIST: u8 = 9;
pub(super) const STRUCT: u8 = 12;

/// Reads values one after the other; `None` is a broken or extravagant encoding.
pub(super) struct Compact<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Compact<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    /// Bytes read so far.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    fn jump(&mut self, bytes: u64) -> Option<()> {
        let at = self.at.checked_add(usize::try_from(bytes).ok()?)?;
        self.at = at;
        (at <= self.bytes.len()).then_some(())
    }

    fn varint(&mut self) -> Option<u64> {
        let mut value = 0u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(value);
            }
        }
        None
    }

    /// A signed integer of any width.
    pub(super) fn integer(&mut self) -> Option<i64> {
        let value = self.varint()?;
        Some((value >> 1) as i64 ^ -((value & 1) as i64))
    }

    /// Number and wire type of the items of the list that starts here.
    pub(super) fn list(&mut self) -> Option<(u64, u8)> {
        let head = self.byte()?;
        let items = match head >> 4 {
            15 => self.varint()?,
            few => u64::from(few),
        };
        (items <= MAX_ITEMS).then_some((items, head & 15))
    }

    /// Reads a struct: `field` is given number and wire type of each field and either reads it
    /// (`Some(true)`) or leaves it alone (`Some(false)`).
    pub(super) fn structure(
        &mut self,
        depth: usize,
        mut field: impl FnMut(&mut Self, i64, u8) -> Option<bool>,
    ) -> Option<()> {
        let mut id = 0i64;
        loop {
            let head = self.byte()?;
            if head == 0 {
                return Some(());
            }
            id = match head >> 4 {
                0 => self.integer()?,
                step => id.checked_add(i64::from(step))?,
            };
            let kind = head & 15;
            if !field(self, id, kind)? {
                // The value of a boolean field is in its type.
                if !matches!(kind, YES | NO) {
                    self.skip(kind, depth)?;
                }
            }
        }
    }

    fn skip(&mut self, kind: u8, depth: usize) -> Option<()> {
        if depth > MAX_DEPTH {
            return None;
        }
        match kind {
            1..=3 => self.jump(1),
            4..=6 => self.varint().map(drop),
            7 => self.jump(8),
            8 => {
                let bytes = self.varint()?;
                self.jump(bytes)
            }
            9 | 10 => {
                let (items, kind) = self.list()?;
                (0..items).try_for_each(|_| self.skip(kind, depth + 1))
            }
            11 => {
                let items = self.varint().filter(|&items| items <= MAX_ITEMS)?;
                let kinds = if items > 0 { self.byte()? } else { 0 };
                (0..items).try_for_each(|_| {
                    self.skip(kinds >> 4, depth + 1)?;
                    self.skip(kinds & 15, depth + 1)
                })
            }
            12 => self.structure(depth + 1, |_, _, _| Some(false)),
            13 => self.jump(16),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_struct_with_fields_to_skip() {
        // 1: i32 = -2, 3: binary "ab", 4: list of two i32, 5: true, 6: i32 = 300, stop.
        let bytes = [
            0x15, 0x03, 0x28, 2, b'a', b'b', 0x19, 0x25, 2, 4, 0x11, 0x15, 0xd8, 0x04, 0,
        ];
        let mut seen = Vec::new();
        let mut compact = Compact::new(&bytes);
        let done = compact.structure(0, |compact, id, kind| {
            if kind != I32 {
                return Some(false);
            }
            seen.push((id, compact.integer()?));
            Some(true)
        });
        assert_eq!(done, Some(()));
        assert_eq!(seen, [(1, -2), (6, 300)]);
        assert_eq!(compact.at(), bytes.len());
    }

    #[test]
    fn extravagance_is_refused() {
        let deep = [0x1c; 100_000];
        let skip = |bytes| Compact::new(bytes).structure(0, |_, _, _| Some(false));
        assert_eq!(skip(&deep), None);
        let long_list = [0x19, 0xf1, 0xff, 0xff, 0xff, 0xff, 0x07];
        assert_eq!(skip(&long_list), None);
        assert_eq!(skip(&[0x18, 0xff]), None);
    }
}
