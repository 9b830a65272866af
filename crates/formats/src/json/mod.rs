//! JSON: one value, or one in every line (JSON lines).
//!
//! Where a number stands is its name: keys with dots between them (`yaw.position`), indices of lists left out. A list of
//! numbers is a column, and so is one key of a list of records (`[{"t": 0}, {"t": 1}]`); lines are such a list. A key that a
//! record lacks, and `null`, is NaN. A number in no list is a scalar. Lists within a list are the rows of a matrix `q(:,1)`,
//! `q(:,2)` ... where they have one length; a few long ones are columns of their own, `runs{1}.q`, `runs{2}.q`. An object whose
//! keys count `"0"`, `"1"`, `"2"` is a list, as pandas writes it. Numbers are correctly rounded; `true` is 1; dates with time
//! become seconds from the first; text is named in [`Table::skipped`]. The text is never held as a whole.

mod token;

use std::fs::File;

use token::{Token, Tokens};

use crate::binary::{Collector, Tree};
use crate::text::{Cell, classify};
use crate::{Error, Limits, Table};

/// Deepest nesting of objects and lists.
const MAX_DEPTH: usize = 32;

/// Reads every number of a file.
pub(crate) fn read(file: File, limits: Limits) -> Result<Table, Error> {
    let mut reader = Reader {
        tokens: Tokens::new(file),
        tree: Tree::new(Collector::new(limits)),
    };
    reader.tokens.byte_order_mark()?;
    let mut documents = 0;
    while reader.tokens.ahead()?.is_some() {
        if documents > 0 {
            reader.tree.begin_lines(documents);
        }
        reader.value(0, 0)?;
        documents += 1;
    }
    if reader.tree.lines {
        let said = format!("{documents} values, one in a line");
        reader.tree.collector.detected(said);
    }
    Ok(reader.tree.finish(documents)?.finish())
}

struct Reader {
    tokens: Tokens<File>,
    tree: Tree,
}

impl Reader {
    fn value(&mut self, node: usize, depth: usize) -> Result<(), Error> {
        if depth > MAX_DEPTH {
            let found = format!("objects and lists nested deeper than {MAX_DEPTH}");
            return Err(self.at(node, self.tokens.bad(found)));
        }
        let token = self.tokens.value().map_err(|error| self.at(node, error))?;
        match token {
            Token::Object => self.object(node, depth),
            Token::Array => self.list(node, depth),
            Token::Null => {
                self.tree.null(node);
                Ok(())
            }
            Token::Number(value, rounded) => self.tree.number(node, value, rounded),
            Token::Truth(value) => self.tree.number(node, f64::from(u8::from(value)), false),
            Token::Text => self.text(node),
        }
        .map_err(|error| self.placed(node, error))
    }

    /// A text may be a number, nothing, or a date.
    fn text(&mut self, node: usize) -> Result<(), Error> {
        match classify(self.tokens.text()) {
            Cell::Number(_, Some(crate::text::Decimal::Comma))
            | Cell::Local(_)
            | Cell::List(_)
            | Cell::Text => {
                let row = self.tokens.row();
                let text = String::from_utf8_lossy(self.tokens.text());
                let text: String = text.chars().take(20).collect();
                self.tree
                    .refuse(node, format!("text such as {text} in line {row}"));
                Ok(())
            }
            Cell::Number(value, _) => self.tree.number(node, value, false),
            Cell::Empty | Cell::Missing => {
                self.tree.null(node);
                Ok(())
            }
            Cell::Moment(moment) => self.tree.moment(node, moment),
        }
    }

    fn object(&mut self, node: usize, depth: usize) -> Result<(), Error> {
        if self.tokens.take(b'}')? {
            return Ok(());
        }
        let mut counted = false;
        for index in 0_u64.. {
            self.tokens.key()?;
            let key = self.tokens.text();
            if index == 0 && key == b"0" {
                counted = true;
                self.tree.at.push(0);
            }
            if counted && key != index.to_string().as_bytes() {
                let (key, last) = (key.escape_ascii().to_string(), index - 1);
                return Err(self.tokens.bad(format!(
                    "the key \"{key}\" after \"{last}\" in an object whose keys count samples"
                )));
            }
            let child = self.tree.child(node, Some(key).filter(|_| !counted))?;
            if counted {
                self.tree.index(index);
            }
            self.value(child, depth + 1)?;
            if self.tokens.take(b',')? {
                continue;
            }
            if !self.tokens.take(b'}')? {
                return Err(self.tokens.instead_of("`,` or `}`"));
            }
            if counted {
                self.end_list(node, index + 1)?;
            }
            break;
        }
        Ok(())
    }

    fn list(&mut self, node: usize, depth: usize) -> Result<(), Error> {
        self.tree.at.push(0);
        let mut length = 0;
        if !self.tokens.take(b']')? {
            let child = self.tree.child(node, None)?;
            loop {
                self.value(child, depth + 1)?;
                length += 1;
                if self.tokens.take(b']')? {
                    break;
                }
                if !self.tokens.take(b',')? {
                    return Err(self.tokens.instead_of("`,` or `]`"));
                }
                self.tree.index(length);
            }
        }
        self.end_list(node, length)
    }

    fn end_list(&mut self, node: usize, length: u64) -> Result<(), Error> {
        self.tree.at.pop();
        self.tree.end_list(node, length)
    }

    /// The same error, in this column.
    fn at(&self, node: usize, error: Error) -> Error {
        match (&error.place.column, self.tree.path(node)) {
            (None, path) if !path.is_empty() => error.in_column(path),
            _ => error,
        }
    }

    /// The same error, in this column and at the place that is being read, unless it knows better.
    fn placed(&self, node: usize, error: Error) -> Error {
        let error = self.at(node, error);
        match error.place.row {
            None => error.at_line(self.tokens.row()),
            Some(_) => error,
        }
    }
}
