//! TwinCAT over ADS: a cyclic notification for each symbol, joined by their time stamps.
//!
//! Source: "AMS/ADS specification" and "ADS commands", Beckhoff Information System. Numbers are little-endian. Times of a
//! notification are asked for in 100 ns, as Beckhoff's AdsLib does; the specification says ms.

mod join;
mod packet;
mod request;
mod symbol;

use crate::error::{Error, Fault};
use crate::link::{Link, shown};
use crate::source::{Column, MANY, Sample, Source};
use join::Join;
use packet::{Packet, frame_length, notifications};
use request::{Addresses, Request};
use std::net::IpAddr;
use std::time::{Duration, Instant};
pub use symbol::{NetId, Symbol};
use symbol::{Place, remedy};

/// TCP port of an AMS router.
pub(crate) const PORT: u16 = 48898;
/// Rate without another wish, Hz: that of a usual task.
pub(crate) const RATE: f64 = 1000.0;
/// Highest rate, Hz.
pub(crate) const MAX_RATE: f64 = 10_000.0;
/// Most symbols: TwinCAT has 550 notifications for each connection.
pub(crate) const MAX_SYMBOLS: usize = 500;
/// AMS port of this end; any that no service has.
const OWN_PORT: u16 = 50126;
/// Ticks of the clock in a second.
const TICKS: f64 = 1e7;
/// Longest wait for the answer to the last request.
const GOODBYE: Duration = Duration::from_millis(500);
/// Time stamps without a whole row after which there will be none.
const HOPELESS: usize = 2000;

/// A PLC.
pub(crate) struct Ads {
    host: String,
    port: u16,
    address: String,
    target: (NetId, u16),
    symbols: Vec<Symbol>,
    columns: Vec<Column>,
    rate: f64,
    /// The connection, the two ends of it, and the handles of the symbols.
    link: Option<(Link, Addresses, Vec<u32>)>,
    places: Vec<Place>,
    join: Join,
    /// The time stamp that counts as 0 s.
    zero: Option<u64>,
}

impl Ads {
    pub fn new(
        host: String,
        port: u16,
        target: (NetId, u16),
        symbols: Vec<Symbol>,
        rate: f64,
    ) -> Self {
        Self {
            address: shown(&host, port),
            host,
            port,
            target,
            columns: symbols.iter().map(Symbol::column).collect(),
            join: Join::new(symbols.len()),
            symbols,
            rate,
            link: None,
            places: Vec::new(),
            zero: None,
        }
    }

    /// Looks every symbol up and asks for its notifications.
    fn set_up(&mut self, link: &mut Link, ends: &mut Addresses) -> Result<Vec<u32>, Error> {
        self.places.clear();
        for symbol in &self.symbols {
            let request = Request::LookUp(&symbol.name);
            let answer = ask(link, ends, &request, &symbol.name)?;
            let place = Place::read(&answer).map_err(|what| {
                link.fault(Fault::Refused, format!("symbol {} {what}", symbol.name))
            })?;
            self.places.push(place);
        }
        let mut handles = Vec::new();
        for (symbol, place) in self.symbols.iter().zip(&self.places) {
            let request = Request::Notify {
                place,
                cycle: (TICKS / self.rate).round() as u32,
            };
            let answer = ask(link, ends, &request, &symbol.name)?;
            let handle = answer.first_chunk().map(|bytes| u32::from_le_bytes(*bytes));
            let what = "answers without a notification handle";
            handles.push(handle.ok_or_else(|| link.fault(Fault::Malformed, what))?);
        }
        Ok(handles)
    }
}

