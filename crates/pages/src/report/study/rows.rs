//! Rows of a study as its tables and figures show them.

use stiction_files::study::result::{MetricEntry, ResultRow};
use stiction_number::Percent;
use stiction_report::Color;

pub(crate) const COLORS: [Color; 7] = [
    Color::Grey,
    Color::Sky,
    Color::Orange,
    Color::Green,
    Color::Purple,
    Color::Vermilion,
    Color::Blue,
];

/// The metric by which compensators are compared.
pub(crate) fn judged(row: &ResultRow) -> Option<&MetricEntry> {
    row.judged()
}

/// Whether a run tracks worse with compensation than without, by the least reduction of a row; a row without one says nothing.
pub(crate) fn is_worse(least_reduction_percent: Option<f64>) -> bool {
    least_reduction_percent.is_some_and(|percent| percent < 0.0)
}

/// The rows of the tables: what is promised stands in one of its own.
pub(crate) fn tabled(rows: &[ResultRow]) -> Vec<ResultRow> {
    let tabled = rows.iter().filter(|r| r.parameters != "promised");
    tabled.cloned().collect()
}

/// The kind of parameters.
pub(crate) fn kind(row: &ResultRow) -> String {
    match row.parameters.as_str() {
        "exact" => "axis as modelled".into(),
        other => other.into(),
    }
}

/// The kind of parameters, and what became of the compensation.
pub(crate) fn believed(row: &ResultRow) -> String {
    match row.remarks() {
        remarks if remarks.is_empty() => kind(row),
        remarks => format!("{}, {remarks}", kind(row)),
    }
}

/// A reduction, in percent, with one decimal: the simulated axis is not exact enough for more. A value below 100 % is
/// never rounded up to 100 %.
pub(crate) fn less(x: f64) -> String {
    match Percent::error(x).decimals(1) {
        all if all == "100.0 %" && x < 100.0 => "> 99.9 %".into(),
        text => text.replace('-', "−"),
    }
}

/// Rows that are drawn: those with exact parameters; if they are many, the first, which is without compensation, and
/// those with the smallest error.
pub(crate) fn drawn(rows: &[ResultRow]) -> (Vec<&ResultRow>, usize) {
    let exact: Vec<&ResultRow> = rows.iter().filter(|r| r.parameters == "exact").collect();
    let all = exact.len();
    let left = |r: &ResultRow| judged(r).map_or(f64::INFINITY, |m| m.mean);
    let mut order: Vec<usize> = (1..all).collect();
    order.sort_by(|a, b| left(exact[*a]).total_cmp(&left(exact[*b])));
    order.truncate(COLORS.len() - 1);
    order.sort_unstable();
    let chosen = std::iter::once(0).chain(order).filter_map(|i| exact.get(i));
    (chosen.copied().collect(), all)
}

/// What is said of curves that are left out.
pub(crate) fn left_out(drawn: usize, all: usize) -> String {
    match all > drawn {
        true => format!(" {drawn} of {all}: without compensation, and those that leave the least."),
        false => String::new(),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_row_that_is_compared_with_nothing_is_not_worse() {
        assert!(!super::is_worse(None));
        assert!(!super::is_worse(Some(0.0)));
        assert!(super::is_worse(Some(-0.1)));
    }

    #[test]
    fn what_is_nearly_all_is_not_all() {
        assert_eq!(super::less(99.97), "> 99.9 %");
        assert_eq!(super::less(99.94), "99.9 %");
        assert_eq!(super::less(100.0), "100.0 %");
        assert_eq!(super::less(-3.21), "−3.2 %");
    }
}
