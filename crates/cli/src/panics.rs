//! What a panic says is kept, and shown only where nothing caught it: a decoder that fails on a file is refused in a sentence, and
//! its panic is nothing for the user.

use crate::output;
use std::backtrace::{Backtrace, BacktraceStatus};
use std::io::Write;
use std::sync::Mutex;

/// What the last one said.
static LAST: Mutex<String> = Mutex::new(String::new());

/// Keeps what panics say from now on.
pub fn keep() {
    std::panic::set_hook(Box::new(|panic| {
        let trace = Backtrace::capture();
        let mut said = panic.to_string();
        if trace.status() == BacktraceStatus::Captured {
            said = format!("{said}\n{trace}");
        }
        if let Ok(mut last) = LAST.lock() {
            *last = said;
        }
    }));
}

/// Shows what the last one said.
pub fn tell() {
    if let Ok(last) = LAST.lock() {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "{}", output::plain(&last));
    }
}
