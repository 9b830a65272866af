//! Messages of ROS 2, whatever file holds them: CDR with the definition of their type.
//!
//! Each topic is a list of records: `joint_states.header.stamp`, and where a message has names beside lists, as JointState has,
//! `joint_states.elbow.position`. Lists of one length are `topic.field(:,1)`. Time stamps become seconds from the first message;
//! `topic.log_time`, when the message was recorded, stands where it has no stamp of its own.

// A build without the reader of SQLite leaves parts of this unused.
#![cfg_attr(not(feature = "all"), allow(dead_code, unused_imports))]

mod cdr;
mod common;
mod definition;
mod message;
#[cfg(feature = "rosbag")]
pub(crate) mod split;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;

use cdr::Cdr;
pub(crate) use common::layouts;
pub(crate) use definition::Definitions;
pub(crate) use message::Trouble;
use message::moment;

use crate::binary::{Collector, Tree, guard, zstd};
use crate::{Error, Kind, Limits, Table};

/// Longest name of a topic in bytes; ROS allows 255.
pub(crate) const MAX_TOPIC: usize = 1024;

/// Bytes that are held for a byte of a definition, at most: `byte a` is a field.
pub(crate) const DEFINED: u64 = 24;

/// First bytes of what is packed with Zstandard, which no message in CDR begins with.
pub(crate) const ZSTD: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Largest message or other record that is kept, in bytes.
pub(crate) const MAX_RECORD: u64 = 64 << 20;

/// Bytes of a packed message that are unpacked at once.
const PART: usize = 1 << 16;

/// A recording in the making.
pub(crate) struct Bag {
    tree: Tree,
    /// The index of each topic by its name.
    places: BTreeMap<String, usize>,
    topics: Vec<Topic>,
}

/// One topic.
struct Topic {
    name: String,
    /// Its place in the tree, which it has from its first message on.
    node: Option<usize>,
    rows: u64,
}

/// Reads messages of a recording in this format, whose files have so many bytes together.
pub(crate) fn read(
    format: &str,
    bytes: u64,
    limits: Limits,
    take: impl FnOnce(&mut Bag) -> Result<(), Error>,
) -> Result<Table, Error> {
    guard(format, || {
        let mut bag = Bag::new(Collector::packed(limits, bytes, MAX_RECORD));
        take(&mut bag)?;
        bag.finish()
    })
}

impl Bag {
    fn new(collector: Collector) -> Self {
        Self {
            tree: Tree::new(collector),
            places: BTreeMap::new(),
            topics: Vec::new(),
        }
    }

    pub(crate) fn collector(&mut self) -> &mut Collector {
        &mut self.tree.collector
    }

    /// The topic of this name, as it is called in names of columns.
    pub(crate) fn topic(&mut self, name: String) -> usize {
        let next = self.topics.len();
        let index = *self.places.entry(name.clone()).or_insert(next);
        if index == next {
            self.topics.push(Topic {
                name,
                node: None,
                rows: 0,
            });
        }
        index
    }

    /// The name of a topic.
    pub(crate) fn name(&self, topic: usize) -> String {
        self.topics[topic].name.clone()
    }

    /// A message as it was before rosbag2 packed it, where it did (`compression_mode: message`).
    pub(crate) fn unpacked<'m>(&mut self, message: &'m [u8]) -> Result<Cow<'m, [u8]>, Error> {
        if !message.starts_with(&ZSTD) {
            return Ok(Cow::Borrowed(message));
        }
        let damaged = |error| {
            let found = format!("a packed message is damaged ({error})");
            Error::new(
                Kind::Format,
                found,
                "messages that rosbag2 packed with zstd",
            )
        };
        let mut stream = zstd(message, 0).map_err(damaged)?;
        let (mut bytes, mut part) = (Vec::new(), 0);
        while part == 0 || bytes.len() == part {
            part = bytes.len() + PART;
            self.tree.collector.holds("a message", part as u64)?;
            let stream = stream.by_ref().take(PART as u64);
            { stream }.read_to_end(&mut bytes).map_err(damaged)?;
        }
        match self.tree.collector.unpacks(bytes.len() as u64) {
            true => Ok(Cow::Owned(bytes)),
            false => Err(Error::new(
                Kind::Limit,
                "messages that unpack to more than this file can hold",
                "the topics that matter",
            )),
        }
    }

    /// Reads a message of a topic that was recorded at this time, in ns since 1970.
    ///
    /// # Errors
    /// [`Trouble`], to be told with [`place`](Self::place).
    pub(crate) fn message(
        &mut self,
        topic: usize,
        definitions: &Definitions,
        time: i64,
        bytes: &[u8],
    ) -> Result<(), Trouble> {
        self.tree.origin.get_or_insert(moment(time));
        let Topic { name, node, rows } = &mut self.topics[topic];
        let node = match *node {
            Some(node) => node,
            None => *node.insert(self.tree.child(0, Some(name.as_bytes()))?),
        };
        self.tree.at.clear();
        self.tree.at.push(*rows);
        *rows += 1;
        let element = self.tree.child(node, None)?;
        let mut cdr = Cdr::new(bytes).ok_or(Trouble::Short)?;
        if !definitions.is_stamped() {
            let child = self.tree.child(element, Some(b"log_time"))?;
            self.tree.moment(child, moment(time))?;
        }
        message::read(definitions, &mut cdr, element, &mut self.tree)
    }

    /// The same error, at the last message of a topic.
    pub(crate) fn place(&self, error: Error, topic: usize) -> Error {
        let Topic { name, rows, .. } = &self.topics[topic];
        match error.place.column {
            None => error.at_row(*rows).in_column(name.clone()),
            Some(_) => error,
        }
    }

    fn finish(mut self) -> Result<Table, Error> {
        self.tree.at.clear();
        for Topic { node, rows, .. } in self.topics {
            if let Some(node) = node {
                self.tree.end_list(node, rows)?;
            }
        }
        Ok(self.tree.finish(0)?.finish())
    }
}

/// A topic as it is called in names of columns: `arm.joint_states` of `/arm/joint_states`.
pub(crate) fn column_name(topic: &str) -> String {
    topic.trim_matches('/').replace('/', ".")
}
