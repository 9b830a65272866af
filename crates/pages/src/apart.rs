//! Levels that are too far apart to be of one unit, in words.

use std::fmt::Write;
use stiction_files::batch::Apart;
use stiction_files::shell::{quoted, shown};
use stiction_number::four_digits as short;

/// What is far apart, and how to see which of the two logs has the wrong unit.
pub(crate) fn apart(all: &[Apart]) -> String {
    let mut text = String::new();
    for found in all {
        let axis = match &found.axis {
            Some(axis) => format!("logs with {}", shown(axis)),
            None => "logs without an axis file".into(),
        };
        let _ = writeln!(
            text,
            "warning: {axis} have {} {} times apart: {} {unit} in {}, {} {unit} in {}; the unit of a column of one of them is probably wrong",
            found.parameter,
            short(found.ratio()),
            short(found.least),
            shown(&found.least_log),
            short(found.most),
            shown(&found.most_log),
            unit = found.unit,
        );
    }
    text
}

/// The command that shows the units of both logs.
pub(crate) fn look(all: &[Apart]) -> Option<String> {
    let found = all.first()?;
    let axis = found.axis.as_ref();
    let axis = axis.map_or(String::new(), |axis| format!(" --axis {}", quoted(axis)));
    Some(format!(
        "compare the units of the two logs, and give the right one in an axis file of that log:\nnext: stiction check {} {}{axis}\n",
        quoted(&found.least_log),
        quoted(&found.most_log)
    ))
}
