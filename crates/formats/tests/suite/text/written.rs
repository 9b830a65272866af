//! Single files, one for each habit of the programs that write logs.

use super::{detect, shape};
use stiction_formats::Kind;
use stiction_formats::text::{Decimal, Separator, TextOptions, read};

/// The columns of a text as `name|unit|values`.
#[track_caller]
fn columns(text: impl AsRef<[u8]>) -> Vec<String> {
    let table = detect(text).unwrap_or_else(|e| panic!("{e}"));
    shape(&table)
        .into_iter()
        .map(|(n, u, v)| format!("{n}|{u}|{}", v.join(" ")))
        .collect()
}

fn options(change: impl FnOnce(&mut TextOptions)) -> TextOptions {
    let mut options = TextOptions::default();
    change(&mut options);
    options
}

#[test]
fn says_what_it_detected() {
    let table = detect("Axis X\nTime [s];Pos (mm);\n\n0;1,5;\n0,001;-2,5;\n").unwrap();
    assert_eq!(
        table.detected,
        [
            "separator `;`",
            "1 preamble line",
            "header in line 2",
            "separator at the end of each row",
            "decimal comma",
            "units in the header"
        ]
    );
    assert_eq!(columns("0 1.5\n1 2\n"), ["||0 1", "||1.5 2"]);
    let table = detect("0 1.5\n1 2\n").unwrap();
    assert_eq!(
        table.detected,
        ["separator blanks", "no header", "decimal point"]
    );
}

#[test]
fn separators_and_padding() {
    let expected = ["a||1 3", "b||2.5 -4"];
    for text in [
        "a,b\n1,2.5\n3,-4\n",
        "a, b\n1, 2.5\n3, -4\n",
        "a\tb\r\n1\t2.5\r\n3\t-4",
        "a;b;\n1;2,5;\n3;-4;\n",
        "a | b\n1 | 2.5\n3 | -4\n",
        "  a   b \n  1   2.5 \n\t3 -4\n",
        "a\tb\r1\t2.5\r3\t-4\r",
        "\"a\";\"b\"\n\"1\";\"2,5\"\n\"3\";\"-4\"\n",
        "\"a\",\"b\"\n\"1\",\"2,5\"\n\"3\",\"-4\"\n",
        "a \t b\n1.0 \t 2.5\n3 \t -4\n",
    ] {
        assert_eq!(columns(text), expected, "{text:?}");
    }
}

#[test]
fn encodings() {
    let text = "Zeit [µs];Winkel [°]\n0;1,5\n1;2,5\n";
    let expected = ["Zeit|µs|0 1", "Winkel|°|1.5 2.5"];
    let utf16 = |big: bool| -> Vec<u8> {
        let encode = |u: u16| {
            if big {
                u.to_be_bytes()
            } else {
                u.to_le_bytes()
            }
        };
        "\u{FEFF}"
            .encode_utf16()
            .chain(text.encode_utf16())
            .flat_map(encode)
            .collect()
    };
    let latin: Vec<u8> = text
        .chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap())
        .collect();
    for (bytes, said) in [
        (text.as_bytes().to_vec(), None),
        (
            format!("\u{FEFF}{text}").into_bytes(),
            Some("UTF-8 with byte order mark"),
        ),
        (utf16(false), Some("UTF-16 LE")),
        (utf16(true), Some("UTF-16 BE")),
        (latin, Some("encoding ISO-8859-1")),
    ] {
        assert_eq!(columns(&bytes), expected);
        let detected = detect(&bytes).unwrap().detected;
        assert_eq!(detected[0], said.unwrap_or("separator `;`"));
    }
}

#[test]
fn headers_and_units() {
    assert_eq!(
        columns("t [s],x (1),y (mm)\n0,1,2.5\n"),
        ["t|s|0", "x (1)||1", "y|mm|2.5"]
    );
    assert_eq!(
        columns("t;x;F\ns;mm;N\n0;1,5;2\n"),
        ["t|s|0", "x|mm|1.5", "F|N|2"]
    );
    assert_eq!(
        columns("t;x;n\n[s];(mm);-\n0;1,5;2\n"),
        ["t|s|0", "x|mm|1.5", "n||2"]
    );
    assert_eq!(
        columns("# t [s] x [mm]\n0 1.5\n1 2\n"),
        ["t|s|0 1", "x|mm|1.5 2"]
    );
    assert_eq!(
        columns("% made by a drive\n% t x\n0 1.5\n1 2\n"),
        ["t||0 1", "x||1.5 2"]
    );
    assert_eq!(
        columns("\"t\n[s]\",\"x, y\"\n0,1.5\n"),
        ["t|s|0", "x, y||1.5"]
    );
    assert_eq!(
        columns(",t,x\n0,0.5,1\n1,0.6,2\n"),
        ["||0 1", "t||0.5 0.6", "x||1 2"]
    );
    // The same name twice is for the mapping to judge.
    assert_eq!(columns("x,x\n0,1.5\n"), ["x||0", "x||1.5"]);
}

