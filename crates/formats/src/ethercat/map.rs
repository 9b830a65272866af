//! Which bytes of which datagram are a column.

/// The process data of a capture that become columns, in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProcessData {
    /// A column each; none leaves the capture unread.
    pub entries: Vec<Entry>,
}

/// One number of the process data.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// What its column is called.
    pub name: String,
    /// The unit of the number.
    pub unit: Option<String>,
    /// Where its datagram begins; `None` for the only one that goes its way.
    pub address: Option<Address>,
    /// The byte of the datagram's data in which it begins, from 0.
    pub byte: usize,
    /// The bit of that byte, 0 to 7.
    pub bit: u8,
    /// Its type; little-endian as everything in EtherCAT.
    pub kind: Type,
    /// Which way it goes.
    pub direction: Direction,
}

/// Where a datagram reads or writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Address {
    /// In the logical memory of the network.
    Logical(u32),
    /// In the memory of one slave.
    Physical {
        /// The configured address of the slave.
        station: u16,
        /// The place in its memory.
        offset: u16,
    },
}

/// Which way process data goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From a slave to the master.
    In,
    /// From the master to a slave.
    Out,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// One bit.
    Bool,
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 32 bits.
    I32,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 64 bits.
    I64,
    /// Unsigned, 64 bits.
    U64,
    /// Floating point, 32 bits.
    F32,
    /// Floating point, 64 bits.
    F64,
}

impl Type {
    /// All of them with the words that an axis file and, behind it, IEC 61131-3 have for them.
    pub const ALL: [(Type, &'static str, &'static [&'static str]); 11] = [
        (Type::Bool, "bool", &["BOOL", "BIT"]),
        (Type::I8, "i8", &["SINT"]),
        (Type::U8, "u8", &["USINT", "BYTE", "BITARR8"]),
        (Type::I16, "i16", &["INT"]),
        (Type::U16, "u16", &["UINT", "WORD", "BITARR16"]),
        (Type::I32, "i32", &["DINT"]),
        (Type::U32, "u32", &["UDINT", "DWORD", "BITARR32"]),
        (Type::I64, "i64", &["LINT"]),
        (Type::U64, "u64", &["ULINT", "LWORD"]),
        (Type::F32, "f32", &["REAL"]),
        (Type::F64, "f64", &["LREAL"]),
    ];

    /// The type that an axis file calls so.
    pub fn named(word: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|(_, name, _)| *name == word)
            .map(|(kind, ..)| kind)
    }

    /// What an axis file calls it.
    pub fn word(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// Its bits.
    pub fn bits(self) -> usize {
        match self {
            Type::Bool => 1,
            Type::I8 | Type::U8 => 8,
            Type::I16 | Type::U16 => 16,
            Type::I32 | Type::U32 | Type::F32 => 32,
            Type::I64 | Type::U64 | Type::F64 => 64,
        }
    }
}

impl Entry {
    /// Bytes that a datagram has at least.
    pub(super) fn end(&self) -> usize {
        (8 * self.byte + usize::from(self.bit) + self.kind.bits()).div_ceil(8)
    }

    /// Its number in the data of its datagram, which is long enough, and whether `f64` cannot hold it.
    pub(super) fn number(&self, data: &[u8]) -> (f64, bool) {
        let bytes = data.get(self.byte..self.end()).unwrap_or_default();
        let mut all = [0; 16];
        all[..bytes.len()].copy_from_slice(bytes);
        let bits = u128::from_le_bytes(all) >> self.bit;
        let bits = (bits & ((1 << self.kind.bits()) - 1)) as u64;
        let whole = |integer: i128| (integer as f64, integer as f64 as i128 != integer);
        match self.kind {
            Type::I8 => whole(i128::from(bits as i8)),
            Type::I16 => whole(i128::from(bits as i16)),
            Type::I32 => whole(i128::from(bits as i32)),
            Type::I64 => whole(i128::from(bits as i64)),
            Type::F32 => (f64::from(f32::from_bits(bits as u32)), false),
            Type::F64 => (f64::from_bits(bits), false),
            _ => whole(i128::from(bits)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_begin_in_any_bit() {
        let entry = |byte, bit, kind| Entry {
            name: String::new(),
            unit: None,
            address: None,
            byte,
            bit,
            kind,
            direction: Direction::In,
        };
        // -2 of 64 bits, from the third bit on.
        let data: Vec<u8> = (((-2_i64 as u64 as u128) << 3) | 5).to_le_bytes()[..9].to_vec();
        assert_eq!(entry(0, 3, Type::I64).end(), 9);
        assert_eq!(entry(0, 3, Type::I64).number(&data), (-2.0, false));
        assert_eq!(entry(0, 2, Type::Bool).number(&data), (1.0, false));
        assert_eq!(entry(0, 1, Type::Bool).number(&data), (0.0, false));
        assert!(entry(0, 3, Type::U64).number(&data).1);
        let words = Type::ALL.iter().enumerate();
        assert!(
            words
                .into_iter()
                .all(|(n, (kind, word, _))| *kind as usize == n && kind.word() == *word)
        );
    }
}
