//! Recordings of rosbag2 in SQLite (`.db3`), the default of ROS 2 up to Humble.
//!
//! Tables `topics` and `messages`, and `message_definitions` from Iron on; without it the layouts of common types are built in.
//! Other topics are named in [`Table::skipped`](crate::Table::skipped).

mod pages;
mod record;
mod rows;
mod schema;

use std::collections::{BTreeMap, HashMap};
use std::ffi::OsString;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;
use std::rc::Rc;

use pages::{Pages, Source};
use record::{Place, places};
use rows::{Cell, Rows};
use schema::Schema;

use crate::binary::zstd;
use crate::ros::{Bag, DEFINED, Definitions, MAX_TOPIC, Trouble, ZSTD, column_name, layouts};
use crate::{Error, Kind, Limits};

/// Most topics.
const MAX_TOPICS: usize = 4096;

/// Longest row of the tables that say what the messages are, in bytes.
const MAX_ROW: u64 = 1 << 20;

/// Reads the numbers of every message in a file of this many bytes.
pub(crate) fn read(
    mut file: File,
    path: &Path,
    bytes: u64,
    limits: Limits,
    bag: &mut Bag,
) -> Result<(), Error> {
    refuse_unfinished(path)?;
    let io = |error| Error::new(Kind::Io, format!("cannot be read ({error})"), "");
    let mut start = Vec::new();
    file.by_ref().take(4).read_to_end(&mut start).map_err(io)?;
    file.rewind().map_err(io)?;
    let (source, bytes) = match start == ZSTD {
        true => {
            let mut stream = zstd(BufReader::new(file), 0).map_err(io)?;
            Source::unpacked(&mut stream, bag.collector())?
        }
        false => (Source::file(file), bytes),
    };
    let pages = Pages::new(source, bytes, bag.collector())?;
    if pages.logs_ahead {
        bag.collector().detected(
            "a database with a write-ahead log, whose file (-wal) is not beside it: complete if the recorder closed it",
        );
    }
    let mut reader = Reader {
        pages,
        bag,
        limits,
        channels: HashMap::new(),
    };
    let [topics, messages, definitions] = reader.tables()?;
    let (Some(topics), Some(messages)) = (topics, messages) else {
        return Ok(());
    };
    reader.topics(&topics, definitions.as_ref())?;
    reader.messages(&messages)
}

/// Refuses a database of which a part still stands in a file beside it.
fn refuse_unfinished(path: &Path) -> Result<(), Error> {
    let beside = |end: &str| {
        let mut name: OsString = path.into();
        name.push(end);
        let name = Path::new(&name);
        let mut start = Vec::new();
        if crate::is_regular(name) {
            let file = File::open(name).ok();
            file.map(|file| file.take(33).read_to_end(&mut start));
        }
        start
    };
    let name = path.file_name().unwrap_or_default().display();
    let refused = |found: &str, instead: String| {
        let found = format!("{name}{found}");
        Err(Error::new(Kind::Format, found, instead))
    };
    // A header of 32 bytes alone holds no messages.
    if beside("-wal").len() > 32 {
        return refused(
            "-wal holds messages that are not in the file yet",
            format!(
                "once the recorder is closed: sqlite3 {name} \"PRAGMA wal_checkpoint(TRUNCATE)\""
            ),
        );
    }
    if beside("-journal").starts_with(b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7") {
        return refused(
            "-journal holds what undoes a change that was interrupted",
            format!("once the recorder is closed: sqlite3 {name} .tables"),
        );
    }
    Ok(())
}

/// A topic whose messages are read.
struct Channel {
    topic: usize,
    /// The layout of its messages; until the first was read, those that they may have.
    layouts: Vec<Rc<Definitions>>,
    /// The type, where its layout is built in and no message has been read.
    assumed: Option<String>,
}

/// A row of the table of topics.
struct Listed {
    id: i64,
    name: String,
    kind: String,
    encoding: String,
}

struct Reader<'b> {
    pages: Pages,
    bag: &'b mut Bag,
    limits: Limits,
    /// Topics by their number in the file; `None` where they are not read.
    channels: HashMap<i64, Option<Channel>>,
}

