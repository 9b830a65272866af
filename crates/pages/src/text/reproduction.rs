//! Published experiments on the terminal.

use super::table::table;
use stiction_files::reproduce_file::{ClaimEntry, ReproduceFile};
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
    if !file.claims.is_empty() {
        out.push('\n');
        out.push_str(&claims(&file.claims));
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

/// The magnitude of a value that should be zero, with one digit.
fn one_digit(x: f64) -> String {
    format!("{x:.0e}")
}

/// Metrics of ours beside the claims of a publication.
fn claims(claims: &[ClaimEntry]) -> String {
    let header = [
        "metric",
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
            claim.compensation.clone(),
            quantity(claim.without, &claim.unit),
            quantity(claim.with, &claim.unit),
            Percent::error(claim.reduction_percent).decimals(1),
            claim.published.clone(),
        ]
    }));
    table(&rows, &[false, false, true, true, true, false])
}
