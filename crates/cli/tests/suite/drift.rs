//! `drift` as a user meets it, on tables as `batch` writes them.

use std::path::Path;
use std::process::{Command, Stdio};
use stiction::commands::batch::{LogRow, ParameterRow, Results};

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
