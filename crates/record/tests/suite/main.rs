//! The integration tests of `stiction-record` in one program. The servers are those of the testkit.

mod addresses;
mod ads;
mod hostile;
mod rtde;

use std::path::Path;
use std::time::Duration;
use stiction_formats::{ReadOptions, read_table};
use stiction_record::{Device, Error, Options, Recorded, record};

/// Records so many seconds; waits are short.
fn recorded(words: &[String], rate: f64, time: f64, out: &Path) -> Result<Recorded, Error> {
    let mut source = Device::parse(words)?.source(Some(rate))?;
    let options = Options {
        time,
        stall: Duration::from_millis(300),
        patience: Duration::from_millis(600),
    };
    record(&mut *source, out, &options, &mut |_| true)
}

/// Name, unit and values of each column, as the reader of logs has them.
fn read(path: &Path) -> Vec<(String, Option<String>, Vec<f64>)> {
    let table = read_table(path, &ReadOptions::default()).expect("a log that is read");
    let columns = table.columns.into_iter();
    columns
        .map(|own| (own.name, own.unit, own.values))
        .collect()
}

/// Whether two numbers are the same bits.
fn same(one: f64, other: f64) -> bool {
    one.to_bits() == other.to_bits()
}
