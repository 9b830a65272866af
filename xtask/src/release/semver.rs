//! The public interface of the three packages beside that of the last release on crates.io.

use crate::package;
use crate::shell::{self, Outcome};
use crate::tools;

/// Fails where the version promises more than the interface holds. Without an earlier release there is nothing to
/// compare with, which is said.
pub fn compare() -> Outcome {
    let last = "describe --tags --abbrev=0 --match v[0-9]* HEAD";
    let last: Vec<&str> = last.split_whitespace().collect();
    let Ok(tag) = shell::output(shell::command("git", &last)) else {
        println!(
            "==> semver: no tag `v..` before this commit, so no interface to keep; not compared"
        );
        return Ok(());
    };
    // The packages as they are published: in the workspace most of the interface is in crates that nobody sees.
    package::assembled()?;
    let check = format!(
        "semver-checks --manifest-path {} --workspace --baseline-version {}",
        package::workspace(),
        tag.trim().trim_start_matches('v')
    );
    shell::run(tools::command(&tools::SEMVER, &check)?)
}
