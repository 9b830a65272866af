//! The integration tests of `stiction-cli` in one program, which is linked once: a new file is a module here.

mod cli;
mod export;
mod exported;
#[cfg(target_os = "linux")]
mod killed;
mod leads;
#[cfg(unix)]
mod linuxcnc;
mod paper;
mod plan;
mod procedures;
mod searches;
mod study;
