//! Ctrl-C: the first asks the search to stop and keep what it has, a later one ends the process.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// When the first came.
static ASKED: OnceLock<Instant> = OnceLock::new();
/// Time in which further ones count as the first: a key that is held down, a wrapper that passes the signal on. What there is
/// takes less than that to write.
const SAME: Duration = Duration::from_secs(2);

/// Listens for the interrupt from now on.
pub fn listen() {
    // Without a handler Ctrl-C still ends the process, only without saving.
    let _ = ctrlc::set_handler(|| {
        if ASKED.get_or_init(Instant::now).elapsed() > SAME {
            std::process::exit(130);
        }
    });
}

/// Whether the user asked to stop.
pub fn asked() -> bool {
    ASKED.get().is_some()
}
