//! A TCP connection to the one address that was given, with a limit to every wait.

use crate::error::{Error, Fault};
use std::io::{ErrorKind, Read, Write};
use std::net::{IpAddr, TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

/// Longest wait for a connection or an answer.
pub(crate) const ANSWER: Duration = Duration::from_secs(5);
/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;

/// Length of the frame that these bytes begin with; `None` where they are too few to tell.
pub(crate) type FrameLength = fn(&[u8]) -> Result<Option<usize>, &'static str>;

/// A connection and the bytes that came over it.
#[derive(Debug)]
pub(crate) struct Link {
    stream: TcpStream,
    address: String,
    buffer: Vec<u8>,
    length: FrameLength,
}

impl Link {
    /// Connects to a host and port.
    pub fn connect(host: &str, port: u16, length: FrameLength) -> Result<Self, Error> {
        let address = shown(host, port);
        let until = Instant::now() + ANSWER;
        let unreachable = |e: std::io::Error| {
            let why = match e.kind() {
                ErrorKind::TimedOut | ErrorKind::WouldBlock => {
                    format!("no answer within {} s", ANSWER.as_secs())
                }
                ErrorKind::ConnectionRefused => "the connection is refused".into(),
                _ => e.to_string(),
            };
            let reason = format!("cannot be reached ({why}); check address, network and firewall");
            Error::device(&address, Fault::Unreachable, reason)
        };
        let mut last = std::io::Error::from(ErrorKind::AddrNotAvailable);
        for at in (host, port).to_socket_addrs().map_err(unreachable)? {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            match TcpStream::connect_timeout(&at, left) {
                Ok(stream) => {
                    let set = (stream.set_nodelay(true))
                        .and_then(|()| stream.set_write_timeout(Some(ANSWER)));
                    set.map_err(unreachable)?;
                    return Ok(Self {
                        stream,
                        address: address.clone(),
                        buffer: Vec::new(),
                        length,
                    });
                }
                Err(e) => last = e,
            }
        }
        Err(unreachable(last))
    }

    /// The own address of the connection.
    pub fn own(&self) -> Option<IpAddr> {
        self.stream.local_addr().ok().map(|own| own.ip())
    }

    /// An error of this connection.
    pub fn fault(&self, fault: Fault, reason: impl Into<String>) -> Error {
        Error::device(&self.address, fault, reason)
    }

    /// Sends a request.
    pub fn send(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let sent = self.stream.write_all(bytes);
        sent.map_err(|e| self.fault(Fault::Closed, format!("the connection is lost ({e})")))
    }

    /// The next whole frame that arrives within `wait`. Memory is bounded by the longest frame that [`FrameLength`] allows.
    pub fn frame(&mut self, wait: Duration) -> Result<Option<Vec<u8>>, Error> {
        let until = Instant::now() + wait;
        let mut tried = false;
        loop {
            let length = (self.length)(&self.buffer);
            let length = length.map_err(|what| self.fault(Fault::Malformed, what))?;
            if let Some(length) = length.filter(|length| self.buffer.len() >= *length) {
                let rest = self.buffer.split_off(length);
                return Ok(Some(std::mem::replace(&mut self.buffer, rest)));
            }
            let left = until.saturating_duration_since(Instant::now());
            if tried && left.is_zero() {
                return Ok(None);
            }
            tried = true;
            // A socket takes no wait of zero.
            let left = left.max(Duration::from_millis(1));
            let mut chunk = [0; CHUNK];
            let read = self.stream.set_read_timeout(Some(left));
            match read.and_then(|()| self.stream.read(&mut chunk)) {
                Ok(0) => return Err(self.fault(Fault::Closed, "the device ended the connection")),
                Ok(read) => self.buffer.extend_from_slice(&chunk[..read]),
                Err(e) => match e.kind() {
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {}
                    _ => {
                        let reason = format!("the connection is lost ({e})");
                        return Err(self.fault(Fault::Closed, reason));
                    }
                },
            }
        }
    }

    /// The first frame that `wanted` makes something of, within the time for an answer.
    pub fn answer<T>(
        &mut self,
        mut wanted: impl FnMut(&Self, &[u8]) -> Result<Option<T>, Error>,
    ) -> Result<T, Error> {
        let until = Instant::now() + ANSWER;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            let frame = self.frame(left)?;
            if let Some(frame) = &frame
                && let Some(answer) = wanted(self, frame)?
            {
                return Ok(answer);
            }
            if left.is_zero() {
                let reason = format!("no answer within {} s", ANSWER.as_secs());
                return Err(self.fault(Fault::Silent, reason));
            }
        }
    }
}

/// An address as people write it.
pub(crate) fn shown(host: &str, port: u16) -> String {
    match host.contains(':') {
        true => format!("[{host}]:{port}"),
        false => format!("{host}:{port}"),
    }
}
