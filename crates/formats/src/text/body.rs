//! The samples of a file: blocks read in parallel, joined in order.

use super::choose::Layout;
use super::problem;
use super::row::{self, Block, Role, Rule, Seen, State, Stop};
use super::source::Source;
use super::split;
use crate::limits::Budget;
use crate::{Error, Kind, Passed};
use rayon::prelude::*;

/// Every sample of a file, and what was seen on the way.
pub(super) struct Body {
    /// One for each column of the layout, then those of lists; empty where the column is text, of lists or not kept.
    pub columns: Vec<Vec<f64>>,
    /// What was seen of columns that are not kept; one for each column.
    pub passed: Vec<Passed>,
    pub state: State,
    /// Where the decimal mark first showed.
    pub decimal: Option<Seen>,
    /// For each text column, its first cell.
    pub texts: Vec<Option<Seen>>,
    pub comments: usize,
    /// Before which rows samples are missing, each row once, in order.
    pub overruns: Vec<usize>,
    /// Rows of samples.
    pub rows: usize,
    /// Blank lines between rows.
    pub blank: usize,
    /// Text after the last row.
    pub trailing: Option<Seen>,
}

/// Reads all samples; more than are allowed are refused.
pub(super) fn read(source: &mut Source, layout: &Layout, budget: Budget) -> Result<Body, Error> {
    let width = layout.rule.keep.len();
    let mut joint = Joint {
        layout,
        budget,
        read: layout.offset as u64,
        size: source.size,
        line: layout.line,
        blank_end: 0,
        pending: None,
        body: Body {
            columns: vec![Vec::new(); width],
            passed: vec![Passed::default(); width],
            state: layout.state.clone(),
            decimal: layout.decimal.clone(),
            texts: layout.texts.clone(),
            comments: 0,
            overruns: Vec::new(),
            rows: 0,
            blank: 0,
            trailing: None,
        },
    };
    source.start_at(layout.offset);
    let at_once = 2 * rayon::current_num_threads().min(16);
    let mut batch = Vec::with_capacity(at_once);
    loop {
        batch.clear();
        while batch.len() < at_once {
            match source.next_block(&layout.rule.ends)? {
                Some(block) => batch.push(block),
                None => break,
            }
        }
        if batch.is_empty() {
            break;
        }
        let state = joint.body.state.clone();
        let seen = joint.seen();
        let parse = |text: &Vec<u8>| row::parse(text, &layout.rule, &state, seen.as_deref());
        let blocks: Vec<Block> = match joint.pending {
            None => batch.par_iter().map(parse).collect(),
            Some(_) => Vec::new(),
        };
        let mut blocks = blocks.into_iter();
        for text in &batch {
            joint.add(text, blocks.next(), &state)?;
        }
    }
    joint.finish()
}

/// The samples so far.
struct Joint<'a> {
    layout: &'a Layout,
    budget: Budget,
    /// Bytes of the file before the next block.
    read: u64,
    size: Option<u64>,
    /// Line of the file at which the next block starts.
    line: u64,
    /// Blank lines after the last row so far.
    blank_end: usize,
    /// A row that is text; the end of the samples if only text follows.
    pending: Option<Error>,
    body: Body,
}

