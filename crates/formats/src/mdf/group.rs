//! The groups of a file: channels that share their records, as links lead from one to the next.

use super::channel::{Channel, Numbers};
use super::source::{Source, bad};
use crate::Error;

/// Groups whose records lie among each other.
#[derive(Debug)]
pub(super) struct Data {
    /// Where it stands in the file.
    pub(super) at: u64,
    /// Bytes before each record that say which group it is of; none where there is one group.
    pub(super) id_bytes: usize,
    /// Where the data begin; 0 where there are none.
    pub(super) first: u64,
    pub(super) groups: Vec<Group>,
}

/// Channels that share their records.
#[derive(Debug)]
pub(super) struct Group {
    /// Where it stands in the file.
    pub(super) at: u64,
    pub(super) name: Option<String>,
    /// What it is called here.
    pub(super) label: String,
    /// That of the group whose time its channels have, where that is another.
    pub(super) base: Option<u64>,
    pub(super) id: u64,
    /// How many records it has.
    pub(super) records: u64,
    /// Bytes of a record with values, and of those behind them that say which are none.
    pub(super) bytes: (u64, u64),
    /// Whether its records are the values of another channel, of different lengths.
    pub(super) of_lengths: bool,
    /// Why all of it is left out.
    pub(super) why: Option<&'static str>,
    /// Its master first.
    pub(super) channels: Vec<Channel>,
}

/// Most bytes of a record of which anything is read.
const MAX_RECORD: u64 = 1 << 20;
/// Most channels for each byte of a record: twice as many as it has bits.
const MAX_FOR_BYTE: u64 = 16;

/// All groups, in the order of the file.
pub(super) fn read(source: &mut Source) -> Result<Vec<Data>, Error> {
    let mut all = Vec::new();
    let mut at = source.claim_of(64, b"HD")?.link(0);
    while at != 0 {
        let block = source.claim_of(at, b"DG")?;
        source.collector.hold(3 * size_of::<Data>() as u64)?;
        let mut data = Data {
            at,
            id_bytes: usize::from(block.byte(0)),
            first: block.link(2),
            groups: Vec::new(),
        };
        if !matches!(data.id_bytes, 0 | 1 | 2 | 4 | 8) {
            let found = format!("record numbers of {} bytes", data.id_bytes);
            return Err(bad(at, found));
        }
        let mut next = block.link(1);
        while next != 0 {
            let (group, after) = Group::read(source, next)?;
            data.groups.push(group);
            next = after;
        }
        all.push(data);
        at = block.link(0);
    }
    Ok(all)
}

impl Group {
    /// A group, and where the next one is.
    fn read(source: &mut Source, at: u64) -> Result<(Self, u64), Error> {
        let block = source.claim_of(at, b"CG")?;
        source.collector.entry()?;
        source.collector.hold(3 * size_of::<Self>() as u64)?;
        let flags = block.half(16);
        let bytes = (u64::from(block.word(24)), u64::from(block.word(28)));
        let why = match flags {
            _ if flags & 0b110 != 0 => Some("messages of a bus, not yet signals"),
            _ if flags & 0b1_0000 != 0 => Some("events"),
            _ if flags & 1 == 0 && bytes.0 + bytes.1 > MAX_RECORD => {
                Some("records of more than 1 MiB")
            }
            _ => None,
        };
        let mut group = Self {
            at,
            name: source.text(block.link(2))?,
            label: String::new(),
            base: Some(block.link(6)).filter(|_| flags & 0b1000 != 0),
            id: block.long(0),
            records: block.long(8),
            bytes,
            of_lengths: flags & 1 != 0,
            why,
            channels: Vec::new(),
        };
        if group.why.is_none() && !group.of_lengths {
            group.channels(source, block.link(1))?;
        }
        Ok((group, block.link(0)))
    }

    /// Why a channel of it is left out, if it is.
    pub(super) fn left_out<'a>(&self, channel: &'a Channel) -> Option<&'a str> {
        match &channel.content {
            Err(why) => Some(why),
            Ok(_) if self.records == 0 => Some("empty"),
            Ok(_) => None,
        }
    }

    fn channels(&mut self, source: &mut Source, mut at: u64) -> Result<(), Error> {
        while at != 0 {
            let block = source.claim_of(at, b"CN")?;
            source.collector.entry()?;
            let channel = Channel::new(source, &block, self.bytes);
            let channel = channel.map_err(|error| match error.place.byte {
                None => error.at_byte(at),
                Some(_) => error,
            })?;
            self.channels.push(channel);
            at = block.link(0);
        }
        let stored = |channel: &&Channel| {
            let numbers = channel.content.as_ref().map(|content| content.numbers);
            matches!(numbers, Ok(Numbers::Stored(_)))
        };
        let stored = self.channels.iter().filter(stored).count() as u64;
        if stored > self.bytes.0 * MAX_FOR_BYTE {
            self.why = Some("more channels than its records have bits for");
            self.channels.clear();
        }
        self.channels.sort_by_key(|channel| !channel.master);
        Ok(())
    }
}
