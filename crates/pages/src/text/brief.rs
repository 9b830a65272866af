//! An identification in about twenty lines: what was read, the law, its parameters, what it may be used for.

use super::{
    against_plan, first_sentence, friction, level_along, line, procedure, searched, table::table,
};
use crate::deviation::Deviation;
use crate::inputs;
use crate::names::{as_good, chosen_by, law_of, parameters_shown};
use crate::trust::{constants, range, use_it};
use std::fmt::Write;
use stiction_codes::Code;
use stiction_files::Warning;
use stiction_files::result::{Origin, ParameterEntry, ResultFile};
use stiction_number::{Percent, counted, sig, unit};
use stiction_parameters::{Name, Side};
use stiction_workflows::identify::Outcome;

/// Warnings that are shown; the others stand in the report.
const MOST_WARNINGS: usize = 3;

/// The outcome of an identification in short: what [`outcome`](super::outcome) says in full.
pub fn brief(outcome: &Outcome) -> String {
    let result = &outcome.result;
    let mut out = read(result);
    let held_out = result.laws.iter().find(|law| law.reported);
    let (error, on) = match held_out.and_then(|law| law.held_out_error_percent) {
        Some(error) => (error, "held-out"),
        None => (result.fit.relative_error_percent, "fit"),
    };
    let _ = writeln!(
        out,
        "{}{}: {on} error {}",
        law_of(result),
        chosen_by(&result.law_chosen_by),
        Percent::error(error).digits(3)
    );
    if let Some(others) = as_good(&result.laws) {
        let _ = writeln!(out, "as good: {others}");
    }
    out.push_str(&parameters(outcome));
    if let Some(curve) = &result.friction_curve {
        let _ = writeln!(out, "friction    {}", friction(curve));
    }
    if let Some(line) = line(result) {
        let _ = writeln!(out, "simulators  {line}");
    }
    for along in &result.level_along {
        let _ = writeln!(out, "stroke      {}", level_along(along, outcome));
    }
    for v in &result.validation {
        let error = Percent::error(v.fit.relative_error_percent).digits(3);
        let _ = writeln!(out, "validation  error {error} on {}", v.path);
    }
    out.push_str(&searched::sections(result));
    out.push_str(&procedure::sections(result));
    out.push_str(&against_plan::section(result.planned.as_ref()));
    out.push_str(&verdict(result));
    out.push_str(&warnings(result));
    out
}

/// What was read, in a line; units that were assumed in another.
fn read(result: &ResultFile) -> String {
    let mut out = match result.inputs.as_slice() {
        [one] => format!(
            "{}{}: {} at {} Hz\n",
            stiction_files::shell::shown(&one.path),
            inputs::part(one),
            counted(one.samples, "sample"),
            sig(one.rate_hz, 4)
        ),
        all => {
            let samples = all.iter().map(|input| input.samples).sum();
            format!("{} logs: {}\n", all.len(), counted(samples, "sample"))
        }
    };
    for input in &result.inputs {
        if let Some(units) = inputs::assumed_units(input) {
            let _ = writeln!(
                out,
                "units assumed: {units} (state them in the axis file) [{}]",
                Code::UnitAssumed
            );
        }
    }
    out
}

