//! The crates as they would be published.

use crate::shell::{self, Outcome, cargo};

/// Never published as crates: for tests, the tasks, and the Python package.
const PRIVATE: &str = "--exclude stiction-testkit --exclude stiction-python --exclude xtask";

/// Packs every crate; whether a packed crate also builds is for [`verified`] to say.
pub fn run() -> Outcome {
    shell::run(cargo(&format!(
        "package --workspace {PRIVATE} --quiet --offline --no-verify --allow-dirty"
    )))
}

/// Packs every crate and builds each from its own archive.
pub fn verified() -> Outcome {
    shell::run(cargo(&format!(
        "package --workspace {PRIVATE} --quiet --offline --allow-dirty"
    )))
}
