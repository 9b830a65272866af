//! Laying arrays out as the columns and scalars of a [`Table`], within limits.

use super::Values;
#[cfg(feature = "mdf")]
use crate::Passed;
use crate::limits::Budget;
use crate::{Column, Error, Kind, Scalar, Table};

/// Most variables, fields and cells in one file; far more than any recording has.
const MAX_ENTRIES: usize = 65_536;

/// Most columns of one matrix; a wider one has its signals in rows, or is not a recording.
const MAX_MATRIX_COLUMNS: u64 = 1024;

/// Which index of a matrix varies fastest in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// The last one, as in C and Python.
    Row,
    /// The first one, as in Fortran and MATLAB.
    Column,
}

/// What becomes of an array of these dimensions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Layout {
    /// One number.
    Scalar,
    /// One column.
    Column,
    /// Several columns.
    Matrix { rows: usize, columns: usize },
    /// Nothing, for this reason.
    Skip(String),
}

impl Layout {
    /// Axes of length one do not count, so a row vector is a column too.
    pub(crate) fn of(dims: &[u64]) -> Self {
        if dims.contains(&0) {
            return Layout::Skip("empty".to_owned());
        }
        let long: Vec<u64> = dims.iter().copied().filter(|&n| n != 1).collect();
        match long[..] {
            [] => Layout::Scalar,
            [_] => Layout::Column,
            [rows, columns] => match (usize::try_from(rows), usize::try_from(columns)) {
                (Ok(rows), Ok(wide)) if columns <= MAX_MATRIX_COLUMNS => Layout::Matrix {
                    rows,
                    columns: wide,
                },
                _ => Layout::Skip(format!(
                    "{rows} x {columns} matrix: each signal has to be a column, and there are at most \
                     {MAX_MATRIX_COLUMNS} of them"
                )),
            },
            _ => Layout::Skip(format!("array of {} dimensions", long.len())),
        }
    }
}

/// Most bytes that a byte of a file unpacks to; deflate, which gains most, makes 1032 of one.
const MAX_GAIN: u64 = 1100;

/// A table in the making, with what it may still grow by.
#[derive(Debug)]
pub(crate) struct Collector {
    table: Table,
    budget: Budget,
    samples: u64,
    entries: usize,
    /// Bytes that may still be unpacked, whether they are kept or not.
    unpacked: u64,
}

impl Collector {
    pub(crate) fn new(budget: impl Into<Budget>) -> Self {
        Self {
            table: Table::default(),
            budget: budget.into(),
            samples: 0,
            entries: 0,
            unpacked: u64::MAX,
        }
    }

    /// For a file of this many bytes, which unpack to no more than compression gains, or `some` bytes where that is more.
    #[cfg(any(feature = "hdf5", feature = "mcap"))]
    pub(crate) fn packed(budget: impl Into<Budget>, bytes: u64, some: u64) -> Self {
        Self {
            unpacked: bytes.saturating_mul(MAX_GAIN).max(some),
            ..Self::new(budget)
        }
    }

    /// Whether so many bytes more may be unpacked, which are counted then.
    #[cfg(any(feature = "hdf5", feature = "mcap"))]
    pub(crate) fn unpacks(&mut self, bytes: u64) -> bool {
        let left = self.unpacked.checked_sub(bytes);
        self.unpacked = left.unwrap_or(self.unpacked);
        left.is_some()
    }

    /// How many bytes may still be unpacked.
    #[cfg(feature = "mcap")]
    pub(crate) fn unpackable(&self) -> u64 {
        self.unpacked
    }

    /// Counts one more variable, field or cell.
    pub(crate) fn entry(&mut self) -> Result<(), Error> {
        self.entries += 1;
        if self.entries > MAX_ENTRIES {
            return Err(Error::new(
                Kind::Limit,
                format!("more than {MAX_ENTRIES} variables, fields and cells"),
                "save the signals as columns of a few arrays",
            ));
        }
        Ok(())
    }

