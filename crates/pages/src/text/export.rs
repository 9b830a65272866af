//! What is said after an export.

use std::fmt::Write;
use std::path::Path;
use stiction_number::four_digits as short;
use stiction_workflows::export::Exported;

/// The files of an export, what it assumed, and what to know before it runs.
pub fn exported(exported: &Exported, dir: &Path) -> String {
    let mut out = String::new();
    for warning in &exported.warnings {
        let _ = writeln!(out, "warning [{}]: {}", warning.code, warning.message);
    }
    let unit = match exported.force_unit.as_str() {
        "1" => "(1 is 100 %)",
        typed => &stiction_number::unit(typed),
    };
    let most = format!("force at most {} {unit}", short(exported.limit));
    let what = match exported.target {
        "mujoco" => format!("for a time step of {} s", exported.cycle_time),
        "tf5200" => format!("with {most}"),
        _ => format!("for a cycle of {} s, {most}", exported.cycle_time),
    };
    let _ = writeln!(
        out,
        "{} compensator `{}` {what}; put into operation as in docs/deploy/{}.md",
        exported.law, exported.name, exported.target
    );
    let _ = writeln!(
        out,
        "written to {}: {}",
        dir.display(),
        exported.written.join(", ")
    );
    out
}
