//! A text of which only the columns are kept that a mapping may take is understood as the whole text.

use proptest::prelude::*;
use proptest::sample::select;
use std::path::Path;
use stiction_formats::{ReadOptions, Table, read_table, read_wanted};
use stiction_log::{Channel, Elsewhere, Enable, Joined, Log, Mapping, Offset, Role, Selector};

/// What columns are called: clear names, names that several axes have, errors and states, units that tell, nothing.
const HEADS: [&str; 26] = [
    "time [s]",
    "t",
    "stamp [ms]",
    "position [mm]",
    "Position",
    "x",
    "X act",
    "Y act",
    "IX [A]",
    "IY [A]",
    "velocity [mm/s]",
    "v",
    "force [N]",
    "torque [Nm]",
    "cmd force [N]",
    "reference [mm]",
    "acceleration [m/s2]",
    "oil temperature [degC]",
    "load",
    "Enabled",
    "following error [mm]",
    "spare",
    "bus [V]",
    "p1 [mm]",
    "note",
    "",
];

/// How the cells of a column run.
#[derive(Clone, Copy, Debug)]
enum Course {
    Stamps,
    Wave,
    Flag,
    Ones,
    Zeros,
    Empty,
    Late,
    Words,
    Day,
}

fn cell(course: Course, row: usize) -> String {
    let t = row as f64 * 0.001;
    match course {
        Course::Stamps => format!("{t:.3}"),
        Course::Wave => format!("{:.4}", 5.0 * (40.0 * t).sin()),
        Course::Flag => u8::from(row > 40).to_string(),
        Course::Ones => "1".into(),
        Course::Zeros => "0".into(),
        Course::Empty => String::new(),
        Course::Late if row < 30 => String::new(),
        Course::Late => format!("{}", row % 7),
        Course::Words if row.is_multiple_of(9) => "idle".into(),
        Course::Words => "run".into(),
        Course::Day => format!("23:59:59.{:03}", row * 10),
    }
}

/// A text with these columns and rows, and what stands below them.
fn text(columns: &[(&str, Course)], rows: usize, end: &str) -> String {
    let heads: Vec<&str> = columns.iter().map(|(head, _)| *head).collect();
    let mut out = format!("{}\n", heads.join(";"));
    for row in 0..rows {
        let cells: Vec<String> = columns.iter().map(|(_, c)| cell(*c, row)).collect();
        out.push_str(&cells.join(";"));
        out.push('\n');
    }
    out + end
}

fn columns() -> impl Strategy<Value = Vec<(&'static str, Course)>> {
    use Course::{Day, Empty, Flag, Late, Ones, Stamps, Wave, Words, Zeros};
    let course = select(vec![
        Stamps, Wave, Wave, Wave, Flag, Flag, Ones, Zeros, Empty, Late, Words, Day,
    ]);
    prop::collection::vec((select(HEADS.to_vec()), course), 2..9)
}

/// A column by a name or by a number.
fn selector() -> impl Strategy<Value = Selector> {
    prop_oneof![
        select(HEADS.to_vec()).prop_map(|name| Selector::Name(name.to_uppercase())),
        select(HEADS.to_vec()).prop_map(|name| {
            let bare = name.split(" [").next().unwrap_or(name);
            Selector::Name(bare.into())
        }),
        select(HEADS.to_vec()).prop_map(|name| Selector::Name(name.into())),
        (1_usize..10).prop_map(Selector::Index),
    ]
}

fn channel() -> impl Strategy<Value = Option<Channel>> {
    prop::option::weighted(
        0.4,
        selector().prop_map(|column| Channel {
            column,
            ..Channel::index(1)
        }),
    )
}

fn mapping() -> impl Strategy<Value = Mapping> {
    let rate = prop::option::weighted(0.3, Just(1000.0));
    let enable = prop::option::weighted(0.2, selector());
    let channels = (channel(), channel(), channel(), channel(), channel());
    (channels, rate, enable).prop_map(|((time, position, velocity, force, load), rate, enable)| {
        Mapping {
            time,
            position,
            velocity,
            force,
            load,
            rate_hz: rate,
            enable: enable.map(|column| Enable {
                column,
                equals: None,
                mask: None,
            }),
            ..Mapping::default()
        }
    })
}

/// A log, or what is said of it.
fn understood(
    table: Result<Table, stiction_formats::Error>,
    mapping: &Mapping,
) -> Result<Log, String> {
    table
        .and_then(|table| Log::of_table(table, mapping))
        .map_err(|e| format!("{e} {:?} {:?}", e.place, e.setting()))
}

