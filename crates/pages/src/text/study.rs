//! A study on the terminal.

use super::table::table;
use crate::next::ANOTHER_LOG;
use crate::report::study::exported::exported_rows;
use crate::report::study::promise::{best, lacking, left, said};
use crate::report::study::rates::columns;
use crate::report::study::rows::{judged, kind, less, tabled};
use crate::report::study::sweep::{groups, label, lines};
use std::fmt::Write;
use std::path::Path;
use stiction_files::shell::quoted_path;
use stiction_files::study::result::{PromiseEntry, ResultRow, StudyFile};
use stiction_files::study::{Started, Study, results};
use stiction_number::{Percent, bytes, counted, quantity, short};
use stiction_workflows::study::{StudyOutcome, memory};

/// Rows of a study up to which all are shown; of more, the best of each path and controller.
const MOST_ROWS: usize = 40;
/// The same of the promises.
const MOST_PROMISES: usize = 12;

/// What a study file was begun with, and what to type next.
pub fn started_study(started: &Started, file: &Path) -> String {
    let mut out = format!("{} written\n", file.display());
    if let Some(reason) = &started.undecided {
        let _ = writeln!(out, "to decide: {reason}\nfill in what is to decide, then");
    }
    let _ = writeln!(
        out,
        "next: stiction simulate {} --out {}",
        quoted_path(file),
        quoted_path(&results(file))
    );
    out
}

/// Samples up to which nothing is said before: a study of some seconds.
const SHORT: u64 = 10_000_000;

/// How large a study is, before it runs; `None` of a short one.
pub fn announced(study: &Study) -> Option<String> {
    let size = study.size();
    let text = format!(
        "{} of {} samples at most, {} samples in all, in some {} of memory",
        counted(size.runs, "run"),
        short(size.longest as f64),
        short(size.samples as f64),
        bytes(memory(study))
    );
    (size.samples > SHORT).then_some(text)
}

/// The outcome of a study.
pub fn study(outcome: &StudyOutcome) -> String {
    let file = &outcome.file;
    let mut out = format!("{}: {}\n", file.name, file.axis.origin);
    if let Some(second) = &file.second_axis {
        let _ = writeln!(out, "second axis: {}", second.origin);
    }
    out.push_str(&promised(file));
    let same = |a: &ResultRow, b: &ResultRow| (&a.path, &a.controller) == (&b.path, &b.controller);
    let results = tabled(&file.results);
    if results.len() > MOST_ROWS {
        let best = results.chunk_by(same).flat_map(bare_and_best);
        let lines =
            best.map(|row| [vec![row.path.clone(), row.controller.clone()], line(row)].concat());
        let header = ["path", "controller"].iter().chain(&HEADER);
        out.push('\n');
        out.push_str(&rows_table(header, lines, 2));
        let _ = writeln!(
            out,
            "\nwithout compensation and with the best of each path and controller; all {} rows: report.html, study.json",
            results.len()
        );
    } else {
        for rows in results.chunk_by(same) {
            let _ = writeln!(out, "\n{}, {}", rows[0].path, rows[0].controller);
            out.push_str(&rows_table(HEADER.iter(), rows.iter().map(line), 0));
            out.push_str(&speeds(rows));
        }
    }
    for sweep in &file.sweeps {
        for rows in groups(sweep) {
            let _ = writeln!(
                out,
                "\n{}, {}: largest error over {}",
                rows[0].path,
                rows[0].controller,
                label(file, sweep)
            );
            let lines = lines(sweep, rows);
            out.push_str(&table(&lines, &vec![true; lines[0].len()]));
        }
    }
    out.push_str(&exported(file));
    if !file.results.is_empty() {
        let several = results.iter().any(|row| row.runs > 1);
        let worst = |line: &&str| several || !line.starts_with("worst:");
        for line in LEGEND.lines().filter(worst) {
            let _ = writeln!(out, "{line}");
        }
    }
    for warning in &file.warnings {
        let _ = writeln!(out, "\nwarning [{}] {}", warning.code, warning.message);
    }
    if file.status == "interrupted" {
        out.push_str("\nSTOPPED EARLY: what was done is kept\n");
    }
    out
}

