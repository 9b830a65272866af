//! EtherCAT in an Ethernet frame: behind VLAN tags, in UDP, in Linux cooked captures; and the datagrams in it (IEC 61158-4-12).

/// Link types of captures.
const ETHERNET: u32 = 1;
const LINUX_COOKED: u32 = 113;
const LINUX_COOKED_2: u32 = 276;

/// EtherTypes.
const ETHERCAT: u16 = 0x88a4;
const IPV4: u16 = 0x0800;
const VLANS: [u16; 3] = [0x8100, 0x88a8, 0x9100];
/// Most VLAN tags of a frame.
const MOST_TAGS: usize = 4;
/// Protocol and port of EtherCAT in UDP.
const UDP: u8 = 17;
const PORT: u16 = 0x88a4;

/// The bit of a source address that the first slave sets.
const MARK: u8 = 0x02;

/// A datagram.
#[derive(Debug, PartialEq)]
pub(super) struct Datagram<'a> {
    /// `LRW` is 12.
    pub(super) command: u8,
    /// What the master tells its datagrams apart by.
    pub(super) index: u8,
    /// Logical, or station (lower half) and place in its memory.
    pub(super) address: u32,
    pub(super) data: &'a [u8],
    /// The working counter.
    pub(super) counter: u16,
}

/// The EtherCAT in a packet, and whether its source bears the mark of a slave; `None` of other packets, the link type where it is
/// not read.
pub(super) fn payload(link: u32, packet: &[u8]) -> Result<Option<(bool, &[u8])>, u32> {
    let [source, kind, start] = match link {
        ETHERNET => [6, 12, 14],
        LINUX_COOKED => [6, 14, 16],
        LINUX_COOKED_2 => [12, 0, 20],
        _ => return Err(link),
    };
    let found = || {
        let marked = packet.get(source)? & MARK != 0;
        let (mut kind, mut rest) = (big(packet, kind)?, packet.get(start..)?);
        for _ in 0..MOST_TAGS {
            if !VLANS.contains(&kind) {
                break;
            }
            (kind, rest) = (big(rest, 2)?, rest.get(4..)?);
        }
        match kind {
            ETHERCAT => Some((marked, rest)),
            IPV4 => Some((marked, udp(rest)?)),
            _ => None,
        }
    };
    Ok(found())
}

/// What a packet of IPv4 has for the port of EtherCAT.
fn udp(packet: &[u8]) -> Option<&[u8]> {
    let [version, ..] = packet else { return None };
    let head = usize::from(version & 0x0f) * 4;
    // A later fragment has no ports.
    let is_first = big(packet, 6)? & 0x1fff == 0;
    if version >> 4 != 4 || head < 20 || !is_first || *packet.get(9)? != UDP {
        return None;
    }
    let datagram = packet.get(head..)?;
    let is_ours = big(datagram, 0)? == PORT || big(datagram, 2)? == PORT;
    is_ours.then(|| datagram.get(8..))?
}

/// The datagrams of a frame, up to the first that is not whole.
pub(super) fn datagrams(payload: &[u8]) -> impl Iterator<Item = Datagram<'_>> {
    // The length of all, and a type of 1 for datagrams.
    let head = little(payload, 0).unwrap_or(0);
    let length = usize::from(head & 0x07ff);
    let all = payload.get(2..).unwrap_or_default();
    let all = match head >> 12 {
        1 => &all[..length.min(all.len())],
        _ => &[],
    };
    let mut rest = Some(all);
    std::iter::from_fn(move || {
        let bytes = rest.take()?;
        let [command, index, a, b, c, d, ..] = *bytes else {
            return None;
        };
        let about = little(bytes, 6)?;
        let length = usize::from(about & 0x07ff);
        let data = bytes.get(10..10 + length)?;
        let counter = little(bytes, 10 + length)?;
        // Another one follows.
        rest = (about & 0x8000 != 0).then(|| &bytes[12 + length..]);
        Some(Datagram {
            command,
            index,
            address: u32::from_le_bytes([a, b, c, d]),
            data,
            counter,
        })
    })
}

fn big(bytes: &[u8], at: usize) -> Option<u16> {
    bytes
        .get(at..)?
        .first_chunk()
        .copied()
        .map(u16::from_be_bytes)
}

fn little(bytes: &[u8], at: usize) -> Option<u16> {
    bytes
        .get(at..)?
        .first_chunk()
        .copied()
        .map(u16::from_le_bytes)
}