#[test]
fn preambles() {
    let text = "Drive: A7\nRate;1000\nOperator;Ms. Doe\n\ntime;pos\n0;1,5\n1;2,5\n";
    assert_eq!(columns(text), ["time||0 1", "pos||1.5 2.5"]);
    assert!(
        detect(text)
            .unwrap()
            .detected
            .contains(&"3 preamble lines".to_owned())
    );
    let text = "Recorded on a Monday, by hand\n\n0,1.5,2\n1,2.5,3\n";
    assert_eq!(columns(text), ["||0 1", "||1.5 2.5", "||2 3"]);
    // A sampling trace of CODESYS 2.
    let text =
        "Trace\nD:\\PROJECTS\\AXIS.PRO\nCycle PLC_PRG.Pos PLC_PRG.Moving\n0 2.5 TRUE\n1 2 FALSE\n";
    assert_eq!(
        columns(text),
        ["Cycle||0 1", "PLC_PRG.Pos||2.5 2", "PLC_PRG.Moving||1 0"]
    );
    // halsampler with sample numbers: blanks at the ends, no header.
    assert_eq!(
        columns("0 0.500000 1 \n1 0.510000 0 \n"),
        ["||0 1", "||0.5 0.51", "||1 0"]
    );
}

#[test]
fn missing_values_and_words() {
    let text = "a,b,c,d\n1,,NaN,inf\n,2.5,-Inf,1\nTRUE,n/a,false,1.#QNAN\n";
    assert_eq!(
        columns(text),
        [
            "a||1 NaN 1",
            "b||NaN 2.5 NaN",
            "c||NaN -inf 0",
            "d||inf 1 NaN"
        ]
    );
}

#[test]
fn a_row_of_empty_cells_is_a_sample() {
    assert_eq!(
        columns("a;b\n1;2,5\n;\n3;4\n"),
        ["a||1 NaN 3", "b||2.5 NaN 4"]
    );
    assert_eq!(
        columns("a\tb\n1\t2.5\n\t\n3\t4\n"),
        ["a||1 NaN 3", "b||2.5 NaN 4"]
    );
}

#[test]
fn text_columns_are_skipped_and_said() {
    let table = detect("t,phase,x,note\n0,hold,1.5,\n1,\"go, on\",2,\n").unwrap();
    assert_eq!(table.columns.len(), 2);
    assert_eq!(table.columns[1].values, [1.5, 2.0]);
    assert_eq!(
        table.skipped,
        [
            "phase: text such as `hold` in line 2",
            "note: no number in any row"
        ]
    );
    // Of a column that is mostly text the first text is shown, and what of it may be mended.
    let table = detect("t;x\n0;0.5\n1;1,234.5\n2;2,345.5\n").unwrap();
    assert_eq!(
        table.skipped,
        ["x: text such as `1,234.5` (digits must not be grouped) in line 3"]
    );
}

#[test]
fn what_stands_between_and_after_the_rows() {
    let table = detect("t,x\n0,1.5\n# paused\n\n1,2.5\n\nEOF\n").unwrap();
    assert_eq!(table.columns[1].values, [1.5, 2.5]);
    assert_eq!(
        table.skipped,
        [
            "1 comment line between the rows",
            "1 blank line between the rows",
            "text after the last sample, from line 7: `EOF`"
        ]
    );
    let table = detect("0.5,1\n1.5,2\nEnd of recording, no errors\nSamples: 2\n").unwrap();
    assert_eq!(table.rows(), 2);
}

#[test]
fn moments_become_seconds() {
    let text =
        "time,x\n2024-05-01T12:00:00.001,1\n2024-05-01T12:00:00.5Z,2\n,3\n2024-05-02 12:00:00,4\n";
    let table = detect(text).unwrap();
    assert_eq!(table.columns[0].values[..2], [0.0, 0.499]);
    assert!(table.columns[0].values[2].is_nan());
    assert_eq!(table.columns[0].values[3], 86_399.999);
    assert_eq!(table.columns[0].unit.as_deref(), Some("s"));
    assert!(
        table
            .detected
            .contains(&"time: dates with time, converted to seconds from the first".to_owned())
    );
    let text = "23:59:59,5\t1,5\n23:59:59,75\t2\n00:00:00,25\t3\n";
    let table = detect(text).unwrap();
    assert_eq!(table.columns[0].values, [0.0, 0.25, 0.75]);
    assert!(
        table
            .detected
            .iter()
            .any(|d| d.contains("a day added after each midnight"))
    );
}

