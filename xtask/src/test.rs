//! Everything CI checks, the quick refusals first.

use crate::shell::{self, Outcome, cargo};
use crate::{instructions, licences, setup};

/// Runs all checks and stops at the first that fails.
pub fn run() -> Outcome {
    setup()?;
    shell::run(cargo("fmt --all --check"))?;
    licences::run()?;
    shell::run(cargo("clippy --workspace --all-targets -- -D warnings"))?;
    let mut doc = cargo("doc --workspace --no-deps");
    doc.env("RUSTDOCFLAGS", "-D warnings");
    shell::run(doc)?;
    instructions::compare()?;
    // nextest runs no doctests; where it is missing, `cargo test` runs everything.
    if shell::on_path("cargo-nextest") {
        shell::run(cargo("test --quiet --workspace --doc"))?;
        shell::run(cargo("nextest run --workspace --no-fail-fast"))
    } else {
        shell::run(cargo("test --workspace --no-fail-fast"))
    }
}
