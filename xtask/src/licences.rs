//! Refuses dependencies under licences that the project's own (MIT OR Apache-2.0) cannot carry.

use crate::shell::{self, Outcome};
use crate::spdx;

/// Licences that ask for no more than their text and the copyright notice being kept.
const ALLOWED: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MIT-0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Checks every package in the lock file that any target, feature or test can reach.
pub fn run() -> Outcome {
    let tree = shell::output(shell::cargo(
        "tree --workspace --all-features --target all --edges normal,build,dev \
         --prefix none --no-dedupe --format {p}|{l}",
    ))?;
    let mut lines: Vec<&str> = tree
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    lines.sort_unstable();
    lines.dedup();
    let refused: Vec<String> = lines.iter().filter_map(|line| refusal(line)).collect();
    if refused.is_empty() {
        println!("==> licences: {} packages, all permissive", lines.len());
        return Ok(());
    }
    Err(format!(
        "{}\nallowed: {}",
        refused.join("\n"),
        ALLOWED.join(", ")
    ))
}

/// What is wrong with one line, `name version|licence`.
fn refusal(line: &str) -> Option<String> {
    let (package, licence) = line.split_once('|').unwrap_or((line, ""));
    match spdx::permits(licence, &|term| ALLOWED.contains(&term)) {
        Some(true) => None,
        Some(false) => Some(format!("{package}: licence `{licence}` is not allowed")),
        None => Some(format!(
            "{package}: licence `{licence}` is not an SPDX expression"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::refusal;

    #[test]
    fn permissive_passes_and_the_rest_is_named() {
        assert_eq!(refusal("a v1.0.0|MIT/Apache-2.0"), None);
        assert!(refusal("b v1.0.0|GPL-3.0").is_some_and(|text| text.contains("GPL-3.0")));
        assert!(refusal("c v1.0.0|").is_some_and(|text| text.starts_with("c v1.0.0")));
    }
}
