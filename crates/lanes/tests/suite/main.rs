//! The integration tests of `stiction-lanes` in one program, which is linked once: a new file is a module here.

mod common;
mod normal;
mod oracle;
mod plant;
mod same_bits;