#[test]
fn local_dates_become_seconds_where_their_order_is_clear_or_not_needed() {
    let read = |rows: &[&str]| {
        let rows: Vec<String> = rows.iter().map(|date| format!("{date};1.5\n")).collect();
        detect(format!("Zeit;x\n{}", rows.concat())).map(|table| {
            let said = table.detected.iter().find(|said| said.starts_with("Zeit"));
            (
                table.columns[0].values.clone(),
                said.cloned().unwrap_or_default(),
            )
        })
    };
    let seconds = |order: &str| {
        format!("Zeit: dates with time, {order}, converted to seconds from the first")
    };
    for (rows, values, order) in [
        (
            ["26.11.2024 12:00:00.123", "26.11.2024 12:00:00.124"],
            [0.0, 0.001],
            "day before month",
        ),
        (
            ["11/26/2024 11:59:59 AM", "11/26/2024 12:00:00 PM"],
            [0.0, 1.0],
            "month before day",
        ),
        (
            ["02/01/2024 10:00:00.5", "02/01/2024 10:00:00.75"],
            [0.0, 0.25],
            "all of one day",
        ),
        (
            ["02/01/2024 23:59:59.5", "03/01/2024 00:00:00.5"],
            [0.0, 1.0],
            "day before month",
        ),
        (
            ["02/01/2024 23:59:59.5", "02/02/2024 00:00:00.5"],
            [0.0, 1.0],
            "month before day",
        ),
        (
            ["24/11/26 12:00:00", "24/11/26 12:00:01"],
            [0.0, 1.0],
            "all of one day",
        ),
    ] {
        assert_eq!(
            read(&rows).unwrap(),
            (values.to_vec(), seconds(order)),
            "{rows:?}"
        );
    }
    // A day that follows far down in the file shows the order for all blocks that come after it.
    let mut text = String::from("time;x\n");
    for i in 0..200_000_u32 {
        let (day, second) = ((i >= 100_000) as u32, i % 100_000);
        let of_day = f64::from(second) * 1e-3 + if day == 0 { 86_300.0 } else { 0.0 };
        let (hour, minute) = (of_day as u32 / 3600, of_day as u32 / 60 % 60);
        text += &format!(
            "{}/05/2024 {hour:02}:{minute:02}:{:06.3};1.5\n",
            3 + day,
            of_day % 60.0
        );
    }
    let table = detect(&text).unwrap();
    let last = table.columns[0].values.last().copied().unwrap();
    assert!((last - 199.999).abs() < 1e-9, "{last}");
}

#[test]
fn decimal_mark_may_show_late() {
    // The first mark stands behind the lines that are looked at.
    let mut text = String::from("a;b\n");
    for i in 0..5000 {
        text += &format!("{i};7\n");
    }
    let point = detect(format!("{text}1.5;2\n0;-2.25\n")).unwrap();
    assert_eq!(point.columns[1].values[5000..], [2.0, -2.25]);
    let comma = detect(format!("{text}1,5;2\n0;-2,25\n")).unwrap();
    assert_eq!(comma.columns[0].values[5000..], [1.5, 0.0]);
    assert!(comma.detected.contains(&"decimal comma".to_owned()));
    let both = detect(format!("{text}1,5;2\n0;-2.25\n")).unwrap_err();
    assert_eq!((both.kind, both.place.row), (Kind::Ambiguous, Some(5003)));
    let whole = detect(&text).unwrap();
    assert!(whole.detected.contains(&"whole numbers only".to_owned()));
}

#[test]
fn a_column_may_be_empty_for_long() {
    // More than one block of text, with the first words and numbers in the middle.
    let mut text = String::from("t,word,number\n");
    for i in 0..120_000 {
        let (word, number) = match i {
            60_000.. => ("go", "2.5"),
            _ => ("", ""),
        };
        text += &format!("{i}.5,{word},{number}\n");
    }
    let table = detect(&text).unwrap();
    assert_eq!(table.skipped, ["word: text such as `go` in line 60002"]);
    let number = &table.columns[1].values;
    assert_eq!(number.len(), 120_000);
    assert!(number[..60_000].iter().all(|v| v.is_nan()));
    assert!(number[60_000..].iter().all(|v| *v == 2.5));
    assert_eq!(table.columns[0].values[119_999], 119_999.5);
}

