//! A check in short: the columns, what is wrong, what the log determines, and what to do next.

use super::told::{Row, rows};
use super::{next, silent, tracking};
use crate::text::first_sentence;
use crate::text::table::table;
use std::fmt::Write;
use std::path::Path;
use stiction_files::shell::shown;
use stiction_number::{counted, sig, unit};
use stiction_workflows::check::{Check, Finding, LogCheck};

/// Findings that are shown of a log.
const MOST_FINDINGS: usize = 5;

/// The outcome of a check in short: what [`check`](super::check) says in full.
pub fn check_in_short(check: &Check) -> String {
    let axis = check.axis.as_deref();
    let kind = check.logs.first().map_or("", |log| log.kind.as_str());
    let mut out: String = check.tracking.iter().map(|c| tracking(c, kind)).collect();
    out.extend(silent(check));
    // How several logs follow their reference is what they are given for.
    let compared = !check.tracking.is_empty();
    for log in &check.logs {
        let separator = if out.is_empty() || compared { "" } else { "\n" };
        out.push_str(separator);
        match compared {
            true => out.extend(refused(log)),
            false => out.push_str(&one(log, axis)),
        }
    }
    out
}

fn one(log: &LogCheck, axis: Option<&Path>) -> String {
    let mut out = format!(
        "{}: {} axis, {}, {} s at {} Hz\n",
        shown(&log.input.path),
        log.kind,
        counted(log.input.samples, "sample"),
        sig(log.seconds, 3),
        sig(log.input.rate_hz, 3)
    );
    out.push_str(&columns(log));
    out.push_str(&findings(&log.findings));
    out.push_str(&parameters(log));
    out.extend(refused(log));
    let (lines, command) = next(log, axis);
    for line in lines {
        let _ = writeln!(out, "{line}");
    }
    let _ = writeln!(out, "next: {command}");
    out
}

fn refused(log: &LogCheck) -> Option<String> {
    let why = log.refused.as_ref()?;
    let path = shown(&log.input.path);
    Some(format!("{path} cannot be trusted: {why}\n"))
}

/// The columns that are used.
fn columns(log: &LogCheck) -> String {
    let used = log.columns.iter().filter_map(|column| {
        let role = column.role.clone()?;
        Some(vec![
            format!("  {role}"),
            column.column.clone(),
            unit(&column.unit),
        ])
    });
    let rows: Vec<Vec<String>> = used.collect();
    let unused = log.columns.len() - rows.len();
    let mut out = table(&rows, &[]);
    if unused > 0 {
        let _ = writeln!(out, "  {} not used", counted(unused, "column"));
    }
    out
}

/// The findings that matter most, and what to do about those that are warnings.
fn findings(all: &[Finding]) -> String {
    let is_warning = |f: &&Finding| f.severity == "warning";
    let warnings = all.iter().filter(is_warning);
    let notes = all.iter().filter(|f| !is_warning(f));
    let mut out = String::new();
    for f in warnings.chain(notes).take(MOST_FINDINGS) {
        let text = match is_warning(&f) {
            true => f.message.as_str(),
            false => first_sentence(&f.message),
        };
        let text = shown(text);
        let _ = writeln!(out, "{} [{}] {text}", f.severity, f.code);
    }
    let more = all.len().saturating_sub(MOST_FINDINGS);
    if more > 0 {
        let _ = writeln!(out, "{}: --verbose", counted(more, "more finding"));
    }
    out
}

/// What the log determines, by a fit where there is one, a line each.
fn parameters(log: &LogCheck) -> String {
    let row = |row: Row| {
        let verdict = match row.value {
            Some(value) => format!("determined, about {} {}", sig(value, 3), unit(&row.unit)),
            None => format!("{}: {}", row.verdict, row.remark),
        };
        match row.symbol.is_empty() {
            true => vec![format!("  {}", row.name), verdict],
            false => vec![format!("  {}", row.name), row.symbol, verdict],
        }
    };
    let rows: Vec<Vec<String>> = rows(log).into_iter().map(row).collect();
    table(&rows, &[])
}
