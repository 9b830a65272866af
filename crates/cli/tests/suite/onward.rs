//! What is refused leads on: by a command that works, or by the key and the value that settle it.

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use stiction_files::batch::{LogRow, ParameterRow, Results};

/// A carriage of 10 kg with Coulomb friction of 20 N on a sine, positions in millimetres under a heading of this unit.
fn log(file: &Path, unit: &str, samples: u32) {
    log_at(file, unit, samples, 1000.0);
}

/// The same with this sample rate, Hz.
fn log_at(file: &Path, unit: &str, samples: u32, rate: f64) {
    let mut text = format!("time [s],position [{unit}],force [N]\n");
    for k in 0..samples {
        let w = 2.0 * std::f64::consts::PI;
        let t = f64::from(k) / rate;
        let (x, v) = (30.0 * (w * t).sin(), 0.03 * w * (w * t).cos());
        let noise = f64::from(k.wrapping_mul(2_654_435_761) >> 16) / 65_536.0 - 0.5;
        let force = 20.0 * (v / 1e-3).tanh() + 50.0 * v - 10.0 * w * w * 1e-3 * x + 0.2 * noise;
        let _ = writeln!(text, "{t},{x:.5},{force:.4}");
    }
    std::fs::write(file, text).unwrap();
}

fn run(folder: &Path, line: &str) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
    command
        .args(line.split_whitespace())
        .current_dir(folder)
        .stdin(Stdio::null());
    crate::split(command.output().unwrap())
}

/// The command behind the last `next`.
fn next(said: &str) -> String {
    let next = said.rsplit_once("next: stiction ");
    let (_, next) = next.unwrap_or_else(|| panic!("{said}"));
    next.lines().next().unwrap().to_owned()
}

#[test]
fn what_is_no_regular_file_is_refused_by_name_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(&at.join("log.csv"), "mm", 3000);
    let made = Command::new("mkfifo").arg(at.join("pipe")).status();
    assert!(made.unwrap().success());
    for (path, what) in [
        ("pipe", "a pipe"),
        ("/dev/zero", "a device"),
        ("/proc/self/mem", "a file of the kernel"),
        ("/proc/kmsg", "a file of the kernel"),
    ] {
        for line in [
            format!("check {path}"),
            format!("check log.csv --axis {path}"),
            format!("identify log.csv --axis {path} --out out"),
            format!("identify log.csv --out out --method ga --resume {path}"),
            format!("batch {path} --out out"),
            format!("batch log.csv --axis {path} --out out"),
            format!("drift {path}"),
            format!("plan {path} --out out"),
            format!("simulate {path} --out out"),
            format!("export {path} --target c --out out"),
        ] {
            let (code, _, err) = run(at, &line);
            assert_eq!(code, 2, "{line}: {err}");
            assert!(err.contains(&format!("{path}: {what}")), "{line}: {err}");
            assert!(err.contains("next"), "{line}: {err}");
            assert!(!at.join("out").exists(), "{line}");
        }
    }
}

#[test]
fn a_log_that_is_only_validated_on_leads_to_all_that_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(&at.join("a.csv"), "mm", 4000);
    log(&at.join("b.csv"), "mm", 3500);
    let listed = "[[log]]\nfile = \"a.csv\"\n[[log]]\nfile = \"b.csv\"\nvalidate = \"all\"\n";
    std::fs::write(at.join("axis.toml"), listed).unwrap();
    let (_, out, _) = run(at, "check b.csv --axis axis.toml");
    let leads = next(&out);
    assert_eq!(leads, "identify --axis axis.toml --out result");
    let (code, _, err) = run(at, &leads);
    assert!(code <= 1, "{err}");
    let alone = "[[log]]\nfile = \"b.csv\"\nvalidate = \"all\"\n";
    std::fs::write(at.join("alone.toml"), alone).unwrap();
    let (_, out, _) = run(at, "check --axis alone.toml");
    assert!(
        out.contains("leave validate = \"all\" out of [[log]]"),
        "{out}"
    );
    let (code, _, err) = run(at, "identify --axis alone.toml --out alone");
    assert_eq!(code, 2);
    assert!(
        err.contains("alone.toml: line 3, column 12, log[1].validate"),
        "{err}"
    );
}

