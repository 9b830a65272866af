//! Known columns of the regression that a fitted delay moves.
//!
//! A delay is read between six neighbouring samples ([`Shift`]). Each of the six is kept as a column at the kept samples, so
//! that a delay takes six products a kept sample, and the filter is run again only where a delay passes a whole sample.

use crate::conditioning::record::Record;
use crate::conditioning::shift::{INTERPOLATION_POINTS, Shift};
use crate::law::terms::ColumnKind;
use crate::separable::fixed::{Column, full_column};
use std::array::from_fn;
use std::borrow::Cow;
use std::sync::{Arc, OnceLock};
use stiction_signal::Thinning;

/// The first of six samples, relative to the one asked for, for the longest delay that is fitted.
const LEAST_FIRST: isize = -6;
/// Number of places of the first sample from there on, up to the longest delay the other way.
const FIRSTS: usize = 9;

/// One column at each of six neighbouring samples.
type Six = [Column; INTERPOLATION_POINTS];

/// The columns, each made when first asked for.
#[derive(Clone, Debug)]
pub(super) struct Moving {
    kinds: Vec<ColumnKind>,
    /// By the first of six samples, column by column; `None` where they cannot be read.
    near: [OnceLock<Option<Vec<Six>>>; FIRSTS],
    /// At the full rate, filtered: column by column, segment by segment.
    full: OnceLock<Vec<Vec<Vec<f64>>>>,
}

impl Moving {
    /// Columns of these kinds.
    pub fn new(kinds: Vec<ColumnKind>) -> Self {
        Self {
            kinds,
            near: from_fn(|_| OnceLock::new()),
            full: OnceLock::new(),
        }
    }

    /// A column at the kept samples, taken earlier by a shift.
    pub fn at(
        &self,
        number: usize,
        record: &Record,
        shift: Shift,
        thinning: Option<&Thinning>,
    ) -> Column {
        let near = thinning.and_then(|thinning| {
            let place = usize::try_from(shift.first() - LEAST_FIRST).ok()?;
            let made = || self.read(record, shift.first(), thinning);
            self.near.get(place)?.get_or_init(made).as_ref()
        });
        if let Some(six) = near.and_then(|columns| columns.get(number)) {
            return shift.of(six);
        }
        let full = self.full.get_or_init(|| self.filtered(record));
        let mut out = Vec::with_capacity(record.kept());
        let segments = full.get(number).into_iter().flatten();
        for (segment, full) in record.segments.iter().zip(segments) {
            record.thin(segment, full, shift, &mut out);
        }
        Arc::new(out)
    }

    /// All columns at six samples from `first` on; `None` where one lies beyond an end of a segment.
    fn read(&self, record: &Record, first: isize, thinning: &Thinning) -> Option<Vec<Six>> {
        let mut out = vec![from_fn(|_| Vec::with_capacity(record.kept())); self.kinds.len()];
        for segment in &record.segments {
            let kinds = self.kinds.iter();
            let full: Vec<Cow<[f64]>> = kinds.map(|kind| full_column(segment, *kind)).collect();
            let views: Vec<&[f64]> = full.iter().map(|full| &**full).collect();
            let read = segment.points(&views, first, thinning)?;
            for (out, read) in out.iter_mut().zip(read) {
                let out: &mut [Vec<f64>; INTERPOLATION_POINTS] = out;
                out.iter_mut()
                    .zip(read)
                    .for_each(|(to, from)| to.extend(from));
            }
        }
        let shared = |six: [Vec<f64>; INTERPOLATION_POINTS]| six.map(Arc::new);
        Some(out.into_iter().map(shared).collect())
    }

    /// All columns after the common filter.
    fn filtered(&self, record: &Record) -> Vec<Vec<Vec<f64>>> {
        let each = |kind: &ColumnKind| -> Vec<Vec<f64>> {
            let segments = record.segments.iter();
            segments
                .map(|s| full_column(s, *kind).into_owned())
                .collect()
        };
        let mut full: Vec<Vec<Vec<f64>>> = self.kinds.iter().map(each).collect();
        for i in 0..record.segments.len() {
            record.filter(full.iter_mut().map(|column| &mut column[i]));
        }
        full
    }
}
