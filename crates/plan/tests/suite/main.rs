//! Tests of `stiction-plan`.

mod limits;
mod pieces;
mod prediction;
