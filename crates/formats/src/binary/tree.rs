//! Numbers by where they stand in a tree of objects and lists (JSON, messages): a path of keys, and the lists around them.

use std::borrow::Cow;
use std::collections::HashMap;

use super::{Collector, Order, Values};
use crate::text::{Moment, unwrap_midnight};
use crate::{Error, Kind};

/// How many lists of one signal each are columns of their own, when they are not the rows of a matrix.
const MAX_LISTS: usize = 64;

/// Most cells without a number for each number of a file, and how many are allowed however few numbers there are: a log in which
/// every record has one of some hundred signals has fewer.
const MAX_ABSENT: u64 = 256;
const SOME_ABSENT: u64 = 1 << 22;

/// One place: a path of keys without the indices of lists.
#[derive(Debug, Default)]
pub(crate) struct Node {
    /// The key; `None` for the element of a list.
    key: Option<String>,
    parent: usize,
    /// Bytes of the keys from the root to here.
    path: usize,
    children: Vec<usize>,
    /// The index of each child by its key.
    places: HashMap<Option<String>, usize>,
    /// Which of the children was asked for last: records have their keys in the same order.
    last: usize,
    /// Lists around it, without the one that lines make.
    lists: usize,
    /// Lengths of the lists that stand here, by the index of the list around them.
    lengths: Vec<u64>,
    samples: Samples,
}

/// The numbers at one place.
#[derive(Debug, Default)]
struct Samples {
    /// The numbers that are there; the cells between them that are not take no memory before all are counted.
    values: Values,
    /// Where numbers are missing: before which of those that are there, and how many.
    gaps: Vec<(usize, usize)>,
    /// Cells so far, those that are missing counted.
    length: u64,
    /// Where the numbers of each outer element begin, within two lists.
    starts: Vec<usize>,
    /// Why they are no signal.
    refused: Option<String>,
    /// The first date or time of day among texts.
    first: Option<Moment>,
    /// A number was here.
    number: bool,
    null: bool,
}

/// All places, the root first.
pub(crate) struct Tree {
    nodes: Vec<Node>,
    /// Whether every line is a value of its own: the elements of a list around them all.
    pub(crate) lines: bool,
    /// Indices of the lists around the value that is being read.
    pub(crate) at: Vec<u64>,
    pub(crate) collector: Collector,
    /// What time stamps are counted from, where all places of a file have that in common.
    pub(crate) origin: Option<Moment>,
    /// Cells with a number, and cells of the same columns without one.
    present: u64,
    absent: u64,
}

impl Tree {
    pub(crate) fn new(collector: Collector) -> Self {
        Self {
            nodes: vec![Node::default()],
            lines: false,
            at: Vec::new(),
            collector,
            origin: None,
            present: 0,
            absent: 0,
        }
    }

    /// Makes the value that was read the first of many, each in a line.
    pub(crate) fn begin_lines(&mut self, documents: u64) {
        if !self.lines {
            for node in &mut self.nodes {
                match node.lists {
                    0 => continue,
                    1 => node.samples.starts = vec![0],
                    _ => {
                        node.samples.values = Values::default();
                        node.samples.gaps = Vec::new();
                        node.samples.length = 0;
                    }
                }
                node.lengths = Vec::new();
            }
        }
        self.lines = true;
        self.at = vec![documents];
    }

    /// The child of this key, or the element of a list.
    pub(crate) fn child(&mut self, node: usize, key: Option<&[u8]>) -> Result<usize, Error> {
        let key = key.map(String::from_utf8_lossy);
        let nodes = &self.nodes;
        let here = &nodes[node];
        let next = (here.last + 1) % here.children.len().max(1);
        let likely = here.children.get(next);
        let likely = likely.filter(|&&child| nodes[child].key.as_deref() == key.as_deref());
        let (key, found) = match likely {
            Some(_) => (None, Some(next)),
            None => {
                let key = key.map(Cow::into_owned);
                let place = here.places.get(&key).copied();
                (key, place)
            }
        };
        if let Some(index) = found {
            self.nodes[node].last = index;
            return Ok(self.nodes[node].children[index]);
        }
        self.collector.entry()?;
        let path = here.path + key.as_ref().map_or(0, String::len);
        // The node, and its path as the name of a column.
        self.collector.hold((size_of::<Node>() + path) as u64)?;
        let lists = here.lists + usize::from(key.is_none());
        let made = self.nodes.len();
        self.nodes.push(Node {
            key: key.clone(),
            parent: node,
            path,
            lists,
            ..Node::default()
        });
        let parent = &mut self.nodes[node];
        parent.last = parent.children.len();
        parent.places.insert(key, parent.last);
        parent.children.push(made);
        Ok(made)
    }

