//! What a reader should know of a log before its results: what the fit did not see.

use stiction_codes::Code;
use stiction_files::result::{ExcludedEntry, Input};
use stiction_number::four_digits as short;

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
