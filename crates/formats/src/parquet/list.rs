//! Lists of numbers in the rows of a column, which are columns of the table where all have one length.

use parquet::basic::Repetition;
use parquet::schema::types::{ColumnDescriptor, SchemaDescriptor};

use super::column::{Meaning, Samples};
use crate::Error;
use crate::binary::{Collector, Order};

/// The lists of a column, as far as they were read.
#[derive(Debug)]
pub(super) struct Lists {
    /// What the column is called, without the names that every list has inside.
    pub(super) name: String,
    /// Definition level from which on an element is there, be its value missing or not.
    element: i16,
    /// The length of those that have elements, and another one that was seen.
    lengths: [Option<usize>; 2],
    /// Rows without elements.
    empty: Vec<usize>,
    pub(super) rows: usize,
    /// Elements of the row that is read, if any is.
    current: Option<usize>,
}

impl Lists {
    /// The lists of a column that has numbers at the end of one list: `q.list.element`; `None` where it is no list, or more.
    pub(super) fn of(schema: &SchemaDescriptor, column: &ColumnDescriptor) -> Option<Self> {
        let parts = column.path().parts();
        let mut repeated = None;
        let (mut at, mut optional) = (schema.root_schema(), false);
        for (depth, part) in parts.iter().enumerate() {
            at = at.get_fields().iter().find(|field| field.name() == part)?;
            match at.get_basic_info().repetition() {
                Repetition::REPEATED if repeated.is_some() => return None,
                Repetition::REPEATED => repeated = Some(depth),
                repetition => optional = repetition == Repetition::OPTIONAL,
            }
        }
        let full = column.max_def_level();
        let (named, element) = match parts.len() - repeated? {
            // Of two groups, as it once was written, the list is the column itself.
            1 => (parts.len(), full),
            2 => (parts.len() - 2, full - i16::from(optional)),
            _ => return None,
        };
        (named > 0).then(|| Self {
            name: parts[..named].join("."),
            element,
            lengths: [None; 2],
            empty: Vec::new(),
            rows: 0,
            current: None,
        })
    }

    /// Takes note of one level of a row, the first of it or not; whether an element is there.
    pub(super) fn see(&mut self, first: bool, level: i16) -> bool {
        if first {
            self.end();
            self.rows += 1;
            self.current = Some(0);
        }
        let there = level >= self.element;
        if let Some(current) = &mut self.current {
            *current += usize::from(there);
        }
        there
    }

    /// The row that was read is whole.
    pub(super) fn end(&mut self) {
        match (self.current.take(), self.lengths[0]) {
            (Some(0), _) => self.empty.push(self.rows - 1),
            (Some(length), None) => self.lengths[0] = Some(length),
            (Some(length), Some(known)) if length != known => self.lengths[1] = Some(length),
            _ => {}
        }
    }

    /// Adds a column for each element, NaN in rows without any.
    pub(super) fn give(
        self,
        meaning: &Meaning,
        samples: Samples,
        collector: &mut Collector,
    ) -> Result<(), Error> {
        let name = &self.name;
        let length = match self.lengths {
            _ if matches!(meaning, Meaning::Ticks(..)) => {
                collector.skip_column(name, "several time stamps in every row");
                return Ok(());
            }
            [Some(one), Some(other)] => {
                let why = format!("lists of different lengths, {one} and {other}");
                collector.skip_column(name, &why);
                return Ok(());
            }
            [None, _] => {
                collector.skip_column(name, "empty");
                return Ok(());
            }
            [Some(length), None] => length,
        };
        let mut values = samples.values;
        if !self.empty.is_empty() {
            collector.reserve(name, &[self.rows as u64, length as u64])?;
            let mut whole = Vec::with_capacity(self.rows * length);
            let (mut there, mut empty) =
                (values.samples.chunks(length), self.empty.iter().peekable());
            for row in 0..self.rows {
                match empty.next_if(|empty| **empty == row) {
                    Some(_) => whole.resize(whole.len() + length, f64::NAN),
                    None => whole.extend(there.next().into_iter().flatten()),
                }
            }
            values.samples = whole;
        }
        if self.rows == 1 {
            // A file of one row still has columns.
            for (index, value) in values.samples.into_iter().enumerate() {
                let name = match length {
                    1 => name.clone(),
                    _ => Collector::of_matrix(name, index),
                };
                collector.column(&name, None, vec![value]);
            }
            return Ok(());
        }
        let dims = [self.rows as u64, length as u64];
        collector.array(name, None, &dims, Order::Row, values);
        Ok(())
    }
}
