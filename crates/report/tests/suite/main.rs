//! The integration tests of `stiction-report` in one program, which is linked once: a new file is a module here.

mod hostile;
mod robust;
mod size;
mod snapshots;
mod square;
