//! `drift` as a user meets it, on tables as `batch` writes them.

use std::path::Path;
use std::process::{Command, Stdio};
use stiction_files::batch::{LogRow, ParameterRow, Results};

/// A table of machines with a log a day for 40 days, Coulomb friction of 20 N with noise; of the first it steps up by 15 % on day
/// 25 if `step`.
fn table(folder: &Path, machines: u32, days: u32, step: bool) {
    let mut out = Results::begin(&folder.join("results.parquet")).unwrap();
    let mut noise = 7_u32;
    for machine in 0..machines {
        for day in 0..days {
            let mut normal = 0.0;
            for _ in 0..12 {
                noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                normal += f64::from(noise) / f64::from(u32::MAX) - 0.5;
            }
            let changed = if step && machine == 0 && day >= 25 {
                1.15
            } else {
                1.0
            };
            let value = 20.0 * changed * (1.0 + 0.01 * normal);
            let row = LogRow {
                path: format!("logs/m{machine}-{day:02}.csv"),
                machine: Some(format!("M{machine}")),
                time: Some(1_772_323_200.0 + 86_400.0 * f64::from(day)),
                law: Some("lugre".into()),
                key: format!("{machine} {day}"),
                parameters: vec![coulomb(value)],
                ..LogRow::default()
            };
            out.add(&row).unwrap();
        }
    }
    out.end().unwrap();
}

/// Coulomb friction of that size, N, as it was identified.
fn coulomb(value: f64) -> ParameterRow {
    ParameterRow {
        name: "coulomb".into(),
        value: Some(value),
        unit: "N".into(),
        std: Some(0.1),
        low: Some(value - 0.196),
        high: Some(value + 0.196),
        identifiable: true,
        origin: "identified".into(),
    }
}

fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
    command
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null());
    crate::split(command.output().unwrap())
}

