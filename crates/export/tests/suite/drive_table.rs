//! The numbers for drives: read back by Python, and put into what the drive's documentation says of them.

use crate::common::compiled::write;
use crate::common::{laws, model};
use crate::mujoco::python;
use stiction_export::{Model, Target, advice, export};
use stiction_friction::CoulombViscous;
use stiction_friction::compensator::Friction;

fn axis(friction: Friction<f64>, unit: &str, top: Option<f64>) -> Model {
    Model {
        force_unit: unit.into(),
        rotary: unit == "N m",
        top_speed: top,
        ..model(friction)
    }
}

fn text(model: &Model) -> String {
    let mut files = export(model, Target::DriveTable).unwrap();
    assert_eq!(files[0].path, "x_axis_drive_table.csv");
    String::from_utf8(files.remove(0).bytes).unwrap()
}

/// Drive, parameter, value and unit of every row, as the csv module of Python reads them.
const READ: &str = r##"
import csv
with open("x_axis_drive_table.csv", newline="") as file:
    rows = csv.DictReader(line for line in file if not line.startswith("#"))
    for row in rows:
        assert len(row) == 5 and None not in row and row["meaning"], row
        print(row["drive"], row["parameter"], repr(float(row["value"])), row["unit"], sep="|")
"##;

fn read(model: &Model) -> Vec<(String, f64, String)> {
    let dir = tempfile::tempdir().unwrap();
    write(&export(model, Target::DriveTable).unwrap(), dir.path());
    std::fs::write(dir.path().join("read.py"), READ).unwrap();
    let said = python("read.py", &[], dir.path());
    said.lines()
        .map(|line| {
            let parts: Vec<&str> = line.split('|').collect();
            let value = parts[2].parse().unwrap();
            (parts[1].into(), value, parts[3].into())
        })
        .collect()
}

fn value(rows: &[(String, f64, String)], parameter: &str) -> f64 {
    rows.iter().find(|row| row.0 == parameter).unwrap().1
}

fn steady(friction: &Friction<f64>, v: f64) -> f64 {
    match friction {
        Friction::Coulomb(law) => law.force(v),
        law => law.curve().unwrap().force(v),
    }
}

/// Root of the mean square and largest difference from a law over speeds to `top` both ways.
fn off(law: &Friction<f64>, top: f64, force: impl Fn(f64) -> f64) -> [f64; 2] {
    let n = 200_000;
    let (mut sum, mut most) = (0.0, 0.0_f64);
    for k in 0..n {
        let v = top * (f64::from(k) + 0.5) / f64::from(n);
        for v in [v, -v] {
            let off = steady(law, v) - force(v);
            sum += off * off;
            most = most.max(off.abs());
        }
    }
    for v in [1e-300, -1e-300, top, -top] {
        most = most.max((steady(law, v) - force(v)).abs());
    }
    [(sum / (2.0 * f64::from(n))).sqrt(), most]
}

fn number(text: &str) -> f64 {
    text.split(' ').next().unwrap().parse().unwrap()
}

/// What is stated for a drive: root of the mean square and largest.
fn stated(text: &str, drive: &str) -> [f64; 2] {
    let line = text.lines().find(|l| l.starts_with(&format!("# {drive}:")));
    let line = line.unwrap();
    let rms = line.split("off by ").nth(1).unwrap();
    let most = line.split(" rms").nth(1).unwrap();
    let most = most.split(", ").nth(1).unwrap();
    [number(rms), number(most)]
}

