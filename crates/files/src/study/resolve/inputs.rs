//! Files that a study reads.

use crate::error::{Error, Warning};
use crate::hash::sha256;
use crate::study::plan::Study;
use crate::study::result::StudyInput;
use std::path::Path;

/// A file with its hash.
pub(super) fn input(path: &Path) -> Result<StudyInput, Error> {
    Ok(StudyInput {
        path: crate::shell::text(path),
        sha256: sha256(path)?,
    })
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
