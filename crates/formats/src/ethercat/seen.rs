//! Which datagrams a capture has, how often they come back, and with which working counter.
//!
//! The first slave marks a frame in its source address, and each slave that takes part in a datagram counts on its working counter.
//! A master whose own address bears the mark, or a capture that lost it, leaves the counter: a datagram that no slave has counted
//! on is one that was sent.

use std::collections::BTreeMap;

use super::frame::Datagram;
use super::map::{Address, Direction};

/// Most kinds of datagrams that are told apart; others of a network that asks for more are passed over.
const MOST_KINDS: usize = 4096;
/// Most working counters of one kind that are told apart.
const MOST_COUNTERS: usize = 8;
/// Least part of the datagrams that came back which is no accident, and of the most frequent ones, which is cyclic.
const SOME: f64 = 0.1;
/// Most datagrams that are listed.
const LISTED: usize = 12;
/// Fewest datagrams that are cyclic.
const FEWEST: u64 = 3;
/// Picoseconds of a second.
const SECOND: f64 = 1e12;

/// Commands that address one slave by its station, or the memory of all; the others go by place or to all slaves.
const STATIONS: [u8; 4] = [4, 5, 6, 14];
const LOGICAL: [u8; 3] = [10, 11, 12];
const NAMES: [&str; 15] = [
    "NOP", "APRD", "APWR", "APRW", "FPRD", "FPWR", "FPRW", "BRD", "BWR", "BRW", "LRD", "LWR",
    "LRW", "ARMW", "FRMW",
];

/// What datagrams have in common that differ in their data alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Key {
    pub(super) command: u8,
    address: u32,
    /// Bytes of data.
    pub(super) length: usize,
}

impl Key {
    pub(super) fn of(datagram: &Datagram<'_>) -> Self {
        let by_slave = STATIONS.contains(&datagram.command) || LOGICAL.contains(&datagram.command);
        Self {
            command: datagram.command,
            // Slaves count in the place by which the others address them.
            address: match by_slave {
                true => datagram.address,
                false => datagram.address & 0xffff_0000,
            },
            length: datagram.data.len(),
        }
    }

    /// Where its process data is; `None` of what is addressed by place or to all.
    pub(super) fn address(&self) -> Option<Address> {
        let [a, b, c, d] = self.address.to_le_bytes();
        match self.command {
            command if LOGICAL.contains(&command) => Some(Address::Logical(self.address)),
            command if STATIONS.contains(&command) => Some(Address::Physical {
                station: u16::from_le_bytes([a, b]),
                offset: u16::from_le_bytes([c, d]),
            }),
            _ => None,
        }
    }

    /// Whether it carries data this way.
    pub(super) fn goes(&self, direction: Direction) -> bool {
        match direction {
            Direction::In => matches!(self.command, 4 | 6 | 10 | 12 | 14),
            Direction::Out => matches!(self.command, 5 | 6 | 11 | 12),
        }
    }

    /// `LRW 0x10000 of 24 bytes`.
    pub(super) fn words(&self) -> String {
        let name = NAMES.get(usize::from(self.command)).copied().unwrap_or("?");
        let at = match self.address() {
            Some(Address::Logical(address)) => format!("0x{address:x}"),
            Some(Address::Physical { station, offset }) => {
                format!("station {station} 0x{offset:04x}")
            }
            None => format!("0x{:04x}", self.address >> 16),
        };
        format!("{name} {at} of {} bytes", self.length)
    }
}

/// Datagrams of one kind.
#[derive(Clone, Debug, Default)]
pub(super) struct Kind {
    /// Those with a working counter, in frames with the mark of a slave and in those without.
    counters: [Vec<(u16, u64)>; 2],
    /// When the first and the last of them came, ps.
    times: Option<(i128, i128)>,
    /// Those without, in frames with the mark.
    unanswered: u64,
}

/// The datagrams of a capture.
#[derive(Debug, Default)]
pub(super) struct Seen {
    kinds: BTreeMap<Key, Kind>,
    /// Whether frames have the mark of a slave, and whether they have none.
    marks: [bool; 2],
}

impl Seen {
    pub(super) fn take(&mut self, at: i128, marked: bool, datagram: &Datagram<'_>) {
        self.marks[usize::from(marked)] = true;
        let key = Key::of(datagram);
        if self.kinds.len() >= MOST_KINDS && !self.kinds.contains_key(&key) {
            return;
        }
        let kind = self.kinds.entry(key).or_default();
        if datagram.counter == 0 {
            kind.unanswered += u64::from(marked);
            return;
        }
        let counters = &mut kind.counters[usize::from(marked)];
        let known = counters
            .iter()
            .position(|(own, _)| *own == datagram.counter);
        match known {
            Some(at) => counters[at].1 += 1,
            None if counters.len() < MOST_COUNTERS => counters.push((datagram.counter, 1)),
            None => {}
        }
        let (first, last) = kind.times.unwrap_or((at, at));
        kind.times = Some((first.min(at), last.max(at)));
    }

