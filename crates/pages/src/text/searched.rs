//! What searches found by themselves, and what least squares added, for a terminal.

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
        "least squares added",
    ];
    let [own, descended] = points.map(error);
    // The least squares after a step do not minimise its cost.
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
        let added = own
            .filter(|x| *x != 0.0)
            .map(|x| 100.0 * (p.value / x - 1.0));
        rows.push(vec![
            p.name.clone(),
            shown(own),
            shown(descended),
            short(p.value),
            added.map_or("-".into(), |x| format!("{x:+.2} %")),
        ]);
    }
    let _ = write!(out, "{}", table(&rows, &[false, true, true, true, true]));
    out
}
