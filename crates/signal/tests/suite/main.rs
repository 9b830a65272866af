//! The integration tests of `stiction-signal` in one program, which is linked once: a new file is a module here.

mod common;
mod filter_properties;
mod scipy_derivatives;
mod scipy_filters;
mod signal_properties;
