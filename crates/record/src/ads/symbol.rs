//! Names, places and values of variables.

use super::packet::u32_at;
use crate::source::Column;
use std::fmt;
use std::net::Ipv4Addr;

/// Address of an AMS router: six numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NetId(pub [u8; 6]);

impl NetId {
    /// Reads `5.12.34.56.1.1`.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let numbers: Result<Vec<u8>, _> = text.split('.').map(str::parse).collect();
        numbers.ok()?.try_into().ok().map(Self)
    }

    /// The address of its first four numbers, by convention that of the host.
    pub(crate) fn host(self) -> String {
        let [a, b, c, d, ..] = self.0;
        Ipv4Addr::new(a, b, c, d).to_string()
    }

    /// The usual one of a host.
    pub(crate) fn of_host(host: Ipv4Addr) -> Self {
        let [a, b, c, d] = host.octets();
        Self([a, b, c, d, 1, 1])
    }
}

impl fmt::Display for NetId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers: Vec<String> = self.0.iter().map(u8::to_string).collect();
        f.write_str(&numbers.join("."))
    }
}

/// A variable by its name in the PLC, and its unit where it was given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Name, such as `MAIN.axis.NcToPlc.ActPos`.
    pub name: String,
    /// Unit.
    pub unit: Option<String>,
}

/// Longest name, bytes.
const LONGEST: usize = 1000;

impl Symbol {
    /// Reads `NAME` or `NAME=UNIT`.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let (name, unit) = match text.split_once('=') {
            Some((name, unit)) => (name, Some(unit.to_string())),
            None => (text, None),
        };
        let is_plain = |text: &str| !text.is_empty() && !text.chars().any(char::is_control);
        let fits = is_plain(name) && name.len() <= LONGEST && !name.contains("://");
        let unit_fits = unit
            .as_ref()
            .is_none_or(|unit| is_plain(unit) && unit.len() <= 40);
        (fits && unit_fits).then(|| Self {
            name: name.into(),
            unit,
        })
    }

    /// Its column: `a[1,2]` is written `a[1][2]`, since what else stands in brackets at the end is a unit.
    pub(crate) fn column(&self) -> Column {
        Column {
            name: self.name.replace(',', "]["),
            unit: self.unit.clone(),
        }
    }
}

/// Kinds of numbers: ADST number, size in bytes.
const KINDS: [(u32, u32, Kind); 11] = [
    (2, 2, |b| Some(i16::from_le_bytes(*b.as_array()?).into())),
    (3, 4, |b| Some(i32::from_le_bytes(*b.as_array()?).into())),
    (4, 4, |b| Some(f32::from_le_bytes(*b.as_array()?).into())),
    (5, 8, |b| Some(f64::from_le_bytes(*b.as_array()?))),
    (16, 1, |b| Some(i8::from_le_bytes(*b.as_array()?).into())),
    (17, 1, |b| Some(u8::from_le_bytes(*b.as_array()?).into())),
    (18, 2, |b| Some(u16::from_le_bytes(*b.as_array()?).into())),
    (19, 4, |b| Some(u32::from_le_bytes(*b.as_array()?).into())),
    // Beyond 2^53 rounded, as in every log.
    (20, 8, |b| Some(i64::from_le_bytes(*b.as_array()?) as f64)),
    (21, 8, |b| Some(u64::from_le_bytes(*b.as_array()?) as f64)),
    (33, 1, |b| Some(u8::from_le_bytes(*b.as_array()?).into())),
];

/// A value from its bytes; `None` where they are too few or too many.
type Kind = fn(&[u8]) -> Option<f64>;

/// Where a variable is, and what it holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub group: u32,
    pub offset: u32,
    size: u32,
    kind: Kind,
}

impl Place {
    /// Reads the answer to a look-up, behind its result.
    pub fn read(answer: &[u8]) -> Result<Self, &'static str> {
        const SHORT: &str = "is described by too few bytes";
        // Length of the answer, length of the entry, then the entry.
        let at = |number: usize| u32_at(answer, 4 + 4 * number).ok_or(SHORT);
        let (group, offset, size, kind) = (at(1)?, at(2)?, at(3)?, at(4)?);
        let of_kind = |own: &&(u32, u32, Kind)| own.0 == kind && own.1 == size;
        match KINDS.iter().find(of_kind) {
            Some((_, _, kind)) => Ok(Self {
                group,
                offset,
                size,
                kind: *kind,
            }),
            None => Err("is no number; name a number, an element or a member"),
        }
    }

    pub fn size(&self) -> u32 {
        self.size
    }

    pub fn value(&self, bytes: &[u8]) -> Option<f64> {
        (self.kind)(bytes)
    }
}

/// What an error code means and asks for.
pub(super) fn remedy(code: u32) -> &'static str {
    match code {
        0x6 => {
            "no PLC answers at this AMS port; 851 is that of the first PLC project, 501 that of NC"
        }
        0x7 => "the NetId is not known there; check it, and the AMS routes of both sides",
        0x707 | 0x712 => "the PLC is not ready; start its program",
        0x70C | 0x710 => "there is no such symbol; check name, project and AMS port",
        0x716 => "the device has no notification left; record fewer symbols",
        0x723 => "access is denied",
        _ => "refused",
    }
}
