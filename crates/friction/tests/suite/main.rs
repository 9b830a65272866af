//! The integration tests of `stiction-friction` in one program, which is linked once: a new file is a module here.

mod adaptation;
mod bound;
mod c95;
mod common;
mod compensator;
mod elasto_plastic;
mod gms;
mod memory;
mod order;
mod parameters;
mod passivity;
mod source;
mod sweep;
mod symmetry;
mod terms;
mod watchdog;
