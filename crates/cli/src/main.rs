//! The `stiction` command line: arguments, progress, exit codes. All work is done by the library of the same name.

mod arguments;
mod brought;
mod commands;
mod exit;
mod interrupt;
mod large;
mod looking;
mod next;
mod output;
mod panics;
mod progress;
mod typed;
mod wording;

use arguments::Arguments;
use clap::Parser;
use exit::Exit;
use std::io::Write;
use std::process::ExitCode;

/// Keeps the memory that one search gives back for the next, where the system's would be asked for anew.
#[global_allocator]
static MEMORY: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(e) => {
            let printed = match e.use_stderr() {
                // What was typed stands in it, such as the name of a file for an option.
                true => {
                    let written = std::io::stderr();
                    let written =
                        (&written).write_all(output::plain(&e.render().to_string()).as_bytes());
                    output::complain(&next::of_arguments(&e));
                    written
                }
                false => e.print().and_then(|()| std::io::stdout().flush()),
            };
            // Help and version are no errors, unless they do not reach their reader.
            let exit = match output::written(printed) {
                _ if e.use_stderr() => Exit::BadInput,
                Ok(()) => Exit::Done,
                Err(e) => {
                    let _ = writeln!(std::io::stderr(), "stiction: [{}] {e}", e.code());
                    Exit::BadInput
                }
            };
            return ExitCode::from(exit as u8);
        }
    };
    // A panic is a fault of ours: say so in a sentence, not with a trace alone.
    panics::keep();
    let result = std::panic::catch_unwind(|| commands::run(&arguments));
    let exit = result.unwrap_or_else(|_| {
        panics::tell();
        let _ = writeln!(
            std::io::stderr(),
            "stiction: internal error. Please report it with the command and, if you can, the log."
        );
        Exit::Internal
    });
    ExitCode::from(exit as u8)
}