impl Reader<'_> {
    /// Reads the places of some columns of every row of a table that says what the messages are.
    fn each<const N: usize>(
        &mut self,
        root: u32,
        columns: [usize; N],
        mut take: impl FnMut(&mut Self, &Cell, &[u8], [Place; N]) -> Result<Option<()>, Error>,
    ) -> Result<(), Error> {
        let mut rows = Rows::new(root, &mut self.pages)?;
        let mut record = Vec::new();
        while let Some(cell) = rows.next(&mut self.pages)? {
            if cell.length > MAX_ROW {
                let found = format!("a row of {} bytes, more than {MAX_ROW}", cell.length);
                return Err(self.pages.bad(root, found));
            }
            rows.whole(&cell, &mut self.pages, &mut record)?;
            let known = match places(&record, columns) {
                Some(places) => take(self, &cell, &record, places)?,
                None => None,
            };
            known.ok_or_else(|| self.pages.bad(root, "a damaged row"))?;
        }
        Ok(())
    }

    /// The tables of topics, messages and definitions.
    fn tables(&mut self) -> Result<[Option<Schema>; 3], Error> {
        let (mut found, mut others) = ([None, None, None], Vec::new());
        self.each(1, [0, 1, 3, 4], |_, _, record, [kind, name, root, sql]| {
            if kind.text(record) != Some("table") {
                return Ok(Some(()));
            }
            let (Some(name), Some(root), Some(sql)) =
                (name.text(record), root.integer(record), sql.text(record))
            else {
                return Ok(None);
            };
            let place = ["topics", "messages", "message_definitions"]
                .iter()
                .position(|known| *known == name);
            match place {
                Some(place) => found[place] = Schema::new(root, sql),
                None if others.len() < 20 => others.push(name.chars().take(40).collect()),
                None => {}
            }
            Ok(Some(()))
        })?;
        if let [Some(_), Some(_), _] = &found {
            return Ok(found);
        }
        let others: Vec<String> = others;
        Err(Error::new(
            Kind::Format,
            match others.first() {
                None => "an SQLite database without tables".to_owned(),
                Some(_) => format!("an SQLite database with the tables {}", others.join(", ")),
            },
            "topics and messages, as rosbag2 writes them; of another database export a table: \
             sqlite3 -csv -header FILE 'SELECT * FROM TABLE' > log.csv",
        ))
    }

    fn missing(&self, schema: &Schema) -> Error {
        self.pages
            .bad(schema.root, "a table without the columns of rosbag2")
    }

    fn topics(&mut self, topics: &Schema, definitions: Option<&Schema>) -> Result<(), Error> {
        let columns = topics.columns(["id", "name", "type", "serialization_format"]);
        let columns = columns.ok_or_else(|| self.missing(topics))?;
        let mut all: Vec<Listed> = Vec::new();
        self.each(
            topics.root,
            columns,
            |_, cell, record, [id, name, kind, encoding]| {
                let texts = (name.text(record), kind.text(record), encoding.text(record));
                let (Some(name), Some(kind), Some(encoding)) = texts else {
                    return Ok(None);
                };
                if all.len() >= MAX_TOPICS || name.len().max(kind.len()) > MAX_TOPIC {
                    let found = format!(
                        "more than {MAX_TOPICS} topics, or a name of more than {MAX_TOPIC} bytes"
                    );
                    return Err(Error::new(
                        Kind::Limit,
                        found,
                        "record the topics that matter",
                    ));
                }
                all.push(Listed {
                    id: id.integer(record).unwrap_or(cell.row),
                    name: column_name(name),
                    kind: kind.to_owned(),
                    encoding: encoding.to_owned(),
                });
                Ok(Some(()))
            },
        )?;
        let own = match definitions {
            Some(definitions) => self.definitions(definitions, &all)?,
            None => BTreeMap::new(),
        };
        let mut built_in: BTreeMap<String, Vec<Rc<Definitions>>> = BTreeMap::new();
        for Listed {
            id,
            name,
            kind,
            encoding,
        } in all
        {
            let own = own.get(&kind);
            let assumed = !matches!(own, Some(Ok(_)));
            let known = match own {
                Some(Ok(own)) => vec![Rc::clone(own)],
                _ => {
                    let made = || layouts(&kind).into_iter().map(Rc::new).collect();
                    built_in.entry(kind.clone()).or_insert_with(made).clone()
                }
            };
            let why = match own {
                _ if encoding != "cdr" => format!("messages encoded as {encoding}, not as cdr"),
                _ if !known.is_empty() => String::new(),
                Some(Err(why)) => format!("{kind}, with {why}"),
                _ => format!("{kind}, of which the recording has no definition"),
            };
            let channel = match why.is_empty() {
                true => Some(Channel {
                    topic: self.bag.topic(name),
                    layouts: known,
                    assumed: assumed.then_some(kind),
                }),
                false => {
                    self.bag.collector().skip(&name, &why);
                    None
                }
            };
            self.channels.insert(id, channel);
        }
        Ok(())
    }

    /// The definitions of the types of these topics.
    fn definitions(
        &mut self,
        table: &Schema,
        topics: &[Listed],
    ) -> Result<BTreeMap<String, Result<Rc<Definitions>, String>>, Error> {
        let mut all = BTreeMap::new();
        let columns = ["topic_type", "encoding", "encoded_message_definition"];
        let columns = table.columns(columns).ok_or_else(|| self.missing(table))?;
        self.each(
            table.root,
            columns,
            |reader, _, record, [kind, encoding, text]| {
                let texts = (kind.text(record), encoding.text(record), text.text(record));
                let (Some(kind), Some(encoding), Some(text)) = texts else {
                    return Ok(None);
                };
                let wanted = topics.iter().any(|topic| topic.kind == kind);
                if wanted && !all.contains_key(kind) {
                    let definitions = match encoding {
                        "ros2msg" => {
                            let held = DEFINED * text.len() as u64;
                            reader.bag.collector().hold(held)?;
                            Definitions::new(kind, text).map(Rc::new)
                        }
                        other => Err(format!("a definition in {other}, not in ros2msg")),
                    };
                    all.insert(kind.to_owned(), definitions);
                }
                Ok(Some(()))
            },
        )?;
        Ok(all)
    }

    fn messages(&mut self, table: &Schema) -> Result<(), Error> {
        let columns = table.columns(["topic_id", "timestamp", "data"]);
        let columns = columns.ok_or_else(|| self.missing(table))?;
        let mut rows = Rows::new(table.root, &mut self.pages)?;
        let mut record = Vec::new();
        let mut count = 0u64;
        loop {
            let read = match rows.next(&mut self.pages) {
                Ok(None) => return Ok(()),
                Ok(Some(cell)) => self.message(&rows, &cell, columns, &mut record),
                Err(error) => Err(error),
            };
            read.map_err(|mut error| {
                if error.kind == Kind::Format {
                    error.found += &format!(" (after {count} messages)");
                }
                error
            })?;
            count += 1;
        }
    }

    fn message(
        &mut self,
        rows: &Rows,
        cell: &Cell,
        columns: [usize; 3],
        record: &mut Vec<u8>,
    ) -> Result<(), Error> {
        let local = rows.local(cell);
        let topic = |bytes: &[u8]| places(bytes, columns)?[0].integer(bytes);
        let skipped = |channels: &HashMap<_, _>, topic| matches!(channels.get(&topic), Some(None));
        // Of a topic that is left out the pages with the rest need not be read.
        if topic(local).is_some_and(|topic| skipped(&self.channels, topic)) {
            return Ok(());
        }
        let record = match cell.length == local.len() as u64 {
            true => local,
            false => {
                self.bag.collector().holds("a message", cell.length)?;
                rows.whole(cell, &mut self.pages, record)?;
                record.as_slice()
            }
        };
        let damaged = || self.pages.bad(rows.page(), "a damaged row");
        let [id, time, data] = places(record, columns).ok_or_else(damaged)?;
        let values = (id.integer(record), time.integer(record), data.bytes(record));
        let (Some(id), Some(time), Some(data)) = values else {
            return Err(damaged());
        };
        let Some(Some(channel)) = self.channels.get_mut(&id) else {
            return match skipped(&self.channels, id) {
                true => Ok(()),
                false => Err(damaged()),
            };
        };
        let data = &*self.bag.unpacked(data)?;
        if let Some(kind) = channel.assumed.take() {
            channel
                .layouts
                .retain(|layout| layout.fits(data, self.limits));
            let collector = self.bag.collector();
            match channel.layouts.is_empty() {
                false => collector.detected(format!(
                    "{kind}: no definition in the recording, read as ROS 2 defines it"
                )),
                true => {
                    let name = self.bag.name(channel.topic);
                    let why = format!(
                        "{kind}, with another layout than ROS 2 defines, and without a definition"
                    );
                    self.bag.collector().skip(&name, &why);
                    self.channels.insert(id, None);
                    return Ok(());
                }
            }
        }
        let (topic, layout) = (channel.topic, Rc::clone(&channel.layouts[0]));
        let read = self.bag.message(topic, &layout, time, data);
        read.map_err(|trouble| {
            let page = rows.page();
            let error = match trouble {
                Trouble::Short => self
                    .pages
                    .bad(page, "a message that does not fit its definition"),
                Trouble::Error(error) => error,
            };
            self.bag.place(error, topic)
        })
    }
}
