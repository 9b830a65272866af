//! The integration tests of `stiction-parameters` in one program, which is linked once: a new file is a module here.

mod law;
mod names;
mod steady;
