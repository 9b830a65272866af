//! What searches found by themselves, and how far that is from what least squares made of it, for a terminal.

use super::table::table;
use std::fmt::Write;
use stiction_files::result::{ResultFile, SearchedEntry, SearchedPoint};
use stiction_number::{Percent, four_digits as short};

/// A table for each search that was made.
pub(super) fn sections(result: &ResultFile) -> String {
    let searches = result.searches();
    searches.map(|entry| section(entry, result)).collect()
}

fn section(entry: &SearchedEntry, result: &ResultFile) -> String {
    let of = match entry.cost.as_str() {
        "curve" => "the steady curve",
        "dynamic" => "sigma0 and sigma1, the steady curve held",
        "six" => "six parameters at once",
        _ => "the nonlinear unknowns",
    };
    let mut out = format!(
        "\n{} over {of}, ended: {}, after {:.0} evaluations of all samples\n",
        entry.method, entry.status, entry.evaluations.full_records
    );
    let points = [&entry.own, &entry.after_least_squares];
    let error = |point: &Option<SearchedPoint>| match point {
        Some(point) => Percent::error(100.0 * point.cost.sqrt()).fine(),
        None => "-".into(),
    };
    let head = [
        "",
        "by itself",
        "after its descents",
        "in the end",
        "off by itself",
    ];
    let [own, descended] = points.map(error);
    // Results do not give the cost of the last least squares of a step.
    let last = match entry.cost.as_str() {
        "curve" | "dynamic" => String::new(),
        _ => Percent::error(result.fit.relative_error_percent).fine(),
    };
    let mut rows = vec![
        head.map(String::from).to_vec(),
        vec!["relative error".into(), own, descended, last, String::new()],
    ];
    for p in &result.parameters {
        let value = |point: &Option<SearchedPoint>| {
            let mut all = point.iter().flat_map(|point| &point.parameters);
            all.find(|x| x.name == p.name).map(|x| x.value)
        };
        let [own, descended] = points.map(value);
        let held = entry.cost == "dynamic" && !entry.unknowns.contains(&p.name);
        if held || (own.is_none() && descended.is_none()) {
            continue;
        }
        let shown = |x: Option<f64>| x.map_or("-".into(), short);
        // Relative to the end: a search that did not see a parameter may leave it next to 0. At an end of its range the value
        // is that of the range, not of the log.
        let off = own.map(|x| match p.value == 0.0 || entry.is_at_an_end(&p.name, x) {
            true => "not comparable".into(),
            false => format!("{:+.2} %", 100.0 * (x / p.value - 1.0)),
        });
        rows.push(vec![
            p.name.clone(),
            shown(own),
            shown(descended),
            short(p.value),
            off.unwrap_or_else(|| "-".into()),
        ]);
    }
    let _ = write!(out, "{}", table(&rows, &[false, true, true, true, true]));
    out
}
