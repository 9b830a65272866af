//! MCAP recordings of ROS 2, as rosbag2 writes them: messages in CDR with their definition (`ros2msg`).
//!
//! Format: <https://mcap.dev/spec>. Topics in other encodings are named in [`Table::skipped`](crate::Table::skipped).

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};

use flate2::Crc;

use crate::binary::{lz4, zstd};
use crate::ros::{Bag, DEFINED, Definitions, MAX_RECORD, MAX_TOPIC, Trouble, ZSTD, column_name};
use crate::{Error, Kind};

/// Most schemas and channels.
const MAX_CHANNELS: usize = 4096;

/// Reads the numbers of every message in a file, which may be packed as a whole.
pub(crate) fn read(file: File, bag: &mut Bag) -> Result<(), Error> {
    let mut reader = Reader {
        bag,
        schemas: BTreeMap::new(),
        channels: BTreeMap::new(),
        at: 0,
        ended: false,
    };
    let mut file = BufReader::with_capacity(1 << 16, file);
    let start = file.fill_buf().map_err(|error| reader.cut(error))?;
    let mut stream: Box<dyn Read> = match start.starts_with(&ZSTD) {
        true => {
            let unpacked = zstd(file, 0).map_err(|error| reader.cut(error))?;
            Box::new(unpacked.take(reader.bag.collector().unpackable()))
        }
        false => Box::new(file),
    };
    let mut magic = [0; 8];
    stream
        .read_exact(&mut magic)
        .map_err(|error| reader.cut(error))?;
    reader.at = 8;
    reader.records(&mut stream, false)?;
    match reader.ended {
        true => Ok(()),
        false => {
            Err(reader.bad("the file ends before the record that ends its data; was it cut off?"))
        }
    }
}

/// What messages of a channel are.
enum Channel {
    /// Messages with these definitions.
    Read {
        schema: u16,
        topic: usize,
    },
    Skipped,
}

struct Reader<'b> {
    bag: &'b mut Bag,
    schemas: BTreeMap<u16, Result<Definitions, String>>,
    channels: BTreeMap<u16, Channel>,
    /// Where the record begins that is read, in the file.
    at: u64,
    ended: bool,
}

