//! What is odd in workbooks is told, or read as it is meant.

use super::common::written;
use stiction_formats::{Kind, ReadOptions, read_table};

#[test]
fn odd_workbooks_are_told() {
    let folder = written("write_odd_xlsx.py");
    let read = |name: &str| read_table(&folder.path().join(name), &ReadOptions::default());

    let booleans = read("booleans.xlsx").unwrap();
    let position = &booleans.columns[1].values;
    let missing: Vec<usize> = (0..position.len())
        .filter(|k| position[*k].is_nan())
        .collect();
    assert_eq!(missing, [4, 9]);
    let said =
        "2 cells TRUE or FALSE among the numbers of column B, first TRUE in row 6: read as missing";
    assert_eq!(booleans.skipped, [said]);
    // A column of them alone is one of flags.
    assert_eq!(booleans.columns[2].values[..4], [0.0, 0.0, 0.0, 1.0]);

    let hidden = read("hidden.xlsx").unwrap();
    assert_eq!(hidden.columns[1].values[3], 0.3);
    assert!(
        hidden.skipped[0].starts_with("sheet old: "),
        "{:?}",
        hidden.skipped
    );

    // A hidden one is read where no other has a table, which is said.
    let alone = read("only_hidden.xlsx").unwrap();
    assert_eq!(alone.detected[1], "sheet raw, which is hidden");

    let wide = read("wide.xlsx").unwrap_err();
    assert_eq!(wide.kind, Kind::Limit);
    let said = wide.to_string();
    assert!(said.contains("row 1 goes on to column FAO"), "{said}");
    assert!(said.contains("at most 4096 columns"), "{said}");
}
