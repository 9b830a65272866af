//! Everything CI checks, the quick refusals first.

use crate::shell::{self, Outcome, cargo};
use crate::{instructions, licences, package, setup, tools, web, wheel};
use std::thread;

/// Every target that has tests; examples and benchmarks are only checked, with the lints.
const TESTS: &str = "nextest run --workspace --tests --no-fail-fast";
/// What property tests draw their cases from: the same on every run, so that a change is judged by what it changed. Other
/// cases are drawn by `soak`.
const SEED: (&str, &str) = ("PROPTEST_RNG_SEED", "1");
/// The one crate with features, without them; its tests are run so by `soak`.
const BARE: &str =
    "clippy --package stiction-log --no-default-features --all-targets -- -D warnings";

/// Runs all checks and stops at the first that fails.
pub fn run() -> Outcome {
    shell::run(cargo("fmt --all --check"))?;
    // Installing waits for the network and is not in the way of the compiler.
    let aside = thread::spawn(|| {
        setup()?;
        web::check()
    });
    let built = build();
    aside
        .join()
        .unwrap_or_else(|_| Err("set-up panicked".into()))?;
    built?;
    instructions::compare()?;
    // One more than there are cores: some tests wait, for LinuxCNC's own clock or for a program that is to be ended.
    let at_once = 1 + thread::available_parallelism().map_or(1, usize::from);
    let tests = format!("{TESTS} --test-threads {at_once}");
    let mut tests = tools::command(&tools::NEXTEST, &tests)?;
    tests.env(SEED.0, SEED.1);
    shell::run(tests)?;
    // nextest runs no doctests.
    shell::run(cargo("test --quiet --workspace --doc"))?;
    web::test()?;
    wheel::test()
}

/// What needs the compiler alone.
fn build() -> Outcome {
    shell::run(cargo("clippy --workspace --all-targets -- -D warnings"))?;
    shell::run(cargo(BARE))?;
    let mut doc = cargo("doc --workspace --no-deps");
    doc.env("RUSTDOCFLAGS", "-D warnings");
    shell::run(doc)?;
    licences::run()?;
    package::run()?;
    // With the tests, the library of the Python package: of the same dependencies, which are built once; and the program
    // that its tests compare it with.
    shell::run(cargo("build --workspace --lib --bins --tests"))
}
