//! TwinCAT Scope exports in every layout of its export dialog, generated.

use super::{detect, shape};
use stiction_formats::{Kind, Table};

/// A channel: name, symbol, unit cell, sample time in ms, samples.
#[derive(Clone)]
struct Channel {
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    period: f64,
    values: Vec<f64>,
}

/// How the export dialog was set.
#[derive(Clone, Copy)]
struct Dialog {
    separator: char,
    comma: bool,
    /// Time columns: one per channel, one per sample time, or none.
    times: Times,
    file_time: bool,
    /// Rows of the channel header: all, only the names, or the old names of the keys.
    header: Header,
    eof: bool,
    /// Cells of channels that ran out: a blank each, or nothing (short rows).
    blank_cells: bool,
    end: &'static str,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Times {
    Each,
    Grouped,
    None,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Header {
    Full,
    Old,
    NamesOnly,
}

const PLAIN: Dialog = Dialog {
    separator: '\t',
    comma: true,
    times: Times::Grouped,
    file_time: false,
    header: Header::Full,
    eof: false,
    blank_cells: false,
    end: "\n",
};

const START: i64 = 132_959_733_843_760_000;

fn channels() -> Vec<Channel> {
    let values = |n: usize, f: fn(f64) -> f64| (0..n).map(|i| f(i as f64)).collect();
    vec![
        Channel {
            name: "ActPos",
            symbol: "MAIN.fPos",
            unit: "mm (Length)",
            period: 0.5,
            values: values(40, |i| 0.25 * i + 0.125),
        },
        Channel {
            name: "ActPos (1)",
            symbol: "MAIN.fPos",
            unit: "mm (Length)",
            period: 0.5,
            values: values(40, |i| 0.25 * i + 0.125),
        },
        Channel {
            name: "bMoving",
            symbol: "MAIN.bMoving",
            unit: "(None)",
            period: 2.0,
            values: values(10, |i| f64::from(i > 3.0)),
        },
        Channel {
            name: "ActTorque",
            symbol: "MAIN.fTorque",
            unit: "%",
            period: 2.0,
            values: values(10, |i| -12.5 - i),
        },
    ]
}

/// Writes an export; groups are channels with the same time column.
fn export(channels: &[Channel], dialog: Dialog) -> String {
    let Dialog { separator, end, .. } = dialog;
    let sep = separator.to_string();
    let number = |v: f64| {
        let text = v.to_string();
        if dialog.comma {
            text.replace('.', ",")
        } else {
            text
        }
    };
    let mut groups: Vec<Vec<&Channel>> = Vec::new();
    for channel in channels {
        match groups.last_mut() {
            Some(last) if dialog.times != Times::Each && last[0].period == channel.period => {
                last.push(channel)
            }
            _ => groups.push(vec![channel]),
        }
    }
    let row = |key: &str, cell: &dyn Fn(&Channel) -> String| {
        let group = |g: &Vec<&Channel>| {
            let cells: Vec<String> = g.iter().map(|c| cell(c)).collect();
            format!("{key}{sep}{}", cells.join(&sep))
        };
        groups.iter().map(group).collect::<Vec<_>>().join(&sep) + end
    };
    let old = dialog.header == Header::Old;
    let (from, to) = if old {
        ("StartRecord", "EndRecord")
    } else {
        ("Starttime of export", "Endtime of export")
    };
    let mut text = format!("Name{sep}YT Scope Project{end}File{sep}C:\\logs\\axis.svdx{end}");
    text += &format!("{from}{sep}{START}{sep}Montag, 2. Mai 2022{sep}15:56:24.376{end}");
    text += &format!(
        "{to}{sep}{}{sep}Montag, 2. Mai 2022{sep}15:56:25.375{end}{end}",
        START + 9_990_000
    );
    text += &row("Name", &|c| c.name.to_owned());
    if dialog.header != Header::NamesOnly {
        text += &row("SymbolComment", &|_| String::new());
        text += &row("Data-Type", &|_| {
            if old {
                "ADST_REAL64".into()
            } else {
                "REAL64".into()
            }
        });
        text += &row(if old { "SampleTime" } else { "SampleTime[ms]" }, &|c| {
            number(c.period)
        });
        text += &row("VariableSize", &|_| "8".into());
        text += &row("SymbolName", &|c| c.symbol.into());
        text += &row("NetID", &|_| "5.23.1.7.1.1".into());
        text += &row("Port", &|_| "851".into());
        text += &row("Offset", &|c| {
            if c.unit == "%" {
                "2".into()
            } else {
                "0".into()
            }
        });
        text += &row("ScaleFactor", &|c| {
            if c.unit == "%" {
                "-1".into()
            } else {
                "1".into()
            }
        });
        text += &row("BitMask", &|_| "0xffffffffffffffff".into());
        text += &row("Unit", &|c| c.unit.into());
        text += &row("Unit ScaleFactor", &|_| "1".into());
        text += &row("Unit Offset", &|_| "0".into());
    }
    text += end;
    let rows = channels.iter().map(|c| c.values.len()).max().unwrap();
    for i in 0..rows {
        let mut cells: Vec<Option<String>> = Vec::new();
        for group in &groups {
            let there = i < group[0].values.len();
            if dialog.times != Times::None {
                let ms = i as f64 * group[0].period;
                cells.push(there.then(|| match dialog.file_time {
                    true => (START + (ms * 1e4) as i64).to_string(),
                    false => number(ms),
                }));
            }
            cells.extend(group.iter().map(|c| c.values.get(i).map(|v| number(*v))));
        }
        if !dialog.blank_cells {
            while cells.last() == Some(&None) {
                cells.pop();
            }
        }
        let cells: Vec<String> = cells.into_iter().map(|c| c.unwrap_or(" ".into())).collect();
        text += &(cells.join(&sep) + end);
    }
    if dialog.eof {
        text += "EOF";
        text += end;
    }
    text
}

/// A small export for other tests.
pub(crate) fn example() -> String {
    export(&channels(), PLAIN)
}

fn find<'a>(table: &'a Table, name: &str) -> &'a [f64] {
    &table
        .columns
        .iter()
        .find(|c| c.name == name)
        .unwrap_or_else(|| panic!("{name}"))
        .values
}

