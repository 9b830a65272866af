//! Time stamps have a unit of their own, which says nothing of the other columns.

use stiction_formats::{ReadOptions, Table, read_table};
use stiction_log::{Log, Mapping};

/// A motion of a second as text, JSON with dates, and JSON with seconds and nanoseconds as ROS has them; `unit` stands behind the
/// position.
fn written(unit: &str) -> Vec<(&'static str, String)> {
    let row = |k: u32| {
        let t = 1e-3 * f64::from(k);
        let (x, f) = (0.1 * (9.0 * t).sin(), 5.0 * (9.0 * t).cos());
        (k, x, f)
    };
    let rows: Vec<(u32, f64, f64)> = (0..1000).map(row).collect();
    let of = |line: &dyn Fn(&(u32, f64, f64)) -> String| -> Vec<String> {
        rows.iter().map(line).collect()
    };
    let date = |k: u32| format!("2026-03-01T06:30:00.{k:03}");
    let name = format!("position{unit}");
    let text = of(&|(k, x, f)| format!("{};{x};{f}\n", date(*k))).concat();
    let dates =
        of(&|(k, x, f)| format!(r#"{{"time": "{}", "{name}": {x}, "force": {f}}}"#, date(*k)));
    let pairs = of(&|(k, x, f)| {
        let nanoseconds = 1_000_000 * k;
        format!(
            r#"{{"stamp": {{"sec": 1772346600, "nanosec": {nanoseconds}}}, "{name}": {x}, "force": {f}}}"#
        )
    });
    vec![
        ("log.csv", format!("time;{name};force\n{text}")),
        ("dates.json", format!("[{}]", dates.join(","))),
        ("pairs.json", format!("[{}]", pairs.join(","))),
    ]
}

fn tables(unit: &str) -> Vec<(&'static str, Table)> {
    let folder = tempfile::tempdir().unwrap();
    let read = |(name, text): (&'static str, String)| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let table = read_table(&path, &ReadOptions::default());
        (name, table.unwrap_or_else(|e| panic!("{name}: {e}")))
    };
    written(unit).into_iter().map(read).collect()
}

#[test]
fn stamps_leave_the_other_units_to_be_assumed_and_said() {
    for (name, table) in tables("") {
        let log = Log::from_table(&table, &Mapping::default());
        let log = log.unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(log.position.unwrap(), table.columns[1].values, "{name}");
        let says = |finding: &stiction_log::Finding| finding.code().as_str() == "unit-assumed";
        assert!(log.findings.iter().any(says), "{name}");
    }
}

#[test]
fn a_unit_that_somebody_wrote_does_not() {
    for (name, table) in tables(" [mm]") {
        let refused = Log::from_table(&table, &Mapping::default()).unwrap_err();
        let said = refused.to_string();
        assert!(
            said.contains("force has no unit while other columns have one"),
            "{name}: {said}"
        );
    }
}