fn both(
    file: &Path,
    wanted: &dyn Fn(&Table) -> Vec<bool>,
) -> [Result<Table, stiction_formats::Error>; 2] {
    let options = ReadOptions::default();
    [
        read_table(file, &options),
        read_wanted(file, &options, |_| {}, wanted),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn a_log_is_the_same_with_the_columns_that_it_may_take(
        columns in columns(),
        mapping in prop_oneof![1 => Just(Mapping::default()), 3 => mapping()],
        rows in 1_usize..120,
        end in select(vec!["", "", "EOF\n", "1;0;\n", "idle;1;2;3;4;5;6;7;8\nEOF;1\n", "run;1;x;0\n"]),
    ) {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text(&columns, rows, end)).unwrap();
        let [whole, wanted] = both(file.path(), &|heads| mapping.wanted(heads));
        if let (Ok(whole), Ok(wanted)) = (&whole, &wanted) {
            for (index, column) in wanted.columns.iter().enumerate() {
                let kept = !wanted.passed.contains_key(&index);
                let values = &whole.columns[index].values;
                let same = column.values.iter().map(|x| x.to_bits()).eq(values.iter().map(|x| x.to_bits()));
                let as_told = if kept { same } else { column.values.is_empty() };
                prop_assert!(as_told, "column {}", index);
            }
        }
        prop_assert_eq!(understood(whole, &mapping), understood(wanted, &mapping));
    }
}

#[test]
fn columns_that_nobody_asks_for_are_checked_and_not_kept() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let columns = [
        ("time [s]", Course::Stamps),
        ("bus [V]", Course::Wave),
        ("position [mm]", Course::Wave),
        ("ready", Course::Flag),
        ("force [N]", Course::Wave),
        ("spare", Course::Late),
    ];
    let mapping = Mapping {
        position: Some(Channel::named("position")),
        force: Some(Channel::named("force")),
        ..Mapping::default()
    };
    let wanted = |heads: &Table| mapping.wanted(heads);
    std::fs::write(file.path(), text(&columns, 100, "")).unwrap();
    let [whole, kept] = both(file.path(), &wanted);
    let kept = kept.unwrap();
    let lengths: Vec<usize> = kept.columns.iter().map(|c| c.values.len()).collect();
    assert_eq!(lengths, [100, 0, 100, 0, 100, 0]);
    assert_eq!(kept.rows(), whole.unwrap().rows());
    // A cell that cannot be read is refused wherever it stands.
    std::fs::write(file.path(), text(&columns, 100, "0.1;1;1;maybe;1;2\n")).unwrap();
    let [whole, kept] = both(file.path(), &wanted);
    assert_eq!(
        kept.unwrap_err().to_string(),
        whole.unwrap_err().to_string()
    );
}

#[test]
fn of_another_file_its_column_and_its_stamps_are_kept() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let columns = [
        ("stamp [s]", Course::Stamps),
        ("bus [V]", Course::Wave),
        ("torque [Nm]", Course::Wave),
    ];
    std::fs::write(file.path(), text(&columns, 100, "")).unwrap();
    let from = Elsewhere {
        role: Role::Force,
        time: None,
        offset: Offset::Given(0.0),
    };
    let channel = Channel::named("torque");
    let [whole, kept] = both(file.path(), &|heads| from.wanted(&channel, heads));
    let kept = kept.unwrap();
    assert_eq!(kept.passed.keys().collect::<Vec<_>>(), [&1]);
    let log = || {
        let mut log = whole.as_ref().unwrap().clone();
        log.columns[2].name = "angle".into();
        log.columns[2].unit = Some("deg".into());
        log
    };
    let mapping = Mapping {
        force: Some(channel.clone()),
        ..Mapping::default()
    };
    let joined = |other: &Table| {
        let mut joined = Joined::new(log(), &mapping);
        joined.join("tau.csv", other, &from).unwrap();
        Log::from_joined(&joined).unwrap()
    };
    assert_eq!(joined(&kept), joined(whole.as_ref().unwrap()));
}

#[test]
fn numbers_beyond_the_whole_ones_are_said_of_columns_that_are_not_kept_too() {
    let row = |n: u32| format!("{n};{}.5;{}\n", n % 7, n % 2);
    let rows: String = (0..40).map(row).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.txt");
    std::fs::write(&path, format!("t [s];F [N];spare\n{rows}40;1.5;-1e308\n")).unwrap();
    let force = |heads: &Table| heads.columns.iter().map(|c| c.name != "spare").collect();
    let part = read_wanted(&path, &ReadOptions::default(), |_| {}, &force).unwrap();
    let whole = read_table(&path, &ReadOptions::default()).unwrap();
    assert_eq!(part.detected, whole.detected);
    assert!(part.detected.iter().any(|said| said.contains("2^53")));
}

#[test]
fn lost_samples_of_halsampler_are_counted_where_nothing_but_a_force_is_kept() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let rows: Vec<String> = (0..100)
        .filter(|n| !(50..53).contains(n))
        .map(|n| {
            let mark = if n == 53 { "overrun\n" } else { "" };
            format!(
                "{mark}{n} {:.3} {:.3} 7\n",
                f64::from(n).sin(),
                f64::from(n).cos()
            )
        })
        .collect();
    std::fs::write(file.path(), rows.concat()).unwrap();
    let mapping = Mapping {
        position: Some(Channel::index(2)),
        force: Some(Channel::index(3)),
        rate_hz: Some(1000.0),
        ..Mapping::default()
    };
    let [whole, kept] = both(file.path(), &|heads| mapping.wanted(heads));
    let kept = kept.unwrap();
    assert_eq!(kept.passed.keys().collect::<Vec<_>>(), [&3]);
    assert_eq!(kept.detected, whole.as_ref().unwrap().detected);
    assert_eq!(understood(Ok(kept), &mapping), understood(whole, &mapping));
}
