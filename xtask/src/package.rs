//! The crates as they would be published.

use crate::shell::{self, Outcome, cargo};

/// Never published: for tests, and the tasks.
const PRIVATE: &str = "--exclude stiction-testkit --exclude xtask";

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
