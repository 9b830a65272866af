//! The integration tests of `stiction-codes` in one program, which is linked once: a new file is a module here.

mod pages;
