//! Random tables written in every dialect come back as they were.

use super::detect;
use proptest::prelude::*;
use stiction_formats::Kind;

/// How a table is written.
#[derive(Clone, Debug)]
struct Dialect {
    separator: &'static str,
    comma: bool,
    header: bool,
    units: Units,
    end: &'static str,
    /// Remarks at the top, each with the character it starts with.
    remarks: Vec<&'static str>,
    padded: bool,
    quoted: bool,
    trailing: bool,
    encoding: Encoding,
    exponent: bool,
    last_end: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Units {
    None,
    Brackets,
    Row,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    Utf8,
    Utf8Mark,
    Utf16Le,
    Utf16Be,
    Latin1,
}

const NAMES: [&str; 6] = ["time", "Drehmoment_M°", "q[1]", "vel.x", "I (1)", "x"];
const UNITS: [&str; 6] = ["s", "Nm", "rad", "mm/s", "A", "µm"];

fn dialect() -> impl Strategy<Value = Dialect> {
    let flag = any::<bool>;
    let pick = |choices: &'static [&'static str]| prop::sample::select(choices);
    let encoding = prop::sample::select(
        &[
            Encoding::Utf8,
            Encoding::Utf8Mark,
            Encoding::Utf16Le,
            Encoding::Utf16Be,
            Encoding::Latin1,
        ][..],
    );
    (
        (pick(&[",", ";", "\t", "|", " ", "   "]), flag(), flag()),
        prop::sample::select(&[Units::None, Units::Brackets, Units::Row][..]),
        (
            pick(&["\n", "\r\n", "\r"]),
            prop::collection::vec(pick(&["#", "%", "//"]), 0..3),
        ),
        (flag(), flag(), flag(), flag(), flag()),
        encoding,
    )
        .prop_map(
            |((separator, comma, header), units, (end, remarks), flags, encoding)| {
                let (padded, quoted, trailing, exponent, last_end) = flags;
                Dialect {
                    separator,
                    comma,
                    header,
                    units,
                    end,
                    remarks,
                    padded,
                    quoted,
                    trailing,
                    encoding,
                    exponent,
                    last_end,
                }
            },
        )
        .prop_filter("a comma is not both", |d| {
            !(d.comma && d.separator == "," && !d.quoted)
        })
}

fn value() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |v| v.is_finite()),
        4 => (-1e4..1e4_f64).prop_map(|v| (v * 1e3).round() / 1e3),
        2 => (-5_i32..5).prop_map(f64::from),
        1 => prop::sample::select(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, 5e-324][..]),
    ]
}

fn table() -> impl Strategy<Value = Vec<Vec<f64>>> {
    (1_usize..=6, 2_usize..30).prop_flat_map(|(width, rows)| {
        prop::collection::vec(prop::collection::vec(value(), width), rows)
    })
}

