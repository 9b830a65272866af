//! JSON that is broken, hostile, or written in an unusual way.

use stiction_formats::{Error, Kind, Limits, ReadOptions, Table, read_table};

fn read_within(text: &str, samples: u64) -> Result<Table, Error> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.json");
    std::fs::write(&file, text).unwrap();
    let limits = Limits {
        memory: samples * 24,
    };
    let options = ReadOptions {
        limits,
        ..ReadOptions::default()
    };
    read_table(&file, &options)
}

fn read(text: &str) -> Result<Table, Error> {
    read_within(text, 1 << 20)
}

/// A table keeps the headers of the program that wrote it: units behind names are taken, indices and words are names.
#[test]
fn units_stand_behind_names() {
    let text =
        "[{\"t [s]\": 0, \"Position (mm)\": 1, \"q [0]\": 2, \"v (left)\": 3, \"i [Ticks]\": 4}]";
    let table = read(text).unwrap();
    let columns: Vec<(&str, Option<&str>)> = table
        .columns
        .iter()
        .map(|c| (c.name.as_str(), c.unit.as_deref()))
        .collect();
    let expected = [
        ("t", Some("s")),
        ("Position", Some("mm")),
        ("q [0]", None),
        ("v (left)", None),
        ("i [Ticks]", None),
    ];
    assert_eq!(columns, expected);
}

#[test]
fn errors_name_line_byte_and_column() {
    for (text, row, byte, column, words) in [
        ("{\"t\": [0,\n1,\n x]}", 3, 15, "t", "`x` where a value"),
        (
            "{\"a\": {\"b\": [1, 2",
            1,
            17,
            "a.b",
            "ends where `,` or `]`",
        ),
        (
            "[{\"t\": 0},\n{\"t\": 1 \"x\": 2}]",
            2,
            19,
            "",
            "where `,` or `}`",
        ),
        ("{\"t\": 0}\n{\"t\": 1}\n{\"t\"", 3, 22, "", "`:`"),
        ("[{\"t\": 0, \"t\": 1}]", 1, 16, "t", "second value"),
        ("[{\"t\": [0], \"t\": [1]}]", 1, 20, "t", "second value"),
        ("{\"t\": [1.2.3]}", 1, 12, "t", "`1.2.3`"),
        ("{\"t\": {\"0\": 1, \"2\": 2}}", 1, 19, "t", "after \"0\""),
    ] {
        let error = read(text).unwrap_err();
        assert_eq!(error.kind, Kind::Format, "{text}: {error}");
        assert_eq!(error.place.row, Some(row), "{text}: {error}");
        assert_eq!(
            error.place.column.as_deref().unwrap_or(""),
            column,
            "{text}: {error}"
        );
        assert!(
            error.place.byte.is_none_or(|at| at == byte),
            "{text}: {error}"
        );
        assert!(error.to_string().contains(words), "{text}: {error}");
    }
}

#[test]
fn whatever_is_cut_off_is_refused() {
    let whole =
        "{\"kt\": 2.5, \"entries\": [{\"t\": 0.5, \"q\": [1, 2]}, {\"t\": 1.5, \"q\": [3, 4]}]}";
    assert_eq!(read(whole).unwrap().columns.len(), 3);
    for end in 2..whole.len() {
        assert!(read(&whole[..end]).is_err(), "{}", &whole[..end]);
    }
}

#[test]
fn nothing_is_allocated_for_what_is_not_allowed() {
    // Each record has a key of its own: as a table it is the square of what the file holds.
    let records: Vec<String> = (0..4000).map(|n| format!("{{\"k{n}\":1}}")).collect();
    for text in [format!("[{}]", records.join(",")), records.join("\n")] {
        let error = read(&text).unwrap_err();
        assert_eq!(error.kind, Kind::Limit, "{error}");
    }
    let error = read_within("[1, 2, 3, 4]", 3).unwrap_err();
    assert_eq!(error.kind, Kind::Limit, "{error}");
    let many: Vec<String> = (0..70_000).map(|n| format!("\"k{n}\":1")).collect();
    let error = read(&format!("{{{}}}", many.join(","))).unwrap_err();
    assert_eq!(error.kind, Kind::Limit, "{error}");
    let error = read(&"[".repeat(100_000)).unwrap_err();
    assert!(error.found.contains("deeper than 32"), "{error}");
    let error = read(&"{\"a\":".repeat(100_000)).unwrap_err();
    assert!(error.found.contains("deeper than 32"), "{error}");
}

#[test]
fn what_is_no_signal_is_named() {
    let table =
        read("[{\"t\": 0, \"s\": \"hold\", \"n\": 1}, {\"t\": 1, \"s\": 2, \"n\": \"run\"}]")
            .unwrap();
    assert_eq!(table.columns.len(), 1);
    assert_eq!(table.left_out, [2, 3]);
    assert_eq!(
        table.skipped,
        [
            "s: text such as hold in line 1",
            "n: text such as run in line 1"
        ]
    );
    let error = read("{\"a\": \"x\"}").unwrap_err();
    assert_eq!(error.kind, Kind::Missing);
    assert!(error.found.contains("a: text such as x"), "{error}");
}

#[test]
fn times_of_day_run_on_over_midnight() {
    let table = read("{\"at\": [\"23:59:59.5\", \"00:00:00.25\"], \"q\": [1, 2]}").unwrap();
    assert_eq!(table.columns[0].values, [0.0, 0.75]);
}

/// Cells that are missing count before they take memory: a short file cannot ask for a large table.
#[test]
fn records_with_hardly_a_key_in_common_are_refused() {
    let each = |count: usize, record: &dyn Fn(usize) -> String| {
        let records: Vec<String> = (0..count).map(record).collect();
        records
    };
    let keys: Vec<String> = (0..3000).map(|k| format!("\"k{k}\": 1")).collect();
    let mut long = vec![format!("{{{}}}", keys.join(","))];
    long.extend(vec!["{}".to_owned(); 3000]);
    for (records, record) in [
        (each(4000, &|k| format!("{{\"k{k}\": 1}}")), Some(2897)),
        (each(4000, &|k| format!("[{{\"k{k}\": 1}}]")), Some(2049)),
        (long, None),
    ] {
        let list = format!("[{}]", records.join(",\n"));
        let lines = records.join("\n");
        for text in [list, lines] {
            let error = read_within(&text, 1 << 28).unwrap_err();
            assert_eq!(error.kind, Kind::Limit, "{error}");
            let said = error.to_string();
            let at = record.map_or_else(String::new, |n| format!("record {n}:"));
            assert!(said.contains(&at), "{said}");
            assert!(said.contains("without one"), "{said}");
            assert!(said.contains("at most 4194304 cells without"), "{said}");
        }
    }
}

/// Signals that take turns are a log, and every cell stands in its row.
#[test]
fn records_of_signals_in_turn_are_read() {
    let record = |k: usize| format!("{{\"t\": {k}, \"s{}\": {k}}}", k % 200);
    let records: Vec<String> = (0..20_000).map(record).collect();
    let table = read_within(&records.join("\n"), 1 << 28).unwrap();
    assert_eq!(table.columns.len(), 201);
    for (signal, column) in table.columns[1..].iter().enumerate() {
        let right = |(row, x): (usize, &f64)| match row % 200 == signal {
            true => *x == row as f64,
            false => x.is_nan(),
        };
        assert_eq!(column.values.len(), 20_000);
        assert!(column.values.iter().enumerate().all(right));
    }
}
