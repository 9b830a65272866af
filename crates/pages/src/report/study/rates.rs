//! What the rows of a study say of the feed rate, of motion at constant velocity, of standing still and of the load that is
//! found: the columns that mean something on a path.

use super::rows::believed;
use stiction_files::study::result::{MetricEntry, ResultRow};
use stiction_number::{Percent, quantity};
use stiction_report::{Align, Table, Text, number};

/// Metrics and the words for them, in the order of the columns.
const COLUMNS: [(&str, &str); 9] = [
    ("feed_error_peak", "feed error"),
    ("feed_error_share", "of the feed"),
    ("velocity_ripple", "ripple"),
    ("rest_share", "at rest"),
    ("standing_error", "standing error"),
    ("hunting_amplitude", "hunting"),
    ("hunting_period", "period"),
    ("found_mass", "mass found"),
    ("found_friction", "friction found"),
];

/// Headers and, for each row, the values in words; no columns where the motion has none of them.
pub(crate) fn columns(rows: &[ResultRow]) -> (Vec<&'static str>, Vec<Vec<String>>) {
    let shown = |name: &str| rows.iter().any(|r| r.metric(name).is_some());
    let columns: Vec<_> = COLUMNS.iter().filter(|(name, _)| shown(name)).collect();
    let cells = |row: &ResultRow| {
        let values = columns.iter().map(|(name, _)| row.metric(name));
        let known = |m: &&MetricEntry| !(m.name.starts_with("found") && learnt_nothing(row));
        let values = values.map(|m| m.filter(known));
        values.map(|m| m.map_or("n/a".into(), value)).collect()
    };
    (
        columns.iter().map(|(_, words)| *words).collect(),
        rows.iter().map(cells).collect(),
    )
}

/// Whether the load that a row found is the one it began with.
fn learnt_nothing(row: &ResultRow) -> bool {
    row.metric("learning_time")
        .is_some_and(|m| m.largest == 0.0)
}

/// The mean in the unit of the field: feed rates by the minute, shares in percent.
fn value(metric: &MetricEntry) -> String {
    let mean = metric.mean;
    match metric.unit.as_str() {
        "m/s" => format!("{} mm/min", number::sig(60e3 * mean, 3)),
        "rad/s" => format!("{} °/min", number::sig(60.0 * mean.to_degrees(), 3)),
        "1" if metric.name == "found_friction" => format!("× {}", number::sig(mean, 3)),
        "1" => share(100.0 * mean),
        _ if metric.name == "hunting_amplitude" && mean == 0.0 => "none".into(),
        unit => quantity(mean, unit),
    }
}

/// Least share of a speed or of a time that is stated, %: the simulation resolves no less.
const LEAST_PERCENT: f64 = 0.01;

/// A share in percent. Velocities that err by more than ten times the feed are those of an axis that jumps, and no share of
/// it.
fn share(percent: f64) -> String {
    let shown = Percent::error(percent);
    if percent > 0.0 && percent < LEAST_PERCENT {
        format!("< {LEAST_PERCENT} %")
    } else if shown.is_bounded() {
        shown.digits(3)
    } else {
        "jumps".into()
    }
}

/// The same as a table of the report.
pub(super) fn table(rows: &[ResultRow]) -> Option<Table> {
    let (headers, cells) = columns(rows);
    if headers.is_empty() {
        return None;
    }
    let capital = |words: &str| words[..1].to_uppercase() + &words[1..];
    let mut columns = vec![
        ("Compensator".to_string(), Align::Left),
        ("Parameters".to_string(), Align::Left),
    ];
    columns.extend(headers.iter().map(|words| (capital(words), Align::Right)));
    let columns = columns.iter().map(|(text, align)| (text.as_str(), *align));
    let table = Table::new(columns)
        .caption("Speed, standing still and the load found, means over the runs of a row.");
    Some(rows.iter().zip(cells).fold(table, |table, (row, cells)| {
        let names = [row.scheme(), believed(row)];
        table.row(names.into_iter().chain(cells).map(Text::from))
    }))
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn shares_that_a_reader_can_use() {
        assert_eq!(share(0.0), "0 %");
        assert_eq!(share(1.3e-6), "< 0.01 %");
        assert_eq!(share(0.0123), "0.0123 %");
        assert_eq!(share(105.0), "105 %");
        assert_eq!(share(3e6), "jumps");
    }
}
