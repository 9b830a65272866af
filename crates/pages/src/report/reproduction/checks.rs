//! Numbers beside their references.

use stiction_files::reproduce_file::{CheckEntry, ReproduceFile};
use stiction_files::symbols;
use stiction_number::Percent;
use stiction_report::{Align, Callout, Severity, Table, Text, number};

/// How many numbers are within their tolerance.
pub(super) fn verdict(file: &ReproduceFile) -> Callout {
    let off = file.checks.iter().filter(|c| !c.within).count();
    let all = file.checks.len();
    let (severity, text) = match off {
        0 if all == 0 => (Severity::Error, "Nothing could be checked.".to_string()),
        0 => (
            Severity::Good,
            format!("All {all} numbers are within their tolerance."),
        ),
        n => (
            Severity::Error,
            format!("{n} of {all} numbers are off; marked below."),
        ),
    };
    Callout {
        severity,
        code: String::new(),
        text: Text::from(text),
        link: String::new(),
    }
}

pub(super) fn table<'c>(checks: impl Iterator<Item = &'c CheckEntry>) -> Table {
    let columns = [
        ("Number", Align::Left),
        ("Reference", Align::Right),
        ("Found", Align::Right),
        ("Unit", Align::Left),
        ("Off by", Align::Right),
        ("Allowed", Align::Right),
        ("", Align::Center),
    ];
    let table = Table::new(columns);
    checks.fold(table, |table, check| {
        let share = |x: f64| match check.reference {
            0.0 => format!("{} {}", number::sig(x, 2), number::unit(&check.unit)),
            reference => Percent::error(100.0 * x / reference.abs()).digits(2),
        };
        let cells = [
            symbols::symbol(&check.name),
            number::sig(check.reference, 6),
            number::sig(check.found, 6),
            number::unit(&check.unit),
            share(check.found - check.reference),
            share(check.tolerance),
            if check.within { "within" } else { "OFF" }.to_string(),
        ];
        if check.within {
            table.row(cells)
        } else {
            table.marked(Severity::Error, cells)
        }
    })
}

/// The numbers of one experiment.
pub(super) fn numbers(file: &ReproduceFile, experiment: &str) -> Table {
    table(file.checks.iter().filter(|c| c.experiment == experiment))
}