/// Sends a request and waits for what it gives; what else arrives, such as first notifications, is of no use yet.
fn ask(
    link: &mut Link,
    ends: &mut Addresses,
    request: &Request,
    name: &str,
) -> Result<Vec<u8>, Error> {
    let (bytes, id) = ends.packet(request);
    link.send(&bytes)?;
    let own = ends.own;
    let answer = link.answer(|link, frame| {
        let packet = read(link, frame)?;
        Ok((packet.id == id && packet.command == request.command())
            .then(|| (packet.error, packet.data.to_vec())))
    });
    let (error, data) = answer.map_err(|e| match e {
        // A router without a route ends the connection, or keeps silent.
        Error::Device {
            address,
            fault: fault @ (Fault::Closed | Fault::Silent),
            reason,
        } => {
            let reason =
                format!("{reason}; TwinCAT needs an AMS route to this computer: AMS NetId {own}");
            Error::Device {
                address,
                fault,
                reason,
            }
        }
        e => e,
    })?;
    let (result, rest) = match data.split_first_chunk() {
        Some((result, rest)) if error == 0 => (u32::from_le_bytes(*result), rest),
        _ => (error, &[][..]),
    };
    match result {
        0 if error == 0 && data.len() >= 4 => Ok(rest.to_vec()),
        0 => Err(link.fault(Fault::Malformed, "answers with too little")),
        code => {
            let reason = format!("symbol {name}: {} (ADS error {code:#x})", remedy(code));
            Err(link.fault(Fault::Refused, reason))
        }
    }
}

fn read<'a>(link: &Link, frame: &'a [u8]) -> Result<Packet<'a>, Error> {
    Packet::read(frame).map_err(|what| link.fault(Fault::Malformed, what))
}

impl Source for Ads {
    fn address(&self) -> &str {
        &self.address
    }

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn rate(&self) -> f64 {
        self.rate
    }

    fn connect(&mut self) -> Result<(), Error> {
        self.link = None;
        self.join.restart();
        let mut link = Link::connect(&self.host, self.port, frame_length)?;
        let own = match link.own() {
            Some(IpAddr::V4(own)) => NetId::of_host(own),
            _ => NetId::of_host(std::net::Ipv4Addr::LOCALHOST),
        };
        let mut ends = Addresses::new((own, OWN_PORT), self.target);
        let handles = self.set_up(&mut link, &mut ends)?;
        self.link = Some((link, ends, handles));
        Ok(())
    }

    fn next(&mut self, wait: Duration, samples: &mut Vec<Sample>) -> Result<(), Error> {
        let Some((link, _, handles)) = &mut self.link else {
            return Err(Error::device(&self.address, Fault::Closed, "not connected"));
        };
        let mut wait = wait;
        while let Some(frame) = link.frame(wait)? {
            // What is there already, and no more.
            wait = Duration::ZERO;
            let packet = read(link, &frame)?;
            if !packet.is_notification() {
                continue;
            }
            let malformed = |what| link.fault(Fault::Malformed, what);
            for notified in notifications(packet.data) {
                let (stamp, handle, data) = notified.map_err(malformed)?;
                let Some(at) = handles.iter().position(|own| *own == handle) else {
                    continue;
                };
                let value = self.places[at].value(data);
                let value = value.ok_or_else(|| {
                    malformed("sends a value of another size than its symbol has")
                })?;
                if let Some(values) = self.join.add(stamp, at, value) {
                    let zero = *self.zero.get_or_insert(stamp);
                    // Exact for 28 years of ticks.
                    let ticks = stamp.wrapping_sub(zero) as i64;
                    let time = ticks as f64 / TICKS;
                    samples.push(Sample { time, values });
                }
            }
            if self.join.hopeless() > HOPELESS {
                let what = "samples its symbols at different instants; record symbols of one task, at its rate (--rate)";
                return Err(link.fault(Fault::Refused, what));
            }
            if samples.len() >= MANY {
                break;
            }
        }
        Ok(())
    }

    fn incomplete(&self) -> u64 {
        self.join.incomplete()
    }

    fn close(&mut self) {
        if let Some((mut link, mut ends, handles)) = self.link.take() {
            let mut last = 0;
            for handle in handles {
                let (bytes, id) = ends.packet(&Request::Forget(handle));
                // The connection ends anyway.
                if link.send(&bytes).is_err() {
                    return;
                }
                last = id;
            }
            // A connection that is closed with bytes unread may take requests with it.
            let until = Instant::now() + GOODBYE;
            while Instant::now() < until
                && let Ok(Some(frame)) = link.frame(GOODBYE)
                && Packet::read(&frame)
                    .is_ok_and(|packet| packet.is_notification() || packet.id != last)
            {}
        }
    }
}
