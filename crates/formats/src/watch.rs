//! How far a file has been read, for whoever watches.

use std::path::Path;
use std::sync::OnceLock;

/// A reading on its way.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a> {
    /// The file.
    pub file: &'a Path,
    /// Bytes that have been read: all of them at the end, also where the reading failed.
    pub done: u64,
    /// Bytes of the file.
    pub all: u64,
}

static WATCHER: OnceLock<fn(&Reading)> = OnceLock::new();

/// Lets a function be told of every reading of this process: when it begins, of text some times a second on the way, and when it
/// ends. The first call counts.
pub fn watch(watcher: fn(&Reading)) {
    let _ = WATCHER.set(watcher);
}

/// Tells whoever watches.
pub(crate) fn tell(file: &Path, done: u64, all: u64) {
    if let Some(watcher) = WATCHER.get() {
        watcher(&Reading { file, done, all });
    }
}
