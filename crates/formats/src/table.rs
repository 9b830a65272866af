//! A recording as it is in its file: named columns of plain numbers, nothing converted.

use std::collections::BTreeMap;

/// One numeric column of a recording, in the unit of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// Name as written in the file without its unit; empty where the file has none.
    pub name: String,
    /// Unit as written in the file (`Position [mm]` gives `mm`); `None` where the file has none.
    pub unit: Option<String>,
    /// Whether these are seconds that the reader has made of time stamps or durations: the unit is not one that somebody wrote, and
    /// says nothing of those of other columns.
    pub stamps: bool,
    /// Samples in file order; a cell that is empty or marked as missing is NaN.
    pub values: Vec<f64>,
}

impl Column {
    /// A column under a header as files have it: `Position [mm]` is the position in mm, `Position` has no unit.
    pub fn headed(header: &str, values: Vec<f64>) -> Self {
        let (name, unit) = crate::text::unit::split(header);
        Self {
            name,
            unit,
            stamps: false,
            values,
        }
    }
}

/// A single number that a file carries beside its columns (a force constant, a sample time).
#[derive(Clone, Debug, PartialEq)]
pub struct Scalar {
    /// Name as written in the file.
    pub name: String,
    /// The number, in the unit of the file.
    pub value: f64,
}

/// What is known of a column whose samples were read and not kept, since no mapping could take it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Passed {
    /// Whether one of its numbers is 0.
    pub zeros: bool,
    /// Whether one of them is 1.
    pub ones: bool,
    /// Whether one of them is neither.
    pub others: bool,
    /// Whether they are not all the same.
    pub changes: bool,
    /// Whether one of them is a whole number that 64-bit floats may have rounded.
    pub(crate) beyond: bool,
    /// The bits of one of them.
    any: Option<u64>,
}

/// 2^53, above which 64-bit floats do not hold every whole number.
const LARGEST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// Whether a number is whole and so large that another one may have been written.
pub(crate) fn is_beyond(value: f64) -> bool {
    value.is_finite() && value.abs() > LARGEST_WHOLE
}

impl Passed {
    /// Takes note of a number; a missing cell is none.
    #[inline]
    pub(crate) fn see(&mut self, value: f64) {
        self.zeros |= value == 0.0;
        self.ones |= value == 1.0;
        self.others |= value != 0.0 && value != 1.0 && !value.is_nan();
        self.beyond |= is_beyond(value);
        if !value.is_nan() {
            // Zero has two signs.
            let bits = (value + 0.0).to_bits();
            self.changes |= *self.any.get_or_insert(bits) != bits;
        }
    }

    /// Takes note of what was seen elsewhere.
    pub(crate) fn add(&mut self, other: Self) {
        self.zeros |= other.zeros;
        self.ones |= other.ones;
        self.others |= other.others;
        self.beyond |= other.beyond;
        self.changes |= other.changes || self.any.zip(other.any).is_some_and(|(a, b)| a != b);
        self.any = self.any.or(other.any);
    }

    /// Whether it has numbers, all of them the same.
    pub fn never_changes(&self) -> bool {
        self.any.is_some() && !self.changes
    }
}

/// What a reader found in a file: columns, scalars, and how it understood them.
///
/// Columns may differ in length (a slower channel runs out early); the mapping decides what that
/// means.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Columns in file order.
    pub columns: Vec<Column>,
    /// Numbers in the file, counted from 1 and ascending, of columns that are not among `columns`: text,
    /// or no number in any row. A column keeps the number that it has in the file, so that an axis file
    /// that names columns by number means the same ones in the next log, where another column is empty.
    pub left_out: Vec<usize>,
    /// Columns that have no `values`, by their place in `columns`: the reader was told that nobody can take them
    /// ([`read_wanted`](crate::read_wanted)).
    pub passed: BTreeMap<usize, Passed>,
    /// Other names of columns, by their places in `columns`: `q(:,1)` of an element that has a name of its own.
    pub other_names: BTreeMap<usize, String>,
    /// Rows, counted from 0 and ascending, with which another recording begins, such as an episode: nothing is known of the
    /// motion and the time between such a row and the one before.
    pub starts: Vec<usize>,
    /// Single numbers in the file.
    pub scalars: Vec<Scalar>,
    /// Sample time in seconds where the file states one apart from a time column.
    pub sample_time: Option<f64>,
    /// What was detected, in words: `separator TAB`, `decimal comma`, `3 preamble lines`.
    pub detected: Vec<String>,
    /// What was present and left out, and why: `phase_name: text`.
    pub skipped: Vec<String>,
}

