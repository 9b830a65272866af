//! Captures of EtherCAT (pcap and pcapng): process data of drives, cycle by cycle.
//!
//! A capture does not say what the bytes of a datagram mean; [`ProcessData`] does. Every frame is there twice, as the master sent
//! it and as it came back: inputs count in the one that came back, with the working counter that all slaves give it, outputs in the
//! one that was sent, where the capture has it. Time is that of the capture. Without a map the refusal lists the cyclic datagrams,
//! and offers a map by the network's (ENI) or device's (ESI) description beside the capture.

mod capture;
mod frame;
mod map;
mod object;
mod offer;
mod rows;
mod seen;
mod xml;

use std::fs::File;
use std::path::Path;

use crate::binary::Collector;
use crate::{Error, Kind, Limits, Table};
use capture::Capture;
use frame::Datagram;
pub use map::{Address, Direction, Entry, ProcessData, Type};
pub use object::{Object, object};
use seen::Seen;

/// The key of the axis file.
const KEY: &str = "ethercat";

/// Reads the entries of a map, a row each cycle.
pub(crate) fn read(
    file: &File,
    path: &Path,
    limits: Limits,
    map: &ProcessData,
) -> Result<Table, Error> {
    let mut seen = Seen::default();
    let about = each(file, |at, marked, datagram| seen.take(at, marked, datagram))?;
    let allowed = "a capture of the port of an EtherCAT master, Ethernet or Linux cooked (SLL)";
    if seen.is_empty() {
        let found = match about.link {
            Some(link) => format!("packets of link type {link}, which is not read"),
            None => format!("no EtherCAT in {} packets", about.packets),
        };
        return Err(Error::new(Kind::Format, found, allowed));
    }
    if !seen.is_answered() {
        let found = "frames as the master sent them alone: no slave counted on any of them";
        return Err(Error::new(Kind::Missing, found, allowed));
    }
    if map.entries.is_empty() {
        return Err(offer::refusal(&seen, path, limits).of_setting(KEY));
    }
    let mut collector = Collector::new(limits);
    let mut rows = rows::Rows::new(map, &seen, &mut collector)?;
    each(file, |at, marked, datagram| {
        rows.take(at, seen.is_back(marked, datagram), datagram);
    })?;
    if about.cut {
        collector.detected("the capture ends within a packet, which is left out");
    }
    rows.finish(&mut collector);
    Ok(collector.finish())
}

/// What was found on the way.
struct About {
    packets: u64,
    cut: bool,
    /// A link type of which no packet was read, where there is one.
    link: Option<u32>,
}

/// Hands on every datagram with its time, ps, and whether a slave marked the frame.
fn each(file: &File, mut take: impl FnMut(i128, bool, &Datagram<'_>)) -> Result<About, Error> {
    let mut capture = Capture::new(file)?;
    let (mut packets, mut link) = (0, None);
    while let Some(packet) = capture.next()? {
        packets += 1;
        match frame::payload(packet.link, packet.bytes) {
            Ok(Some((marked, payload))) => {
                frame::datagrams(payload).for_each(|datagram| take(packet.at, marked, &datagram));
            }
            Ok(None) => {}
            Err(other) => link = Some(other),
        }
    }
    Ok(About {
        packets,
        cut: capture.is_cut(),
        link,
    })
}
