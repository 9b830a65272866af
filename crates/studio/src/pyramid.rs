//! Least and largest values of a column over buckets of samples, so that any part of any record is drawn in the time of a
//! screen: what a pixel shows is exactly the span of the samples below it, spikes included.
//!
//! Built once, in one pass over the samples and one over each coarser level.

use std::ops::Range;

/// Samples of a bucket of the finest level.
const FINEST: usize = 64;
/// Buckets of a level that are one of the next.
const STEP: usize = 8;
/// Lanes in which least and largest values are kept apart, so that they fill vector registers.
const LANES: usize = 8;

/// Least and largest value.
pub type Span = (f64, f64);

/// The span of nothing.
const NOTHING: Span = (f64::INFINITY, f64::NEG_INFINITY);

/// The levels of a column.
#[derive(Clone, Debug, Default)]
pub struct Pyramid {
    /// Number of samples.
    samples: usize,
    /// From fine to coarse; a bucket of a level has `FINEST * STEP^level` samples, the last of it fewer.
    levels: Vec<Vec<Span>>,
}

/// The buckets in which a part of a column is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiles {
    /// First sample of the first.
    pub start: usize,
    /// End of the last.
    pub end: usize,
    /// Samples of each but the last; 1 for the samples themselves.
    pub size: usize,
}

impl Tiles {
    /// The buckets of a range of samples, of which there are at most about `most`: whole buckets of one level, put together.
    pub fn of(range: Range<usize>, most: usize) -> Self {
        let most = most.max(1);
        let wanted = range.len().div_ceil(most).max(1);
        // A few samples more are drawn as they are: a line is easier on the eye than spans of two.
        if wanted <= 2 {
            return Self {
                start: range.start,
                end: range.end,
                size: 1,
            };
        }
        let mut unit = 1;
        let mut next = FINEST;
        // Of units an eighth as large or less, so that little more is put together than was asked for.
        while next.saturating_mul(STEP) <= wanted {
            unit = next;
            next = next.saturating_mul(STEP);
        }
        let size = wanted.div_ceil(unit) * unit;
        Self {
            start: range.start / size * size,
            end: range.end,
            size,
        }
    }

    /// The samples of each bucket.
    pub fn ranges(self) -> impl Iterator<Item = Range<usize>> {
        let starts = (self.start..self.end).step_by(self.size);
        starts.map(move |start| start..(start + self.size).min(self.end))
    }
}

impl Pyramid {
    /// Builds the levels of a column. Values that are not a number count for nothing.
    pub fn new(values: &[f64]) -> Self {
        let mut levels = Vec::new();
        let mut level: Vec<Span> = values.chunks(FINEST).map(span).collect();
        while level.len() > 1 {
            let next = level.chunks(STEP).map(together).collect();
            levels.push(std::mem::replace(&mut level, next));
        }
        levels.push(level);
        Self {
            samples: values.len(),
            levels,
        }
    }

    /// The span of some samples of the column that this was built of: at most a few buckets of each level are looked at.
    pub fn span(&self, values: &[f64], range: Range<usize>) -> Span {
        let end = range.end.min(self.samples).min(values.len());
        let mut at = range.start;
        let mut out = NOTHING;
        while at < end {
            let (mut size, mut found) = (1, None);
            let mut next = FINEST;
            for level in &self.levels {
                let whole = at.is_multiple_of(next) && (at + next <= end || end == self.samples);
                if !whole {
                    break;
                }
                (size, found) = (next, level.get(at / next).copied());
                next = next.saturating_mul(STEP);
            }
            match found {
                Some(own) => {
                    out = together(&[out, own]);
                    at += size;
                }
                None => {
                    let until = (at / FINEST + 1).saturating_mul(FINEST).min(end);
                    out = together(&[out, span(&values[at..until])]);
                    at = until;
                }
            }
        }
        out
    }
}

fn span(values: &[f64]) -> Span {
    let mut low = [f64::INFINITY; LANES];
    let mut high = [f64::NEG_INFINITY; LANES];
    let mut chunks = values.chunks_exact(LANES);
    for chunk in &mut chunks {
        for ((low, high), &x) in low.iter_mut().zip(&mut high).zip(chunk) {
            // Comparisons with what is no number are false, so it is left out.
            *low = if x < *low { x } else { *low };
            *high = if x > *high { x } else { *high };
        }
    }
    let rest = chunks.remainder().iter().map(|x| match x.is_nan() {
        true => NOTHING,
        false => (*x, *x),
    });
    let lanes = low.into_iter().zip(high);
    lanes.chain(rest).fold(NOTHING, |a, b| together(&[a, b]))
}

fn together(spans: &[Span]) -> Span {
    spans.iter().fold(NOTHING, |(low, high), own| {
        (
            if own.0 < low { own.0 } else { low },
            if own.1 > high { own.1 } else { high },
        )
    })
}

#[cfg(test)]
mod tests {
    use super::{NOTHING, Pyramid, Span, Tiles};
    use proptest::prelude::*;

    /// The same by looking at every sample.
    fn by_hand(values: &[f64]) -> Span {
        let numbers = values.iter().filter(|x| !x.is_nan());
        numbers.fold(NOTHING, |(low, high), x| (low.min(*x), high.max(*x)))
    }

    fn values() -> impl Strategy<Value = Vec<f64>> {
        let value = prop_oneof![
            20 => -1e6..1e6f64,
            1 => Just(f64::NAN),
            1 => Just(0.0),
        ];
        prop::collection::vec(value, 0..5000)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn spans_are_those_of_the_samples(values in values(), a in 0..5000usize, b in 0..5000usize) {
            let pyramid = Pyramid::new(&values);
            let (from, to) = (a.min(b), a.max(b).min(values.len()));
            if from <= to {
                prop_assert_eq!(pyramid.span(&values, from..to), by_hand(&values[from..to]));
            }
        }

        #[test]
        fn tiles_cover_a_range_once(from in 0..200_000usize, length in 0..200_000usize, most in 1..3000usize) {
            let tiles = Tiles::of(from..from + length, most);
            let mut at = tiles.start;
            let mut count = 0;
            for range in tiles.ranges() {
                prop_assert_eq!(range.start, at);
                prop_assert!(range.end > range.start);
                at = range.end;
                count += 1;
            }
            prop_assert!(tiles.start <= from);
            prop_assert!(length == 0 || at == from + length);
            prop_assert!(count <= 2 * most + 1, "{} of {}", count, most);
            prop_assert!(from - tiles.start < tiles.size);
        }
    }

    #[test]
    fn few_samples_are_drawn_as_they_are() {
        assert_eq!(Tiles::of(10..1000, 600).size, 1);
        assert_eq!(Tiles::of(0..6_000_000, 1000).size, 6144);
    }
}