/// A row for each parameter; one for both directions of a parameter that each has.
fn parameters(outcome: &Outcome) -> String {
    let result = &outcome.result;
    let knows_truth = !outcome.truth.is_empty();
    let mut header = vec!["parameter", "", "value", "unit"];
    match knows_truth {
        true => header.extend(["another day", "true", ""]),
        false => header.extend(["another day", "another motion", ""]),
    }
    let mut rows = vec![header.into_iter().map(String::from).collect()];
    // What was stated stands in the axis file.
    let fitted = parameters_shown(result).filter(|p| p.origin != Origin::Given);
    let all: Vec<&ParameterEntry> = fitted.collect();
    let both = |a: &&ParameterEntry, b: &&ParameterEntry| {
        let name = |p: &ParameterEntry| p.name.parse::<Name>().ok();
        match (name(a), name(b)) {
            (Some(a), Some(b)) => {
                a.quantity == b.quantity && (a.side, b.side) == (Side::Positive, Side::Negative)
            }
            _ => false,
        }
    };
    for pair in all.chunk_by(both) {
        let joined = |cell: &dyn Fn(&ParameterEntry) -> String| {
            let mut cells: Vec<String> = pair.iter().map(|p| cell(p)).collect();
            cells.dedup();
            cells.join(" / ")
        };
        let widest = widest(pair);
        let deviation = |of: fn(&ParameterEntry, &ResultFile) -> Deviation| {
            of(widest, result).cell(&unit(&widest.unit))
        };
        let name = match pair {
            [one] => one.name.clone(),
            _ => pair[0].name.trim_end_matches("_pos").to_string(),
        };
        let truth = |p: &ParameterEntry| {
            let own = outcome.truth.iter().find(|(name, _)| *name == p.name);
            own.map_or(String::new(), |(_, truth)| sig(*truth, 3))
        };
        rows.push(vec![
            name,
            joined(&|p| p.symbol.clone()),
            joined(&|p| sig(p.value, 3)),
            match pair[0].unit.as_str() {
                "1" => String::new(),
                own => unit(own),
            },
            deviation(Deviation::of),
            match knows_truth {
                true => joined(&truth),
                false => deviation(Deviation::of_transfer),
            },
            flag(pair).into(),
        ]);
    }
    table(&rows, &[false, false, true, false, true, true, false])
}

/// The one that is known least, in parts of its value.
fn widest<'a>(pair: &[&'a ParameterEntry]) -> &'a ParameterEntry {
    let part = |p: &ParameterEntry| {
        let half = p.half_width.map_or(f64::INFINITY, |half| half.repeat);
        half / p.value.abs()
    };
    let rest = pair[1..].iter();
    rest.fold(
        pair[0],
        |most, p| if part(p) > part(most) { p } else { most },
    )
}

fn flag(pair: &[&ParameterEntry]) -> &'static str {
    let open: Vec<bool> = pair.iter().map(|p| !p.identifiable).collect();
    match open.as_slice() {
        [true, false] => "+ NOT IDENTIFIABLE",
        [false, true] => "- NOT IDENTIFIABLE",
        open if open.contains(&true) => "NOT IDENTIFIABLE",
        _ => "",
    }
}

/// Whether the law may compensate friction, and where.
fn verdict(result: &ResultFile) -> String {
    let trust = &result.trust;
    let mut out = format!("for compensation  {}\n", use_it(trust));
    if let Some(seen) = &trust.compensation {
        let _ = writeln!(out, "                  {}", range(seen, result));
    }
    // Flags of single parameters do not say that none of them holds.
    if trust.constants.is_empty() {
        let why = constants(result, str::to_string);
        let _ = writeln!(out, "as constants      {why}");
    }
    out
}

/// The first warnings in a sentence each, and how many there are beside them. What the table flags is said there.
fn warnings(result: &ResultFile) -> String {
    let flagged = |w: &&Warning| w.code == Code::NotIdentifiable;
    let all: Vec<&Warning> = result.warnings.iter().filter(|w| !flagged(w)).collect();
    let mut out = String::new();
    for warning in all.iter().take(MOST_WARNINGS) {
        let _ = writeln!(out, "warning [{}] {}", warning.code, first(warning, result));
    }
    let more = result.warnings.len() - all.len().min(MOST_WARNINGS);
    if more > 0 {
        let _ = writeln!(out, "{}: --verbose", counted(more, "more warning"));
    }
    out
}

/// The first sentence of a warning, without the log where there is only one.
fn first<'a>(warning: &'a Warning, result: &ResultFile) -> &'a str {
    let mut text = warning.message.as_str();
    if let [one] = result.inputs.as_slice() {
        let own = text.strip_prefix(&one.path);
        text = own.and_then(|rest| rest.strip_prefix(": ")).unwrap_or(text);
    }
    first_sentence(text)
}
