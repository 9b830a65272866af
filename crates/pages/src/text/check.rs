//! The outcome of a check, and what an axis file was begun with.

mod brief;
mod changed;
mod told;

use super::table::table;
use crate::next::{ANOTHER_LOG, Line};
pub use brief::check_in_short;
pub use changed::{Changed, ChangedRow, changed};
use changed::{micro, worst};
use std::fmt::Write;
use std::path::Path;
use stiction_files::result::Action;
use stiction_files::shell::{new_axis_file, quoted, quoted_path, shown};
use stiction_files::symbols;
use stiction_number::{counted, four_digits as short, unit};
use stiction_workflows::check::{Check, LogCheck, Started, TrackingChange};
pub use told::{Row, Told, told};

/// The outcome of a check.
pub fn check(check: &Check) -> String {
    let axis = check.axis.as_deref();
    let kind = check.logs.first().map_or("", |log| log.kind.as_str());
    let logs = check.logs.iter().map(|log| log_check(log, axis));
    let changes = check.tracking.iter().map(|change| tracking(change, kind));
    // What changed is what several logs are given for; what each shows by itself comes after.
    changes
        .chain(silent(check))
        .chain(logs)
        .collect::<Vec<_>>()
        .join("\n")
}

/// Which logs cannot be compared with the first, and why.
fn silent(check: &Check) -> impl Iterator<Item = String> {
    // Where one log has a reference, whoever gives several compares them.
    let has_reference = |log: &LogCheck| {
        let mut roles = log.columns.iter().map(|c| c.role.as_deref());
        roles.any(|role| role == Some("reference"))
    };
    let compares = check.logs.len() > 1 && check.logs.iter().any(has_reference);
    let logs = check.logs.iter().filter(move |_| compares);
    logs.filter_map(|log| {
        let why = log.not_tracked.as_ref()?;
        Some(format!(
            "the following error of {} is not compared: {why}\n",
            shown(&log.input.path)
        ))
    })
}

/// What changed in how a reference is followed.
fn tracking(change: &TrackingChange, kind: &str) -> String {
    let (before, after) = (&change.before, &change.after);
    let found = changed(change, kind);
    let mut out = format!(
        "following error of {}, against that of {}\n",
        after.log, before.log
    );
    let [a, b] = [before, after].map(|log| log.peaks.len().to_string());
    let mut rows = vec![
        vec![
            String::new(),
            "before".into(),
            "after".into(),
            String::new(),
        ],
        vec!["  reversals of the reference".into(), a, b, String::new()],
    ];
    rows.extend(found.rows.iter().map(|row| {
        let words = match row.change_percent {
            c if !c.is_finite() => String::new(),
            c if c < 0.0 => format!("{:.1} % less", -c),
            c => format!("{c:.1} % more"),
        };
        let [a, b] = [row.before, row.after].map(|x| micro(x, kind));
        vec![format!("  {}", row.name), a, b, words]
    }));
    out.push_str(&table(&rows, &[false, true, true]));
    for note in &found.notes {
        let _ = writeln!(out, "  {note}");
    }
    let exit = match change.worse {
        true => "; exit code 1, since that is half of them or more",
        false => "",
    };
    match worst(change, kind) {
        Some(worst) => {
            let _ = writeln!(out, "  worse {worst}{exit}");
        }
        None if change.differs.is_empty() => out.push_str("  worse at no reversal\n"),
        None => {}
    }
    out
}

/// Part of a turn by which a difference of whole turns may be off.
const ABOUT_A_TURN: f64 = 0.01;

/// An angle, rad, in whole turns, where it is some.
fn turns(angle: f64) -> Option<String> {
    let turns = (angle / std::f64::consts::TAU).abs();
    let whole = turns.round();
    let is = whole >= 1.0 && (turns - whole).abs() < ABOUT_A_TURN;
    is.then(|| counted(whole as usize, "turn"))
}

/// What an axis file was begun with, and what to type next.
pub fn started(started: &Started, logs: &[&Path], file: &Path) -> String {
    let mut out = format!("{} written\n", shown(&file.display().to_string()));
    for change in &started.changes {
        let _ = writeln!(out, "  {change}");
    }
    if started.changes.is_empty() && started.undecided.is_none() {
        out.push_str("  nothing was added: the axis file gives all that the log shows\n");
    }
    for reason in started.undecided.iter().flat_map(|all| all.lines()) {
        let _ = writeln!(out, "to decide: {reason}");
    }
    if started.undecided.is_some() {
        out.push_str("fill in what is to decide, then\n");
    }
    let logs: Vec<String> = logs.iter().map(|log| quoted_path(log)).collect();
    let _ = writeln!(
        out,
        "next: stiction check {} --axis {}",
        logs.join(" "),
        quoted_path(file)
    );
    out
}

