//! Addresses as they are typed.

use crate::ads::{self, Ads, NetId, Symbol};
use crate::error::Error;
use crate::rtde::{self, Rtde};
use crate::source::Source;

/// What is allowed as an address.
const ALLOWED: &str = "rtde://HOST, or ads://NETID:PORT/SYMBOL SYMBOL.. with the host where its address does not begin the \
    NetID: ads://NETID:PORT@HOST/SYMBOL";

/// A device to record from.
#[derive(Clone, Debug, PartialEq)]
pub enum Device {
    /// A TwinCAT device: variables of one AMS port.
    Ads {
        /// Host name or address.
        host: String,
        /// TCP port, mostly 48898.
        port: u16,
        /// AMS NetId.
        net_id: NetId,
        /// AMS port, such as 851.
        ams_port: u16,
        /// What is recorded.
        symbols: Vec<Symbol>,
    },
    /// A robot of Universal Robots.
    Rtde {
        /// Host name or address.
        host: String,
        /// TCP port, mostly 30004.
        port: u16,
    },
}

impl Device {
    /// Reads an address, and for ADS further symbols; a symbol may have a unit: `MAIN.fPos=mm`.
    ///
    /// # Errors
    /// [`Error::Usage`] where it is none.
    pub fn parse<T: AsRef<str>>(words: &[T]) -> Result<Self, Error> {
        let mut words = words.iter().map(AsRef::as_ref);
        let url = words.next().unwrap_or_default();
        let refuse = |what: &str| Error::usage(format!("{url:?} {what}"), ALLOWED);
        let Some((scheme, rest)) = url.split_once("://") else {
            return Err(refuse("is no address"));
        };
        match scheme {
            "rtde" => {
                if let Some(more) = words.next() {
                    let found = format!("{more:?} beside a robot");
                    return Err(Error::usage(found, "one robot is recorded, all its joints"));
                }
                let (host, port) = host_and_port(rest.strip_suffix('/').unwrap_or(rest));
                Ok(Device::Rtde {
                    host: host.ok_or_else(|| refuse("has no host"))?,
                    port: port.map_err(refuse)?.unwrap_or(rtde::PORT),
                })
            }
            "ads" => {
                let (target, first) = rest.split_once('/').unwrap_or((rest, ""));
                let (ams, host) = match target.split_once('@') {
                    Some((ams, host)) => (ams, Some(host)),
                    None => (target, None),
                };
                let (net_id, ams_port) = ams
                    .split_once(':')
                    .ok_or_else(|| refuse("has no AMS port"))?;
                let net_id = NetId::parse(net_id)
                    .ok_or_else(|| refuse("has no NetId of six numbers to 255"))?;
                let ams_port = ams_port
                    .parse()
                    .map_err(|_| refuse("has an AMS port that is none from 0 to 65535"))?;
                let (host, port) = match host {
                    Some(host) => host_and_port(host),
                    None => (Some(net_id.host()), Ok(None)),
                };
                let symbols = std::iter::once(first).chain(words).map(Symbol::parse);
                let symbols: Option<Vec<Symbol>> = symbols.collect();
                let symbols = symbols.ok_or_else(|| {
                    refuse("or what follows it has a symbol that is empty, too long or an address")
                })?;
                if symbols.len() > ads::MAX_SYMBOLS {
                    let found = format!("{} symbols", symbols.len());
                    let allowed = format!("at most {} are recorded at once", ads::MAX_SYMBOLS);
                    return Err(Error::usage(found, allowed));
                }
                let twice = symbols.iter().enumerate();
                let twice = twice.map(|(at, symbol)| (symbol, &symbols[..at]));
                for (symbol, before) in twice {
                    if before.iter().any(|own| own.name == symbol.name) {
                        return Err(Error::usage(
                            format!("{} is given twice", symbol.name),
                            "give each symbol once",
                        ));
                    }
                }
                Ok(Device::Ads {
                    host: host.ok_or_else(|| refuse("has no host"))?,
                    port: port.map_err(refuse)?.unwrap_or(ads::PORT),
                    net_id,
                    ams_port,
                    symbols,
                })
            }
            _ => Err(refuse("is of no known kind")),
        }
    }

    /// The device as a source, not connected yet, at a rate in Hz; `None` is 1000 for ADS and 125 for RTDE.
    ///
    /// # Errors
    /// [`Error::Usage`] where the rate is outside of 1 to 10000 for ADS or 1 to 500 for RTDE.
    pub fn source(self, rate: Option<f64>) -> Result<Box<dyn Source>, Error> {
        let (usual, most) = match self {
            Device::Ads { .. } => (ads::RATE, ads::MAX_RATE),
            Device::Rtde { .. } => (rtde::RATE, rtde::MAX_RATE),
        };
        let rate = rate.unwrap_or(usual);
        if !(1.0..=most).contains(&rate) {
            return Err(Error::usage(
                format!("a rate of {rate} Hz"),
                format!("from 1 to {most} Hz is allowed for this device"),
            ));
        }
        Ok(match self {
            Device::Ads {
                host,
                port,
                net_id,
                ams_port,
                symbols,
            } => Box::new(Ads::new(host, port, (net_id, ams_port), symbols, rate)),
            Device::Rtde { host, port } => Box::new(Rtde::new(host, port, rate)),
        })
    }
}

/// The host and the port behind it; IPv6 addresses with a port are in square brackets.
fn host_and_port(text: &str) -> (Option<String>, Result<Option<u16>, &'static str>) {
    let (host, port) = match text.strip_prefix('[').and_then(|t| t.split_once(']')) {
        Some((host, rest)) => (host, rest.strip_prefix(':')),
        None if text.matches(':').count() > 1 => (text, None),
        None => match text.split_once(':') {
            Some((host, port)) => (host, Some(port)),
            None => (text, None),
        },
    };
    let is_host = !host.is_empty()
        && (host.chars()).all(|c| c.is_ascii_alphanumeric() || "-._:%".contains(c));
    let port = port.map(|port| {
        port.parse()
            .map_err(|_| "has a port that is none from 0 to 65535")
    });
    (is_host.then(|| host.to_string()), port.transpose())
}
