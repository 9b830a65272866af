//! A record of several logs, each of which may have linear unknowns of its own.

use crate::conditioning::record::Record;
use crate::separable::linear::{Solution, solve};
use crate::separable::objective::Evaluation;
use std::ops::Range;

/// The kept samples of a record of several logs, log by log.
#[derive(Clone, Debug)]
pub(crate) struct Logs {
    ranges: Vec<Range<usize>>,
    /// Which log each range is.
    numbers: Vec<usize>,
    /// Where segments begin.
    breaks: Vec<usize>,
    samples: usize,
}

/// What one log has of the regression.
pub(crate) struct OneLog<'a> {
    /// Indices of the linear unknowns that are fitted.
    pub active: Vec<usize>,
    /// Their columns.
    pub columns: Vec<&'a [f64]>,
    residual: &'a [f64],
    /// Where segments begin in it.
    pub breaks: Vec<usize>,
}

impl OneLog<'_> {
    /// The linear unknowns of this log less those of all, for those that are fitted, and the residual that these leave.
    pub fn solution(&self) -> Solution {
        let unbounded = vec![false; self.columns.len()];
        solve(&self.columns, &unbounded, self.residual)
    }
}

impl Logs {
    /// The logs of a record; `None` for a single one.
    pub fn of(record: &Record) -> Option<Self> {
        let mut out = Self {
            ranges: Vec::new(),
            numbers: Vec::new(),
            breaks: record.breaks(),
            samples: 0,
        };
        for segment in &record.segments {
            let begin = out.samples;
            out.samples += segment.keep.iter().filter(|&&k| k).count();
            if out.numbers.last() == Some(&segment.log)
                && let Some(last) = out.ranges.last_mut()
            {
                last.end = out.samples;
            } else if out.samples > begin {
                out.numbers.push(segment.log);
                out.ranges.push(begin..out.samples);
            }
        }
        (out.ranges.len() > 1).then_some(out)
    }

    /// Whether an evaluation is one of these samples.
    pub fn are_of(&self, at: &Evaluation) -> bool {
        at.residual().len() == self.samples
    }

    /// The kept samples of each log.
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.ranges
    }

    /// Which log each of them is, counted from 0.
    pub fn numbers(&self) -> &[usize] {
        &self.numbers
    }

    /// The residual when every log has linear unknowns of its own: what levels that differ leave is not in it. `None` where
    /// there is another number of samples.
    pub fn within(&self, at: &Evaluation) -> Option<Vec<f64>> {
        let each = || self.each(at, |log| log.solution().residual);
        self.are_of(at).then(|| each().concat())
    }

    /// Reads something off every log.
    pub fn each(&self, at: &Evaluation, read: impl Fn(&OneLog) -> Vec<f64>) -> Vec<Vec<f64>> {
        let active: Vec<usize> = (0..at.columns.len())
            .filter(|&j| at.solution.active[j])
            .collect();
        let own = |range: &Range<usize>| {
            let inside = self.breaks.iter().filter(|b| range.contains(b));
            read(&OneLog {
                active: active.clone(),
                columns: active
                    .iter()
                    .map(|&j| &at.columns[j][range.clone()])
                    .collect(),
                residual: &at.residual()[range.clone()],
                breaks: inside.map(|b| b - range.start).filter(|b| *b > 0).collect(),
            })
        };
        self.ranges.iter().map(own).collect()
    }
}
