//! A comparison as a terminal shows it.

use super::table::table;
use std::fmt::Write;
use stiction_files::compare_file::{CompareFile, MethodEntry, Quartiles};
use stiction_number::{counted, four_digits as short, short as whole};
use stiction_workflows::compare::CompareSize;

fn median(values: &Quartiles) -> String {
    values.map_or("-".into(), |[_, median, _]| short(median))
}

/// Samples up to which nothing is said before: a comparison of some seconds.
const SHORT: u64 = 1_000_000_000;

/// How large a comparison is, before it runs; `None` of a short one.
pub fn announced_comparison(size: CompareSize) -> Option<String> {
    let text = format!(
        "{}, whose candidates are computed on up to {} samples in all",
        counted(size.runs as usize, "run"),
        whole(size.samples as f64)
    );
    (size.samples > SHORT).then_some(text)
}

/// What was compared, the rates, and how long success took.
pub fn comparison(file: &CompareFile) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "{}: {}", file.problem, file.motion);
    let noise = file
        .noise
        .map_or(String::new(), |x| format!(", noise {} %", short(100.0 * x)));
    let decades = file.box_decades.map_or(String::new(), |x| {
        format!(", box of {} decades to each side", short(x))
    });
    let _ = writeln!(
        out,
        "{} samples{noise}{decades}; {} cost, integrator {}",
        file.samples, file.cost, file.integrator
    );
    let _ = writeln!(
        out,
        "optimum J = {:.6e} ({}); success: {}",
        file.reference.cost, file.reference.by, file.success
    );
    if file.reference.beaten {
        let before = file
            .reference
            .before
            .map_or("none".into(), |x| format!("{x:.6e}"));
        let _ = writeln!(out, "lower than what the reference search found: {before}");
    }
    out.push('\n');
    let header = [
        "method",
        "runs",
        "success alone",
        "with least squares",
        "median J alone",
        "over the optimum",
        "evaluations to success",
        "s to success",
        "s a run",
    ];
    let mut rows = vec![header.map(String::from).to_vec()];
    rows.extend(file.methods.iter().map(row));
    out.push_str(&table(
        &rows,
        &[false, true, true, true, true, true, true, true, true],
    ));
    if file.status == "interrupted" {
        out.push_str("\ninterrupted: runs that were not complete are left out\n");
    }
    out
}

fn row(method: &MethodEntry) -> Vec<String> {
    vec![
        method.name.clone(),
        method.runs.len().to_string(),
        method.own.successes.to_string(),
        method.after_least_squares.successes.to_string(),
        median(&method.own.cost),
        median(&method.own.excess),
        median(&method.evaluations_to_success),
        median(&method.seconds_to_success),
        median(&method.seconds),
    ]
}