#[test]
fn every_setting_of_the_export_dialog_reads_the_same() {
    let channels = channels();
    let mut count = 0;
    for (separator, comma) in [
        ('\t', true),
        ('\t', false),
        (';', true),
        (';', false),
        (',', false),
        (':', true),
        (':', false),
    ] {
        for times in [Times::Each, Times::Grouped, Times::None] {
            for header in [Header::Full, Header::Old, Header::NamesOnly] {
                for (file_time, eof, blank_cells, end) in [
                    (false, false, false, "\n"),
                    (false, true, true, "\r\n"),
                    (true, true, false, "\r\n"),
                    (true, false, true, "\n"),
                ] {
                    let dialog = Dialog {
                        separator,
                        comma,
                        times,
                        file_time,
                        header,
                        eof,
                        blank_cells,
                        end,
                    };
                    let text = export(&channels, dialog);
                    let table = detect(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
                    check(&table, &channels, dialog, &text);
                    count += 1;
                }
            }
        }
    }
    assert_eq!(count, 7 * 3 * 3 * 4);
}

fn check(table: &Table, channels: &[Channel], dialog: Dialog, text: &str) {
    let full = dialog.header != Header::NamesOnly;
    for channel in channels {
        // Neither the Offset nor the ScaleFactor row ever touches a sample.
        assert_eq!(find(table, channel.name), channel.values, "{text}");
        let column = table
            .columns
            .iter()
            .find(|c| c.name == channel.name)
            .unwrap();
        let unit = channel
            .unit
            .split(' ')
            .next()
            .filter(|u| full && *u != "(None)");
        assert_eq!(column.unit.as_deref(), unit);
    }
    let stamps = |n: usize, period: f64| -> Vec<f64> {
        let ms = |i: usize| i as f64 * period;
        (0..n)
            .map(|i| {
                if dialog.file_time {
                    (ms(i) * 1e4) / 1e7
                } else {
                    ms(i)
                }
            })
            .collect()
    };
    if dialog.times == Times::None {
        assert_eq!(table.columns.len(), channels.len());
    } else {
        assert_eq!(
            table.columns.len(),
            channels.len() + 2,
            "{:?}",
            table.detected
        );
        assert_eq!(find(table, "time of ActPos"), stamps(40, 0.5));
        assert_eq!(find(table, "time of bMoving"), stamps(10, 2.0));
        let unit = if dialog.file_time { "s" } else { "ms" };
        assert!(
            table
                .columns
                .iter()
                .filter(|c| c.name.starts_with("time"))
                .all(|c| c.unit.as_deref() == Some(unit))
        );
        let said = "`time of bMoving` applies to `bMoving`, `ActTorque`".to_owned();
        assert!(table.detected.contains(&said), "{:?}", table.detected);
    }
    let said = |what: &str| table.detected.iter().any(|d| d == what);
    assert!(said("TwinCAT Scope export"));
    assert!(
        said(if dialog.comma {
            "decimal comma"
        } else {
            "decimal point"
        }),
        "{:?}",
        table.detected
    );
    assert_eq!(said("display Offset not applied: `ActTorque` 2"), full);
    assert_eq!(
        said("display ScaleFactor not applied: `ActTorque` -1"),
        full
    );
    let periods: Vec<f64> = table.scalars.iter().map(|s| s.value).collect();
    let expected = if full {
        vec![0.5, 0.5, 2.0, 2.0]
    } else {
        vec![]
    };
    assert_eq!(periods, expected);
    assert_eq!(
        table.skipped.iter().any(|s| s.contains("EOF")),
        dialog.eof,
        "{:?}",
        table.skipped
    );
}

#[test]
fn one_sample_time_has_one_time_column() {
    let channels = &channels()[..2];
    for times in [Times::Each, Times::Grouped] {
        let table = detect(export(channels, Dialog { times, ..PLAIN })).unwrap();
        let names: Vec<_> = table.columns.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["time", "ActPos", "ActPos (1)"]);
        assert_eq!(table.sample_time, Some(0.0005));
        assert_eq!(table.columns[0].unit.as_deref(), Some("ms"));
    }
    let none = detect(export(
        channels,
        Dialog {
            times: Times::None,
            ..PLAIN
        },
    ))
    .unwrap();
    assert_eq!(none.sample_time, Some(0.0005));
    assert!(none.detected.contains(&"no time columns".to_owned()));
}

