//! The inner loop: all sections of a filter in one pass over the samples, for one or more columns
//! side by side.
//!
//! The next output of a section depends on its last one, so a single column leaves most of the
//! processor idle. Running the sections in one loop lets section 2 work on sample n while section 1
//! is at n + 1; running several columns in lanes uses what is still idle. Each lane does the same
//! operations in the same order whatever runs beside it, so the result does not depend on the
//! grouping.

use crate::sos::Section;
use core::array::from_fn;

/// Sections together with their states, for `L` columns.
pub(crate) struct Cascade<const S: usize, const L: usize> {
    sections: [Section; S],
    state: [[[f64; L]; 2]; S],
}

impl<const S: usize, const L: usize> Cascade<S, L> {
    /// At rest with all signals zero.
    pub(crate) fn new(sections: [Section; S]) -> Self {
        Self {
            sections,
            state: [[[0.0; L]; 2]; S],
        }
    }

    /// As if column `l` had been at `level[l]` for ever; `settled` is for a level of 1.
    pub(crate) fn settle(&mut self, settled: &[[f64; 2]; S], level: [f64; L]) {
        for (state, unit) in self.state.iter_mut().zip(settled) {
            *state = unit.map(|unit| level.map(|level| unit * level));
        }
    }

    /// Sets one state of a section for all columns.
    pub(crate) fn set(&mut self, section: usize, index: usize, value: f64) {
        self.state[section][index] = [value; L];
    }

    /// One state of a section for the first column.
    pub(crate) fn get(&self, section: usize, index: usize) -> f64 {
        self.state[section][index][0]
    }

    /// One sample of every column. Transposed direct form II, the order of operations as in
    /// `scipy.signal.sosfilt`.
    #[inline(always)]
    pub(crate) fn step(&mut self, mut x: [f64; L]) -> [f64; L] {
        for (Section { b, a }, [s0, s1]) in self.sections.iter().zip(&mut self.state) {
            let output: [f64; L] = from_fn(|l| b[0] * x[l] + s0[l]);
            *s0 = from_fn(|l| b[1] * x[l] - a[0] * output[l] + s1[l]);
            *s1 = from_fn(|l| b[2] * x[l] - a[1] * output[l]);
            x = output;
        }
        x
    }
}

/// Calls `$run::<S, L>` with the sections as an array, for every length a filter can have.
macro_rules! for_each_length {
    ($sections:expr, |$array:ident| $body:expr) => {{
        let sections: &[$crate::Section] = $sections;
        match *sections {
            [a] => {
                let $array = [a];
                $body
            }
            [a, b] => {
                let $array = [a, b];
                $body
            }
            [a, b, c] => {
                let $array = [a, b, c];
                $body
            }
            [a, b, c, d] => {
                let $array = [a, b, c, d];
                $body
            }
            _ => unreachable!("a filter has one to four sections"),
        }
    }};
}
pub(crate) use for_each_length;

/// Filters one column in place from rest.
pub(crate) fn filter(sections: &[Section], signal: &mut [f64]) {
    for_each_length!(sections, |array| {
        let mut cascade = Cascade::<_, 1>::new(array);
        for sample in signal {
            [*sample] = cascade.step([*sample]);
        }
    });
}