    /// `keys.of.the.path`; of elements only, where they are told apart, by the index given for them.
    pub(crate) fn path(&self, node: usize) -> String {
        self.path_with(node, None)
    }

    fn path_with(&self, mut node: usize, outer: Option<usize>) -> String {
        let mut parts: Vec<Cow<'_, str>> = Vec::new();
        let mut index = String::new();
        while node != 0 {
            let here = &self.nodes[node];
            if let Some(key) = &here.key {
                parts.push(Cow::Owned(format!("{key}{}", std::mem::take(&mut index))));
            } else if let Some(outer) = outer.filter(|_| here.lists + usize::from(self.lines) == 1)
            {
                index = format!("{{{}}}", outer + 1);
            }
            node = here.parent;
        }
        if let (Some(outer), true) = (outer, self.lines) {
            index = format!("{{{}}}", outer + 1);
        }
        if !index.is_empty() {
            parts.push(Cow::Owned(index));
        }
        parts.reverse();
        parts.join(".")
    }

    /// A list ends that stands at this place.
    pub(crate) fn end_list(&mut self, node: usize, length: u64) -> Result<(), Error> {
        let lists = self.nodes[node].lists + usize::from(self.lines);
        let row = match lists {
            0 => 0,
            1 => self.at[0] as usize,
            _ => return Ok(()),
        };
        let have = self.nodes[node].lengths.len();
        let missing = row.checked_sub(have).ok_or_else(second)? as u64;
        // Every record before this one without the list takes a length.
        self.miss(missing)?;
        self.collector.reserve("", &[missing + 1])?;
        let lengths = &mut self.nodes[node].lengths;
        lengths.resize(row, 0);
        lengths.push(length);
        Ok(())
    }

    /// The next element of the innermost list has this index.
    pub(crate) fn index(&mut self, index: u64) {
        if let Some(last) = self.at.last_mut() {
            *last = index;
        }
    }

    /// A number at this place.
    pub(crate) fn number(&mut self, node: usize, value: f64, rounded: bool) -> Result<(), Error> {
        self.nodes[node].samples.number = true;
        self.nodes[node].samples.values.rounded |= rounded;
        self.push(node, value)
    }

    pub(crate) fn null(&mut self, node: usize) {
        self.nodes[node].samples.null = true;
    }

    /// A date or time of day at this place.
    pub(crate) fn moment(&mut self, node: usize, moment: Moment) -> Result<(), Error> {
        let first = *self.nodes[node]
            .samples
            .first
            .get_or_insert(self.origin.unwrap_or(moment));
        let ns = i128::from(moment.ns) - i128::from(first.ns);
        self.push(node, ns as f64 / 1e9)
    }

    /// The place is no signal, for this reason: text, or a list without end.
    pub(crate) fn refuse(&mut self, node: usize, why: String) {
        let samples = &mut self.nodes[node].samples;
        if samples.refused.is_none() {
            samples.refused = Some(why);
            samples.values.samples = Vec::new();
            samples.starts = Vec::new();
            samples.gaps = Vec::new();
            samples.length = 0;
        }
    }

    fn push(&mut self, node: usize, value: f64) -> Result<(), Error> {
        if self.nodes[node].samples.refused.is_some() {
            return Ok(());
        }
        match self.at[..] {
            [] => self.fill(node, 0)?,
            [row] => self.fill(node, row)?,
            [outer, inner] => {
                self.rows_before(node, outer as usize + 1)?;
                let begin = self.nodes[node].samples.starts[outer as usize];
                self.fill(node, begin as u64 + inner)?;
            }
            _ => return Ok(()),
        }
        self.collector.reserve("", &[1])?;
        self.present += 1;
        let samples = &mut self.nodes[node].samples;
        samples.values.samples.push(value);
        samples.length += 1;
        Ok(())
    }

    /// Counts this many cells of a place, of which those that are not there have no number; more of them are two values of one
    /// key.
    fn fill(&mut self, node: usize, count: u64) -> Result<(), Error> {
        let have = self.nodes[node].samples.length;
        if have > count {
            return Err(second());
        }
        if have == count {
            return Ok(());
        }
        self.miss(count - have)?;
        self.collector.reserve("", &[count - have])?;
        let samples = &mut self.nodes[node].samples;
        let before = samples.values.samples.len();
        samples.gaps.push((before, (count - have) as usize));
        samples.length = count;
        Ok(())
    }

    /// Counts cells that have no number, and refuses a file that has hardly any others.
    fn miss(&mut self, cells: u64) -> Result<(), Error> {
        self.absent = self.absent.saturating_add(cells);
        self.sparse(self.absent)
    }

