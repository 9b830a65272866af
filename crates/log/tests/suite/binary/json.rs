//! JSON that is broken, hostile, or written in an unusual way.

use stiction_log::{Error, Kind, Limits, ReadOptions, Table, read_table};

fn read_within(text: &str, samples: u64) -> Result<Table, Error> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.json");
    std::fs::write(&file, text).unwrap();
    let limits = Limits {
        samples,
        ..Limits::default()
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
