//! A batch as a terminal shows it.

use super::table::table;
use crate::apart::{apart, look};
use crate::more_logs::more_logs;
use std::fmt::Write;
use std::path::Path;
use stiction_codes::Code;
use stiction_files::batch::{BatchFile, Failure, RESULTS};
use stiction_files::shell::{quoted_path, shown};
use stiction_number::counted;
use stiction_workflows::drift::least_logs;

/// What is wrong where an axis file does not say which columns a log has.
const COLUMNS: [Code; 3] = [Code::LogAmbiguous, Code::LogMissing, Code::LogUnit];
/// Name of the list of logs that is proposed.
const LIST: &str = "logs.csv";

/// A cell of a list.
fn cell(text: &str) -> String {
    match text.contains([',', ';', '"', '\t']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into(),
    }
}

/// A name that no file has: this one, else with a number.
fn free_file(name: &str) -> String {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
    let numbered = (2..1000).map(|number| format!("{stem}-{number}.{ending}"));
    let mut names = std::iter::once(name.to_string()).chain(numbered);
    let is_free = |name: &String| Path::new(name).symlink_metadata().is_err();
    names.find(is_free).unwrap_or_else(|| name.into())
}

/// What became of the logs, and what to do next.
pub fn batch(file: &BatchFile, dir: &Path) -> String {
    let mut out = String::new();
    let failed: usize = file.failed.iter().map(|failure| failure.logs).sum();
    let taken = match file.taken {
        0 => String::new(),
        taken => format!(", {taken} of them taken from an earlier call"),
    };
    let copies = match file.copies {
        0 => String::new(),
        1 => ", 1 of them a copy of another".into(),
        copies => format!(", {copies} of them copies of others"),
    };
    let _ = writeln!(out, "{}{taken}{copies}", counted(file.logs, "log"));
    let doubted = file.identified - file.trustworthy;
    let named = |logs: usize, first: &str| match logs > 1 {
        true => format!("first: {first}"),
        false => first.to_string(),
    };
    let left = file.logs - file.identified - failed;
    let mut rows = vec![
        vec![
            "trustworthy".into(),
            file.trustworthy.to_string(),
            String::new(),
        ],
        vec![
            "not trustworthy".into(),
            doubted.to_string(),
            file.doubted
                .as_ref()
                .map_or(String::new(), |log| named(doubted, &shown(&log.path))),
        ],
        vec!["failed".into(), failed.to_string(), String::new()],
    ];
    if left > 0 {
        rows.push(vec!["not done".into(), left.to_string(), String::new()]);
    }
    for failure in &file.failed {
        let first = failure.first.lines().next().unwrap_or_default();
        rows.push(vec![
            format!("  {}", failure.code),
            failure.logs.to_string(),
            named(failure.logs, first),
        ]);
    }
    out.push_str(&table(&rows, &[false, true, false]));
    out.push_str(&apart(&file.apart));
    if file.status == "complete" {
        let _ = writeln!(out, "\nwritten to {}: {RESULTS}, batch.json", dir.display());
    }
    let table = quoted_path(&dir.join(RESULTS));
    if let Some(failure) = file.failed.first() {
        let _ = writeln!(
            out,
            "what is wrong with the first log that failed:\nnext: stiction check {}",
            failure.log.arguments()
        );
    }
    let of_columns = |failure: &&Failure| COLUMNS.contains(&failure.code);
    if let Some(failure) = file.failed.iter().find(of_columns)
        && file.logs > 1
        && !failure.log.path.contains(char::is_control)
    {
        let list = free_file(LIST);
        let _ = writeln!(
            out,
            "where logs need axis files of their own: write them into {list}, a line for each such log\n  path,axis\n  {},AXIS.toml\nnext: {}",
            cell(&failure.log.path),
            file.command_with(dir, Some(&list))
        );
    }
    if let Some(log) = &file.doubted {
        let which = if doubted > 1 {
            "the first log"
        } else {
            "the log"
        };
        let _ = writeln!(
            out,
            "why {which} that was identified is not trusted:\nnext: {}",
            file.single(log)
        );
    }
    if let Some(next) = look(&file.apart) {
        out.push_str(&next);
    } else if file.status == "complete" && file.identified > 0 && file.identified < least_logs() {
        out.push_str(&more_logs(file, dir));
    } else if file.status == "complete" && file.identified > 0 {
        let _ = writeln!(
            out,
            "what changed over time, and on which machine:\nnext: stiction drift {table}"
        );
    }
    out
}
