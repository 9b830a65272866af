//! All that is ever sent to a PLC.

use super::symbol::{NetId, Place};

/// A request. None of them writes: the only ReadWrite is the look-up of a symbol.
pub(super) enum Request<'a> {
    /// Where a symbol is and what it holds: ReadWrite of the index group that gives it by name.
    LookUp(&'a str),
    /// Notifications of a place, each cycle of that many 100 ns.
    Notify { place: &'a Place, cycle: u32 },
    /// No more notifications of a handle.
    Forget(u32),
}

/// Index group that gives group, offset, size and type of a symbol by its name.
const INFO_BY_NAME: u32 = 0xF009;
/// Most bytes of an answer about a symbol: numbers, name, type and comment.
const MOST_INFO: u32 = 0x1000;
/// A notification each cycle, whether the value changed or not.
const EACH_CYCLE: u32 = 3;
/// Longest time that the device gathers notifications, 100 ns.
const GATHERED: u32 = 500_000;

impl Request<'_> {
    /// Number of the command.
    pub fn command(&self) -> u16 {
        match self {
            Request::LookUp(_) => 9,
            Request::Notify { .. } => 6,
            Request::Forget(_) => 7,
        }
    }

    fn data(&self) -> Vec<u8> {
        let numbers = |numbers: &[u32]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        match self {
            Request::LookUp(name) => {
                let length = name.len() as u32;
                let mut data: Vec<u8> = numbers(&[INFO_BY_NAME, 0, MOST_INFO, length]);
                data.extend_from_slice(name.as_bytes());
                data
            }
            Request::Notify { place, cycle } => {
                let (group, offset, size) = (place.group, place.offset, place.size());
                let mut data: Vec<u8> =
                    numbers(&[group, offset, size, EACH_CYCLE, GATHERED, *cycle]);
                data.extend_from_slice(&[0; 16]);
                data
            }
            Request::Forget(handle) => numbers(&[*handle]),
        }
    }
}

/// The two ends of a connection; counts the requests.
pub(super) struct Addresses {
    pub own: NetId,
    own_port: u16,
    target: (NetId, u16),
    id: u32,
}

impl Addresses {
    pub fn new((own, own_port): (NetId, u16), target: (NetId, u16)) -> Self {
        Self {
            own,
            own_port,
            target,
            id: 0,
        }
    }

    /// A request as it is sent, and its number.
    pub fn packet(&mut self, request: &Request) -> (Vec<u8>, u32) {
        self.id = self.id.wrapping_add(1);
        let data = request.data();
        let header = [
            &[0, 0],
            &(32 + data.len() as u32).to_le_bytes()[..],
            &self.target.0.0,
            &self.target.1.to_le_bytes(),
            &self.own.0,
            &self.own_port.to_le_bytes(),
            &request.command().to_le_bytes(),
            // An ADS command over TCP.
            &4_u16.to_le_bytes(),
            &(data.len() as u32).to_le_bytes(),
            &0_u32.to_le_bytes(),
            &self.id.to_le_bytes(),
            &data,
        ];
        (header.concat(), self.id)
    }
}
