//! From a selector to a column.

use super::channel::Selector;
use super::describe::{columns, key, listed};
use crate::{Error, Kind, Table};
use std::fmt::Display;
use stiction_formats::unit::nearest;

/// The position of the column that a selector means; `role` is what it is called in messages.
pub(crate) fn select(
    table: &Table,
    selector: &Selector,
    role: impl Display,
) -> Result<usize, Error> {
    match selector {
        Selector::Index(number) => {
            if let Some(index) = table.index(*number) {
                return Ok(index);
            }
            let found = if table.left_out.contains(number) {
                format!("{role} is column {number}, which has no numbers")
            } else {
                let count = table.columns.len() + table.left_out.len();
                format!("{role} is column {number}, and the table has {count}")
            };
            Err(Error::new(Kind::Missing, found, columns(table)))
        }
        Selector::Name(name) => by_name(table, name, role),
    }
}

fn by_name(table: &Table, name: &str, role: impl Display) -> Result<usize, Error> {
    let wanted = name.trim();
    let full = |index: usize| {
        let column = &table.columns[index];
        column
            .unit
            .as_ref()
            .map(|unit| format!("{} [{unit}]", column.name))
    };
    let all = 0..table.columns.len();
    let mut hits: Vec<usize> = all
        .clone()
        .filter(|&i| table.columns[i].name == wanted)
        .collect();
    if hits.is_empty() {
        hits = all
            .clone()
            .filter(|&i| full(i).as_deref() == Some(wanted))
            .collect();
    }
    if hits.is_empty() {
        let lower = wanted.to_lowercase();
        hits = all
            .clone()
            .filter(|&i| table.columns[i].name.to_lowercase() == lower)
            .collect();
    }
    if hits.is_empty() {
        hits = all.filter(|&i| table.is_also(i, wanted)).collect();
    }
    hits = distinct(table, hits);
    match hits.as_slice() {
        [one] => Ok(*one),
        [] => {
            let near = nearest(wanted, table.columns.iter().map(|c| c.name.as_str()));
            let hint = match near.as_slice() {
                [] => String::new(),
                near => format!("did you mean {}? ", near.join(", ")),
            };
            let found = format!("no column {wanted:?} for {role}");
            Err(Error::new(
                Kind::Missing,
                found,
                format!("{hint}{}", columns(table)),
            ))
        }
        several => {
            let lines: Vec<_> = several
                .iter()
                .map(|&i| format!("{role} = {}", table.number(i)))
                .collect();
            let found = format!(
                "{} columns are named {wanted:?}, with different samples: {}",
                several.len(),
                listed(several.iter().map(|&i| key(table, i)))
            );
            let allowed = format!("say which by its number: {}", lines.join(" or "));
            Err(Error::new(Kind::Ambiguous, found, allowed))
        }
    }
}

/// The same columns without those that repeat an earlier one sample by sample.
pub(super) fn distinct(table: &Table, hits: Vec<usize>) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    for hit in hits {
        let repeats = kept.iter().any(|&earlier| same(table, earlier, hit));
        if !repeats {
            kept.push(hit);
        }
    }
    kept
}

fn same(table: &Table, a: usize, b: usize) -> bool {
    let (a, b) = (&table.columns[a], &table.columns[b]);
    let bits = |x: &f64| x.to_bits();
    a.unit == b.unit && a.values.iter().map(bits).eq(b.values.iter().map(bits))
}