#[test]
fn a_step_is_an_alarm_with_its_day_its_size_and_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    table(at, 8, 40, true);
    let (code, out, err) = run(
        at,
        &[
            "drift",
            "results.parquet",
            "--limit",
            "coulomb > 1.1",
            "--out",
            "drift",
        ],
    );
    assert_eq!((code, err.as_str()), (1, ""));
    insta::assert_snapshot!(out);
    let report = std::fs::read_to_string(at.join("drift/report.html")).unwrap();
    assert!(report.contains("coulomb of M0 (lugre)") && report.contains("<svg"));
    let (code, json, _) = run(at, &["drift", "results.parquet", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(
        (
            code,
            &json["alarms"][0]["machine"],
            &json["alarms"][0]["kind"]
        ),
        (1, &"M0".into(), &"step".into())
    );
}

#[test]
fn what_is_quiet_is_said_and_ends_well() {
    let folder = tempfile::tempdir().unwrap();
    table(folder.path(), 8, 40, false);
    let (code, out, err) = run(folder.path(), &["drift", "results.parquet"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("\nnothing changed\n"), "{out}");
    assert!(
        out.ends_with("next: stiction drift results.parquet --out drift\n"),
        "{out}"
    );
    table(folder.path(), 2, 9, false);
    let (code, out, _) = run(folder.path(), &["drift", "results.parquet"]);
    assert_eq!(code, 0);
    assert!(
        out.contains("2 of them have fewer than 15 logs")
            && out.contains("too few logs to follow anything"),
        "{out}"
    );
    // A limit asks for no course: the logs as they stand are beyond it or not.
    for (limit, expected) in [("coulomb > 1 N", 1), ("coulomb > 1000 N", 0)] {
        let (code, out, _) = run(
            folder.path(),
            &["drift", "results.parquet", "--limit", limit],
        );
        assert_eq!(code, expected, "{out}");
    }
}

#[test]
fn logs_without_a_machine_and_fleets_of_few_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let mut out = Results::begin(&at.join("results.parquet")).unwrap();
    for k in 0..20 {
        let row = LogRow {
            path: format!("{k}.csv"),
            law: Some("lugre".into()),
            key: k.to_string(),
            parameters: vec![coulomb(20.0 + 0.1 * f64::from(k % 3))],
            ..LogRow::default()
        };
        out.add(&row).unwrap();
    }
    out.end().unwrap();
    let (code, out, err) = run(at, &["drift", "results.parquet"]);
    assert_eq!((code, err.as_str()), (0, ""));
    insta::assert_snapshot!(out);
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    table(at, 2, 20, false);
    let refused = |arguments: &[&str]| {
        let (code, out, err) = run(at, arguments);
        assert_eq!((code, out.as_str()), (2, ""));
        err
    };
    let limit = |text: &str| refused(&["drift", "results.parquet", "--limit", text]);
    insta::assert_snapshot!(
        [
            limit("coulomb"),
            limit("coulom > 1.3"),
            limit("coulomb > 3 A"),
            refused(&["drift", "none.parquet"])
        ]
        .concat()
    );
    let batch = r#"{"schema": "stiction.batch/1", "version": "0", "status": "interrupted", "options": {"law": "lugre",
        "method": "separable", "seed": "0", "asymmetric": "true", "axis": "my axis.toml"}, "inputs": ["logs"], "logs": 3,
        "identified": 1, "trustworthy": 1, "taken": 0, "failed": []}"#;
    std::fs::create_dir(at.join("half")).unwrap();
    std::fs::write(at.join("half/batch.json"), batch).unwrap();
    insta::assert_snapshot!("unfinished", refused(&["drift", "half/results.parquet"]));
    let with = |change: &dyn Fn(&mut LogRow)| {
        let row = |k: i32| {
            let mut row = LogRow {
                path: format!("{k}.csv"),
                machine: Some("A".into()),
                time: Some(1e9),
                law: Some("lugre".into()),
                key: k.to_string(),
                parameters: vec![coulomb(20.0)],
                ..LogRow::default()
            };
            change(&mut row);
            row
        };
        let mut out = Results::begin(&at.join("other.parquet")).unwrap();
        (0..20).for_each(|k| out.add(&row(k)).unwrap());
        out.end().unwrap();
        refused(&["drift", "other.parquet"])
    };
    insta::assert_snapshot!(
        "numbers",
        [
            with(&|_| ()),
            with(&|row| row.parameters[0].value = Some(1e200)),
            with(&|row| row.temperature = Some(f64::INFINITY)),
        ]
        .concat()
    );
    std::fs::write(at.join("results.parquet"), "path,parameter\n").unwrap();
    assert!(refused(&["drift", "results.parquet"]).contains("[log-format] results.parquet: "));
}

/// A folder of tables that holds one of them twice has each log once.
#[test]
fn a_table_that_lies_there_twice_counts_once() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("tables")).unwrap();
    table(&at("tables"), 3, 40, true);
    let (code, once, _) = run(folder.path(), &["drift", "tables", "--json"]);
    assert_eq!(code, 1);
    std::fs::copy(at("tables/results.parquet"), at("tables/more.parquet")).unwrap();
    let (code, twice, _) = run(folder.path(), &["drift", "tables", "--json"]);
    assert_eq!(code, 1);
    let alarms = |text: &str| {
        let file: serde_json::Value = serde_json::from_str(text).unwrap();
        (file["alarms"].clone(), file["input"]["logs"].clone())
    };
    assert_eq!(alarms(&once), alarms(&twice));
}

/// Twenty logs of one machine without times, which repeat to .2 % and whose intervals are ten times as wide.
fn alone(folder: &Path, name: &dyn Fn(u32) -> String, value: &dyn Fn(u32) -> f64) {
    let mut out = Results::begin(&folder.join("results.parquet")).unwrap();
    for k in 0..20 {
        let level = value(k) * (1.0 + 1e-3 * [0.0, 2.0, -1.5, 1.0, -2.5][k as usize * 3 % 5]);
        let row = LogRow {
            path: name(k),
            machine: Some("M".into()),
            law: Some("lugre".into()),
            key: k.to_string(),
            parameters: vec![ParameterRow {
                std: Some(0.02 * level),
                low: Some(level * (1.0 - 0.0392)),
                high: Some(level * (1.0 + 0.0392)),
                ..coulomb(level)
            }],
            ..LogRow::default()
        };
        out.add(&row).unwrap();
    }
    out.end().unwrap();
}

