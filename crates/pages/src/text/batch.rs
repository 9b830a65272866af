//! A batch as a terminal shows it.

use super::table::table;
use crate::apart::{apart, look};
use crate::more_logs::more_logs;
use std::fmt::Write;
use std::path::Path;
use stiction_files::batch::{BatchFile, RESULTS};
use stiction_files::shell::{quoted, quoted_path};
use stiction_number::counted;
use stiction_workflows::drift::least_logs;

/// What became of the logs, and what to do next. `axis` is the axis file of the logs.
pub fn batch(file: &BatchFile, dir: &Path, axis: Option<&Path>) -> String {
    let mut out = String::new();
    let failed: usize = file.failed.iter().map(|failure| failure.logs).sum();
    let taken = match file.taken {
        0 => String::new(),
        taken => format!(", {taken} of them taken from an earlier call"),
    };
    let _ = writeln!(out, "{}{taken}", counted(file.logs, "log"));
    let left = file.logs - file.identified - failed;
    let mut rows = vec![
        vec![
            "trustworthy".into(),
            file.trustworthy.to_string(),
            String::new(),
        ],
        vec![
            "not trustworthy".into(),
            (file.identified - file.trustworthy).to_string(),
            String::new(),
        ],
        vec!["failed".into(), failed.to_string(), String::new()],
    ];
    if left > 0 {
        rows.push(vec!["not done".into(), left.to_string(), String::new()]);
    }
    for failure in &file.failed {
        let first = failure.first.lines().next().unwrap_or_default();
        let which = if failure.logs > 1 { "first: " } else { "" };
        rows.push(vec![
            format!("  {}", failure.code),
            failure.logs.to_string(),
            format!("{which}{first}"),
        ]);
    }
    out.push_str(&table(&rows, &[false, true, false]));
    out.push_str(&apart(&file.apart));
    if file.status == "complete" {
        let _ = writeln!(out, "\nwritten to {}: {RESULTS}, batch.json", dir.display());
    }
    let table = quoted_path(&dir.join(RESULTS));
    if let Some(failure) = file.failed.first() {
        let axis = axis.map_or(String::new(), |axis| {
            format!(" --axis {}", quoted_path(axis))
        });
        let _ = writeln!(
            out,
            "next: see what is wrong with the first log that failed\n  stiction check {}{axis}",
            quoted(&failure.path)
        );
    }
    if let Some(next) = look(&file.apart) {
        out.push_str(&next);
    } else if file.status == "complete" && file.identified > 0 && file.identified < least_logs() {
        out.push_str(&more_logs(file, dir));
    } else if file.status == "complete" && file.identified > 0 {
        let _ = writeln!(
            out,
            "next: what changed over time, and on which machine\n  stiction drift {table}"
        );
    }
    out
}
