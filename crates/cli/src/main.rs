//! The program `stiction`.

use std::process::ExitCode;

/// Keeps the memory that one search gives back for the next, where the system's would be asked for anew.
#[global_allocator]
static MEMORY: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    stiction_cli::run(std::env::args_os().skip(1)).into()
}