/// The columns of a row.
const HEADER: [&str; 8] = [
    "compensator",
    "parameters",
    "rms",
    "largest",
    "at reversals",
    "less",
    "worst",
    "",
];

/// A table of rows, with `names` more columns of text before the compensator.
fn rows_table<'a>(
    header: impl Iterator<Item = &'a &'a str>,
    lines: impl Iterator<Item = Vec<String>>,
    names: usize,
) -> String {
    let mut all = vec![header.map(|s| s.to_string()).collect::<Vec<_>>()];
    all.extend(lines);
    let last = all[0].len() - 1;
    let right: Vec<bool> = (0..=last).map(|c| c >= names + 2 && c < last).collect();
    let (lines, right) = filled(&all, &right);
    table(&lines, &right)
}

/// Of the rows of a path under a controller those of the axis as modelled without compensation and with the smallest error.
fn bare_and_best(rows: &[ResultRow]) -> impl Iterator<Item = &ResultRow> {
    let exact = || rows.iter().filter(|row| row.parameters == "exact");
    let bare = exact().find(|row| row.compensator == "none" && !row.coupled);
    let left = |row: &&ResultRow| judged(row).map_or(f64::INFINITY, |m| m.mean);
    let best = exact().min_by(|a, b| left(a).total_cmp(&left(b)));
    let best = best.filter(|best| bare.is_none_or(|bare| !std::ptr::eq(*best, bare)));
    bare.into_iter().chain(best)
}

/// Exported C beside the compensator of the model.
fn exported(file: &StudyFile) -> String {
    let Some(exported) = &file.exported_c else {
        return String::new();
    };
    let mut out = format!(
        "\nexported C in {}, compiled and run, beside the same compensator in Rust: largest error\n",
        exported.folder
    );
    let lines = exported_rows(exported);
    let right: Vec<bool> = (0..lines[0].len()).map(|c| c >= 2).collect();
    out.push_str(&table(&lines, &right));
    out
}

/// What compensation is promised to leave, before everything else.
fn promised(file: &StudyFile) -> String {
    if let Some(reason) = &file.not_promised {
        return format!(
            "\n{}\nwith that log recorded as {ANOTHER_LOG}:\nnext: stiction identify {ANOTHER_LOG} --out another\n",
            lacking(reason)
        );
    }
    let Some(draws) = file.promise.first().map(|entry| entry.draws) else {
        return String::new();
    };
    let mut out = String::from("\n");
    let best = best(file);
    for entry in best.iter().take(MOST_PROMISES) {
        let _ = writeln!(
            out,
            "{} with {}: {}, {}",
            said(entry),
            entry.scheme(),
            entry.path,
            entry.controller
        );
    }
    let _ = writeln!(
        out,
        "90 % interval of {draws} draws of what the identification leaves open, each compared with itself without \
         compensation, under the controller of the study; that of the machine may leave another part"
    );
    if let Some(line) = whole(&best) {
        let _ = writeln!(out, "{line}");
    }
    out.push('\n');
    let mut lines = vec![
        ["path", "controller", "compensator", "left"]
            .map(String::from)
            .to_vec(),
    ];
    let many = file.promise.len() > MOST_PROMISES;
    let shown = match many {
        true => best,
        false => file.promise.iter().collect(),
    };
    lines.extend(shown.iter().map(|entry| {
        vec![
            entry.path.clone(),
            entry.controller.clone(),
            entry.scheme(),
            left(entry.left90_percent),
        ]
    }));
    out += &table(&lines, &[false, false, false, true]);
    if many {
        let all = file.promise.len();
        let _ = writeln!(
            out,
            "\nthe best of each path and controller; all {all} intervals: report.html"
        );
    }
    out
}

