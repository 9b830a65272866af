//! The text reader against other writers and readers of the same files.

// The errors are those of the crate, which carry the place and the words.

mod dialects;
mod errors;
mod halsampler;
mod hostile;
mod lists;
mod python;
mod recordings;
mod twincat;
mod written;

use stiction_formats::text::{TextOptions, read};
use stiction_formats::{Error, Table};

/// Reads a text with everything detected.
fn detect(text: impl AsRef<[u8]>) -> Result<Table, Error> {
    read(text.as_ref(), &TextOptions::default())
}

/// Names, units and values of a table, for comparison; NaN compares by its name.
fn shape(table: &Table) -> Vec<(String, String, Vec<String>)> {
    table
        .columns
        .iter()
        .map(|c| {
            let values = c.values.iter().map(f64::to_string).collect();
            (c.name.clone(), c.unit.clone().unwrap_or_default(), values)
        })
        .collect()
}