impl Joint<'_> {
    /// Where the decimal mark was seen, for messages.
    fn seen(&self) -> Option<String> {
        self.body
            .decimal
            .as_ref()
            .map(|seen| format!("line {} ({})", seen.line, seen.text))
    }

    /// Joins the next block, which was read from `state` if it was read at all.
    fn add(&mut self, text: &[u8], block: Option<Block>, state: &State) -> Result<(), Error> {
        if self.pending.is_some() {
            return self.only_text(text);
        }
        let mut block = match block {
            // An earlier block of the batch has changed the rule: read again by the new one.
            Some(block) if *state == self.body.state => block,
            _ => row::parse(
                text,
                &self.layout.rule,
                &self.body.state,
                self.seen().as_deref(),
            ),
        };
        self.reserve(&block, text.len())?;
        self.read += text.len() as u64;
        let body = &mut self.body;
        let first_line = self.line;
        let absolute = |seen: Seen| Seen {
            line: first_line + seen.line,
            ..seen
        };
        for (to, from) in body.columns.iter_mut().zip(&block.columns) {
            to.extend_from_slice(from);
        }
        for (all, seen) in body.passed.iter_mut().zip(&block.passed) {
            all.add(*seen);
        }
        body.state = block.state;
        if let Some(seen) = block.decimal {
            body.decimal = Some(absolute(seen));
        }
        for (column, seen) in block.texts {
            body.columns[column] = Vec::new();
            body.texts[column] = Some(absolute(seen));
        }
        body.comments += block.comments;
        let overruns = block.overruns.iter().map(|row| body.rows + row);
        let last = body.overruns.last().copied();
        body.overruns
            .extend(overruns.filter(|row| Some(*row) != last));
        body.rows += block.rows;
        if block.rows > 0 {
            body.blank += self.blank_end + block.blank - block.blank_end;
            self.blank_end = block.blank_end;
        } else {
            self.blank_end += block.blank_end;
        }
        let samples: usize = body.columns.iter().map(Vec::len).sum();
        if samples as u64 > self.budget.samples() {
            let error = self.budget.too_many_samples(Some(self.expected(samples)));
            return Err(error.at_line(first_line + block.lines));
        }
        let Some(stop) = block.stop.take() else {
            self.line += block.lines;
            return Ok(());
        };
        self.line += stop.line;
        let at = stop.at;
        let error = self.explain(stop);
        let row = &text[at..];
        if error.kind == Kind::Limit || !starts_with_text(row, &self.layout.rule) {
            return Err(error);
        }
        let end = self.layout.rule.ends.next_row(row, 0);
        let words = problem::show(row[..end].trim_ascii());
        self.body.trailing = Some(Seen {
            line: self.line,
            text: words,
        });
        self.pending = Some(error);
        self.only_text(row)
    }

    fn explain(&self, stop: Stop) -> Error {
        let error = stop.error.at_line(self.line);
        match stop.column {
            Some(column) => error.in_column(self.layout.label(column)),
            None => error,
        }
    }

    /// Makes sure that no row of numbers follows a row of text.
    fn only_text(&mut self, text: &[u8]) -> Result<(), Error> {
        let ends = &self.layout.rule.ends;
        let mut at = 0;
        while at < text.len() {
            let end = ends.next_row(text, at);
            let cells = split::fields(&text[at..end], ends, self.body.state.width + 2);
            let sample = |f: &split::Field| super::cell::classify(&f.text).is_sample();
            let whole = (self.body.state.width..).take(2).any(|n| n == cells.len());
            if whole && cells.iter().any(sample) {
                return Err(self.pending.take().unwrap_or_else(problem::open_quote));
            }
            at = end;
        }
        Ok(())
    }

    /// Samples of the whole file, where these many are in what has been read: twice as many where nobody knows how long it is.
    fn expected(&self, samples: usize) -> u64 {
        let share = self.size.map(|size| size as f64 / self.read.max(1) as f64);
        (samples as f64 * share.unwrap_or(2.0).max(1.0)).ceil() as u64
    }

    /// Makes room for the whole file after its first block, so that columns need not grow by
    /// doubling; refuses a file that would take far more than is allowed.
    fn reserve(&mut self, block: &Block, bytes: usize) -> Result<(), Error> {
        let Some(size) = self.size else {
            return Ok(());
        };
        if bytes == 0 || self.body.rows > 0 {
            return Ok(());
        }
        let share = size as f64 / bytes as f64 * 1.01;
        let samples: usize = block.columns.iter().map(Vec::len).sum();
        let expected = samples as f64 * share;
        let allowed = self.budget.samples() as f64;
        // Rows may become longer, hardly twice as long.
        if samples > 0 && expected > 2.0 * allowed {
            return Err(self.budget.too_many_samples(Some(expected as u64)));
        }
        for (to, from) in self.body.columns.iter_mut().zip(&block.columns) {
            let own = from.len() as f64 * share * (allowed / expected).min(1.0);
            if own > from.len() as f64 {
                // Growing later is fine where this much is not to be had.
                let _ = to.try_reserve_exact(own as usize + 1);
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Body, Error> {
        if self.body.rows == 0 && self.body.state.roles.iter().all(|r| *r != Role::Text) {
            return Err(self.pending.take().unwrap_or_else(|| {
                Error::new(
                    Kind::Format,
                    "no rows of numbers",
                    "at least one row of numbers",
                )
            }));
        }
        for column in &mut self.body.columns {
            if column.capacity() > column.len() + column.len() / 8 {
                column.shrink_to_fit();
            }
        }
        Ok(self.body)
    }
}

/// Whether a row starts with words, as the lines after the last sample do.
fn starts_with_text(row: &[u8], rule: &Rule) -> bool {
    let first = split::field(row, rule.ends.skip_blanks(row, 0), &rule.ends);
    !first.open && matches!(super::cell::classify(&first.text), super::cell::Cell::Text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;
    use crate::text::{TextOptions, choose};

    #[test]
    fn samples_are_limited() {
        let text = "1.5;2\n".repeat(300_000);
        let read = |samples| {
            let budget = Budget::from(Limits {
                memory: samples * crate::limits::PER_SAMPLE,
            });
            let mut source = Source::open(text.as_bytes(), None).unwrap();
            let layout = choose::layout(&source, &TextOptions::default()).unwrap();
            read(&mut source, &layout, budget).map(|body| body.columns[1].len())
        };
        assert_eq!(read(600_000), Ok(300_000));
        assert_eq!(read(599_999).unwrap_err().kind, Kind::Limit);
    }
}
