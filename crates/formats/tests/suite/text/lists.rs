//! Lists of numbers within cells: a column of the table for each of their elements.

use super::{detect, shape};
use stiction_formats::text::{TextOptions, read_file};
use stiction_formats::{ReadOptions, Table, read_wanted};
use stiction_testkit::recordings;

/// The same numbers in the columns of a table without lists.
const PLAIN: &str = "n,\"q(:,1) [rad]\",\"q(:,2) [rad]\",t\n0,0.5,-1,1\n1,,,2\n2,1e-3,25,3\n";

#[test]
fn lists_as_python_and_numpy_print_them_are_columns() {
    let plain = shape(&detect(PLAIN).unwrap());
    for rows in [
        "0,\"[0.5, -1]\",1\n1,,2\n2,\"[1e-3, 25]\",3\n",
        "0,\"(0.5, -1)\",1\n1,[],2\n2,\"(1e-3, 25)\",3\n",
        "0,\"[0.5 -1. ]\",1\n1,nan,2\n2,\"[1e-3\n 25. ]\",3\n",
    ] {
        let table = detect(format!("n,q [rad],t\n{rows}")).unwrap();
        assert_eq!(shape(&table), plain, "{rows}");
        assert!(
            table
                .detected
                .iter()
                .any(|line| line == "q: lists of 2 numbers")
        );
    }
    let other = "n;q [rad];t\n0;[0.5, -1];1\n1;;2\n2;[1e-3, 25];3\n";
    assert_eq!(shape(&detect(other).unwrap()), plain);
}

#[test]
fn columns_beside_lists_keep_their_numbers() {
    let table = detect("kind,q,t\nA,\"[1, 2, 3]\",0.5\nB,\"[4, 5, 6]\",0.75\n").unwrap();
    assert_eq!(table.left_out, [1]);
    let numbers: Vec<usize> = (0..4).map(|index| table.number(index)).collect();
    assert_eq!(numbers, [2, 3, 4, 5]);
}

#[test]
fn what_is_not_a_list_of_that_length_is_refused_with_its_line() {
    for (row, found) in [
        ("\"[1, 2]\"", "a list of 2"),
        ("\"[1, 2, 3, 4]\"", "a list of 4"),
        ("\"[1, x, 3]\"", "[1, x, 3]"),
        ("7", "7"),
    ] {
        let good = "\"[1, 2, 3]\"";
        let text = format!("t,q,F\n0,{good},1\n1,{good},2\n2,{row},3\n3,{good},4\n");
        let error = detect(text).unwrap_err();
        assert_eq!(error.place.row, Some(4), "{error}");
        assert_eq!(error.place.column.as_deref(), Some("q"));
        assert!(error.found.contains(found), "{error}");
        assert!(error.allowed.contains("a list of 3 numbers"), "{error}");
    }
}

#[test]
fn single_numbers_in_brackets_stay_text() {
    let table = detect("t,a,b\n0,[1],(5)\n1,[2],(6)\n").unwrap();
    assert_eq!(table.columns.len(), 1);
    assert_eq!(table.skipped.len(), 2);
}

#[test]
fn of_lists_those_elements_alone_are_kept_that_are_wanted() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.csv");
    let rows = |n| format!("{n},\"[{n}.5, {}, 0]\",7\n", 2 * n);
    let rows: String = (0..5000).map(rows).collect();
    std::fs::write(&file, format!("t,q,F\n{rows}")).unwrap();
    let wanted = |heads: &Table| {
        let names: Vec<&str> = heads.columns.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["t", "q(:,1)", "q(:,2)", "q(:,3)", "F"]);
        vec![true, false, true, false, true]
    };
    let table = read_wanted(&file, &ReadOptions::default(), |_| {}, &wanted).unwrap();
    let lengths: Vec<usize> = table.columns.iter().map(|c| c.values.len()).collect();
    assert_eq!(lengths, [5000, 0, 5000, 0, 5000]);
    assert_eq!(table.columns[2].values[4999], 9998.0);
    let passed: Vec<usize> = table.passed.keys().copied().collect();
    assert_eq!(passed, [1, 3]);
    assert!(table.passed[&3].zeros && table.passed[&1].others);
}

#[test]
fn so101() {
    let Some(folder) = recordings() else { return };
    for test in ["single_joint_rotation", "coupled_joints"] {
        for (name, lists) in [("state_motor", 3), ("control", 1)] {
            let path = folder.join(format!("robots/so101/{test}/{name}.csv"));
            let table = read_file(&path, &TextOptions::default()).unwrap();
            let lists = &["positions", "velocities", "torques"][..lists];
            let names = |list| (1..=6).map(move |n| format!("{list}(:,{n})"));
            let mut expected = vec!["timestamp".to_owned()];
            expected.extend(lists.iter().flat_map(names));
            let names: Vec<&str> = table.columns.iter().map(|c| c.name.as_str()).collect();
            assert_eq!(names, expected);
            // The numbers of each line, by the standard library.
            let text = std::fs::read_to_string(&path).unwrap();
            for (row, line) in text.lines().skip(1).enumerate() {
                let plain = line.replace(['[', ']', '"', ' '], "");
                for (column, cell) in table.columns.iter().zip(plain.split(',').skip(1)) {
                    let value: f64 = cell.parse().unwrap();
                    assert_eq!(column.values[row].to_bits(), value.to_bits());
                }
            }
            assert_eq!(table.rows(), text.lines().count() - 1);
        }
    }
}