    /// Refuses a file with this many cells without a number, if that is hardly any number a cell.
    fn sparse(&self, absent: u64) -> Result<(), Error> {
        let most = MAX_ABSENT.saturating_mul(self.present).max(SOME_ABSENT);
        if absent <= most {
            return Ok(());
        }
        let columns = self.nodes.iter().filter(|n| n.samples.length > 0).count();
        let record = self.at.first().map_or_else(String::new, |at| {
            format!("up to record {}: ", at.saturating_add(1))
        });
        let found = format!(
            "{record}{} numbers under {columns} keys, and {absent} cells of these keys without one",
            self.present
        );
        let allowed = format!(
            "at most {most} cells without a number: give the records the same keys, each a signal"
        );
        Err(Error::new(Kind::Limit, found, allowed))
    }

    /// Puts NaN where numbers are missing.
    fn expand(&mut self, node: usize) {
        let samples = &mut self.nodes[node].samples;
        if samples.gaps.is_empty() {
            return;
        }
        let there = std::mem::take(&mut samples.values.samples);
        let mut whole = Vec::with_capacity(samples.length as usize);
        let mut from = 0;
        for (at, missing) in std::mem::take(&mut samples.gaps) {
            whole.extend_from_slice(&there[from..at]);
            whole.resize(whole.len() + missing, f64::NAN);
            from = at;
        }
        whole.extend_from_slice(&there[from..]);
        samples.values.samples = whole;
    }

    /// Begins this many outer elements of a place within two lists, and fills up those before.
    fn rows_before(&mut self, node: usize, count: usize) -> Result<(), Error> {
        let list = self.list_around(node);
        while self.nodes[node].samples.starts.len() < count {
            let rows = self.nodes[node].samples.starts.len();
            if let Some(last) = rows.checked_sub(1) {
                let begin = self.nodes[node].samples.starts[last] as u64;
                let length = self.nodes[list].lengths.get(last).copied().unwrap_or(0);
                self.fill(node, begin + length)?;
            }
            // A list in which the key is missing takes as much as a cell.
            if rows + 1 < count {
                self.miss(1)?;
            }
            self.collector.reserve("", &[1])?;
            let samples = &mut self.nodes[node].samples;
            samples.starts.push(samples.length as usize);
        }
        Ok(())
    }

    /// The place of the innermost list around this one.
    fn list_around(&self, mut node: usize) -> usize {
        while node != 0 {
            let here = &self.nodes[node];
            node = here.parent;
            if here.key.is_none() {
                break;
            }
        }
        node
    }

