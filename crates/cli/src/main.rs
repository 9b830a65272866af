//! The `stiction` command line: arguments, progress, exit codes. All work is done by the library of the same name.

mod arguments;
mod brought;
mod commands;
mod exit;
mod interrupt;
mod large;
mod looking;
mod misplaced;
mod next;
mod output;
mod panics;
mod progress;
mod refused;
mod typed;
mod usage;
mod wording;

use arguments::Arguments;
use clap::Parser;
use clap::error::ErrorKind;
use exit::Exit;
use std::fmt::Write as _;
use std::io::Write;
use std::process::ExitCode;

/// Keeps the memory that one search gives back for the next, where the system's would be asked for anew.
#[global_allocator]
static MEMORY: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// What leads on from arguments that are missing or cannot be read.
fn led_on(error: &clap::Error) -> String {
    let is_missing = error.kind() == ErrorKind::MissingRequiredArgument;
    let known = is_missing.then(next::incomplete).flatten();
    let Some((refused, next)) = known.or_else(|| Some((None, usage::unread(error)?))) else {
        return String::new();
    };
    let mut text = String::from("\n");
    for (_, line) in refused.iter().flat_map(wording::lines) {
        let _ = writeln!(text, "stiction: {}", output::line(&line));
    }
    for line in next.lines() {
        let _ = writeln!(text, "stiction: {}", output::line(line));
    }
    text
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(e) => {
            let printed = match e.use_stderr() {
                // What was typed stands in it, such as the name of a file for an option.
                true => {
                    let text = format!("{}{}", e.render(), led_on(&e));
                    std::io::stderr().write_all(output::plain(&text).as_bytes())
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
