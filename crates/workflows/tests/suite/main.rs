//! The integration tests of `stiction-workflows` in one program, which is linked once: a new file is a module here.

mod robots;
mod servos;