/// Points, percent, by which what is left may go beyond what the gain leaves, where the whole force is the next step.
const KNOWN_WITHIN: f64 = 5.0;

/// What a gain below 1 leaves whatever is known, where little more is left, and the next step.
fn whole(best: &[&PromiseEntry]) -> Option<String> {
    let entry = best.iter().find(|entry| {
        let kept = entry.gain.map(|gain| 100.0 * (1.0 - gain));
        kept.is_some_and(|kept| kept > 0.0 && entry.left90_percent[1] <= kept + KNOWN_WITHIN)
    })?;
    let gain = entry.gain?;
    Some(format!(
        "of what is left, {} is the gain of {gain}: gain = 1 under [[compensator]] in the study shows what the whole force leaves, and \
         stiction export --gain 1 lets it out (or --adapt, where friction changes)",
        Percent::error(100.0 * (1.0 - gain)).short()
    ))
}

/// What is said of speed and standing still; nothing where the motion shows nothing of them.
fn speeds(rows: &[ResultRow]) -> String {
    let (headers, cells) = columns(rows);
    if headers.is_empty() {
        return String::new();
    }
    let names = ["compensator", "parameters"];
    let header = names.iter().chain(&headers).map(|s| s.to_string());
    let mut lines = vec![header.collect::<Vec<_>>()];
    lines.extend(rows.iter().zip(cells).map(|(row, cells)| {
        let names = [row.scheme(), kind(row)];
        names.into_iter().chain(cells).collect()
    }));
    let right: Vec<bool> = (0..lines[0].len()).map(|c| c >= names.len()).collect();
    format!("\n{}", table(&lines, &right))
}

/// What the columns are.
const LEGEND: &str = "
rms, largest, at reversals: tracking error (on a contour: the distance to it), mean over the runs of a row
less: by how much the largest error is below that without compensation, on the same path and controller
worst: the same with the largest error of all runs of a row; negative where compensation makes it larger
feed error: largest difference of the velocity along the motion from that of the reference; of the feed: in parts of the fastest
jumps: over ten times the velocity of the reference
ripple, at rest: at constant velocity, its rms deviation and the share of the time below a tenth of it
standing error, hunting, period: mean error, half width and length of a limit cycle while the reference stands still
mass found, friction found: at the end of the run, of a load estimate or an adaptation; friction as a factor on that of the law
";

/// The columns of a table in which a row below the header has something.
fn filled(lines: &[Vec<String>], right: &[bool]) -> (Vec<Vec<String>>, Vec<bool>) {
    let full = |c: &usize| lines[1..].iter().any(|line| !line[*c].is_empty());
    let kept: Vec<usize> = (0..right.len()).filter(full).collect();
    let of = |line: &Vec<String>| kept.iter().map(|&c| line[c].clone()).collect();
    (
        lines.iter().map(of).collect(),
        kept.iter().map(|&c| right[c]).collect(),
    )
}

fn line(row: &ResultRow) -> Vec<String> {
    let contour = row.metric("contour_peak").is_some();
    let value = |name: &str| {
        // Without reversals there is no error about one.
        let metric = row.metric(name).filter(|m| m.largest > 0.0);
        metric.map_or("n/a".into(), |m| quantity(m.mean, &m.unit))
    };
    let judged = judged(row).filter(|_| row.compensator != "none" || row.coupled);
    let percent = |x: Option<f64>| x.map_or(String::new(), less);
    vec![
        row.scheme(),
        kind(row),
        value(if contour { "contour_rms" } else { "rms_error" }),
        value(if contour {
            "contour_peak"
        } else {
            "peak_error"
        }),
        if contour {
            String::new()
        } else {
            value("reversal_peak")
        },
        percent(judged.and_then(|m| m.reduction_percent)),
        percent(
            judged
                .and_then(|m| m.worst_reduction_percent)
                .filter(|_| row.runs > 1),
        ),
        row.remarks(),
    ]
}
