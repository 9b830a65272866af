//! Tests of `stiction-plan`.

mod carriers;
mod limits;
mod pieces;
mod prediction;
mod recognised;