    /// Whether an array of these dimensions is within what is still allowed, and its length.
    pub(crate) fn fits(&self, name: &str, dims: &[u64]) -> Result<u64, Error> {
        let wanted = dims.iter().try_fold(1u64, |n, &dim| n.checked_mul(dim));
        let total = wanted.and_then(|wanted| self.samples.checked_add(wanted));
        match (wanted, total) {
            (Some(wanted), Some(total)) if total <= self.budget.samples() => Ok(wanted),
            _ => {
                let mut error = self.budget.too_many_samples(total);
                if dims.len() > 1 {
                    error.found = format!("{}: {}", times(dims), error.found);
                }
                Err(match name {
                    "" => error,
                    name => error.in_column(name),
                })
            }
        }
    }

    /// Refuses a part of a file that a decoder would hold at once, in so many bytes, where these are too many.
    #[cfg(any(feature = "mcap", feature = "parquet"))]
    pub(crate) fn holds(&self, what: &str, bytes: u64) -> Result<(), Error> {
        match bytes > self.budget.memory() {
            true => Err(self.budget.refusal(what, Some(bytes))),
            false => Ok(()),
        }
    }

    /// Number of samples in an array of these dimensions, taken from what is allowed.
    ///
    /// To be asked for before anything is allocated for them.
    pub(crate) fn reserve(&mut self, name: &str, dims: &[u64]) -> Result<u64, Error> {
        let wanted = self.fits(name, dims)?;
        self.samples += wanted;
        Ok(wanted)
    }

    /// Counts bytes that a reader holds beside the samples: what a file says of its columns, a block that is unpacked.
    ///
    /// To be asked for before they are allocated.
    #[cfg(any(feature = "json", feature = "mcap", feature = "mdf"))]
    pub(crate) fn hold(&mut self, bytes: u64) -> Result<(), Error> {
        let samples = bytes.div_ceil(crate::limits::PER_SAMPLE);
        let total = self.samples.saturating_add(samples);
        if total > self.budget.samples() {
            let bytes = total.checked_mul(crate::limits::PER_SAMPLE);
            return Err(self.budget.refusal("reading this file", bytes));
        }
        self.samples = total;
        Ok(())
    }

    /// Says how the file was understood.
    pub(crate) fn detected(&mut self, what: impl Into<String>) {
        self.table.detected.push(what.into());
    }

    /// Says what was left out, and why.
    pub(crate) fn skip(&mut self, name: &str, why: &str) {
        self.table.skipped.push(match name {
            "" => why.to_owned(),
            name => format!("{name}: {why}"),
        });
    }

    /// Says what was left out of the columns of a table, whose others keep their numbers.
    pub(crate) fn skip_column(&mut self, name: &str, why: &str) {
        let number = self.table.columns.len() + self.table.left_out.len() + 1;
        self.table.left_out.push(number);
        self.skip(name, why);
    }

    /// Adds one column.
    pub(crate) fn column(&mut self, name: &str, unit: Option<String>, values: Vec<f64>) {
        self.table.columns.push(Column {
            name: name.to_owned(),
            unit,
            stamps: false,
            values,
        });
    }

    /// Adds a column whose samples nobody asks for.
    #[cfg(feature = "mdf")]
    pub(crate) fn passed(&mut self, name: &str, unit: Option<String>, passed: Passed) {
        self.table.passed.insert(self.columns(), passed);
        self.column(name, unit, Vec::new());
    }

    /// Adds a column of seconds that were made of time stamps or durations.
    pub(crate) fn stamps(&mut self, name: &str, values: Vec<f64>) {
        let first = self.columns();
        self.column(name, Some("s".to_owned()), values);
        self.are_stamps(first);
    }

    /// How many columns there are so far.
    pub(crate) fn columns(&self) -> usize {
        self.table.columns.len()
    }

    /// Says that the columns from this one on are seconds that were made of time stamps.
    pub(crate) fn are_stamps(&mut self, first: usize) {
        let columns = self.table.columns.iter_mut().skip(first);
        columns.for_each(|column| column.stamps = true);
    }

