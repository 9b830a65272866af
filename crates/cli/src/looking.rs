//! Looking for logs, which takes long in a huge tree: what is said meanwhile, and that an interrupt ends it.

use crate::interrupt;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Before anything is said, and between two pictures on a terminal: what is short says nothing.
const SHORT: Duration = Duration::from_millis(500);
/// Between two lines where there is no terminal.
const BETWEEN: Duration = Duration::from_secs(20);

/// Does the work. An interrupt ends the process until something is found; how long it has taken is said now and then, unless
/// that is `hidden`.
pub fn looking<T>(hidden: bool, work: impl FnOnce() -> T) -> T {
    interrupt::nothing_yet();
    if hidden {
        return work();
    }
    thread::scope(|scope| {
        // Dropped at the end, also by a panic.
        let (_done, waits) = channel();
        scope.spawn(move || tell(&waits));
        work()
    })
}

/// Says how long it has taken until the other end is dropped.
fn tell(waits: &Receiver<()>) {
    let began = Instant::now();
    let terminal = std::io::stderr().is_terminal();
    let between = if terminal { SHORT } else { BETWEEN };
    let mut bar = None;
    while waits.recv_timeout(between) == Err(RecvTimeoutError::Timeout) {
        let seconds = began.elapsed().as_secs();
        if terminal {
            let bar = bar.get_or_insert_with(spinner);
            bar.set_message(format!("{seconds} s"));
            bar.tick();
        } else {
            // With standard error closed there is nowhere to say it.
            let _ = writeln!(std::io::stderr(), "stiction: {seconds} s: looking for logs");
        }
    }
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
}

fn spinner() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("looking for logs {spinner} {msg}") {
        bar.set_style(style);
    }
    bar
}

#[cfg(test)]
mod tests {
    use super::looking;
    use std::time::Duration;

    #[test]
    fn it_ends_with_the_work() {
        assert_eq!(looking(true, || 1), 1);
        let long = || std::thread::sleep(Duration::from_millis(10));
        looking(false, long);
    }
}
