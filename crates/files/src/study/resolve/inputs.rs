//! Files that a study reads.

use crate::error::Warning;
use crate::hash::sha256_of;
use crate::study::plan::Study;
use crate::study::result::StudyInput;
use std::path::Path;

/// A file with the hash of the text that was read from it.
pub(super) fn input(path: &Path, text: &str) -> StudyInput {
    StudyInput {
        path: crate::shell::text(path),
        sha256: sha256_of(text.as_bytes()),
    }
}

impl Study {
    /// Notes a file that was read, the hash of what was read, and what was said of it.
    pub(super) fn reads(&mut self, file: &Path, sha256: String, warning: Option<Warning>) {
        let input = StudyInput {
            path: crate::shell::text(file),
            sha256,
        };
        if !self.inputs.contains(&input) {
            self.inputs.push(input);
        }
        self.warnings.extend(warning);
    }
}
