//! What the readers of binary formats share: decoding numbers, laying arrays out as columns,
//! limits, integer time stamps, and the boundary around third-party decoders.

// A build with only some of the formats leaves parts of this unused.
#![cfg_attr(not(feature = "all"), allow(dead_code, unused_imports))]

mod array;
mod collect;
mod guard;
mod number;
mod record;
mod ticks;
#[cfg(any(feature = "json", feature = "mcap"))]
mod tree;
#[cfg(any(feature = "arrow", feature = "mcap", feature = "parquet"))]
mod unpack;

pub(crate) use array::grow;
pub(crate) use collect::{Collector, Layout, Order};
pub(crate) use guard::guard;
pub(crate) use number::{ByteOrder, Class, Number, Values, decimal, half, read_numbers};
pub(crate) use record::{Cell, Field, Record};
pub(crate) use ticks::{Clock, Period, seconds};
#[cfg(any(feature = "json", feature = "mcap"))]
pub(crate) use tree::Tree;
#[cfg(any(feature = "arrow", feature = "mcap"))]
pub(crate) use unpack::lz4;
#[cfg(any(feature = "arrow", feature = "mcap", feature = "parquet"))]
pub(crate) use unpack::zstd;