/// A step of one machine stands out of its own repeats, however wide intervals are, and what is quiet is drawn as well.
#[test]
fn one_machine_is_held_against_its_own_repeats() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let json = |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap();
    let name = |k: u32| format!("log_{k:02}.csv");
    alone(at, &name, &|k| if k < 12 { 20.0 } else { 25.0 });
    let (code, out, _) = run(
        at,
        &["drift", "results.parquet", "--out", "drift", "--json"],
    );
    let found = json(&out);
    let [alarm] = &found["alarms"].as_array().unwrap()[..] else {
        panic!("{out}");
    };
    assert_eq!(
        (code, &alarm["kind"], &alarm["since"]),
        (1, &"step".into(), &(13.0 * 86_400.0).into())
    );
    let size = alarm["size"].as_f64().unwrap();
    assert!(
        (size - 0.25).abs() < 0.01 && found.get("unclear").is_none(),
        "{out}"
    );
    alone(at, &name, &|_| 20.0);
    let (code, out, _) = run(at, &["drift", "results.parquet", "--out", "quiet"]);
    assert_eq!(code, 0);
    assert!(out.contains("\nnothing changed\n"), "{out}");
    for folder in ["drift", "quiet"] {
        let report = std::fs::read_to_string(at.join(folder).join("report.html")).unwrap();
        assert!(
            report.contains("coulomb of M (lugre)") && report.contains("<svg"),
            "{folder}"
        );
    }
    // Of logs that scatter by as much as the parameter itself nothing can be told.
    alone(at, &name, &|k| 20.0 * f64::from(2u32.pow(k * 7 % 5)));
    let (code, out, _) = run(at, &["drift", "results.parquet"]);
    assert_eq!(code, 0);
    assert!(
        out.contains("cannot tell") && !out.contains("nothing changed"),
        "{out}"
    );
}

/// Logs without a time may have dates in their names, or files that were written at different times.
#[test]
fn times_of_names_and_files_are_offered_and_taken() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let step = |k: u32| if k < 10 { 20.0 } else { 25.0 };
    // Every third day, in the table from the last to the first.
    alone(at, &|k| format!("axis_202603{:02}.csv", 30 - k), &|k| {
        step(19 - k)
    });
    let (_, out, _) = run(at, &["drift", "results.parquet", "--json"]);
    let found: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (&found["timed"], &found["times"]),
        (&false.into(), &serde_json::json!(["names"]))
    );
    let (code, out, _) = run(at, &["drift", "results.parquet", "--times", "names"]);
    assert_eq!(code, 1);
    assert!(
        out.contains("2026-03-21 00:00") && out.contains('+'),
        "{out}"
    );
    let (code, _, err) = run(at, &["drift", "results.parquet", "--times", "files"]);
    assert_eq!(code, 2);
    assert!(
        err.contains("axis_20260330.csv: there is no such file"),
        "{err}"
    );
    // Files with other times than their names have dates.
    alone(at, &|k| format!("{k}.csv"), &|_| 20.0);
    for k in 0..20u64 {
        let file = std::fs::File::create(at.join(format!("{k}.csv"))).unwrap();
        let time =
            std::time::UNIX_EPOCH + std::time::Duration::from_secs(1_772_323_200 + 86_400 * k);
        file.set_modified(time).unwrap();
    }
    let (code, out, _) = run(at, &["drift", "results.parquet"]);
    assert_eq!(code, 0);
    assert!(
        out.ends_with("next: stiction drift results.parquet --times files --out drift\n"),
        "{out}"
    );
    let (code, out, _) = run(
        at,
        &["drift", "results.parquet", "--times", "files", "--json"],
    );
    let found: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, &found["timed"]), (0, &true.into()), "{out}");
}
