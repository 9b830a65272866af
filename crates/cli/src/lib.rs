//! The `stiction` command line: arguments, progress, exit codes. The work is done by the crates below it.
//!
//! [`run`] is the whole program: `main` of the binary and the command of the Python package both call it.

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
mod words;

use arguments::Arguments;
use clap::Parser;
use exit::Exit;
use std::ffi::OsString;
use std::io::Write;

/// Runs a command as the program does: prints, writes files, listens for Ctrl-C.
///
/// `words` are the arguments behind the name of the program. Returns the exit code: 0 done, 1 not trustworthy, 2 bad input or
/// usage, 3 internal error, 130 interrupted; the second Ctrl-C, and the first while there is nothing to keep, end the process with
/// 130 themselves.
pub fn run(words: impl IntoIterator<Item = OsString>) -> u8 {
    words::are(words);
    let arguments = match Arguments::try_parse_from(words::whole()) {
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
            return exit as u8;
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
    exit as u8
}
