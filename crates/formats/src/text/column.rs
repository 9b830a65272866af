//! From the samples that were read to the table that is given back.

use super::body::Body;
use super::choose::Layout;
use super::problem::{self, count};
use super::row::{Role, Seen};
use crate::table::is_beyond;
use crate::{Column, Table};
use std::collections::BTreeMap;

/// Half a day and a day in seconds.
const HALF_DAY: f64 = 43_200.0;
/// s.
const DAY: f64 = 86_400.0;

/// Puts the table together and says what was detected and what was left out.
pub(super) fn finish(layout: Layout, body: Body) -> Table {
    let mut table = Table {
        detected: layout.detected,
        ..Table::default()
    };
    match (body.state.decimal, &body.decimal) {
        (Some(decimal), Some(_)) => table.detected.push(format!("decimal {decimal}")),
        (Some(decimal), None) => table.detected.push(format!("decimal {decimal} as stated")),
        (None, _) => table.detected.push("whole numbers only".to_owned()),
    }
    if layout.titles.iter().any(|t| t.unit.is_some()) && layout.scope.is_none() {
        let in_row = table.detected.iter().any(|d| d.starts_with("units in"));
        if !in_row {
            table.detected.push("units in the header".to_owned());
        }
    }
    let mut left_out = Vec::new();
    let mut passed = BTreeMap::new();
    let mut columns = body.columns;
    for (c, title) in layout.titles.into_iter().enumerate() {
        let mut values = std::mem::take(&mut columns[c]);
        let number = table.columns.len() + 1;
        let label = match title.name.as_str() {
            "" => format!("column {}", c + 1),
            name => problem::label(name, c),
        };
        let (mut unit, mut stamps) = (title.unit.clone(), false);
        match body.state.roles[c] {
            Role::Text => {
                let seen = body.texts[c].as_ref();
                let example = seen.map_or(String::new(), |s| {
                    format!(" such as {} in line {}", s.text, s.line)
                });
                table.skipped.push(format!("{label}: text{example}"));
                left_out.push(number);
            }
            Role::Unknown if layout.scope.is_none() => {
                table.skipped.push(format!("{label}: no number in any row"));
                left_out.push(number);
            }
            Role::Moment { dated, .. } => {
                (unit, stamps) = (Some("s".to_owned()), true);
                let sort = if dated {
                    "dates with time"
                } else {
                    "times of day"
                };
                let midnight = if !dated && unwrap_midnight(&mut values) {
                    ", with a day added after each midnight"
                } else {
                    ""
                };
                let said =
                    format!("{label}: {sort}, converted to seconds from the first{midnight}");
                table.detected.push(said);
            }
            Role::Local(dates) => {
                (unit, stamps) = (Some("s".to_owned()), true);
                table.detected.push(format!(
                    "{label}: dates with time, {}, converted to seconds from the first",
                    dates.said()
                ));
            }
            role @ Role::List { first, length } => {
                table
                    .detected
                    .push(format!("{label}: lists of {length} numbers"));
                for (at, name) in (first..).zip(title.each(role)) {
                    if !layout.rule.keep[at] {
                        passed.insert(table.columns.len() - left_out.len(), body.passed[at]);
                    }
                    table.columns.push(Column {
                        name,
                        unit: unit.clone(),
                        stamps: false,
                        values: std::mem::take(&mut columns[at]),
                    });
                }
                continue;
            }
            _ => {}
        }
        let is_left_out = left_out.last() == Some(&number);
        let beyond = match layout.rule.keep[c] {
            true => values.iter().any(|x| is_beyond(*x)),
            false => body.passed[c].beyond && !is_left_out,
        };
        if beyond {
            table.detected.push(format!(
                "{label}: numbers beyond 2^53 are rounded to the nearest 64-bit float"
            ));
        }
        if !layout.rule.keep[c] && !is_left_out {
            passed.insert(number - 1 - left_out.len(), body.passed[c]);
        }
        table.columns.push(Column {
            name: title.name,
            unit,
            stamps,
            values,
        });
    }
    if let Some(scope) = &layout.scope {
        scope.finish(&mut table);
    }
    if layout.scope.is_none() {
        let mut number = 0;
        table.columns.retain(|_| {
            number += 1;
            !left_out.contains(&number)
        });
        table.left_out = left_out;
        table.passed = passed;
    }
    if body.comments > 0 {
        table.skipped.push(format!(
            "{} between the rows",
            count(body.comments, "comment line")
        ));
    }
    if body.blank > 0 {
        table.skipped.push(format!(
            "{} between the rows",
            count(body.blank, "blank line")
        ));
    }
    if let Some(Seen { line, text }) = &body.trailing {
        table.skipped.push(format!(
            "text after the last sample, from line {line}: {text}"
        ));
    }
    table
}

/// Lets times of day run on over midnight; whether there was one.
pub(crate) fn unwrap_midnight(values: &mut [f64]) -> bool {
    let (mut days, mut last) = (0.0, f64::NEG_INFINITY);
    for value in values.iter_mut().filter(|v| !v.is_nan()) {
        if *value < last - HALF_DAY {
            days += DAY;
        }
        last = *value;
        *value += days;
    }
    days > 0.0
}
