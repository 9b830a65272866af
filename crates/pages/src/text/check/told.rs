//! A check for whoever shows it with elements of its own: rows and lines in place of one text.

use super::next;
use std::path::Path;
use stiction_files::symbols;
use stiction_workflows::check::{LogCheck, ParameterCheck};

/// A check of one log.
#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    /// What the log determines by a fit; where nothing could be fitted, what its motion can show.
    pub rows: Vec<Row>,
    /// What to do next, before the command.
    pub next: Vec<String>,
    /// The command that leads on.
    pub command: String,
}

/// Whether a log determines a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the parameter; what the motion can show in words.
    pub name: String,
    /// Symbol; empty without a fit.
    pub symbol: String,
    /// `determined` or `not determined`; without a fit `possible`, `doubtful` or `no`.
    pub verdict: String,
    /// Estimate where it is determined, SI.
    pub value: Option<f64>,
    /// Unit of it.
    pub unit: String,
    /// Motion to record, else the reason; empty where it is determined.
    pub remark: String,
}

/// What is told of a log that was read with this axis file.
pub fn told(log: &LogCheck, axis: Option<&Path>) -> Told {
    let (next, command) = next(log, axis);
    Told {
        rows: rows(log),
        next,
        command,
    }
}

/// What the log determines by a fit, else what its motion can show.
pub(super) fn rows(log: &LogCheck) -> Vec<Row> {
    match log.parameters.is_empty() {
        true => of_motion(log),
        false => log.parameters.iter().map(|p| of_fit(log, p)).collect(),
    }
}

fn of_fit(log: &LogCheck, p: &ParameterCheck) -> Row {
    let shows = log.shows.iter().find(|s| p.name.starts_with(&s.name));
    let remark = match (p.identifiable, shows) {
        (true, _) => String::new(),
        (false, Some(shows)) if !shows.record.is_empty() => format!("record {}", shows.record),
        (false, _) => p.reason.clone(),
    };
    let verdict = if p.identifiable {
        "determined"
    } else {
        "not determined"
    };
    Row {
        name: p.name.clone(),
        symbol: symbols::symbol(&p.name),
        verdict: verdict.into(),
        value: p.identifiable.then_some(p.value),
        unit: p.unit.clone(),
        remark,
    }
}

fn of_motion(log: &LogCheck) -> Vec<Row> {
    let one = |s: &stiction_workflows::check::Shows| Row {
        name: s.meaning.clone(),
        symbol: String::new(),
        verdict: s.shown.clone(),
        value: None,
        unit: String::new(),
        remark: match s.record.is_empty() {
            true => s.because.clone(),
            false => format!("record {}", s.record),
        },
    };
    log.shows.iter().map(one).collect()
}
