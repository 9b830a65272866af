//! The integration tests of `stiction-files` in one program, which is linked once: a new file is a module here.

mod axis;
mod ethercat;
mod friction_curve;
mod model;
mod pending;
mod robot;