fn log_check(log: &LogCheck, axis: Option<&Path>) -> String {
    let mut out = format!(
        "{}\n  {} axis, {} samples, {} s at {} Hz\n",
        shown(&log.input.path),
        log.kind,
        log.input.samples,
        short(log.seconds),
        short(log.input.rate_hz)
    );
    out.push_str("  columns\n");
    out.push_str(&columns(log));
    for line in log.input.detected.iter().filter(|line| !is_column(line)) {
        let _ = writeln!(out, "  detected   {}", shown(line));
    }
    for line in &log.ranges {
        let _ = writeln!(out, "  range      {line}");
    }
    for f in &log.findings {
        let _ = writeln!(
            out,
            "  {:<10} [{}] {}",
            f.severity,
            f.code,
            shown(&f.message)
        );
    }
    for line in &log.conditioning {
        let _ = writeln!(out, "  condition  {line}");
    }
    if !log.shows.is_empty() {
        out.push_str("  what the motion can show, by itself; whether it does, a fit tells\n");
        out.push_str(&shows(log));
    }
    if !log.parameters.is_empty() {
        out.push_str("  the law that a fit to this log would take\n");
        let mut rows = Vec::new();
        for p in &log.parameters {
            rows.push(vec![
                format!("    {}", p.name),
                symbols::symbol(&p.name),
                if p.identifiable {
                    format!("determined, about {} {}", short(p.value), unit(&p.unit))
                } else {
                    format!("not determined: {}", p.reason)
                },
            ]);
        }
        out.push_str(&table(&rows, &[]));
    }
    if let Some(refused) = &log.refused {
        let _ = writeln!(out, "  cannot be trusted: {refused}");
    }
    let (lines, command) = next(log, axis);
    for line in lines {
        let _ = writeln!(out, "  {line}");
    }
    let _ = writeln!(out, "  next: {command}");
    out
}

/// Whether a line of what was detected is about a column, which the table of columns says too.
fn is_column(line: &str) -> bool {
    let (role, rest) = line.split_once(" = ").unwrap_or_default();
    !role.contains(' ') && rest.starts_with("column ")
}

/// The most columns that are shown though they are not used.
const MOST_UNUSED: usize = 12;

fn columns(log: &LogCheck) -> String {
    let mut rows = Vec::new();
    let (mut shown, mut hidden) = (0, 0);
    for column in &log.columns {
        if column.role.is_none() {
            // A number alone tells nothing.
            if !column.column.contains('"') || shown == MOST_UNUSED {
                hidden += 1;
                continue;
            }
            shown += 1;
        }
        rows.push(vec![
            format!("    {}", column.column),
            column.role.clone().unwrap_or_else(|| "not used".into()),
            unit(&column.unit),
            column.reason.clone(),
        ]);
    }
    let mut out = table(&rows, &[]);
    match (hidden, shown) {
        (0, _) => {}
        (n, 0) => {
            let _ = writeln!(out, "    {} not used", counted(n, "column"));
        }
        (n, _) => {
            let _ = writeln!(out, "    {} more not used", counted(n, "column"));
        }
    }
    out
}

fn shows(log: &LogCheck) -> String {
    let mut out = String::new();
    let wide = log.shows.iter().map(|s| s.meaning.chars().count()).max();
    let wide = wide.unwrap_or(0);
    for s in &log.shows {
        let pad = " ".repeat(wide - s.meaning.chars().count());
        let _ = writeln!(out, "    {}{pad}  {:<8}  {}", s.meaning, s.shown, s.because);
        if !s.record.is_empty() {
            let _ = writeln!(
                out,
                "    {}  {:<8}  record {}",
                " ".repeat(wide),
                "",
                s.record
            );
        }
    }
    out
}

/// What to do next, and the command to type then.
fn next(log: &LogCheck, axis: Option<&Path>) -> (Vec<String>, String) {
    let path = quoted(&log.input.path);
    let mut out = Vec::new();
    let with = axis.map_or(String::new(), |file| {
        format!(" --axis {}", quoted_path(file))
    });
    // A file that is there is kept, and would be refused.
    let file = || axis.map_or_else(|| new_axis_file(Path::new(&log.input.path)), quoted_path);
    let init = || {
        let new = new_axis_file(Path::new(&log.input.path));
        format!("stiction check {path}{with} --init {new}")
    };
    if !log.input.assumed.is_empty() {
        out.push(
            "optional: an axis file with the units that were assumed, to correct them:".into(),
        );
        out.push(format!("  {}", init()));
    }
    let identify = |how: &str| format!("stiction identify {path}{how} --out result");
    let command = match &log.next {
        Action::Listed => {
            out.push("with all logs that are listed and fitted:".into());
            format!("stiction identify{with} --out result")
        }
        Action::Remove { table, line } => {
            out.push(format!(
                "leave {line} out of {table} of a log that is to be fitted, in {}, then",
                file()
            ));
            format!("stiction identify{with} --out result")
        }
        Action::Line {
            table,
            line,
            replaces,
        } => {
            let line = Line {
                file: file(),
                table: table.clone(),
                text: line.clone(),
                replaces: *replaces,
                begins: axis.is_none(),
            };
            out.extend(line.place().lines().map(str::to_string));
            out.push(format!("    {}", line.text));
            identify(&format!(" --axis {}", line.file))
        }
        Action::AxisFile if axis.is_none() => {
            out.push("write an axis file, and correct what is said above in it:".into());
            init()
        }
        Action::AxisFile => {
            out.push(format!("correct {} as said above, then", file()));
            identify(&with)
        }
        Action::Simulate => {
            out.push(format!(
                "if that fails too, record a new log, with reversals at several speeds, as {ANOTHER_LOG}, then"
            ));
            out.push(format!(
                "  stiction identify {ANOTHER_LOG}{with} --out another"
            ));
            identify(&format!("{with} --method output-error"))
        }
        Action::Record => {
            out.push(format!(
                "record another log as {ANOTHER_LOG}, slow and fast and both ways, with its force below its limit (what to record: \
                 docs/procedures.md), then"
            ));
            format!("stiction check {ANOTHER_LOG}{with}")
        }
        _ => identify(&with),
    };
    (out, command)
}
