//! Ctrl-C: while there is nothing to keep it ends the process; else the first asks the search to stop and keep what it has, and a
//! later one ends the process.

use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// When the first came.
static ASKED: OnceLock<Instant> = OnceLock::new();
/// Whether nothing has been found so far that would be lost.
static NOTHING_YET: AtomicBool = AtomicBool::new(false);
/// Whether the command writes nothing that would be.
static NOTHING_EVER: AtomicBool = AtomicBool::new(false);
/// Whether the command runs until it is interrupted.
#[cfg(feature = "studio")]
static USUAL_END: AtomicBool = AtomicBool::new(false);
/// Time in which further ones count as the first: a key that is held down, a wrapper that passes the signal on. What there is
/// takes less than that to write.
const SAME: Duration = Duration::from_secs(2);

/// Listens for the interrupt from now on.
pub fn listen() {
    // Without a handler Ctrl-C still ends the process, only without saving.
    let _ = ctrlc::set_handler(|| {
        #[cfg(feature = "studio")]
        if USUAL_END.load(Ordering::SeqCst) {
            std::process::exit(0);
        }
        if NOTHING_YET.load(Ordering::SeqCst) || NOTHING_EVER.load(Ordering::SeqCst) {
            // With standard error closed only the exit code is left to tell.
            let _ = writeln!(
                std::io::stderr(),
                "stiction: [interrupted] stopped; nothing was written"
            );
            std::process::exit(130);
        }
        if ASKED.get_or_init(Instant::now).elapsed() > SAME {
            std::process::exit(130);
        }
    });
}

/// The command writes nothing that an interrupt would lose.
pub fn nothing_to_keep() {
    NOTHING_EVER.store(true, Ordering::SeqCst);
}

/// The command runs until it is interrupted, which is its usual end.
#[cfg(feature = "studio")]
pub fn usual_end() {
    USUAL_END.store(true, Ordering::SeqCst);
}

/// Nothing would be lost yet: a log is being read.
pub fn nothing_yet() {
    NOTHING_YET.store(true, Ordering::SeqCst);
}

/// From now on something would: a search is on its way.
pub fn something_to_keep() {
    NOTHING_YET.store(false, Ordering::SeqCst);
}

/// Whether some work was told to stop: its outcome may be less than it would have been. An interrupt that comes when everything is
/// found stops nothing.
static STOPPED: AtomicBool = AtomicBool::new(false);

/// Whether work is to stop; it does where that is so.
pub fn stops() -> bool {
    if asked() {
        STOPPED.store(true, Ordering::SeqCst);
    }
    asked()
}

/// Whether work was stopped.
pub fn stopped() -> bool {
    STOPPED.load(Ordering::SeqCst)
}

/// Whether the user asked to stop.
fn asked() -> bool {
    ASKED.get().is_some()
}