#[test]
fn one_log_by_two_paths_is_refused_by_check_as_by_identify() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::create_dir(at.join("sub")).unwrap();
    log(&at.join("a.csv"), "mm", 3000);
    let listed = "[[log]]\nfile = \"a.csv\"\n[[log]]\nfile = \"sub/../a.csv\"\n";
    std::fs::write(at.join("axis.toml"), listed).unwrap();
    let said = [
        "check --axis axis.toml",
        "identify --axis axis.toml --out out",
    ]
    .map(|line| {
        let (code, _, err) = run(at, line);
        assert_eq!(code, 2);
        err.lines().next().unwrap().to_owned()
    });
    assert_eq!(said[0], said[1]);
    assert!(said[0].contains("log[2].file"), "{}", said[0]);
    for line in [
        "check a.csv sub/../a.csv",
        "identify a.csv sub/../a.csv --out out",
    ] {
        let (code, _, err) = run(at, line);
        assert_eq!(code, 2);
        assert!(err.contains("are the same log"), "{err}");
        assert_eq!(next(&err), line.replace(" sub/../a.csv", ""), "{err}");
    }
    // Two names of one file on the disk, or a copy of it.
    std::fs::hard_link(at.join("a.csv"), at.join("b.csv")).unwrap();
    std::fs::copy(at.join("a.csv"), at.join("c.csv")).unwrap();
    for twin in ["b.csv", "c.csv"] {
        for line in [
            format!("check a.csv {twin}"),
            format!("identify a.csv {twin} --out out"),
        ] {
            let (code, _, err) = run(at, &line);
            assert_eq!(code, 2);
            assert!(
                err.contains(&format!("a.csv and {twin} are the same log")),
                "{err}"
            );
            assert_eq!(next(&err), line.replace(&format!(" {twin}"), ""), "{err}");
        }
        let listed = format!("[[log]]\nfile = \"a.csv\"\n[[log]]\nfile = \"{twin}\"\n");
        std::fs::write(at.join("axis.toml"), listed).unwrap();
        for line in [
            "check --axis axis.toml",
            "identify --axis axis.toml --out out",
        ] {
            let (code, _, err) = run(at, line);
            assert_eq!(code, 2);
            assert!(err.contains(&format!("{twin} are the same log")), "{err}");
        }
    }
}

#[test]
fn a_checkpoint_is_kept_apart_from_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(&at.join("a.csv"), "mm", 1500);
    for checkpoint in ["out/result.json", "out/study.toml", "out", "./out/fit.csv"] {
        let line = format!(
            "identify a.csv --law lugre --method ga --evaluations 60 --out out --checkpoint {checkpoint}"
        );
        let (code, _, err) = run(at, &line);
        assert_eq!(code, 2, "{err}");
        assert!(err.contains("is where the result is written"), "{err}");
        let leads = next(&err);
        assert!(
            leads.ends_with("--out out --checkpoint out.checkpoint"),
            "{leads}"
        );
    }
    let (code, _, err) = run(
        at,
        "identify a.csv --method ga --evaluations 60 --out out --checkpoint a.csv",
    );
    assert_eq!(code, 2, "{err}");
}

#[test]
fn times_have_units_in_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for line in [
        "identify none.csv --method ga --time 30s --out out",
        "identify none.csv --method ga --time 0.5min --out out",
        "plan none.toml --time 9s --out out",
        "export none.toml --target c --cycle-time 250us --ramp 50ms --window 2s --out out",
    ] {
        let (_, _, err) = run(at, line);
        assert!(err.contains("none."), "{line}: {err}");
    }
    let (code, _, err) = run(at, "identify none.csv --time 30x --out out");
    assert_eq!(code, 2);
    assert!(err.contains("in seconds or with its unit"), "{err}");
}

#[test]
fn a_setting_that_leaves_nothing_is_named_with_a_value_that_leaves_something() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(&at.join("a.csv"), "mm", 6000);
    for (key, line) in [
        ("min_speed", "min_speed = \"5 m/s\""),
        ("decimate", "decimate = 10000"),
    ] {
        let written = |line: &str| {
            std::fs::write(at.join("axis.toml"), format!("[conditioning]\n{line}\n")).unwrap();
        };
        written(line);
        let (_, out, _) = run(at, "check a.csv --axis axis.toml");
        assert!(!out.contains("output-error"), "{out}");
        let (code, _, err) = run(at, "identify a.csv --axis axis.toml --out out");
        assert_eq!(code, 2);
        let (_, instead) = err
            .split_once(&format!("in place of the line {key} write "))
            .unwrap();
        let (instead, _) = instead.split_once(", or leave it out").unwrap();
        assert!(out.contains(instead), "{out}");
        written(instead);
        let (code, _, err) = run(
            at,
            "identify a.csv --axis axis.toml --law coulomb-viscous --out out",
        );
        assert!(code <= 1, "{err}");
    }
}

