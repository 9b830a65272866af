//! The integration tests of `stiction-formats` in one program, which is linked once: a new file is a module here.

// The errors are those of the crate, which carry the place and the words.
#![allow(clippy::result_large_err)]

#[cfg(feature = "all")]
mod binary;
mod text;
mod without_readers;