#[test]
fn blocks_may_cut_anywhere() {
    // Quoted cells with line ends and separators, in rows of growing length, over several blocks.
    let mut text = String::from("n,words,x\n");
    let mut rows = 0_u32;
    while text.len() < 3 << 20 {
        let word = "a\"\"b,\n".repeat((rows % 17) as usize);
        text += &format!("{rows},\"{word}\",\"{rows}.5\"\n");
        rows += 1;
    }
    let table = detect(&text).unwrap();
    let expected: Vec<f64> = (0..rows).map(f64::from).collect();
    assert_eq!(table.columns[0].values, expected);
    assert!(
        table.columns[1]
            .values
            .iter()
            .zip(&expected)
            .all(|(x, n)| *x == n + 0.5)
    );
    // The line of an error counts line ends within quotes.
    let broken = format!("{text}oops,\"\",1.5\n1,\"\",2\n");
    let error = detect(&broken).unwrap_err();
    assert_eq!(
        error.place.row,
        Some(text.matches('\n').count() as u64 + 1),
        "{error}"
    );
}

#[test]
fn stated_options_settle_what_is_ambiguous() {
    let text = "1,234\n5,678\n";
    assert_eq!(detect(text).unwrap_err().kind, Kind::Ambiguous);
    let one = read(
        text.as_bytes(),
        &options(|o| o.decimal = Some(Decimal::Comma)),
    )
    .unwrap();
    assert_eq!(one.columns[0].values, [1.234, 5.678]);
    let two = read(
        text.as_bytes(),
        &options(|o| o.separator = Some(Separator::Comma)),
    )
    .unwrap();
    assert_eq!(two.columns[1].values, [234.0, 678.0]);
    let two = read(
        text.as_bytes(),
        &options(|o| o.decimal = Some(Decimal::Point)),
    )
    .unwrap();
    assert_eq!(two.columns[1].values, [234.0, 678.0]);

    let text = "0,1,2\n0.5,3,4\n";
    assert_eq!(detect(text).unwrap_err().kind, Kind::Ambiguous);
    let named = read(text.as_bytes(), &options(|o| o.header = Some(true))).unwrap();
    assert_eq!((named.columns[1].name.as_str(), named.rows()), ("1", 1));
    let bare = read(text.as_bytes(), &options(|o| o.header = Some(false))).unwrap();
    assert_eq!((bare.columns[1].name.as_str(), bare.rows()), ("", 2));

    let text = "7;8\n9;1,5\nt;x\n0;1,5\n1;2,5\n";
    assert!(detect(text).is_err());
    let table = read(text.as_bytes(), &options(|o| o.preamble = Some(2))).unwrap();
    assert_eq!(table.columns[1].name, "x");
    assert_eq!(table.columns[1].values, [1.5, 2.5]);
}

#[test]
fn commas_are_never_both() {
    // Each of these could be read wrong by a factor; none is read at all.
    for text in [
        "1,234\n",
        "0,001,1,234\n0,002,1,235\n",
        "0,001,15\n0,002,16\n",
        "t,x\n0,001,1,234\n0,002,1,235\n",
        "t,x\n0,1\n1,1,5\n",
        "pos\n1,5\n2,5\n",
        "1, 5, 2, 5\n1, 6, 2, 6\n",
        "0,5 text 1,5\n0,6 text 1,6\n",
        "12:00:00,001\n12:00:00,002\n",
        "12:00:00,001,1.5\n12:00:00,002,2.5\n",
        "1.234,5\n5.678,2\n",
        "1,5;2.5\n",
        "2,5e-323\n3,5e+10\n",
        "-1,5\n1,25\n",
        "0.5\t1,5\n1.5\t2,5\n",
    ] {
        let error = detect(text).expect_err(text);
        assert_eq!(error.kind, Kind::Ambiguous, "{text:?}: {error}");
    }
    // These can be read in one way only.
    assert_eq!(columns("t,x\n0,1\n2,3\n"), ["t||0 2", "x||1 3"]);
    assert_eq!(columns("1,-2\n3,-4\n"), ["||1 3", "||-2 -4"]);
    assert_eq!(columns("0.001,5\n0.002,6\n"), ["||0.001 0.002", "||5 6"]);
    assert_eq!(columns("0,5 1,5\n0,6 1,6\n"), ["||0.5 0.6", "||1.5 1.6"]);
    assert_eq!(columns("1,234;5,678\n"), ["||1.234", "||5.678"]);
    assert_eq!(
        columns("t,x\n12:00:00,1\n12:00:01,2\n"),
        ["t|s|0 1", "x||1 2"]
    );
}
