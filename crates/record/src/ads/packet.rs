//! What a PLC sends.

/// Length of the headers of TCP and AMS, bytes.
const HEADERS: usize = 6 + 32;
/// Longest packet, bytes: far more than a task gathers in 50 ms.
const LONGEST: usize = 1 << 22;
/// Command of a notification.
const NOTIFICATION: u16 = 8;

/// A packet that arrived.
#[derive(Debug)]
pub(super) struct Packet<'a> {
    /// Number of the command.
    pub command: u16,
    /// Error of the router, or 0.
    pub error: u32,
    /// Number of the request that it answers.
    pub id: u32,
    pub data: &'a [u8],
}

/// Length of the packet that these bytes begin with.
pub(super) fn frame_length(bytes: &[u8]) -> Result<Option<usize>, &'static str> {
    let Some(length) = bytes.get(2..).and_then(|rest| rest.first_chunk()) else {
        return Ok(None);
    };
    let length = u32::from_le_bytes(*length) as usize;
    match length.saturating_add(6) {
        whole @ ..=LONGEST => Ok(Some(whole)),
        _ => Err("sends no AMS packets; is this port 48898 of a TwinCAT device?"),
    }
}

impl<'a> Packet<'a> {
    /// Reads a whole packet; one of the router itself has no command.
    pub fn read(frame: &'a [u8]) -> Result<Self, &'static str> {
        let kind = u16_at(frame, 0).unwrap_or_default();
        if kind != 0 {
            return Ok(Packet {
                command: 0,
                error: 0,
                id: 0,
                data: &[],
            });
        }
        const SHORT: &str = "sends an AMS packet that is too short";
        let data = frame.get(HEADERS..).ok_or(SHORT)?;
        if u32_at(frame, 26).map(|length| length as usize) != Some(data.len()) {
            return Err("sends an AMS packet whose lengths disagree");
        }
        Ok(Packet {
            command: u16_at(frame, 22).ok_or(SHORT)?,
            error: u32_at(frame, 30).ok_or(SHORT)?,
            id: u32_at(frame, 34).ok_or(SHORT)?,
            data,
        })
    }

    pub fn is_notification(&self) -> bool {
        self.command == NOTIFICATION && self.error == 0
    }
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    let bytes = bytes.get(at..)?.first_chunk()?;
    Some(u16::from_le_bytes(*bytes))
}

pub(super) fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..)?.first_chunk()?;
    Some(u32::from_le_bytes(*bytes))
}

/// What was notified: time stamp in 100 ns since 1601, handle, value.
type Notified<'a> = (u64, u32, &'a [u8]);

/// The samples of a notification; the last is an error where it is cut or has something behind it.
pub(super) fn notifications(data: &[u8]) -> Notifications<'_> {
    let stamps = u32_at(data, 4);
    let whole = u32_at(data, 0).map(|length| length as usize) == data.len().checked_sub(4);
    Notifications {
        rest: data.get(8..).unwrap_or_default(),
        stamps: stamps.filter(|_| whole),
        stamp: 0,
        samples: 0,
    }
}

/// See [`notifications`].
pub(super) struct Notifications<'a> {
    rest: &'a [u8],
    /// Stamps that follow; `None` after an error.
    stamps: Option<u32>,
    stamp: u64,
    samples: u32,
}

impl<'a> Notifications<'a> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.rest.split_first_chunk()?;
        self.rest = rest;
        Some(*taken)
    }

    /// The next one; the outer `None` where it is cut.
    fn sample(&mut self) -> Option<Option<Notified<'a>>> {
        let mut stamps = self.stamps?;
        while self.samples == 0 {
            if stamps == 0 {
                return self.rest.is_empty().then_some(None);
            }
            stamps -= 1;
            self.stamps = Some(stamps);
            self.stamp = u64::from_le_bytes(self.take()?);
            self.samples = u32::from_le_bytes(self.take()?);
        }
        self.samples -= 1;
        let handle = u32::from_le_bytes(self.take()?);
        let size = u32::from_le_bytes(self.take()?) as usize;
        let (value, rest) = self.rest.split_at_checked(size)?;
        self.rest = rest;
        Some(Some((self.stamp, handle, value)))
    }
}

impl<'a> Iterator for Notifications<'a> {
    type Item = Result<Notified<'a>, &'static str>;

    fn next(&mut self) -> Option<Self::Item> {
        match self.sample() {
            Some(sample) => sample.map(Ok),
            None => {
                // Told once.
                self.stamps = Some(0);
                self.samples = 0;
                self.rest = &[];
                Some(Err("sends a notification whose lengths disagree"))
            }
        }
    }
}
