//! Dependencies against `deny.toml`: licences that the project's own can carry, no second versions, crates.io alone.

use crate::shell::{self, Outcome};
use crate::tools;

/// Checks every package in the lock file that any target, feature or test can reach.
pub fn run() -> Outcome {
    let check = "--locked check --hide-inclusion-graph bans licenses sources";
    shell::run(tools::command(&tools::DENY, check)?)
}