fn write(rows: &[Vec<f64>], d: &Dialect) -> Vec<u8> {
    let blanks = d.separator.trim().is_empty() && d.separator != "\t";
    let pad = if d.padded && !blanks && !d.quoted {
        " "
    } else {
        ""
    };
    let quote = |cell: String| {
        if d.quoted {
            format!("\"{cell}\"")
        } else {
            cell
        }
    };
    let line = |cells: Vec<String>| {
        let cells: Vec<String> = cells
            .into_iter()
            .map(|c| format!("{pad}{}{pad}", quote(c)))
            .collect();
        let tail = if d.trailing { d.separator } else { "" };
        format!("{}{tail}{}", cells.join(d.separator), d.end)
    };
    let width = rows[0].len();
    let mut text = String::new();
    for mark in &d.remarks {
        // More cells than a table has columns, whatever separates them.
        let remark = "so, 1; 2,5 | it\tis ".repeat(8);
        text += &format!("{mark} {remark}{}", d.end);
    }
    if d.header {
        let unit = |c: usize| {
            if d.units == Units::Brackets {
                format!(" [{}]", UNITS[c])
            } else {
                String::new()
            }
        };
        text += &line(
            (0..width)
                .map(|c| {
                    format!(
                        "{}{}",
                        if blanks {
                            NAMES[c].replace(' ', "")
                        } else {
                            NAMES[c].to_owned()
                        },
                        unit(c)
                    )
                })
                .collect(),
        );
        if d.units == Units::Row {
            text += &line((0..width).map(|c| UNITS[c].to_owned()).collect());
        }
    }
    for row in rows {
        let number = |v: &f64| {
            let text = match v {
                v if v.is_nan() => return "NaN".to_owned(),
                v if v.is_infinite() => {
                    return if *v > 0.0 {
                        "inf".to_owned()
                    } else {
                        "-Inf".to_owned()
                    };
                }
                v if d.exponent => format!("{v:e}"),
                v => format!("{v:?}"),
            };
            if d.comma {
                text.replace('.', ",")
            } else {
                text
            }
        };
        text += &line(row.iter().map(number).collect());
    }
    if !d.last_end {
        text.truncate(text.len() - d.end.len());
    }
    let wide = |encode: fn(u16) -> [u8; 2]| -> Vec<u8> {
        "\u{FEFF}"
            .encode_utf16()
            .chain(text.encode_utf16())
            .flat_map(encode)
            .collect()
    };
    match d.encoding {
        Encoding::Utf8 => text.into_bytes(),
        Encoding::Utf8Mark => format!("\u{FEFF}{text}").into_bytes(),
        Encoding::Utf16Le => wide(u16::to_le_bytes),
        Encoding::Utf16Be => wide(u16::to_be_bytes),
        Encoding::Latin1 => text
            .chars()
            .map(|c| u8::try_from(u32::from(c)).unwrap())
            .collect(),
    }
}

/// Whether the first row is 0, 1, 2 ... or 1, 2, 3 ..., which may be column numbers.
fn counts(rows: &[Vec<f64>]) -> bool {
    let from = |start: f64| {
        rows[0]
            .iter()
            .enumerate()
            .all(|(n, v)| *v == start + n as f64)
    };
    rows[0].len() > 2 && (from(0.0) || from(1.0))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn a_table_comes_back_from_every_dialect(rows in table(), d in dialect()) {
        let bytes = write(&rows, &d);
        let width = rows[0].len();
        // A column of nothing but missing values is left out; a first row of nothing but missing
        // values is no sample to start with.
        prop_assume!((0..width).all(|c| rows.iter().any(|r| !r[c].is_nan())));
        prop_assume!(rows[0].iter().any(|v| !v.is_nan()));
        let table = match detect(&bytes) {
            Ok(table) => table,
            Err(e) => {
                // Refusals must have their reason in the text: commas that could be both, a row that
                // could be a header.
                prop_assert_eq!(e.kind, Kind::Ambiguous, "{}", e);
                let text = String::from_utf8_lossy(&bytes);
                let commas = text.contains(',') && (d.separator == "," || (d.comma && width == 1));
                prop_assert!(!d.header || width == 1, "{}", e);
                prop_assert!(commas || counts(&rows), "{}", e);
                return Ok(());
            }
        };
        prop_assert_eq!(table.columns.len(), width, "{:?}", table.detected);
        for (c, column) in table.columns.iter().enumerate() {
            let same = column.values.len() == rows.len()
                && column.values.iter().zip(&rows).all(|(v, r)| {
                    v.to_bits() == r[c].to_bits() || (v.is_nan() && r[c].is_nan())
                });
            prop_assert!(same, "{:?} is not column {} of {:?}", column, c, rows);
            if d.header {
                let bare = |s: &str| s.replace(' ', "");
                prop_assert_eq!(bare(&column.name), bare(NAMES[c]));
                let unit = (d.units != Units::None).then_some(UNITS[c]);
                prop_assert_eq!(column.unit.as_deref(), unit);
            } else {
                prop_assert_eq!(column.name.as_str(), "");
            }
        }
    }
}