    /// Adds an array: a scalar, a column, or the columns `name(:,1)`, `name(:,2)` ... of a matrix.
    pub(crate) fn array(
        &mut self,
        name: &str,
        unit: Option<String>,
        dims: &[u64],
        order: Order,
        values: Values,
    ) {
        if values.rounded {
            self.rounded(name);
        }
        let samples = values.samples;
        match Layout::of(dims) {
            Layout::Scalar => {
                if let Some(&value) = samples.first() {
                    self.scalar(name, value);
                }
            }
            Layout::Column => self.column(name, unit, samples),
            Layout::Matrix { rows, columns } => {
                for j in 0..columns {
                    let values = match order {
                        Order::Column => samples[j * rows..][..rows].to_vec(),
                        Order::Row => samples.iter().skip(j).step_by(columns).copied().collect(),
                    };
                    self.column(&Self::of_matrix(name, j), unit.clone(), values);
                }
            }
            Layout::Skip(why) => self.skip(name, &why),
        }
    }

    /// Says the time between samples, in s.
    pub(crate) fn sample_time(&mut self, seconds: f64) {
        self.table.sample_time = Some(seconds);
    }

    /// Adds a single number.
    pub(crate) fn scalar(&mut self, name: &str, value: f64) {
        self.table.scalars.push(Scalar {
            name: name.to_owned(),
            value,
        });
    }

    /// Says that integers among these numbers were too large for `f64` to hold exactly.
    pub(crate) fn rounded(&mut self, name: &str) {
        self.detected(format!(
            "{name}: integers beyond 2^53, rounded to the nearest 64-bit float"
        ));
    }

    /// The name of a column of a matrix, by its index counted from 0.
    pub(crate) fn of_matrix(name: &str, index: usize) -> String {
        match name {
            "" => String::new(),
            name => format!("{name}(:,{})", index + 1),
        }
    }

    pub(crate) fn finish(self) -> Table {
        self.table
    }
}

/// `3 x 4` from 3 and 4.
fn times(dims: &[u64]) -> String {
    let dims: Vec<String> = dims.iter().map(u64::to_string).collect();
    dims.join(" x ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    fn collector(samples: u64) -> Collector {
        Collector::new(Limits {
            memory: samples * crate::limits::PER_SAMPLE,
        })
    }

    fn values(samples: &[f64]) -> Values {
        Values {
            samples: samples.to_vec(),
            rounded: false,
        }
    }

    #[test]
    fn a_matrix_gives_the_same_columns_in_either_order() {
        let mut collector = collector(100);
        let c = values(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let fortran = values(&[1.0, 3.0, 5.0, 2.0, 4.0, 6.0]);
        collector.array("q", None, &[3, 2], Order::Row, c);
        collector.array("q", None, &[3, 2], Order::Column, fortran);
        let table = collector.finish();
        assert_eq!(table.columns[0].name, "q(:,1)");
        assert_eq!(table.columns[1].values, [2.0, 4.0, 6.0]);
        assert_eq!(table.columns[..2], table.columns[2..]);
    }

    #[test]
    fn layouts() {
        assert_eq!(Layout::of(&[]), Layout::Scalar);
        assert_eq!(Layout::of(&[1, 1]), Layout::Scalar);
        assert_eq!(Layout::of(&[1, 9]), Layout::Column);
        assert!(matches!(Layout::of(&[3, 0]), Layout::Skip(_)));
        assert!(matches!(Layout::of(&[3, 100_000]), Layout::Skip(_)));
        assert!(matches!(Layout::of(&[3, 4, 5]), Layout::Skip(_)));
    }

    #[test]
    fn the_limit_counts_all_arrays_and_survives_overflow() {
        let mut collector = collector(10);
        assert_eq!(collector.reserve("a", &[2, 3]).unwrap(), 6);
        assert_eq!(collector.reserve("b", &[5]).unwrap_err().kind, Kind::Limit);
        assert!(collector.reserve("c", &[u64::MAX, u64::MAX]).is_err());
        assert_eq!(collector.reserve("d", &[4]).unwrap(), 4);
    }
}
