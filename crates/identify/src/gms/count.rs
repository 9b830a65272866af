//! How many elements a Maxwell-slip law may have.

/// Fewest elements that are tried where the data choose.
pub const FEWEST: usize = 3;

/// Most elements.
pub const MOST: usize = 10;
