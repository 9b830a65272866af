//! Packets of a capture with their times: pcap in both byte orders, in micro- and nanoseconds, and pcapng.
//!
//! Formats: draft-ietf-opsawg-pcap and draft-ietf-opsawg-pcapng. Nothing of a packet is held beyond the largest frame.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};

use crate::{Error, Kind};

/// Bytes of a packet that are kept: of longer ones, which no Ethernet has, the rest is passed over.
const MAX_PACKET: u64 = 1 << 16;
/// Longest description of an interface, bytes, and most of them.
const MAX_DESCRIPTION: u64 = 1 << 16;
const MAX_INTERFACES: usize = 1024;
/// Bytes that are read at once.
const BLOCK: usize = 1 << 16;
/// Picoseconds of a second.
const SECOND: i128 = 1_000_000_000_000;

/// Blocks of pcapng.
const SECTION: u32 = 0x0a0d_0d0a;
const INTERFACE: u32 = 1;
const OLD_PACKET: u32 = 2;
const PACKET: u32 = 6;
/// Options of an interface.
const RESOLUTION: u16 = 9;
const OFFSET: u16 = 14;

/// A packet.
pub(super) struct Packet<'a> {
    /// When it was captured, ps since 1970.
    pub(super) at: i128,
    /// The link type of its interface.
    pub(super) link: u32,
    /// Its first bytes.
    pub(super) bytes: &'a [u8],
}

/// How an interface of pcapng counts time.
#[derive(Clone, Copy)]
struct Interface {
    link: u32,
    /// Ticks of a second.
    ticks: i128,
    /// What is added, s.
    offset: i64,
}

/// Which of the two formats it is.
enum Form {
    Plain(Interface),
    /// With the interfaces of the section.
    Blocks(Vec<Interface>),
}

/// A capture that is read from its beginning.
pub(super) struct Capture<'f> {
    reader: BufReader<&'f File>,
    form: Form,
    is_big: bool,
    /// Bytes read.
    at: u64,
    is_cut: bool,
    packet: Vec<u8>,
}

impl<'f> Capture<'f> {
    pub(super) fn new(mut file: &'f File) -> Result<Self, Error> {
        file.seek(SeekFrom::Start(0))
            .map_err(|error| io(error, 0))?;
        let mut capture = Self {
            reader: BufReader::with_capacity(BLOCK, file),
            form: Form::Blocks(Vec::new()),
            is_big: false,
            at: 0,
            is_cut: false,
            packet: Vec::new(),
        };
        let mut magic = [0; 4];
        capture.whole(&mut magic)?;
        let little = u32::from_le_bytes(magic);
        if little == SECTION {
            capture.section()?;
            return Ok(capture);
        }
        let ticks = |magic| match magic {
            0xa1b2_c3d4 => Some(1_000_000),
            0xa1b2_3c4d => Some(1_000_000_000),
            _ => None,
        };
        let big = ticks(u32::from_be_bytes(magic));
        let ticks = ticks(little)
            .or(big)
            .ok_or_else(|| capture.bad("no magic number"))?;
        capture.is_big = big.is_some();
        let mut rest = [0; 20];
        capture.whole(&mut rest)?;
        // The uppermost bits say how long the checksum of a frame is.
        let link = capture.u32(&rest[16..]) & 0x0fff_ffff;
        capture.form = Form::Plain(Interface {
            link,
            ticks,
            offset: 0,
        });
        Ok(capture)
    }