    /// Makes columns and scalars, in the order in which the places came first.
    pub(crate) fn finish(mut self, documents: u64) -> Result<Collector, Error> {
        self.ends(documents)?;
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            self.column(node, documents)
                .map_err(|error| error.in_column(self.path(node)))?;
            stack.extend(self.nodes[node].children.iter().rev());
        }
        Ok(self.collector)
    }

    /// Refuses a file most of whose columns end long before their table does, before any of them is filled up.
    fn ends(&self, documents: u64) -> Result<(), Error> {
        let short = (0..self.nodes.len()).filter_map(|node| {
            let here = &self.nodes[node];
            let one = here.lists + usize::from(self.lines) == 1;
            let rows = || self.rows(self.list_around(node), documents);
            (one && here.samples.length > 0).then(|| rows().saturating_sub(here.samples.length))
        });
        let missing = short.fold(self.absent, u64::saturating_add);
        self.sparse(missing)
    }

    fn column(&mut self, node: usize, documents: u64) -> Result<(), Error> {
        let lists = self.nodes[node].lists + usize::from(self.lines);
        let name = self.path(node);
        let here = &self.nodes[node];
        if let Some(why) = &here.samples.refused {
            match lists {
                1 => self.collector.skip_column(&name, why),
                _ => self.collector.skip(&name, why),
            }
            return Ok(());
        }
        if !here.samples.number && here.samples.first.is_none() {
            let leaf = here.children.is_empty();
            if here.samples.null && leaf {
                match lists {
                    1 => self.collector.skip_column(&name, "no number in any row"),
                    _ => self.collector.skip(&name, "no number in any row"),
                }
            } else if leaf && here.lengths.iter().all(|&n| n == 0) && !here.lengths.is_empty() {
                self.collector.skip(&name, "empty");
            }
            return Ok(());
        }
        if here.samples.number && here.samples.first.is_some() {
            self.collector.skip(&name, "numbers and dates at one place");
            return Ok(());
        }
        match lists {
            0 => self.give(node, &name, &[]),
            1 => {
                let rows = self.rows(self.list_around(node), documents);
                self.fill(node, rows)?;
                self.expand(node);
                self.give(node, &name, &[rows, 1]);
            }
            2 => self.matrix(node, &name, documents)?,
            _ => self.collector.skip(
                &name,
                "lists nested deeper than two: make every signal one list",
            ),
        }
        Ok(())
    }

    /// Length of the outermost list: the one that stands here, or that of the lines.
    fn rows(&self, list: usize, documents: u64) -> u64 {
        match self.lines {
            true => documents,
            false => self.nodes[list].lengths.first().copied().unwrap_or(0),
        }
    }

    /// Numbers within two lists: the rows of a matrix, or a few lists of a signal each.
    fn matrix(&mut self, node: usize, name: &str, documents: u64) -> Result<(), Error> {
        let list = self.list_around(node);
        let outer = self.rows(self.list_around(list), documents);
        let rows = outer as usize;
        self.rows_before(node, rows)?;
        let lengths = &self.nodes[list].lengths;
        let last = lengths.get(rows.wrapping_sub(1)).copied().unwrap_or(0);
        let mut filled = lengths.iter().copied().filter(|&n| n > 0);
        let one = filled.next().unwrap_or(0);
        let other = filled.find(|&length| length != one);
        let end = self.nodes[node].samples.starts.last().copied().unwrap_or(0) as u64 + last;
        self.fill(node, end)?;
        self.expand(node);
        if other.is_none() && one <= outer {
            self.rectangle(node, one, outer)?;
            self.give(node, name, &[outer, one]);
        } else if rows <= MAX_LISTS {
            let samples = std::mem::take(&mut self.nodes[node].samples);
            let ends = samples.starts.iter().skip(1).copied().chain([end as usize]);
            let bounds: Vec<_> = samples.starts.iter().copied().zip(ends).collect();
            for (row, (begin, end)) in bounds.into_iter().enumerate() {
                let name = self.path_with(node, Some(row));
                if begin == end {
                    self.collector.skip(&name, "empty");
                    continue;
                }
                let part = Samples {
                    values: Values {
                        samples: samples.values.samples[begin..end].to_vec(),
                        rounded: samples.values.rounded,
                    },
                    first: samples.first,
                    ..Samples::default()
                };
                self.nodes[node].samples = part;
                self.give(node, &name, &[(end - begin) as u64, 1]);
            }
        } else {
            let why = match other {
                Some(other) => format!("lists of different lengths, {one} and {other}"),
                None => format!("{outer} lists of {one} numbers: signals have to be columns"),
            };
            self.collector.skip(name, &why);
        }
        Ok(())
    }

    /// Makes the rows where the list is missing or empty rows of NaN.
    fn rectangle(&mut self, node: usize, columns: u64, rows: u64) -> Result<(), Error> {
        let (rows, columns) = (rows as usize, columns as usize);
        let have = self.nodes[node].samples.values.samples.len();
        let missing = (rows * columns).saturating_sub(have);
        if missing == 0 {
            return Ok(());
        }
        self.miss(missing as u64)?;
        self.collector.reserve("", &[missing as u64])?;
        let samples = &mut self.nodes[node].samples;
        let mut whole = vec![f64::NAN; rows * columns];
        let ends = samples.starts.iter().skip(1).copied().chain([have]);
        for (row, (&begin, end)) in samples.starts.iter().zip(ends).enumerate() {
            whole[row * columns..][..end - begin]
                .copy_from_slice(&samples.values.samples[begin..end]);
        }
        samples.values.samples = whole;
        Ok(())
    }

    fn give(&mut self, node: usize, name: &str, dims: &[u64]) {
        let mut samples = std::mem::take(&mut self.nodes[node].samples);
        let mut unit = None;
        if let Some(first) = samples.first {
            let sort = if first.dated {
                "dates with time"
            } else {
                "times of day"
            };
            let run_on = !first.dated && dims.len() == 2 && dims[1] == 1;
            let midnight = if run_on && unwrap_midnight(&mut samples.values.samples) {
                ", with a day added after each midnight"
            } else {
                ""
            };
            self.collector.detected(format!(
                "{name}: {sort}, converted to seconds from the first{midnight}"
            ));
            unit = Some("s".to_owned());
        }
        let (first, stamps) = (self.collector.columns(), samples.first.is_some());
        match dims {
            // A list of one number is a column, as a file of one row has columns.
            [1, 1] => self.collector.column(name, unit, samples.values.samples),
            dims => self
                .collector
                .array(name, unit, dims, Order::Row, samples.values),
        }
        if stamps {
            self.collector.are_stamps(first);
        }
    }
}

fn second() -> Error {
    let found = "a second value of the same key";
    Error::new(Kind::Format, found, "every key once in an object")
}