    pub(super) fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Whether any slave counted on any datagram.
    pub(super) fn is_answered(&self) -> bool {
        self.kinds.keys().any(|key| self.expected(key).is_some())
    }

    /// Whether a datagram is one that came back, by the mark where it tells frames apart.
    pub(super) fn is_back(&self, marked: bool, datagram: &Datagram<'_>) -> bool {
        match self.marks {
            [true, true] => marked,
            _ => datagram.counter > 0,
        }
    }

    /// Working counters of those that came back, each with how many have it.
    fn counters(&self, key: &Key) -> Vec<(u16, u64)> {
        let marked = self.marks[1];
        let both = self.marks == [true, true];
        let kind = self.kinds.get(key);
        let of = |marked: bool| kind.map(|kind| kind.counters[usize::from(marked)].clone());
        match both {
            true => of(true),
            false => of(marked),
        }
        .unwrap_or_default()
    }

    /// The working counter of a datagram on which all slaves have counted: the highest that is no accident. A tap between two
    /// slaves sees datagrams on which some have counted, too.
    pub(super) fn expected(&self, key: &Key) -> Option<u16> {
        let counters = self.counters(key);
        let all: u64 = counters.iter().map(|(_, count)| count).sum();
        let often = counters
            .iter()
            .filter(|(_, count)| *count as f64 >= SOME * all as f64);
        often.map(|(counter, _)| *counter).max()
    }

    /// How many came back with that working counter, and with another one or none.
    pub(super) fn count(&self, key: &Key) -> (u64, u64) {
        let expected = self.expected(key);
        let counters = self.counters(key);
        let whole = counters
            .iter()
            .filter(|(counter, _)| Some(*counter) == expected);
        let whole = whole.map(|(_, count)| count).sum::<u64>();
        let all: u64 = counters.iter().map(|(_, count)| count).sum();
        let none = self.kinds.get(key).map_or(0, |kind| kind.unanswered);
        (whole, all - whole + none)
    }

    /// Mean time from one to the next, s.
    pub(super) fn period(&self, key: &Key) -> Option<f64> {
        let (first, last) = self.kinds.get(key)?.times?;
        let steps = self
            .count(key)
            .0
            .checked_sub(1)
            .filter(|steps| *steps > 0)?;
        Some((last - first) as f64 / SECOND / steps as f64)
    }

    /// The cyclic ones that came back, the most frequent first.
    pub(super) fn cyclic(&self) -> Vec<Key> {
        let mut keys: Vec<(u64, Key)> = (self.kinds.keys())
            .filter(|key| key.command != 0 && key.length > 0)
            .map(|key| (self.count(key).0, *key))
            .collect();
        let most = keys.iter().map(|(count, _)| *count).max().unwrap_or(0);
        keys.retain(|(count, _)| *count >= FEWEST && *count as f64 >= SOME * most as f64);
        keys.sort_by_key(|(count, key)| (std::cmp::Reverse(*count), *key));
        keys.into_iter().map(|(_, key)| key).collect()
    }

    /// Those that carry data this way at an address, the most frequent first; any of the cyclic ones in logical memory where no
    /// address is given.
    pub(super) fn at(&self, address: Option<Address>, direction: Direction) -> Vec<Key> {
        let goes = |key: &Key| key.goes(direction) && self.expected(key).is_some();
        let Some(address) = address else {
            let is_logical = |key: &Key| matches!(key.address(), Some(Address::Logical(_)));
            let cyclic = self.cyclic().into_iter();
            return cyclic.filter(|key| goes(key) && is_logical(key)).collect();
        };
        let mut keys: Vec<Key> = (self.kinds.keys().copied())
            .filter(|key| goes(key) && key.address() == Some(address))
            .collect();
        keys.sort_by_key(|key| std::cmp::Reverse(self.count(key).0));
        keys
    }

    /// The cyclic datagrams, as many as can be listed.
    pub(super) fn listed(&self) -> String {
        let cyclic = self.cyclic();
        let one = |key: &Key| {
            let (count, _) = self.count(key);
            let rate = self.period(key).filter(|period| *period > 0.0);
            let rate = rate.map_or(String::new(), |period| {
                format!(" at {:.1} Hz", 1.0 / period)
            });
            let counter = self.expected(key).unwrap_or(0);
            let words = key.words();
            format!("{words} ({count} times{rate}, working counter {counter})")
        };
        let mut all: Vec<String> = cyclic.iter().take(LISTED).map(one).collect();
        if cyclic.len() > LISTED {
            all.push(format!("and {} more", cyclic.len() - LISTED));
        }
        all.join("; ")
    }
}
