//! What a reader should know of a log before its results: units that were assumed, and what the fit did not see.

use stiction_codes::Code;
use stiction_files::result::{ExcludedEntry, Input};
use stiction_number::{four_digits as short, unit};

/// Which stretches were left out, and why; nothing where the whole log was fitted.
pub(crate) fn left_out(input: &Input) -> Option<String> {
    let stretches: Vec<String> = input
        .excluded
        .iter()
        .map(|e: &ExcludedEntry| format!("{} to {} s", short(e.from_s), short(e.to_s)))
        .collect();
    if stretches.is_empty() {
        return None;
    }
    Some(format!(
        "left out: {}, the axis stands still [{}]; to keep it: rests = \"keep\" under [log] in the axis file",
        stretches.join(" and "),
        Code::RestAtEnd
    ))
}

/// Which units were assumed, and the lines that settle them; nothing where all are given.
pub(crate) fn assumed(input: &Input) -> Option<(String, Vec<&str>)> {
    let units: Vec<String> = input
        .assumed
        .iter()
        .map(|a| format!("{} in {}", a.column, unit(&a.unit)))
        .collect();
    if units.is_empty() {
        return None;
    }
    let text = format!(
        "units assumed, given neither in the file nor in an axis file: {} [{}]; in other units every number below is another. \
         To settle them, in the axis file under [columns]:",
        units.join(", "),
        Code::UnitAssumed
    );
    Some((
        text,
        input.assumed.iter().map(|a| a.line.as_str()).collect(),
    ))
}
