//! The integration tests of `stiction-log` in one program, which is linked once: a new file is a module here.

// The errors are those of the crate, which carry the place and the words.
#![allow(clippy::result_large_err)]

mod dead;
mod join;
mod join_offset;
mod mapping_codes;
mod mapping_common;
mod mapping_detect;
mod mapping_dropouts;
mod mapping_enable;
mod mapping_faults;
mod mapping_filled;
mod mapping_log;
mod mapping_parts;
mod mapping_recordings;
mod mapping_units;
mod rests;
mod stamped;
mod undecided;
mod wanted;
