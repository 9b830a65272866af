//! Friction over time as a terminal shows it.

use super::table::table;
use crate::apart::{apart, look};
use crate::drift::{few, noise_of, quiet, row, unclear, unnamed, untimed};
use crate::more_logs::more_logs;
use std::fmt::Write;
use std::path::Path;
use stiction_files::drift_file::DriftFile;
use stiction_files::shell::{quoted, quoted_path, shown};
use stiction_number::counted;
use stiction_workflows::batch::batch_of;
use stiction_workflows::drift::least_logs;

/// Most alarms that are listed.
const MOST: usize = 40;

/// The alarms, what each parameter does by itself, and what to do next. `out` is the folder of the report, where there is one.
pub fn drift(file: &DriftFile, out: Option<&Path>) -> String {
    let mut text = String::new();
    let failed = match file.input.failed {
        0 => String::new(),
        failed => format!(", of which {failed} failed"),
    };
    let _ = writeln!(
        text,
        "{}: {}{failed}, {}",
        shown(&file.input.path),
        counted(file.input.logs, "log"),
        counted(file.machines, "machine")
    );
    if let Some(said) = untimed(file) {
        let _ = writeln!(text, "{said}");
    }
    if file.input.unnamed > 0 {
        let _ = writeln!(text, "{}", unnamed(file));
    }
    if file.too_short > 0 {
        let _ = writeln!(
            text,
            "{} of them {} fewer than {} logs of any parameter: nothing can be said yet",
            file.too_short,
            if file.too_short == 1 { "has" } else { "have" },
            least_logs()
        );
    }
    let mut rows = vec![
        [
            "parameter",
            "law",
            "unit",
            "logs",
            "scatter",
            "wandering",
            "changed from",
        ]
        .map(String::from)
        .to_vec(),
    ];
    rows.extend(file.noise.iter().map(|n| {
        let [scatter, wandering, limit] = noise_of(n);
        vec![
            n.parameter.clone(),
            n.law.clone(),
            n.unit.clone(),
            n.logs.to_string(),
            scatter,
            wandering,
            limit,
        ]
    }));
    if !file.noise.is_empty() {
        text.push('\n');
        text.push_str(&table(
            &rows,
            &[false, false, false, true, true, true, true],
        ));
    }
    text.push('\n');
    match file.alarms.first() {
        None => {
            let _ = writeln!(text, "{}", quiet(file));
            if let Some(said) = few(file) {
                let _ = writeln!(text, "{said}");
            }
        }
        Some(_) => {
            let machines = file.alarmed_machines();
            let _ = writeln!(
                text,
                "{} of {} changed",
                machines,
                counted(file.machines, "machine")
            );
            text.push_str(&alarms(file));
        }
    }
    if let Some(said) = unclear(file) {
        let _ = writeln!(text, "{said}");
    }
    text.push_str(&apart(&file.apart));
    if let Some(next) = look(&file.apart) {
        text.push_str(&next);
    } else if let Some(alarm) = file.alarms.first() {
        let axis = alarm
            .axis
            .as_ref()
            .map_or(String::new(), |axis| format!(" --axis {}", quoted(axis)));
        let _ = writeln!(
            text,
            "what the log shows with which the largest change was found:\nnext: stiction check {}{axis}",
            quoted(&alarm.log)
        );
    } else if file.noise.is_empty() {
        let dir = Path::new(&file.input.path)
            .parent()
            .unwrap_or(Path::new(""));
        let _ = match batch_of(dir) {
            Some(batch) => write!(text, "{}", more_logs(&batch, dir)),
            None => writeln!(
                text,
                "a table with at least {} logs of one machine, here of a folder logs (docs/fleet.md):\nnext: stiction batch logs \
                 --law lugre --out batch",
                least_logs()
            ),
        };
    } else if out.is_none() {
        let folder = Path::new(&file.input.path).with_file_name("drift");
        let times = file.times.first();
        let _ = writeln!(
            text,
            "the same with a report:\nnext: stiction drift {}{} --out {}",
            quoted(&file.input.path),
            times.map_or(String::new(), |times| format!(" --times {times}")),
            quoted_path(&folder)
        );
    }
    text
}

fn alarms(file: &DriftFile) -> String {
    let head = [
        "machine",
        "parameter",
        "what",
        "since",
        "found",
        "before",
        "after",
        "change",
        "95 % interval",
    ];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(
        file.alarms
            .iter()
            .take(MOST)
            .map(|alarm| row(file, alarm).to_vec()),
    );
    let mut out = table(
        &rows,
        &[false, false, false, false, false, true, true, true, true],
    );
    if file.alarms.len() > MOST {
        let _ = writeln!(out, "and {} more", file.alarms.len() - MOST);
    }
    out
}
