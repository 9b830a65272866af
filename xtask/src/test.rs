//! Everything CI checks, the quick refusals first.

use crate::shell::{self, Outcome, cargo};
use crate::{instructions, licences, package, setup, tools};
use std::thread;

/// Runs all checks and stops at the first that fails.
pub fn run() -> Outcome {
    shell::run(cargo("fmt --all --check"))?;
    // Installing waits for the network, the lints for the processor.
    let installing = thread::spawn(setup);
    let lints = shell::run(cargo("clippy --workspace --all-targets -- -D warnings"));
    installing
        .join()
        .unwrap_or_else(|_| Err("the set-up panicked".into()))?;
    lints?;
    licences::run()?;
    package::run()?;
    let mut doc = cargo("doc --workspace --no-deps");
    doc.env("RUSTDOCFLAGS", "-D warnings");
    shell::run(doc)?;
    instructions::compare()?;
    let tests = "nextest run --workspace --no-fail-fast";
    shell::run(tools::command(&tools::NEXTEST, tests)?)?;
    // The one crate with features. What it shares with the others was built above.
    let bare = "nextest run --package stiction-log --no-default-features --no-fail-fast";
    shell::run(tools::command(&tools::NEXTEST, bare)?)?;
    // nextest runs no doctests.
    shell::run(cargo("test --quiet --workspace --doc"))
}