#[test]
fn a_folder_that_is_taken_and_a_table_of_too_few_logs_lead_on() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::create_dir(at.join("logs")).unwrap();
    log(&at.join("logs/a.csv"), "mm", 6000);
    let (code, _, err) = run(at, "identify logs/a.csv --law coulomb-viscous --out result");
    assert!(code <= 1, "{err}");
    std::fs::create_dir(at.join("result/c")).unwrap();
    std::fs::write(at.join("result/c/own.c"), "int x;\n").unwrap();
    let (code, _, err) = run(at, "export result/model.toml --target c --out result/c");
    assert_eq!(code, 2);
    let leads = next(&err);
    assert_eq!(
        leads,
        "export result/model.toml --target c --out result/c-2"
    );
    let (code, _, err) = run(at, &leads);
    assert!(code <= 1, "{err}");
    // The folder of what is written alone is another one.
    let (code, _, err) = run(at, "batch logs --law coulomb-viscous --out logs");
    assert_eq!(
        (code, next(&err).as_str()),
        (2, "batch logs --law coulomb-viscous --out logs-2"),
        "{err}"
    );
    let (_, out, _) = run(at, "batch logs --law coulomb-viscous --out batch");
    assert!(out.contains("15 logs of one machine"), "{out}");
    assert_eq!(
        next(&out),
        "batch logs --law coulomb-viscous --out batch --resume"
    );
    let (code, _, err) = run(at, &next(&out));
    assert!(code <= 1, "{err}");
}

/// Levels of one axis file a thousand times apart are of two units.
#[test]
fn levels_of_one_axis_file_that_are_far_apart_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (name, samples) in [("m.csv", 3000), ("mm.csv", 3001)] {
        log(&at.join(name), "mm", samples);
    }
    let mut table = Results::begin(&at.join("results.parquet")).unwrap();
    for (day, mass) in [10.0, 10.1, 0.0101].into_iter().enumerate() {
        let row = LogRow {
            path: if mass > 1.0 { "mm.csv" } else { "m.csv" }.into(),
            law: Some("lugre".into()),
            key: day.to_string(),
            parameters: vec![ParameterRow {
                name: "mass".into(),
                value: Some(mass),
                unit: "kg".into(),
                std: Some(0.01 * mass),
                low: Some(0.98 * mass),
                high: Some(1.02 * mass),
                identifiable: true,
                origin: "identified".into(),
            }],
            ..LogRow::default()
        };
        table.add(&row).unwrap();
    }
    table.end().unwrap();
    let (code, out, err) = run(at, "drift results.parquet");
    assert_eq!((code, err.as_str()), (1, ""), "{out}");
    insta::assert_snapshot!(out);
    let leads = next(&out);
    let (code, _, err) = run(at, &leads);
    assert!(code <= 1, "{err}");
}

/// A link is no file of the result: it stays, under another name, and what it leads to is not touched.
#[test]
fn a_link_in_the_folder_of_a_result_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(&at.join("a.csv"), "mm", 3000);
    let line = "identify a.csv --law coulomb-viscous --out result";
    assert!(run(at, line).0 <= 1);
    let model = at.join("result/model.toml");
    std::fs::rename(&model, at.join("own.toml")).unwrap();
    std::fs::write(at.join("own.toml"), "# own\n").unwrap();
    std::os::unix::fs::symlink(at.join("own.toml"), &model).unwrap();
    let (code, _, err) = run(at, line);
    assert!(code <= 1 && err.contains("model.toml is a link"), "{err}");
    assert!(at.join("result/model-1.toml").is_symlink() && !model.is_symlink());
    let own = std::fs::read_to_string(at.join("own.toml")).unwrap();
    assert_eq!(own, "# own\n");
}

/// A force that brakes throughout has the other sign, and the axis file that is begun says so.
#[test]
fn the_sign_of_a_force_that_brakes_is_turned_in_an_axis_file() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(&at.join("a.csv"), "mm", 4000);
    let text = std::fs::read_to_string(at.join("a.csv")).unwrap();
    let turned = text.lines().map(|row| match row.rsplit_once(',') {
        Some((rest, force)) if !force.starts_with('f') => {
            format!("{rest},{}\n", -force.parse::<f64>().unwrap())
        }
        _ => format!("{row}\n"),
    });
    std::fs::write(at.join("a.csv"), turned.collect::<String>()).unwrap();
    let (_, out, _) = run(at, "check a.csv");
    assert!(out.contains("[force-sign]"), "{out}");
    let (_, out, _) = run(at, "check a.csv --init axis.toml");
    assert!(out.contains("force, its sign turned"), "{out}");
    let axis = std::fs::read_to_string(at.join("axis.toml")).unwrap();
    assert!(
        axis.contains("invert = true }    # its sign is turned"),
        "{axis}"
    );
    let (_, out, _) = run(at, "check a.csv --axis axis.toml");
    assert!(!out.contains("[force-sign]"), "{out}");
}

