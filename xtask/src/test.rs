//! Everything CI checks, the quick refusals first.

use crate::shell::{self, Outcome, cargo};
use crate::{exports, forms, licences, setup, site, times, tools, web, wheel};
use std::thread::{self, JoinHandle};
use std::time::Instant;

/// What the tests need and what only has to compile: all of it passes through clippy, so that lints cost no second run of the
/// compiler.
const BUILD: &str = "build --workspace --all-targets";
/// Every target that has tests.
const TESTS: &str = "nextest run --workspace --tests --no-fail-fast";
/// What property tests draw their cases from: the same on every run, so that a change is judged by what it changed. Other
/// cases are drawn by `soak`.
const SEED: (&str, &str) = ("PROPTEST_RNG_SEED", "1");

/// Runs all checks, stops at the first that fails, and prints where the time went.
pub fn run() -> Outcome {
    let start = Instant::now();
    let outcome = checks();
    times::print(start.elapsed());
    outcome
}

fn checks() -> Outcome {
    shell::run(cargo("fmt --all --check"))?;
    // Installing waits for the network and is not in the way of the compiler.
    let aside = thread::spawn(|| {
        setup()?;
        forms::check()?;
        web::check()
    });
    let built = build();
    joined(aside)?;
    built?;
    // One more than there are cores: some tests wait, for LinuxCNC's own clock or for a program that is to be ended.
    let at_once = 1 + thread::available_parallelism().map_or(1, usize::from);
    let tests = format!("{TESTS} --test-threads {at_once}");
    let mut tests = shell::linted(tools::command(&tools::NEXTEST, &tests)?);
    tests.env(SEED.0, SEED.1);
    if exports::have_passed() {
        println!(
            "==> exported code has not changed since it passed under other tools: cargo xtask exports"
        );
        tests.args(["-E", &format!("not ({})", exports::TESTS)]);
    }
    // Browser, Python and site wait more than they compute.
    let aside = thread::spawn(|| {
        web::test()?;
        wheel::test()?;
        site::build()
    });
    let tests = shell::run(tests);
    joined(aside)?;
    tests?;
    // nextest runs no doctests.
    shell::run(shell::linted(cargo("test --quiet --workspace --doc")))
}

/// What a thread came to.
fn joined(aside: JoinHandle<Outcome>) -> Outcome {
    aside
        .join()
        .unwrap_or_else(|_| Err("a step panicked".into()))
}

/// What needs the compiler alone.
fn build() -> Outcome {
    shell::run(shell::linted(cargo(BUILD)))?;
    licences::run()
}
