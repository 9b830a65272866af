//! What CI has no time for: the tests marked `#[ignore = "soak: .."]`, most of them one of the ordinary tests with more
//! seeds, the crate with features without them, the packed crates built on their own, fleets whose workers are killed, and the Python
//! package on a free-threaded Python.

use crate::shell::{self, Outcome};
use crate::{interpreter, package, setup, tools, wheel};

/// The one crate with features, without them.
const BARE: &str =
    "nextest run --package stiction-log --no-default-features --tests --no-fail-fast";

/// Runs it all; about three quarters of an hour on two cores, and a quarter more where the free-threaded Python is to be built.
pub fn run() -> Outcome {
    setup()?;
    package::verified()?;
    shell::run(tools::command(&tools::NEXTEST, BARE)?)?;
    // The ordinary tests too: their property tests draw other cases here than in CI.
    let tests = "nextest run --workspace --no-fail-fast --run-ignored all";
    shell::run(tools::command(&tools::NEXTEST, tests)?)?;
    wheel::soak()?;
    interpreter::install()?;
    wheel::built_free_threaded()
}
