//! Real recordings, which are never committed: found beside the workspace or by `STICTION_DATA`.

use super::detect;
use stiction_formats::Table;
use stiction_formats::text::{TextOptions, read_file};
use stiction_testkit::recordings;

fn table(path: &str) -> Option<Table> {
    let path = recordings()?.join(path);
    Some(read_file(&path, &TextOptions::default()).unwrap_or_else(|e| panic!("{e}")))
}

/// The same file read by splitting at blanks and commas and by the standard library's parser.
fn plainly(path: &str, skip: usize) -> Option<Vec<Vec<f64>>> {
    let text = std::fs::read_to_string(recordings()?.join(path)).unwrap();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for line in text.lines().skip(skip) {
        let cells = line.split([',', '\t']).filter(|c| !c.is_empty());
        for (c, cell) in cells.enumerate() {
            if columns.len() <= c {
                columns.push(Vec::new());
            }
            columns[c].push(cell.parse().unwrap());
        }
    }
    Some(columns)
}

#[track_caller]
fn same(path: &str, skip: usize) -> Option<Table> {
    let table = table(path)?;
    let plain = plainly(path, skip)?;
    assert_eq!(table.columns.len(), plain.len());
    for (column, plain) in table.columns.iter().zip(&plain) {
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&column.values), bits(plain));
    }
    Some(table)
}

#[test]
fn tribometer() {
    let Some(table) = same("tribometer/presliding.tsv", 1) else {
        return;
    };
    let titles: Vec<_> = table
        .columns
        .iter()
        .map(|c| (c.name.as_str(), c.unit.as_deref().unwrap_or("")))
        .collect();
    let expected = [
        ("Time", "s"),
        ("Normal", "uN"),
        ("Position", "mm"),
        ("Friction", "uN"),
    ];
    assert_eq!(titles, expected);
    assert_eq!(
        table.detected,
        [
            "separator TAB",
            "header in line 1",
            "decimal point",
            "units in the header"
        ]
    );
}

#[test]
fn robot_joints() {
    for file in ["ur10e/joint_1.csv", "ur10e/joint_4.csv"] {
        let Some(table) = same(file, 0) else { return };
        assert_eq!(table.columns.len(), 31);
        assert!(
            table
                .columns
                .iter()
                .all(|c| c.name.is_empty() && c.unit.is_none())
        );
        assert_eq!(
            table.detected,
            ["separator `,`", "no header", "decimal point"]
        );
    }
}

#[test]
fn servo_axis() {
    for (test, count, rows) in [
        ("sliding", 7, 12_000),
        ("presliding", 5, 8000),
        ("breakaway", 5, 3000),
    ] {
        for run in 1..=count {
            let Some(table) = same(&format!("servo/{test}_{run}.txt"), 0) else {
                return;
            };
            assert_eq!(table.columns.len(), 5);
            assert!(table.rows().abs_diff(rows) <= 1, "{} rows", table.rows());
        }
    }
}

#[test]
fn a_recording_in_another_dialect_is_the_same_recording() {
    let Some(folder) = recordings() else { return };
    let text = std::fs::read_to_string(folder.join("tribometer/presliding.tsv")).unwrap();
    let values = |t: Table| t.columns.into_iter().map(|c| c.values).collect::<Vec<_>>();
    let original = values(detect(&text).unwrap());
    let german = text
        .replace('\t', ";")
        .replace('.', ",")
        .replace('\n', "\r\n");
    assert_eq!(values(detect(german).unwrap()), original);
    assert_eq!(values(detect(text.replace('\t', ",")).unwrap()), original);
    let wide: Vec<u8> = "\u{FEFF}"
        .encode_utf16()
        .chain(text.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    assert_eq!(values(detect(wide).unwrap()), original);
}
