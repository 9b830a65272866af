//! What is said after an export.

use crate::export::Exported;
use std::fmt::Write;
use std::path::Path;

/// The files of an export, what it assumed, and what to know before it runs.
pub fn exported(exported: &Exported, dir: &Path) -> String {
    let mut out = String::new();
    for warning in &exported.warnings {
        let _ = writeln!(out, "warning [{}]: {}", warning.code, warning.message);
    }
    let _ = writeln!(
        out,
        "{} compensator `{}` for a cycle of {} s, force at most {}; put into operation as in docs/deploy/{}.md",
        exported.law, exported.name, exported.cycle_time, exported.limit, exported.target
    );
    let _ = writeln!(
        out,
        "written to {}: {}",
        dir.display(),
        exported.written.join(", ")
    );
    out
}