    /// Whether the file ends within a packet.
    pub(super) fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// The next packet that has a time.
    pub(super) fn next(&mut self) -> Result<Option<Packet<'_>>, Error> {
        let found = match &self.form {
            Form::Plain(interface) => {
                let interface = *interface;
                self.plain(interface)?
            }
            Form::Blocks(_) => self.blocks()?,
        };
        Ok(found.map(|(at, link)| Packet {
            at,
            link,
            bytes: &self.packet,
        }))
    }

    fn plain(&mut self, interface: Interface) -> Result<Option<(i128, u32)>, Error> {
        let mut head = [0; 16];
        if !self.fill(&mut head)? {
            return Ok(None);
        }
        let [seconds, part, length] = [0, 4, 8].map(|at| self.u32(&head[at..]));
        let at = i128::from(seconds) * SECOND + i128::from(part) * SECOND / interface.ticks;
        if i128::from(part) >= interface.ticks {
            return Err(self.bad("a time stamp that is none"));
        }
        Ok(self
            .data(u64::from(length), u64::from(length))?
            .then_some((at, interface.link)))
    }

    fn blocks(&mut self) -> Result<Option<(i128, u32)>, Error> {
        loop {
            let mut head = [0; 4];
            if !self.fill(&mut head)? {
                return Ok(None);
            }
            // The same in either order.
            if u32::from_le_bytes(head) == SECTION {
                self.section()?;
                continue;
            }
            let kind = self.u32(&head);
            let mut length = [0; 4];
            if !self.fill(&mut length)? {
                return Ok(None);
            }
            let body = self.body(&length, 8)?;
            let done = match kind {
                INTERFACE => self.interface(body)?.then_some(None),
                PACKET | OLD_PACKET => self.stamped(kind, body)?.map(Some),
                _ => self.pass(body)?.then_some(None),
            };
            let mut end = [0; 4];
            match done {
                Some(found) if self.fill(&mut end)? => {
                    if end != length {
                        return Err(self.bad("a block whose two lengths differ"));
                    }
                    if let Some(found) = found {
                        return Ok(Some(found));
                    }
                }
                _ => return Ok(None),
            }
        }
    }

    /// Bytes of a block without its head, of which so many were read, and without its end.
    fn body(&self, length: &[u8], head: u64) -> Result<u64, Error> {
        let length = u64::from(self.u32(length));
        let body = length
            .checked_sub(head + 4)
            .filter(|_| length.is_multiple_of(4));
        body.ok_or_else(|| self.bad(format!("a block of {length} bytes")))
    }

    /// The head of a section, behind its first four bytes: the order of its bytes, and no interface yet.
    fn section(&mut self) -> Result<(), Error> {
        let (mut length, mut order) = ([0; 4], [0; 4]);
        self.whole(&mut length)?;
        self.whole(&mut order)?;
        self.is_big = match u32::from_le_bytes(order) {
            0x1a2b_3c4d => false,
            0x4d3c_2b1a => true,
            _ => return Err(self.bad("a section without its byte order")),
        };
        let body = self.body(&length, 12)?;
        self.pass(body + 4)?;
        self.form = Form::Blocks(Vec::new());
        Ok(())
    }

    /// Reads the description of an interface; whether it is whole.
    fn interface(&mut self, body: u64) -> Result<bool, Error> {
        if !(8..=MAX_DESCRIPTION).contains(&body) {
            return Err(self.bad(format!("an interface of {body} bytes")));
        }
        let mut text = vec![0; body as usize];
        if !self.fill(&mut text)? {
            return Ok(false);
        }
        let mut interface = Interface {
            link: u32::from(self.u16(&text)),
            ticks: 1_000_000,
            offset: 0,
        };
        let mut rest = &text[8..];
        while let [a, b, c, d, more @ ..] = rest {
            let (code, length) = (self.u16(&[*a, *b]), usize::from(self.u16(&[*c, *d])));
            let Some(value) = more.get(..length) else {
                return Err(self.bad("an option that is longer than its block"));
            };
            match (code, value) {
                (0, _) => break,
                (RESOLUTION, [power]) => {
                    interface.ticks = ticks(*power)
                        .ok_or_else(|| self.bad(format!("a resolution of code {power}")))?;
                }
                (OFFSET, [a @ .., _, _, _, _]) if value.len() == 8 => {
                    let (first, second) = (self.u32(a), self.u32(&value[4..]));
                    let (high, low) = if self.is_big {
                        (first, second)
                    } else {
                        (second, first)
                    };
                    interface.offset = (u64::from(high) << 32 | u64::from(low)) as i64;
                }
                _ => {}
            }
            rest = more.get(length.next_multiple_of(4)..).unwrap_or_default();
        }
        let too_many = self.bad(format!("more than {MAX_INTERFACES} interfaces"));
        match &mut self.form {
            Form::Blocks(all) if all.len() < MAX_INTERFACES => all.push(interface),
            _ => return Err(too_many),
        }
        Ok(true)
    }

    /// Reads a packet with its time; `None` where it is not whole.
    fn stamped(&mut self, kind: u32, body: u64) -> Result<Option<(i128, u32)>, Error> {
        let mut head = [0; 20];
        let Some(room) = body.checked_sub(head.len() as u64) else {
            return Err(self.bad("a packet without its head"));
        };
        if !self.fill(&mut head)? {
            return Ok(None);
        }
        let index = match kind {
            OLD_PACKET => u32::from(self.u16(&head)),
            _ => self.u32(&head),
        };
        let [high, low, length] = [4, 8, 12].map(|at| self.u32(&head[at..]));
        let Form::Blocks(interfaces) = &self.form else {
            return Ok(None);
        };
        let interface = interfaces.get(index as usize).copied();
        let interface = interface.ok_or_else(|| {
            self.bad(format!(
                "a packet of interface {index}, which is not described"
            ))
        })?;
        let ticks = i128::from(u64::from(high) << 32 | u64::from(low));
        let at = ticks * SECOND / interface.ticks + i128::from(interface.offset) * SECOND;
        if u64::from(length) > room {
            return Err(self.bad("a packet that is longer than its block"));
        }
        Ok(self
            .data(u64::from(length), room)?
            .then_some((at, interface.link)))
    }

    /// Keeps the first bytes of a packet and passes over the rest of its room; whether it is whole.
    fn data(&mut self, length: u64, room: u64) -> Result<bool, Error> {
        let kept = length.min(MAX_PACKET);
        self.packet.clear();
        let read = (&mut self.reader).take(kept).read_to_end(&mut self.packet);
        self.at += read.map_err(|error| io(error, self.at))? as u64;
        if (self.packet.len() as u64) < kept {
            self.is_cut = true;
            return Ok(false);
        }
        self.pass(room - kept)
    }

    /// Passes over so many bytes; whether they are there.
    fn pass(&mut self, bytes: u64) -> Result<bool, Error> {
        let passed = std::io::copy(&mut (&mut self.reader).take(bytes), &mut std::io::sink());
        let passed = passed.map_err(|error| io(error, self.at))?;
        self.at += passed;
        self.is_cut |= passed < bytes;
        Ok(passed == bytes)
    }

    /// Fills a buffer; `false` at the end of the file.
    fn fill(&mut self, buffer: &mut [u8]) -> Result<bool, Error> {
        let mut filled = 0;
        while filled < buffer.len() {
            match self.reader.read(&mut buffer[filled..]) {
                Ok(0) => {
                    self.is_cut |= filled > 0;
                    return Ok(false);
                }
                Ok(read) => filled += read,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(io(error, self.at)),
            }
        }
        self.at += filled as u64;
        Ok(true)
    }

    /// Fills a buffer of the head of the file.
    fn whole(&mut self, buffer: &mut [u8]) -> Result<(), Error> {
        match self.fill(buffer)? {
            true => Ok(()),
            false => Err(self.bad("the file ends in its head")),
        }
    }

    fn bad(&self, found: impl Into<String>) -> Error {
        let allowed = "a capture in pcap or pcapng, as Wireshark and tcpdump write it";
        Error::new(Kind::Format, found, allowed).at_byte(self.at)
    }

    /// The number in the first four bytes, in the order of the file.
    fn u32(&self, bytes: &[u8]) -> u32 {
        let bytes = bytes.first_chunk().copied().unwrap_or_default();
        match self.is_big {
            true => u32::from_be_bytes(bytes),
            false => u32::from_le_bytes(bytes),
        }
    }

    /// The number in the first two bytes.
    fn u16(&self, bytes: &[u8]) -> u16 {
        let bytes = bytes.first_chunk().copied().unwrap_or_default();
        match self.is_big {
            true => u16::from_be_bytes(bytes),
            false => u16::from_le_bytes(bytes),
        }
    }
}

/// Ticks of a second by the code of `if_tsresol`: a power of 10, or with the highest bit set of 2, negative.
fn ticks(code: u8) -> Option<i128> {
    let power = u32::from(code & 0x7f);
    match code & 0x80 {
        0 => 10_i128.checked_pow(power).filter(|_| power <= 18),
        _ => 2_i128.checked_pow(power).filter(|_| power <= 63),
    }
}

fn io(error: std::io::Error, at: u64) -> Error {
    Error::new(Kind::Io, format!("cannot be read ({error})"), "").at_byte(at)
}
