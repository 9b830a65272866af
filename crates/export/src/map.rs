//! A map along the position at evenly spaced places. Targets write it in their own forms.

use crate::number::Literal;

/// `N` values at each place.
pub(crate) struct Map<const N: usize> {
    /// The first place, m or rad.
    pub from: f64,
    /// From one place to the next, m or rad.
    pub step: f64,
    pub values: Vec<[f64; N]>,
}

impl<const N: usize> Map<N> {
    /// `count` places, the last a step before `to`: of a map that repeats after it.
    pub fn around(from: f64, to: f64, count: usize, at: impl Fn(f64) -> [f64; N]) -> Self {
        let step = (to - from) / count as f64;
        let values = (0..count).map(|i| at(from + step * i as f64)).collect();
        Self { from, step, values }
    }

    /// `count` places, at least two, the last at `to`.
    pub fn along(from: f64, to: f64, count: usize, at: impl Fn(f64) -> [f64; N]) -> Self {
        let step = (to - from) / (count - 1) as f64;
        let values = (0..count).map(|i| at(from + step * i as f64)).collect();
        Self { from, step, values }
    }

    /// Each place with its values; lengths in units of `unit` m or rad.
    pub fn rows(&self) -> impl Iterator<Item = (f64, &[f64; N])> {
        let place = |i: usize| self.from + self.step * i as f64;
        self.values
            .iter()
            .enumerate()
            .map(move |(i, v)| (place(i), v))
    }

    /// As lines of text: place and values with a separator between.
    pub fn lines(&self, separator: &str) -> String {
        let line = |(place, values): (f64, &[f64; N])| {
            let all = std::iter::once(&place).chain(values);
            all.map(|x| x.c()).collect::<Vec<_>>().join(separator)
        };
        self.rows().map(line).collect::<Vec<_>>().join("\n")
    }
}
