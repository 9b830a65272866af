//! stiction beside the searches of Python, on the same logs.

use crate::shell::{self, Outcome};

/// Runs the peers and rewrites their part of `docs/performance.md`.
pub fn run() -> Outcome {
    shell::run(shell::command("python3", &["bench/peers/compare.py"]))
}
