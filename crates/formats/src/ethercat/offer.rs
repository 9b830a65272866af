//! What a capture without a map is refused with: its cyclic datagrams, and lines of a map by the description of the network or the
//! drive beside it.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::map::{Address, Direction, Type};
use super::object::object;
use super::seen::Seen;
use super::xml;
use crate::regular::regular;
use crate::{Error, Kind, Limits};

/// Largest description that is read, bytes, and what is held for a byte of it.
const LARGEST: u64 = 16 << 20;
const HELD: u64 = 16;
/// Most descriptions beside a capture that are read.
const MOST_FILES: usize = 16;
/// Most entries that are offered.
pub(super) const MOST_OFFERED: usize = 64;

/// An entry of a map that is offered.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Offer {
    /// Its index where it is an object of CiA 402.
    pub(super) index: u16,
    pub(super) name: String,
    pub(super) kind: Type,
    pub(super) address: Address,
    /// From the beginning of the data of its datagram.
    pub(super) bit: usize,
    pub(super) direction: Direction,
}

impl Offer {
    /// `{ object = 0x6064, byte = 2 }`
    fn entry(&self) -> String {
        let known = object(self.index);
        let mut parts = Vec::new();
        if known.is_some() {
            parts.push(format!("object = 0x{:04x}", self.index));
        }
        if known.is_none_or(|known| known.name != self.name) {
            parts.push(format!("name = {:?}", self.name));
        }
        if known.is_none_or(|known| known.kind != self.kind) {
            parts.push(format!("type = \"{}\"", self.kind.word()));
        }
        match self.address {
            Address::Logical(address) => parts.push(format!("address = 0x{address:x}")),
            Address::Physical { station, offset } => {
                parts.push(format!("station = {station}, address = 0x{offset:x}"));
            }
        }
        parts.push(format!("byte = {}", self.bit / 8));
        if !self.bit.is_multiple_of(8) {
            parts.push(format!("bit = {}", self.bit % 8));
        }
        let usual = known.map_or(Direction::In, |known| known.direction);
        if self.direction != usual {
            let word = match self.direction {
                Direction::In => "in",
                Direction::Out => "out",
            };
            parts.push(format!("direction = \"{word}\""));
        }
        format!("{{ {} }}", parts.join(", "))
    }
}

/// The refusal of a capture without a map.
pub(super) fn refusal(seen: &Seen, path: &Path, limits: Limits) -> Error {
    let found = format!(
        "a capture of EtherCAT, and no map of its process data; its cyclic datagrams: {}",
        seen.listed()
    );
    let offered = descriptions(path).into_iter().find_map(|file| {
        let offers = xml::offers(&text(&file, limits)?, seen);
        (!offers.is_empty()).then_some((file, offers))
    });
    let allowed = match offered {
        Some((file, offers)) => {
            let name = file.file_name().unwrap_or_default().display().to_string();
            let entries: Vec<String> = offers.iter().map(Offer::entry).collect();
            format!(
                "by {name}, at the top of axis.toml: ethercat.map = [{}]",
                entries.join(", ")
            )
        }
        None => {
            let key = seen.at(None, Direction::In).into_iter().next();
            let address = match key.and_then(|key| key.address()) {
                Some(Address::Logical(address)) => format!("address = 0x{address:x}, "),
                _ => String::new(),
            };
            format!(
                "put the ENI or ESI file (.xml) of the network or drive beside the capture; or say at the top of axis.toml in which byte \
                 each object of the drive begins, such as ethercat.map = [{{ object = 0x6064, {address}byte = 2 }}, {{ object = 0x6077, \
                 {address}byte = 6 }}]"
            )
        }
    };
    Error::new(Kind::Missing, found, allowed).settled_by_line()
}

/// The files in the folder of a capture that may describe its network, in the order of their names.
fn descriptions(path: &Path) -> Vec<PathBuf> {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let entries = whole
        .parent()
        .and_then(|folder| std::fs::read_dir(folder).ok());
    let mut files: Vec<PathBuf> = (entries.into_iter().flatten().flatten())
        .map(|entry| entry.path())
        .filter(|file| {
            file.extension()
                .is_some_and(|end| end.eq_ignore_ascii_case("xml"))
        })
        .collect();
    files.sort();
    files.truncate(MOST_FILES);
    files
}

/// The text of a description that memory allows.
fn text(file: &Path, limits: Limits) -> Option<String> {
    let about = regular(file).ok()?;
    if about.len() > LARGEST.min(limits.memory / HELD) {
        return None;
    }
    let mut bytes = Vec::new();
    let read = File::open(file)
        .ok()?
        .take(about.len())
        .read_to_end(&mut bytes);
    read.ok()?;
    // Names may be in the encoding of a country.
    Some(
        String::from_utf8_lossy(&bytes)
            .trim_start_matches('\u{feff}')
            .to_owned(),
    )
}
