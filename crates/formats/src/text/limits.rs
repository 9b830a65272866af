//! How much of a text is read.

/// Most columns a file may have.
pub const MAX_COLUMNS: usize = 4096;

/// Most bytes in one row, 1 MiB.
pub const MAX_ROW_BYTES: usize = 1 << 20;

/// Most lines before the first row of numbers.
pub const MAX_PREAMBLE_LINES: usize = 1000;