#[test]
fn the_smallest_export() {
    let table = detect("Name\tx\ty\n\n0\t1\t2\n1\t3\t4,5\n").unwrap();
    let expected = [
        ("time", "ms", ["0", "1"]),
        ("x", "", ["1", "3"]),
        ("y", "", ["2", "4.5"]),
    ]
    .map(|(n, u, v)| (n.to_owned(), u.to_owned(), v.map(str::to_owned).to_vec()));
    assert_eq!(shape(&table), expected);
}

#[test]
fn blanks_as_separator() {
    // Names with blanks can be told apart where each channel has its own time column.
    let dialog = Dialog {
        separator: ' ',
        times: Times::Each,
        ..PLAIN
    };
    let table = detect(export(&channels()[..2], dialog)).unwrap();
    let names: Vec<_> = table.columns.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["time", "ActPos", "ActPos (1)"]);
    // And are refused where they cannot.
    let dialog = Dialog {
        separator: ' ',
        times: Times::Grouped,
        ..PLAIN
    };
    assert_eq!(
        detect(export(&channels()[..2], dialog)).unwrap_err().kind,
        Kind::Ambiguous
    );
}

#[test]
fn a_comment_over_several_lines_is_passed_over() {
    let text = example().replace(
        "SymbolComment\t\t",
        "SymbolComment\t(* position\n\n1;2\nof the axis *)\t",
    );
    let table = detect(&text).unwrap();
    assert_eq!(find(&table, "ActTorque"), channels()[3].values);
}

#[test]
fn missing_samples_in_the_middle_stay_in_place() {
    let text = "Name\tx\tName\ty\n\n0\t1\t0\t5,5\n1\t \t2\t \n2\t3\t4\t6\n3\t4\t \t \n";
    let table = detect(text).unwrap();
    assert_eq!(find(&table, "time of x"), [0.0, 1.0, 2.0, 3.0]);
    assert_eq!(find(&table, "time of y"), [0.0, 2.0, 4.0]);
    assert!(find(&table, "x")[1].is_nan() && find(&table, "y")[1].is_nan());
    assert_eq!(find(&table, "y").len(), 3);
}

#[test]
fn a_channel_without_samples_is_not_taken_for_missing_time_columns() {
    for rest in [
        "",
        "Data-Type\tINT16\tData-Type\tINT16\nSampleTime[ms]\t2\tSampleTime[ms]\t2\n",
    ] {
        let text = format!("Name\tx\tName\ty\n{rest}\n0\t7\n2\t7\n4\t8\n");
        let error = detect(text).unwrap_err();
        assert_eq!(error.kind, Kind::Ambiguous, "{error}");
    }
    let error = detect("Name\tx\tName\ty\n\n132959733843760000\t7\n").unwrap_err();
    assert_eq!(error.kind, Kind::Ambiguous, "{error}");
}
