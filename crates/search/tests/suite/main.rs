//! The integration tests of `stiction-search` in one program, which is linked once: a new file is a module here.

mod common;
mod functions;
mod invariants;
mod reference;
mod settings;