/// What an estimated offset is off is part of the delay that a fit finds.
#[test]
fn beside_an_estimated_offset_no_delay_is_a_constant() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let (mut motion, mut force) = (
        "time [s],position [mm]\n".to_owned(),
        "time [s],position [mm],force [N]\n".to_owned(),
    );
    for k in 0..8000_u32 {
        let t = f64::from(k) / 1000.0;
        let turn = 2.0 * std::f64::consts::PI;
        let (phase, rate) = (turn * (0.4 * t + 0.12 * t * t), turn * (0.4 + 0.24 * t));
        let (x, v) = (30.0 * phase.sin(), 0.03 * rate * phase.cos());
        let a = 0.03 * (turn * 0.24 * phase.cos() - rate * rate * phase.sin());
        let noise = f64::from(k.wrapping_mul(2_654_435_761) >> 16) / 65_536.0 - 0.5;
        let f = 20.0 * (v / 1e-3).tanh() + 50.0 * v + 10.0 * a + 0.2 * noise;
        let _ = writeln!(motion, "{t},{x:.5}");
        let _ = writeln!(force, "{:.3},{x:.5},{f:.4}", t + 0.3);
    }
    std::fs::write(at.join("a.csv"), motion).unwrap();
    std::fs::write(at.join("tau.csv"), force).unwrap();
    let constants = |offset: &str| -> Vec<String> {
        let axis = format!(
            "[columns]\ntime = \"time\"\nposition = \"position\"\nforce = {{ file = \"tau.csv\", column = \"force\", offset = \"{offset}\" }}\n"
        );
        std::fs::write(at.join("axis.toml"), axis).unwrap();
        let line = "identify a.csv --axis axis.toml --law coulomb-viscous --json --out out";
        let (_, out, err) = run(at, line);
        let json: serde_json::Value =
            serde_json::from_str(&out).unwrap_or_else(|_| panic!("{err}"));
        let names = json["trust"]["constants"].as_array().unwrap().iter();
        names
            .map(|name| name.as_str().unwrap().to_owned())
            .collect()
    };
    let known = constants("-0.3 s");
    assert!(known.iter().any(|name| name == "delay"), "{known:?}");
    let estimated = constants("estimate");
    assert!(
        estimated.iter().any(|name| name == "coulomb"),
        "{estimated:?}"
    );
    assert!(
        !estimated.iter().any(|name| name == "delay"),
        "{estimated:?}"
    );
}

/// Every line that leads to an export has the cycle time of the log, and one without it is told what it is.
#[test]
fn exports_have_the_cycle_of_the_log() {
    for (rate, option) in [
        (500.0, "--cycle-time 0.002"),
        (1000.0, "--cycle-time 0.001"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        log_at(&at.join("log.csv"), "mm", 4000, rate);
        let (code, out, err) = run(at, "identify log.csv --law dahl --out result");
        assert!(code <= 1, "{out}{err}");
        let leads = next(&out);
        assert!(leads.contains(option), "{leads}");
        for misplaced in [
            "identify result/model.toml --out out",
            "export result/model.toml",
        ] {
            let (code, _, err) = run(at, misplaced);
            assert_eq!(code, 2, "{err}");
            let (_, line) = err.rsplit_once("stiction export ").unwrap();
            assert!(
                line.lines().next().unwrap().contains(option),
                "{misplaced}: {err}"
            );
        }
        let (code, out, err) = run(at, &leads);
        assert!(code <= 1, "{err}");
        assert!(
            !format!("{out}{err}").contains("[export-rate]"),
            "{out}{err}"
        );
        let (code, out, err) = run(at, "export result/model.toml --target c --out plain");
        assert!(code <= 1, "{err}");
        let warned = format!("{out}{err}").contains("[export-rate]");
        assert_eq!(warned, rate != 1000.0, "{out}{err}");
    }
}

/// A split that leaves too few samples leads to one that leaves enough, or where there is none to the whole log.
#[test]
fn a_split_leads_to_one_that_works() {
    for samples in [1500, 2500] {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        log(&at.join("log.csv"), "mm", samples);
        let mut line = "identify log.csv --law maxwell-slip --split .1 --out out".to_string();
        let mut codes = Vec::new();
        for _ in 0..3 {
            let (code, _, err) = run(at, &line);
            codes.push(code);
            if code <= 1 {
                break;
            }
            assert_ne!(next(&err), line, "{err}");
            line = next(&err);
        }
        assert!(
            codes.len() > 1 && codes.last() <= Some(&1),
            "{codes:?}: {line}"
        );
    }
}
