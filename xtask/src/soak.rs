//! What CI has no time for: the tests marked `#[ignore = "soak: .."]`, most of them one of the ordinary tests with more
//! seeds or a check of exported text by one more tool, the crate with features without them, documentation, counts of
//! instructions, the packed crates built on their own, fleets whose workers are killed, and the Python package on a
//! free-threaded Python.

use crate::shell::{self, Outcome, cargo};
use crate::{instructions, interpreter, package, python, setup, tools, wheel};

/// The one crate with features, without them: its lints and its tests.
const BARE_LINTS: &str =
    "clippy --package stiction-formats --no-default-features --all-targets -- -D warnings";
const BARE: &str =
    "nextest run --package stiction-formats --no-default-features --tests --no-fail-fast";

/// Runs it all; about three quarters of an hour on two cores, and a quarter more where the free-threaded Python is to be built.
pub fn run() -> Outcome {
    setup()?;
    let mut doc = cargo("doc --workspace --no-deps");
    doc.env("RUSTDOCFLAGS", "-D warnings");
    shell::run(doc)?;
    instructions::compare()?;
    package::verified()?;
    shell::run(cargo(BARE_LINTS))?;
    shell::run(tools::command(&tools::NEXTEST, BARE)?)?;
    // The ordinary tests too: their property tests draw other cases here than in CI.
    let tests = "nextest run --workspace --no-fail-fast --run-ignored all";
    let mut tests = shell::linted(tools::command(&tools::NEXTEST, tests)?);
    // Of tables of cases, all.
    tests.env("STICTION_SOAK", "1");
    let pinocchio = python::pinocchio()?;
    tests.env("STICTION_URDFS", python::robots(&pinocchio)?);
    tests.env("STICTION_PINOCCHIO", pinocchio);
    shell::run(tests)?;
    wheel::soak()?;
    interpreter::install()?;
    wheel::built_free_threaded()
}
