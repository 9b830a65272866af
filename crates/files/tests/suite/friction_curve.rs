//! Friction at a velocity, from the curve of a result.

use stiction_files::result::{BandEntry, FrictionAtEntry, FrictionCurveEntry};

const SPEED: [f64; 4] = [0.01, 0.02, 0.05, 0.2];

/// Straight lines of the speed: what is linear between its points is exact.
fn line(level: f64, rise: f64) -> BandEntry {
    let of = |level: f64, rise: f64| SPEED.iter().map(|v| level + rise * v).collect();
    BandEntry {
        force: of(level, rise),
        at_once: of(0.1, 1.0),
        repeat: of(0.2, 2.0),
        transfer: of(0.4, 4.0),
    }
}

fn curve(both: bool, directions: [bool; 2]) -> FrictionCurveEntry {
    FrictionCurveEntry {
        speed_unit: "m/s".into(),
        unit: "N".into(),
        at: Vec::new(),
        line: None,
        speed: SPEED.into(),
        both: both.then(|| line(20.0, 60.0)),
        constant: None,
        forward: directions[0].then(|| line(22.0, 50.0)),
        back: directions[1].then(|| line(18.0, 70.0)),
    }
}

fn is(found: Option<FrictionAtEntry>, v: f64, level: f64, rise: f64) {
    let found = found.unwrap_or_else(|| panic!("none at {v}"));
    let due = [
        (found.speed, v.abs()),
        (found.force, v.signum() * (level + rise * v.abs())),
        (found.at_once, 0.1 + v.abs()),
        (found.repeat, 0.2 + 2.0 * v.abs()),
        (found.transfer, 0.4 + 4.0 * v.abs()),
    ];
    for (found, due) in due {
        assert!((found - due).abs() < 1e-12, "at {v}: {found}, {due}");
    }
}

#[test]
fn a_direction_has_its_own_curve_and_no_other() {
    for v in [0.01, 0.013, 0.05, 0.17, 0.2] {
        let two = curve(true, [true, true]);
        is(two.at_velocity(v), v, 22.0, 50.0);
        is(two.at_velocity(-v), -v, 18.0, 70.0);
        let mean = curve(true, [false, false]);
        is(mean.at_velocity(v), v, 20.0, 60.0);
        is(mean.at_velocity(-v), -v, 20.0, 60.0);
        let forward = curve(false, [true, false]);
        is(forward.at_velocity(v), v, 22.0, 50.0);
        assert_eq!(forward.at_velocity(-v), None);
        let back = curve(false, [false, true]);
        is(back.at_velocity(-v), -v, 18.0, 70.0);
        assert_eq!(back.at_velocity(v), None);
    }
}

#[test]
fn nothing_is_said_outside_the_speeds_that_were_seen() {
    let two = curve(true, [true, true]);
    for v in [0.0, 0.0099, -0.0099, 0.2001, -1.0, f64::INFINITY, f64::NAN] {
        assert_eq!(two.at_velocity(v), None, "{v}");
    }
    let none = FrictionCurveEntry {
        speed: Vec::new(),
        ..curve(true, [true, true])
    };
    assert_eq!(none.at_velocity(0.05), None);
    assert_eq!(curve(false, [false, false]).at_velocity(0.05), None);
    let mut open = curve(true, [false, false]);
    open.both.as_mut().unwrap().transfer[2] = f64::NAN;
    assert_eq!(open.at_velocity(0.03), None);
    assert!(open.at_velocity(0.015).is_some());
}
