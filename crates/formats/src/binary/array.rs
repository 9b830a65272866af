//! Arrays read straight into their columns, so that nothing is held twice.

use std::io::{self, Read};

use super::{Collector, Layout, Number, Order, Values};

/// Numbers that are decoded at once.
const BATCH: usize = 8192;

/// How much of a column has to have arrived, as one part in so many, before memory is taken for all of it.
const PROOF: usize = 8;

impl Collector {
    /// Reads an array of these dimensions, which are known to be within what is allowed, and adds what it is: a scalar, a
    /// column, or the columns of a matrix. Memory grows with the numbers that really arrive, and stays below 9/8 of what
    /// they take.
    pub(crate) fn numbers(
        &mut self,
        name: &str,
        unit: Option<String>,
        (dims, order): (&[u64], Order),
        number: Number,
        reader: &mut (impl Read + ?Sized),
    ) -> io::Result<()> {
        let mut buffer = Vec::new();
        let mut batch = Values::default();
        let (rows, count) = match Layout::of(dims) {
            Layout::Matrix { rows, columns } => (rows, columns),
            Layout::Column | Layout::Scalar => (dims.iter().product::<u64>() as usize, 1),
            Layout::Skip(why) => {
                self.skip(name, &why);
                return Ok(());
            }
        };
        let mut columns = vec![Vec::new(); count];
        let interleaved = order == Order::Row && count > 1;
        // Interleaved, a batch is of whole rows; else one column follows the other.
        let wide = if interleaved { count } else { 1 };
        let runs = if interleaved { 1 } else { count };
        for run in 0..runs {
            let mut left = rows;
            while left > 0 {
                let now = left.min((BATCH / wide).max(1));
                buffer.resize(now * wide * number.width(), 0);
                reader.read_exact(&mut buffer)?;
                batch.samples.clear();
                number.decode(&buffer, &mut batch);
                for column in 0..wide {
                    let into = &mut columns[run + column];
                    grow(into, now, rows)?;
                    into.extend(batch.samples.iter().skip(column).step_by(wide));
                }
                left -= now;
            }
        }
        if batch.rounded {
            self.rounded(name);
        }
        match Layout::of(dims) {
            Layout::Scalar => columns
                .iter()
                .flatten()
                .for_each(|&value| self.scalar(name, value)),
            Layout::Matrix { .. } => {
                for (index, values) in columns.into_iter().enumerate() {
                    let name = Self::of_matrix(name, index);
                    self.column(&name, unit.clone(), values);
                }
            }
            _ => columns
                .into_iter()
                .for_each(|values| self.column(name, unit.clone(), values)),
        }
        Ok(())
    }
}

/// Makes room for some more of so many numbers: twice as many while little has arrived, then for all of them.
pub(crate) fn grow(values: &mut Vec<f64>, more: usize, all: usize) -> io::Result<()> {
    if values.capacity() - values.len() >= more {
        return Ok(());
    }
    let known = values.len() + more;
    let room = if known >= all / PROOF {
        all - values.len()
    } else {
        more.max(values.len())
    };
    let made = values.try_reserve_exact(room);
    made.map_err(|_| io::ErrorKind::OutOfMemory.into())
}