impl Table {
    /// Number of samples of the longest column.
    pub fn rows(&self) -> usize {
        self.columns
            .iter()
            .map(|c| c.values.len())
            .max()
            .unwrap_or(0)
    }

    /// The same columns, those alone with their samples that are wanted.
    pub fn only(&self, wanted: &[bool]) -> Self {
        let columns = self
            .columns
            .iter()
            .zip(wanted)
            .map(|(column, wanted)| Column {
                name: column.name.clone(),
                unit: column.unit.clone(),
                stamps: column.stamps,
                values: match wanted {
                    true => column.values.clone(),
                    false => Vec::new(),
                },
            });
        Self {
            columns: columns.collect(),
            left_out: self.left_out.clone(),
            other_names: self.other_names.clone(),
            starts: self.starts.clone(),
            ..Self::default()
        }
    }

    /// The rows with which another recording begins once these rows alone are kept, which are in order.
    pub fn starts_among(&self, kept: &[usize]) -> Vec<usize> {
        let starts = self.starts.iter();
        let among = starts.map(|start| kept.partition_point(|row| row < start));
        let mut among: Vec<usize> = among.filter(|at| (1..kept.len()).contains(at)).collect();
        among.dedup();
        among
    }

    /// Whether a name means the column at `index`, other than as it stands in the file: its other name, or an element of a list
    /// counted from 0, `q[3]` or `q.3` for `q(:,4)`. Case does not count.
    pub fn is_also(&self, index: usize, name: &str) -> bool {
        let own = &self.columns[index].name;
        let mut names = [Some(own), self.other_names.get(&index)]
            .into_iter()
            .flatten();
        let element = element(name);
        let other = |own: &String| Some(own) == self.other_names.get(&index);
        names.any(|own| {
            let is = |name: &str| own.to_lowercase() == name.to_lowercase();
            other(own) && is(name) || element.as_deref().is_some_and(is)
        })
    }

    /// The number in the file, counted from 1, of the column at `index` of `columns`.
    pub fn number(&self, index: usize) -> usize {
        let ascending = self.left_out.iter();
        ascending.fold(index + 1, |number, &gone| {
            number + usize::from(gone <= number)
        })
    }

    /// Where in `columns` the column with a number in the file is, if it was not left out.
    pub fn index(&self, number: usize) -> Option<usize> {
        (0..self.columns.len()).find(|&index| self.number(index) == number)
    }
}

/// The column of an element that is counted from 0: `q(:,4)` for `q[3]` and `q.3`.
fn element(name: &str) -> Option<String> {
    let (list, index) = match name.strip_suffix(']') {
        Some(inside) => inside.rsplit_once('[')?,
        None => name.rsplit_once('.')?,
    };
    let digits = !list.is_empty() && index.bytes().all(|byte| byte.is_ascii_digit());
    let index: u32 = index.parse().ok().filter(|_| digits)?;
    Some(format!("{list}(:,{})", u64::from(index) + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_counted_from_0_in_brackets_and_behind_a_dot() {
        let mut table = Table {
            columns: vec![
                Column::headed("a.q(:,4)", vec![1.0]),
                Column::headed("state.elbow", vec![2.0]),
            ],
            ..Table::default()
        };
        table.other_names.insert(1, "state(:,1)".to_owned());
        for (name, is) in [
            ("a.q[3]", [true, false]),
            ("A.q.3", [true, false]),
            ("a.q[4]", [false, false]),
            ("a.q[+3]", [false, false]),
            ("[3]", [false, false]),
            (".3", [false, false]),
            ("state(:,1)", [false, true]),
            ("state[0]", [false, true]),
            ("state.0", [false, true]),
            ("state.99999999999", [false, false]),
        ] {
            assert_eq!([0, 1].map(|at| table.is_also(at, name)), is, "{name}");
        }
    }
}
