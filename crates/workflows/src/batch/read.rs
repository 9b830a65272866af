//! What an earlier batch left in its folder.

use std::path::Path;
use stiction_files::batch::{BatchFile, SUMMARY};

/// Longest file that is read, bytes.
const LONGEST: u64 = 1 << 28;

/// The `batch.json` of a folder; `None` where there is none that can be read.
pub fn batch_of(dir: &Path) -> Option<BatchFile> {
    let file = dir.join(SUMMARY);
    let about = stiction_formats::regular(&file).ok()?;
    let text = (about.len() <= LONGEST).then(|| std::fs::read_to_string(&file).ok())?;
    serde_json::from_str(&text?).ok()
}
