//! Time stamps that a file has as two columns, seconds and the nanoseconds beyond them, as messages of ROS are written to
//! text, JSON and tables: `header.stamp.sec` and `header.stamp.nanosec`.

use std::collections::BTreeMap;

use crate::{Column, Table};

/// How the two are called at the end of their names.
const PAIRS: [(&str, &str); 4] = [
    ("sec", "nanosec"),
    ("secs", "nsecs"),
    ("sec", "nsec"),
    ("seconds", "nanoseconds"),
];
/// Nanoseconds of a second.
const SECOND: i128 = 1_000_000_000;

/// Whether a column may be one of the two, by the end of its name.
#[cfg(feature = "mdf")]
pub(crate) fn is_part(name: &str) -> bool {
    PAIRS
        .iter()
        .any(|(whole, part)| name.ends_with(whole) || name.ends_with(part))
}

/// Makes one column of each such pair, in seconds from its first stamp. It has the number of the seconds and the name that the
/// two share.
pub(crate) fn join(table: &mut Table) {
    while let Some((seconds, nanoseconds, name)) = pair(table) {
        let (whole, part) = (&table.columns[seconds], &table.columns[nanoseconds]);
        let Some(values) = values(whole, part) else {
            return;
        };
        table.detected.push(format!(
            "time stamps {name} of {} and {}, converted to seconds from the first",
            whole.name, part.name
        ));
        let gone = table.number(nanoseconds);
        table.columns[seconds] = Column {
            name,
            unit: Some("s".to_string()),
            stamps: true,
            values,
        };
        table.columns.remove(nanoseconds);
        table.passed = moved(std::mem::take(&mut table.passed), nanoseconds);
        table.other_names = moved(std::mem::take(&mut table.other_names), nanoseconds);
        let at = table.left_out.partition_point(|number| *number < gone);
        table.left_out.insert(at, gone);
    }
}

/// What is known of columns by their places, after one of them went.
fn moved<T>(known: BTreeMap<usize, T>, gone: usize) -> BTreeMap<usize, T> {
    let kept = known.into_iter().filter(|(at, _)| *at != gone);
    kept.map(|(at, it)| (at - usize::from(at > gone), it))
        .collect()
}

/// Two columns that are one time stamp, by their names and numbers, and the name that they share.
fn pair(table: &Table) -> Option<(usize, usize, String)> {
    let mut columns = table.columns.iter().enumerate();
    columns.find_map(|(at, column)| {
        PAIRS.iter().find_map(|(whole, part)| {
            let name = column.name.strip_suffix(whole)?;
            let group = name.strip_suffix(['.', '_', '/'])?;
            let other = format!("{name}{part}");
            let mut others = (0..table.columns.len()).filter(|c| table.columns[*c].name == other);
            let (other, None) = (others.next()?, others.next()) else {
                return None;
            };
            let clear = !group.is_empty() && table.columns.iter().all(|c| c.name != group);
            let whole = values(column, &table.columns[other]).is_some();
            (clear && whole).then(|| (at, other, group.to_string()))
        })
    })
}

/// Seconds from the first stamp; `None` where the two are no seconds and nanoseconds.
fn values(whole: &Column, part: &Column) -> Option<Vec<f64>> {
    if whole.unit.is_some() || part.unit.is_some() || whole.values.len() != part.values.len() {
        return None;
    }
    let whole_number = |x: f64| x.fract() == 0.0 && x.abs() < 9e15;
    let mut first = None;
    let one = |(seconds, nanoseconds): (&f64, &f64)| {
        if seconds.is_nan() || nanoseconds.is_nan() {
            return Some(f64::NAN);
        }
        let fits = whole_number(*seconds)
            && whole_number(*nanoseconds)
            && (0.0..SECOND as f64).contains(nanoseconds);
        let stamp = fits.then_some(*seconds as i128 * SECOND + *nanoseconds as i128)?;
        Some((stamp - *first.get_or_insert(stamp)) as f64 / SECOND as f64)
    };
    let values: Option<Vec<f64>> = whole.values.iter().zip(&part.values).map(one).collect();
    values.filter(|_| first.is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(columns: &[(&str, &[f64])]) -> Table {
        let column = |(name, values): &(&str, &[f64])| Column::headed(name, values.to_vec());
        Table {
            columns: columns.iter().map(column).collect(),
            ..Table::default()
        }
    }

    #[test]
    fn seconds_and_nanoseconds_are_one_stamp() {
        let mut table = table(&[
            ("yaw", &[1.0, 2.0, 3.0]),
            ("header.stamp.nanosec", &[999_999_999.0, 1.0, f64::NAN]),
            ("header.stamp.sec", &[1.7e9, 1.7e9 + 1.0, 1.7e9 + 1.0]),
            ("effort", &[4.0, 5.0, 6.0]),
        ]);
        join(&mut table);
        let names: Vec<&str> = table.columns.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["yaw", "header.stamp", "effort"]);
        assert_eq!(table.columns[1].values[..2], [0.0, 2e-9]);
        assert!(table.columns[1].values[2].is_nan());
        // Columns keep the numbers that they have in the file.
        assert_eq!([0, 1, 2].map(|at| table.number(at)), [1, 3, 4]);
    }

    #[test]
    fn what_is_no_stamp_is_left_alone() {
        for nanoseconds in [[0.5, 1.0], [1.0, 1e9], [-1.0, 0.0]] {
            let mut own = table(&[("a.sec", &[1.0, 2.0]), ("a.nanosec", &nanoseconds)]);
            join(&mut own);
            assert_eq!(own.columns.len(), 2, "{nanoseconds:?}");
        }
    }
}
