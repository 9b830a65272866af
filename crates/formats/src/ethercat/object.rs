//! Objects of CiA 402 (IEC 61800-7-201) that drives send in their process data: names, types and usual units.

use super::{Direction, Type};

/// An object of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Object {
    /// Its index, such as 6064h.
    pub index: u16,
    /// What its column is called.
    pub name: &'static str,
    /// The type of its number.
    pub kind: Type,
    /// The unit that drives use where nobody set another one.
    pub unit: Option<&'static str>,
    /// Whether the drive sends or gets it.
    pub direction: Direction,
}

/// Increments of the encoder, and thousandths of the rated torque or current.
const COUNTS: Option<&str> = Some("counts");
const COUNTS_A_SECOND: Option<&str> = Some("counts/s");
const THOUSANDTHS: Option<&str> = Some("0.1%");

const fn sent(index: u16, name: &'static str, kind: Type, unit: Option<&'static str>) -> Object {
    Object {
        index,
        name,
        kind,
        unit,
        direction: Direction::In,
    }
}

const fn got(index: u16, name: &'static str, kind: Type, unit: Option<&'static str>) -> Object {
    Object {
        direction: Direction::Out,
        ..sent(index, name, kind, unit)
    }
}

const OBJECTS: [Object; 24] = [
    sent(0x603f, "Error code", Type::U16, None),
    got(0x6040, "Controlword", Type::U16, None),
    sent(0x6041, "Statusword", Type::U16, None),
    got(0x6060, "Modes of operation", Type::I8, None),
    sent(0x6061, "Modes of operation display", Type::I8, None),
    sent(0x6062, "Position demand value", Type::I32, COUNTS),
    sent(0x6063, "Position actual internal value", Type::I32, COUNTS),
    sent(0x6064, "Position actual value", Type::I32, COUNTS),
    sent(0x606b, "Velocity demand value", Type::I32, COUNTS_A_SECOND),
    sent(0x606c, "Velocity actual value", Type::I32, COUNTS_A_SECOND),
    got(0x6071, "Target torque", Type::I16, THOUSANDTHS),
    got(0x6072, "Max torque", Type::U16, THOUSANDTHS),
    sent(0x6074, "Torque demand", Type::I16, THOUSANDTHS),
    sent(0x6077, "Torque actual value", Type::I16, THOUSANDTHS),
    sent(0x6078, "Current actual value", Type::I16, THOUSANDTHS),
    sent(0x6079, "DC link circuit voltage", Type::U32, Some("mV")),
    got(0x607a, "Target position", Type::I32, COUNTS),
    got(0x60b0, "Position offset", Type::I32, COUNTS),
    got(0x60b1, "Velocity offset", Type::I32, COUNTS_A_SECOND),
    got(0x60b2, "Torque offset", Type::I16, THOUSANDTHS),
    sent(0x60f4, "Following error actual value", Type::I32, COUNTS),
    sent(0x60fd, "Digital inputs", Type::U32, None),
    got(0x60fe, "Digital outputs", Type::U32, None),
    got(0x60ff, "Target velocity", Type::I32, COUNTS_A_SECOND),
];

/// The object of an index; those of a drive's further axes are 800h apart.
pub fn object(index: u16) -> Option<Object> {
    let first = match index {
        0x6000..0xa000 => 0x6000 + (index - 0x6000) % 0x800,
        other => other,
    };
    let mut objects = OBJECTS.into_iter();
    objects.find(|object| object.index == first)
}

/// The object of a name as descriptions of drives write it.
pub(super) fn named(name: &str) -> Option<Object> {
    let mut objects = OBJECTS.into_iter();
    objects.find(|object| object.name.eq_ignore_ascii_case(name.trim()))
}