#[test]
fn the_error_is_the_one_that_is_stated() {
    for (name, law) in laws() {
        for top in [0.02, 0.3] {
            for unit in ["N", "A"] {
                let model = axis(law, unit, Some(top));
                let rows = read(&model);
                let get = |parameter| value(&rows, parameter);
                let text = text(&model);
                let check = |drive: &str, force: &dyn Fn(f64) -> f64| {
                    let due = off(&law, top, force);
                    for (stated, due) in stated(&text, drive).into_iter().zip(due) {
                        let apart = (stated - due).abs();
                        assert!(apart <= 2e-3 * due + 1e-9, "{name} {drive}: {stated} {due}");
                    }
                    due[0]
                };
                if unit == "N" {
                    let (level, slope) = (get("0x3144:02"), get("0x3144:03"));
                    check("Beckhoff AX8000 and AMP8000", &|v| {
                        level * v.signum() + slope * v
                    });
                    continue;
                }
                let (level, offset) = (get("IL.FRICTION"), get("IL.OFFSET"));
                let least = check("Kollmorgen AKD and AKD2G", &|v| level * v.signum() + offset);
                let (most, rise) = (get("ISTFR"), get("VSTFR"));
                let ramp = |v: f64| (v / rise).clamp(-1.0, 1.0);
                let least_ramp = check("Beckhoff AX2000", &|v| most * ramp(v));
                // No other numbers are nearer.
                for share in [0.99, 1.01] {
                    let other = off(&law, top, |v| share * level * v.signum() + offset);
                    assert!(other[0] > least, "{name}");
                    let other = off(&law, top, |v| share * most * ramp(v));
                    assert!(other[0] > least_ramp, "{name}");
                }
            }
        }
    }
}

/// 20 and 14 with slopes of 60 and 85 about an offset of -3, over speeds to 0.1: 17 + 72.5 v, of which the mean, and -12.5 v.
#[test]
fn in_closed_form() {
    let law = CoulombViscous::new([20.0, 14.0], [60.0, 85.0], -3.0).unwrap();
    let law = Friction::Coulomb(law);
    let rows = read(&axis(law, "A", Some(0.1)));
    assert_eq!(value(&rows, "IL.FRICTION"), 20.625);
    assert_eq!(value(&rows, "IL.OFFSET"), -0.625);
    assert_eq!(value(&rows, "VSTFR"), 1e-4);
    assert!((value(&rows, "ISTFR") - 20.63).abs() < 0.02);
    let rows = read(&axis(law, "N m", Some(0.1)));
    let units: Vec<&str> = rows.iter().map(|row| row.2.as_str()).collect();
    assert_eq!(units, ["N m", "N m/(rad/s)"]);
    assert_eq!(value(&rows, "0x3144:02"), 17.0);
    assert_eq!(value(&rows, "0x3144:03"), 72.5);
}

/// The spring is that of bristles, or of all elements while they stick.
#[test]
fn the_spring_is_that_of_the_law() {
    for (name, due) in [
        ("lugre", 2e6),
        ("maxwell-slip", 8e4 + 8e4 / 1.5 + 8e4 / 2.25),
    ] {
        let (_, law) = laws().into_iter().find(|(n, _)| *n == name).unwrap();
        let found = value(&read(&axis(law, "N", Some(0.2))), "0x3144:01");
        assert!((found / due - 1.0).abs() < 1e-5, "{name}: {found}");
    }
}

#[test]
fn a_unit_that_no_drive_counts_in_is_refused() {
    let said = export(&axis(laws().remove(0).1, "1", None), Target::DriveTable).unwrap_err();
    let said = said.to_string();
    assert!(
        said.contains("needs forces in N or A") && said.contains("identify again"),
        "{said}"
    );
}

#[test]
fn texts() {
    let (_, law) = laws().remove(0);
    for unit in ["N", "A"] {
        let model = axis(law, unit, Some(0.2));
        let said = advice(&model, Target::DriveTable);
        assert_eq!(said.len(), 1, "{said:?}");
        assert_eq!(said[0].code.as_str(), "export-simplified");
        insta::assert_snapshot!(format!("x_axis_drive_table_{unit}.csv"), text(&model));
    }
}

/// The page has the numbers of this model.
#[test]
fn the_page_has_these_numbers() {
    let page = stiction_testkit::workspace().join("docs/deploy/drive-table.md");
    let page = std::fs::read_to_string(page).unwrap();
    let (_, law) = laws().remove(0);
    for row in read(&axis(law, "N", Some(0.2))) {
        let line = format!("| `{}` | {} |", row.0, row.1);
        assert!(page.contains(&line), "{line}");
    }
}
