//! Published experiments on the terminal.

use super::table::table;
use stiction_files::reproduce_file::{ClaimEntry, ReproduceFile, RunEntry};
use stiction_number::{Percent, four_digits as short, quantity, unit};

/// Every number beside its reference.
pub fn reproduction(file: &ReproduceFile) -> String {
    let header = ["", "number", "reference", "found", "unit", "allowed", ""];
    let mut rows = vec![header.map(String::from).to_vec()];
    for check in &file.checks {
        rows.push(vec![
            check.experiment.clone(),
            check.name.clone(),
            short(check.reference),
            // Where the reference is zero, only a rounding error is found, and its digits are of no use.
            if check.reference == 0.0 {
                one_digit(check.found)
            } else {
                short(check.found)
            },
            unit(&check.unit),
            match check.reference {
                0.0 => one_digit(check.tolerance),
                x => format!("{} %", short(100.0 * check.tolerance / x.abs())),
            },
            if check.within { "within" } else { "OFF" }.into(),
        ]);
    }
    let mut out = table(&rows, &[false, false, true, true, false, true, false]);
    let off = file.checks.iter().filter(|c| !c.within).count();
    out.push_str(&match off {
        0 if file.checks.is_empty() => "\nnothing could be checked\n".to_string(),
        0 => format!("\nall {} within\n", file.checks.len()),
        n => format!("\n{n} of {} OFF\n", file.checks.len()),
    });
    for (_, meaning) in EXPERIMENTS.iter().filter(|(name, _)| {
        let mut checks = file.checks.iter();
        checks.any(|check| check.experiment == *name && !check.within)
    }) {
        out.push_str(&format!("{meaning}\n"));
    }
    let sines: Vec<&RunEntry> = file
        .runs
        .iter()
        .filter(|r| r.experiment == "sine")
        .collect();
    if !sines.is_empty() {
        out.push('\n');
        out.push_str(&runs(&sines));
    }
    let published = file
        .claims
        .iter()
        .filter(|claim| !claim.published.is_empty());
    let published: Vec<&ClaimEntry> = published.collect();
    if !published.is_empty() {
        out.push('\n');
        out.push_str(&claims(&published));
        out.push_str(
            "\nClaims are of another experiment; the assumptions are listed in the report.\n",
        );
    }
    for experiment in &file.not_run {
        out.push_str(&format!("\nnot run: {experiment}\n"));
    }
    if file.status == "interrupted" {
        out.push_str("\nSTOPPED EARLY: what was done is kept\n");
    }
    out
}

/// What it means that an experiment does not find a parameter.
const EXPERIMENTS: [(&str, &str); 3] = [
    (
        "six",
        "six: one search for all parameters over one motion does not find them here from every seed; constant velocities first \
         (static, dynamic) is the paper's way",
    ),
    (
        "measured",
        "measured: from counts of the encoder and with noise in the force, the search ended farther from the axis than these allow",
    ),
    (
        "load",
        "load: found while running, as far as the axis accelerates",
    ),
];

/// The sine under each controller with each compensation.
fn runs(runs: &[&RunEntry]) -> String {
    let Some(first) = runs.first() else {
        return String::new();
    };
    let names = ["sine, controller", "compensation"].map(String::from);
    let metrics = first.metrics.iter().map(|metric| metric.name.clone());
    let mut rows = vec![names.into_iter().chain(metrics).collect::<Vec<_>>()];
    rows.extend(runs.iter().map(|run| {
        let names = [run.controller.clone(), run.compensation.clone()];
        let metrics = run.metrics.iter().map(|m| quantity(m.value, &m.unit));
        names.into_iter().chain(metrics).collect()
    }));
    let right: Vec<bool> = (0..rows[0].len()).map(|c| c >= 2).collect();
    table(&rows, &right)
}

/// The magnitude of a value that should be zero, with one digit.
fn one_digit(x: f64) -> String {
    format!("{x:.0e}")
}

/// Metrics of ours beside the claims of a publication.
fn claims(claims: &[&ClaimEntry]) -> String {
    let header = [
        "metric",
        "controller",
        "compensation",
        "without",
        "with",
        "less",
        "published",
    ];
    let mut rows = vec![header.map(String::from).to_vec()];
    rows.extend(claims.iter().map(|claim| {
        vec![
            claim.name.clone(),
            claim.controller.clone(),
            claim.compensation.clone(),
            quantity(claim.without, &claim.unit),
            quantity(claim.with, &claim.unit),
            Percent::error(claim.reduction_percent).decimals(1),
            claim.published.clone(),
        ]
    }));
    table(&rows, &[false, false, false, true, true, true, false])
}
