//! A log beside its plan, as a terminal shows it.

use super::table::table;
use std::fmt::Write;
use stiction_files::result::PlannedEntry;
use stiction_number::{Percent, counted, four_digits as short};

/// Which pieces ran, and each parameter as it was expected and found; empty where no plan was given.
pub(super) fn section(entry: Option<&PlannedEntry>) -> String {
    let Some(entry) = entry else {
        return String::new();
    };
    let mut out = format!("\nagainst {}\n", entry.path);
    let whole = entry.pieces.iter().filter(|p| p.status == "whole").count();
    let first = entry
        .pieces
        .iter()
        .find_map(|p| Some((p.planned_start, p.start?)));
    if let (Some(log), Some((planned, start))) = (&entry.log, first) {
        let _ = writeln!(
            out,
            "{whole} of {} whole in {log}, from {} s on",
            counted(entry.pieces.len(), "piece"),
            short(start - planned)
        );
    }
    if entry.parameters.is_empty() {
        return out;
    }
    let header = [
        "parameter",
        "expected, half of the axes",
        "nine of ten",
        "found",
        "",
    ];
    let mut rows = vec![header.map(String::from).to_vec()];
    let half = |percent: f64| format!("+-{}", Percent::deviation(percent).short());
    rows.extend(entry.parameters.iter().map(|p| {
        let name = match &p.of {
            Some(of) => format!("{}, of {of}", p.name),
            None => p.name.clone(),
        };
        vec![
            name,
            half(p.expected_percent),
            half(p.expected90_percent),
            p.found_percent.map_or("-".into(), half),
            match p.status.as_str() {
                "wider" => "wider than expected",
                "open" => "open",
                _ => "",
            }
            .into(),
        ]
    }));
    out.push_str(&table(&rows, &[false, true, true, true, false]));
    out
}
