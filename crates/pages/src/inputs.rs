//! What a reader should know of a log before its results: units that were assumed, and what the fit did not see.

use stiction_codes::Code;
use stiction_files::result::{ExcludedEntry, Input, ResolvedAxis};
use stiction_number::{Percent, counted, four_digits as short, unit};

/// Most stretches that are named one by one.
const MOST_NAMED: usize = 4;

/// Which part of a log is fitted, to stand behind its path; nothing where that is all.
pub(crate) fn part(input: &Input) -> String {
    input
        .part
        .as_ref()
        .map_or(String::new(), |part| format!(", {part}"))
}

/// How many rows the enable column leaves out; nothing where it leaves out none.
pub(crate) fn not_enabled(input: &Input) -> Option<String> {
    let left_out = input.not_enabled.as_ref().filter(|left| left.rows > 0)?;
    Some(format!(
        "not fitted: {} of {}, by column {}, which is enable under [columns] of the axis file [{}]",
        left_out.rows,
        counted(left_out.of, "row"),
        left_out.column,
        Code::NotEnabled
    ))
}

/// Which stretches were left out, and why; nothing where the whole log was fitted.
pub(crate) fn left_out(input: &Input) -> Option<String> {
    let excluded: &[ExcludedEntry] = &input.excluded;
    let first = excluded.first()?;
    let stretches: Vec<String> = excluded
        .iter()
        .take(MOST_NAMED)
        .map(|e| format!("{} to {} s", short(e.from_s), short(e.to_s)))
        .collect();
    let more = match excluded.len().saturating_sub(MOST_NAMED) {
        0 => String::new(),
        n => format!(" and {n} more"),
    };
    Some(format!(
        "not fitted: {}{more}, where the axis stands still [{}]; to fit them: rests = \"keep\" under [log] in the axis file",
        stretches.join(", "),
        first.code
    ))
}

/// How long logs are not fitted at their start and after gaps; nothing where that is little.
pub(crate) fn unsettled(axis: &ResolvedAxis) -> Option<String> {
    let left_out = axis.unsettled.as_ref()?;
    let length = match axis.kind.as_str() {
        "rotary" => "rad",
        _ => "m",
    };
    Some(format!(
        "not fitted: {} s, {} of the logs, at the start and after gaps: until the axis has slid {} {length} the force depends on what was \
         before; a log that begins with a stroke of that loses little",
        short(left_out.seconds),
        Percent::error(100.0 * left_out.part).digits(2),
        short(left_out.travel)
    ))
}

/// Which units were assumed; nothing where all are given.
pub(crate) fn assumed_units(input: &Input) -> Option<String> {
    let units = input.assumed.iter();
    let units = units.map(|a| format!("{} in {}", a.column, unit(&a.unit)));
    let units: Vec<String> = units.collect();
    (!units.is_empty()).then(|| units.join(", "))
}

/// Which units were assumed, and the lines that settle them; nothing where all are given.
pub(crate) fn assumed(input: &Input) -> Option<(String, Vec<&str>)> {
    let units = assumed_units(input)?;
    let text = format!(
        "units assumed, given neither in the file nor in an axis file: {units} [{}]; in other units every number below is another. \
         To settle them, in the axis file under [columns]:",
        Code::UnitAssumed
    );
    Some((
        text,
        input.assumed.iter().map(|a| a.line.as_str()).collect(),
    ))
}