impl Reader<'_> {
    fn bad(&self, found: impl Into<String>) -> Error {
        let allowed = "a whole MCAP file; `mcap recover` saves what a broken one holds";
        Error::new(Kind::Format, found, allowed).at_byte(self.at)
    }

    fn cut(&self, error: io::Error) -> Error {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => {
                self.bad("the file ends within a record; was it cut off?")
            }
            _ => self.bad(format!("the data are damaged ({error})")),
        }
    }

    /// Reads records to the end of the data, or of a chunk.
    fn records(&mut self, stream: &mut dyn Read, in_chunk: bool) -> Result<(), Error> {
        loop {
            let mut head = [0; 9];
            // Nothing more is the end of a chunk; the file has to say its own.
            if stream
                .read(&mut head[..1])
                .map_err(|error| self.cut(error))?
                == 0
            {
                return Ok(());
            }
            stream
                .read_exact(&mut head[1..])
                .map_err(|error| self.cut(error))?;
            let [kind, length @ ..] = head;
            let length = u64::from_le_bytes(length);
            let mut record = stream.take(length);
            match kind {
                6 if !in_chunk => self.chunk(&mut record)?,
                3..=5 => {
                    if length > MAX_RECORD {
                        return Err(self.bad(format!(
                            "a record of {length} bytes, more than {MAX_RECORD}"
                        )));
                    }
                    let mut bytes = Vec::new();
                    record
                        .read_to_end(&mut bytes)
                        .map_err(|error| self.cut(error))?;
                    if bytes.len() as u64 != length {
                        return Err(self.cut(io::ErrorKind::UnexpectedEof.into()));
                    }
                    let known = match kind {
                        3 => self.schema(&bytes)?,
                        4 => self.channel(&bytes)?,
                        _ => self.message(&bytes)?,
                    };
                    known.ok_or_else(|| self.bad("a damaged record"))?;
                }
                15 if !in_chunk => {
                    self.ended = true;
                    return Ok(());
                }
                _ => {}
            }
            io::copy(&mut record, &mut io::sink()).map_err(|error| self.cut(error))?;
            if record.limit() > 0 {
                return Err(self.cut(io::ErrorKind::UnexpectedEof.into()));
            }
            if !in_chunk {
                self.at += 9 + length;
            }
        }
    }

    fn chunk(&mut self, record: &mut dyn Read) -> Result<(), Error> {
        let mut head = [0; 32];
        record
            .read_exact(&mut head)
            .map_err(|error| self.cut(error))?;
        let (_, rest) = head.split_at(16);
        let mut rest = rest;
        let size = long(&mut rest).unwrap_or(0);
        let crc = word(&mut rest).unwrap_or(0);
        let length = word(&mut rest).unwrap_or(0);
        if !self.bag.collector().unpacks(size) {
            let found = format!("a chunk of {size} bytes, more than this file can hold");
            let allowed = "the topics that matter: `mcap filter` takes them out of a recording";
            return Err(Error::new(Kind::Limit, found, allowed).at_byte(self.at));
        }
        let mut name = vec![0; length.min(64) as usize];
        record
            .read_exact(&mut name)
            .map_err(|error| self.cut(error))?;
        // The length of what follows, which is the rest of the record.
        record
            .read_exact(&mut [0; 8])
            .map_err(|error| self.cut(error))?;
        let unpacked: Box<dyn Read> = match &name[..] {
            b"" => Box::new(record),
            b"lz4" => Box::new(lz4(record)),
            b"zstd" => {
                Box::new(zstd(record, size.min(MAX_RECORD)).map_err(|error| self.cut(error))?)
            }
            other => {
                let other = other.escape_ascii().to_string();
                return Err(self.bad(format!(
                    "a chunk compressed with {other}, which is neither lz4 nor zstd"
                )));
            }
        };
        let mut unpacked = Summed {
            stream: unpacked.take(size),
            crc: Crc::new(),
        };
        self.records(&mut unpacked, true)?;
        if unpacked.stream.limit() > 0 {
            return Err(self.cut(io::ErrorKind::UnexpectedEof.into()));
        }
        let sum = unpacked.crc.sum();
        if crc != 0 && crc != sum {
            return Err(self.bad("a chunk whose checksum is wrong"));
        }
        Ok(())
    }

    fn schema(&mut self, mut bytes: &[u8]) -> Result<Option<()>, Error> {
        let bytes = &mut bytes;
        let (Some(id), Some(name), Some(encoding), Some(length)) =
            (half(bytes), text(bytes), text(bytes), word(bytes))
        else {
            return Ok(None);
        };
        let Some(data) = bytes.get(..length as usize) else {
            return Ok(None);
        };
        if self.schemas.len() < MAX_CHANNELS && !self.schemas.contains_key(&id) {
            let definitions = match &*encoding {
                "ros2msg" => {
                    self.bag.collector().hold(DEFINED * data.len() as u64)?;
                    Definitions::new(&name, &String::from_utf8_lossy(data))
                }
                other => Err(format!("a definition in {other}, not in ros2msg")),
            };
            self.schemas.insert(id, definitions);
        }
        Ok(Some(()))
    }

    fn channel(&mut self, mut bytes: &[u8]) -> Result<Option<()>, Error> {
        let bytes = &mut bytes;
        let (Some(id), Some(schema), Some(topic), Some(encoding)) =
            (half(bytes), half(bytes), text(bytes), text(bytes))
        else {
            return Ok(None);
        };
        if self.channels.contains_key(&id) {
            return Ok(Some(()));
        }
        if self.channels.len() >= MAX_CHANNELS {
            return Err(Error::new(
                Kind::Limit,
                format!("more than {MAX_CHANNELS} channels"),
                "record the topics that matter",
            ));
        }
        if topic.len() > MAX_TOPIC {
            return Err(self.bad(format!(
                "a topic whose name has more than {MAX_TOPIC} bytes"
            )));
        }
        let name = column_name(&topic);
        let why = match self.schemas.get(&schema) {
            _ if encoding != "cdr" => Some(format!("messages encoded as {encoding}, not as cdr")),
            None => Some("messages without a definition".to_owned()),
            Some(Err(why)) => Some(why.clone()),
            Some(Ok(_)) => None,
        };
        let channel = match (why, self.schemas.get(&schema)) {
            (None, Some(Ok(_))) => Channel::Read {
                schema,
                topic: self.bag.topic(name),
            },
            (why, _) => {
                self.bag.collector().skip(&name, &why.unwrap_or_default());
                Channel::Skipped
            }
        };
        self.channels.insert(id, channel);
        Ok(Some(()))
    }

    fn message(&mut self, mut bytes: &[u8]) -> Result<Option<()>, Error> {
        let bytes = &mut bytes;
        let (Some(id), Some(_), Some(time), Some(_)) =
            (half(bytes), word(bytes), long(bytes), long(bytes))
        else {
            return Ok(None);
        };
        let (schema, topic) = match self.channels.get(&id) {
            None => return Ok(None),
            Some(Channel::Skipped) => return Ok(Some(())),
            Some(Channel::Read { schema, topic }) => (*schema, *topic),
        };
        let Some(Ok(definitions)) = self.schemas.get(&schema) else {
            return Ok(None);
        };
        let time = i64::try_from(time).unwrap_or(i64::MAX);
        let message = self
            .bag
            .unpacked(bytes)
            .map_err(|error| error.at_byte(self.at))?;
        let read = self.bag.message(topic, definitions, time, &message);
        read.map_err(|trouble| {
            let error = match trouble {
                Trouble::Short => self.bad("a message that does not fit its definition"),
                Trouble::Error(error) => error.at_byte(self.at),
            };
            self.bag.place(error, topic)
        })?;
        Ok(Some(()))
    }
}

/// A stream whose checksum is taken while it is read.
struct Summed<R> {
    stream: R,
    crc: Crc,
}

impl<R: Read> Read for Summed<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.stream.read(buffer)?;
        self.crc.update(&buffer[..count]);
        Ok(count)
    }
}

fn part<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*first)
}

fn half(bytes: &mut &[u8]) -> Option<u16> {
    part(bytes).map(u16::from_le_bytes)
}

fn word(bytes: &mut &[u8]) -> Option<u32> {
    part(bytes).map(u32::from_le_bytes)
}

fn long(bytes: &mut &[u8]) -> Option<u64> {
    part(bytes).map(u64::from_le_bytes)
}

fn text(bytes: &mut &[u8]) -> Option<String> {
    let length = word(bytes)? as usize;
    let text = bytes.get(..length)?;
    *bytes = &bytes[length..];
    Some(String::from_utf8_lossy(text).into_owned())
}
