//! Rows of the process data: a cycle each.

use std::collections::BTreeMap;

use super::KEY;
use super::frame::Datagram;
use super::map::{Direction, Entry, ProcessData};
use super::seen::{Key, Seen};
use crate::binary::Collector;
use crate::{Error, Kind};

/// Most columns of a map.
const MOST: usize = 1024;
/// Last byte of the data of a datagram, which has 11 bits for their number.
const LAST_BYTE: usize = 2046;
/// Picoseconds of a second.
const SECOND: f64 = 1e12;

/// A table in the making.
pub(super) struct Rows<'m> {
    entries: &'m [Entry],
    /// The entries of each datagram that has any, the working counter that it comes back with, and whether it is in the row.
    of: BTreeMap<Key, Part>,
    /// The datagram whose time is that of the row: that of the first entry.
    first: Key,
    /// Longest time between the datagrams of one cycle, ps.
    together: i128,
    /// Values of outputs as they were sent, with the index of the datagram.
    sent: Vec<Option<(u8, f64)>>,
    row: Vec<f64>,
    /// When the row began, and when its first datagram came.
    begun: Option<i128>,
    stamp: Option<i128>,
    origin: Option<i128>,
    time: Vec<f64>,
    columns: Vec<Vec<f64>>,
    rounded: Vec<bool>,
    /// Rows that the memory allows, and rows whose first datagram came back otherwise.
    most: usize,
    words: Vec<String>,
}

struct Part {
    entries: Vec<usize>,
    counter: u16,
    is_there: bool,
}

impl<'m> Rows<'m> {
    pub(super) fn new(
        map: &'m ProcessData,
        seen: &Seen,
        collector: &mut Collector,
    ) -> Result<Self, Error> {
        let entries = &map.entries[..];
        if entries.len() > MOST {
            let found = format!("{} entries", entries.len());
            let allowed = format!("at most {MOST}");
            return Err(Error::new(Kind::Limit, found, allowed).of_setting(KEY));
        }
        let mut of: BTreeMap<Key, Part> = BTreeMap::new();
        let mut first = None;
        for (index, entry) in entries.iter().enumerate() {
            if entry.byte > LAST_BYTE || entry.bit > 7 {
                let found = format!("{}: byte {}, bit {}", entry.name, entry.byte, entry.bit);
                let allowed = format!("a byte from 0 to {LAST_BYTE} and a bit from 0 to 7");
                return Err(Error::new(Kind::Value, found, allowed).of_setting(KEY));
            }
            let key = datagram(entry, seen)?;
            first.get_or_insert(key);
            let part = of.entry(key).or_insert_with(|| Part {
                entries: Vec::new(),
                counter: seen.expected(&key).unwrap_or(0),
                is_there: false,
            });
            part.entries.push(index);
        }
        let first = first.ok_or_else(|| Error::new(Kind::Missing, "no entry", "a map"))?;
        let (rows, lost) = seen.count(&first);
        collector.reserve("", &[rows, entries.len() as u64 + 1])?;
        let half = seen.period(&first).map_or(f64::MAX, |period| period / 2.0);
        let mut words: Vec<String> = (of.iter())
            .map(|(key, part)| format!("{}, working counter {}", key.words(), part.counter))
            .collect();
        if lost > 0 {
            words.push(format!(
                "{lost} cycles left out that came back with another working counter"
            ));
        }
        Ok(Self {
            entries,
            of,
            first,
            together: (half * SECOND).min(1e30) as i128,
            sent: vec![None; entries.len()],
            row: vec![f64::NAN; entries.len()],
            begun: None,
            stamp: None,
            origin: None,
            time: Vec::new(),
            columns: vec![Vec::new(); entries.len()],
            rounded: vec![false; entries.len()],
            most: rows as usize,
            words,
        })
    }

    /// Takes a datagram that was captured at this time, ps.
    pub(super) fn take(&mut self, at: i128, is_back: bool, datagram: &Datagram<'_>) {
        let key = Key::of(datagram);
        let Some(part) = self.of.get(&key) else {
            return;
        };
        if !is_back {
            for &index in &part.entries {
                let entry = &self.entries[index];
                if entry.direction == Direction::Out {
                    self.sent[index] = Some((datagram.index, entry.number(datagram.data).0));
                }
            }
            return;
        }
        if datagram.counter != part.counter {
            return;
        }
        let late = self.begun.is_some_and(|begun| at - begun > self.together);
        if part.is_there || late {
            self.end();
        }
        self.begun.get_or_insert(at);
        if key == self.first {
            self.stamp = Some(at);
        }
        let Some(part) = self.of.get_mut(&key) else {
            return;
        };
        part.is_there = true;
        for &index in &part.entries {
            let (value, rounded) = self.entries[index].number(datagram.data);
            // What was sent may have been overwritten by inputs in the same place.
            let sent = self.sent[index]
                .take()
                .filter(|(own, _)| *own == datagram.index);
            self.row[index] = sent.map_or(value, |(_, sent)| sent);
            self.rounded[index] |= rounded;
        }
    }

    /// Ends a row, which is one where its first datagram is there.
    fn end(&mut self) {
        if let Some(stamp) = self.stamp.take().filter(|_| self.time.len() < self.most) {
            let origin = *self.origin.get_or_insert(stamp);
            self.time.push((stamp - origin) as f64 / SECOND);
            for (column, value) in self.columns.iter_mut().zip(&self.row) {
                column.push(*value);
            }
        }
        self.row.fill(f64::NAN);
        self.of.values_mut().for_each(|part| part.is_there = false);
        self.begun = None;
    }

    /// Gives the columns.
    pub(super) fn finish(mut self, collector: &mut Collector) {
        self.end();
        self.words
            .into_iter()
            .for_each(|said| collector.detected(said));
        collector.stamps("time", self.time);
        let columns = self.columns.into_iter().zip(self.rounded);
        for (entry, (values, rounded)) in self.entries.iter().zip(columns) {
            if rounded {
                collector.rounded(&entry.name);
            }
            collector.column(&entry.name, entry.unit.clone(), values);
        }
    }
}

/// The datagram that has an entry.
fn datagram(entry: &Entry, seen: &Seen) -> Result<Key, Error> {
    let refuse = |kind, found: String| {
        let found = format!("{}: {found}", entry.name);
        let allowed = format!(
            "address and byte of a datagram of this capture: {}",
            seen.listed()
        );
        Err(Error::new(kind, found, allowed).of_setting(KEY))
    };
    let way = match entry.direction {
        Direction::In => "inputs",
        Direction::Out => "outputs",
    };
    let mut keys = seen.at(entry.address, entry.direction);
    if keys.is_empty() {
        let found = format!("no datagram with {way} at this address came back");
        return refuse(Kind::Missing, found);
    }
    let longest = keys.iter().map(|key| key.length).max().unwrap_or(0);
    keys.retain(|key| entry.end() <= key.length);
    if entry.address.is_none() && keys.len() > 1 {
        let found = format!("several datagrams with {way} fit, and no address is given");
        return refuse(Kind::Ambiguous, found);
    }
    match keys.first() {
        Some(key) => Ok(*key),
        None => refuse(
            Kind::Value,
            format!(
                "it ends with byte {}, and the datagram has {longest}",
                entry.end()
            ),
        ),
    }
}
