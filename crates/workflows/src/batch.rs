//! Many logs, each identified by itself: as many at the same time as there are threads, one row or more for each of them.

mod found;
mod one;
mod prepare;
mod read;
mod run;
mod single;

pub use prepare::{Batch, Called};
pub use read::batch_of;
pub use run::Done;
