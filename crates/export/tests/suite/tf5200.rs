//! The friction table of TwinCAT CNC: read back as a controller would, against the law.

use crate::common::compiled::{run, write};
use crate::common::{laws, model};
use stiction_export::{Error, Model, Target, advice, export};
use stiction_friction::compensator::Friction;
use stiction_friction::{Direction, Shape, Stribeck};

fn text(model: &Model) -> String {
    let file = export(model, Target::Tf5200).unwrap().remove(0);
    String::from_utf8(file.bytes).unwrap()
}

/// A parameter's value, as the controller reads the list: a name, a blank, a number.
fn value(text: &str, name: &str) -> f64 {
    let line = text
        .lines()
        .find(|l| l.starts_with(&format!("frict_comp.{name} ")))
        .unwrap_or_else(|| panic!("no {name}"));
    line.split(' ').nth(1).unwrap().parse().unwrap()
}

/// The number after words in a comment.
fn stated(text: &str, words: &str) -> f64 {
    let after = text.split(words).nth(1).unwrap().trim();
    after.split(' ').next().unwrap().parse().unwrap()
}

fn steady(friction: &Friction<f64>, v: f64) -> f64 {
    match friction {
        Friction::Coulomb(law) => law.force(v),
        law => law.curve().unwrap().force(v),
    }
}

/// The table, interpolated at ten thousand speeds, is as near to the law as its head says, and no further off.
#[test]
fn the_error_is_the_one_that_is_stated() {
    for (name, friction) in laws() {
        let mut model = model(friction);
        model.settings.limit = 1e4;
        let text = text(&model);
        let count = value(&text, "table_entries") as usize;
        assert!((2..=19).contains(&count), "{name}");
        let points: Vec<[f64; 2]> = (0..count)
            .map(|i| {
                let of = |what| value(&text, &format!("table[{i}].{what}"));
                // um/s; a tenth of a per mille of 221 N
                [of("in") * 1e-6, of("out") * 221.0e-4]
            })
            .collect();
        assert_eq!(points[0][0], 0.0);
        assert!(points.windows(2).all(|p| p[0][0] < p[1][0]), "{name}");
        let (mut mean, mut side) = (0.0_f64, 0.0_f64);
        let end = points[count - 1][0];
        for k in 1..=10_000 {
            let v = end * (f64::from(k) / 10_000.0).powi(3);
            let after = points.iter().position(|p| p[0] >= v).unwrap();
            let ([a, low], [b, high]) = (points[after - 1], points[after]);
            let force = low + (high - low) * (v - a) / (b - a);
            let (there, back) = (steady(&friction, v), -steady(&friction, -v));
            mean = mean.max((force - 0.5 * (there + back)).abs());
            side = side.max((force - there).abs()).max((force - back).abs());
        }
        let (said_mean, said_side) = (
            stated(&text, "against the mean of both directions"),
            stated(&text, "against each direction with its offset"),
        );
        // Three digits are stated, and the two sets of speeds differ.
        assert!(
            mean <= 1.01 * said_mean + 1e-9,
            "{name}: {mean} {said_mean}"
        );
        assert!(mean >= 0.9 * said_mean - 1e-9, "{name}: {mean} {said_mean}");
        assert!(
            side <= 1.01 * said_side + 1e-9,
            "{name}: {side} {said_side}"
        );
        println!("{name}: {count} points, {mean:.2e} N of the mean, {side:.2e} N of a side");
    }
}

/// Of the bench stage's law less than a percent of Fs is lost in the table.
#[test]
fn twenty_points_are_enough() {
    let text = text(&model(laws().remove(0).1));
    let error = stated(&text, "against the mean of both directions");
    assert!(error < 0.01 * 18.0, "{error}");
    insta::assert_snapshot!("x_axis_frict_comp.lis", text);
}

#[test]
fn the_self_test_passes_and_notices() {
    for (name, law) in laws() {
        let dir = tempfile::tempdir().unwrap();
        let mut model = model(law);
        model.rotary = name == "power";
        write(&export(&model, Target::Tf5200).unwrap(), dir.path());
        let said = run("python3", &["x_axis_frict_comp_selftest.py"], dir.path());
        assert!(said.starts_with("ok"), "{name}: {said}");
        let table = dir.path().join("x_axis_frict_comp.lis");
        let text = std::fs::read_to_string(&table).unwrap();
        let first = format!("table[0].out {:.0}", value(&text, "table[0].out"));
        let other = format!("table[0].out {:.0}", value(&text, "table[0].out") + 20.0);
        std::fs::write(&table, text.replace(&first, &other)).unwrap();
        let status = std::process::Command::new("python3")
            .arg("x_axis_frict_comp_selftest.py")
            .current_dir(dir.path())
            .output()
            .unwrap()
            .status;
        assert!(!status.success(), "{name}");
    }
}

#[test]
fn a_rated_force_is_needed() {
    let mut model = model(laws().remove(0).1);
    for (rated, says) in [
        (None, "give the rated force"),
        (Some(0.0), "rated_force = 0"),
        (Some(f64::NAN), "rated_force = NaN"),
        (Some(f64::INFINITY), "rated_force = inf"),
        // 42 N at 1 m/s, of which 1.31 N are a 32nd; 18 N is ten steps of 0.1 per mille of 18 kN.
        (Some(1.31), "range of the drive's object 60B2h"),
        (Some(18_001.0), "too coarse"),
    ] {
        model.rated_force = rated;
        let error: Error = export(&model, Target::Tf5200).unwrap_err();
        assert!(error.to_string().contains(says), "{error}");
    }
    for (rated, codes) in [
        (1.32, vec!["export-rated-force"]),
        (41.9, vec!["export-rated-force"]),
        (42.1, vec![]),
        (18_000.0, vec![]),
    ] {
        model.rated_force = Some(rated);
        export(&model, Target::Tf5200).unwrap();
        let found = advice(&model, Target::Tf5200);
        assert_eq!(
            found.iter().map(|a| a.code.as_str()).collect::<Vec<_>>(),
            codes,
            "{rated}"
        );
    }
    // 27 N at 0.5 m/s, if the log went no faster.
    model.top_speed = Some(0.5);
    model.rated_force = Some(27.1);
    assert_eq!(advice(&model, Target::Tf5200), []);
    model.rated_force = Some(20.0);
    let said = advice(&model, Target::Tf5200).remove(0).message;
    assert!(
        said.starts_with(
            "up to the log's top speed of 0.5 m/s the table goes to 27 N, 135 percent"
        ),
        "{said}"
    );
    assert!(!said.contains('?'), "heads of files have no question mark");
}

/// Cut by a limit, the table says from where and how much is missing, against the law itself; and it never exceeds it.
#[test]
fn a_limit_is_stated() {
    let friction = laws().remove(0).1;
    let mut model = model(friction);
    model.settings.limit = 36.0;
    let text = text(&model);
    let from = stated(&text, "interpolated linearly, from 0 to");
    // 12 N + 30 N s/m v = 36 N at 0.8 m/s; 42 N at 1 m/s.
    assert_eq!(from, 0.8);
    assert!(
        text.contains("limited to 36 N\n# before scaling_factor"),
        "{text}"
    );
    assert!((stated(&text, "larger than the table, by up to") - 6.0).abs() < 0.05);
    let error = stated(&text, "against the mean of both directions");
    let points: Vec<[f64; 2]> = (0..value(&text, "table_entries") as usize)
        .map(|i| {
            let of = |what| value(&text, &format!("table[{i}].{what}"));
            [of("in") * 1e-6, of("out") * 221.0e-4]
        })
        .collect();
    assert!(points.iter().all(|p| p[1] <= 36.0 + 0.5 * 221e-4));
    for k in 1..200_000 {
        let v = f64::from(k) * 5e-6;
        let after = points.iter().position(|p| p[0] >= v).unwrap();
        let ([a, low], [b, high]) = (points[after - 1], points[after]);
        let force = low + (high - low) * (v - a) / (b - a);
        let off = (force - steady(&friction, v).min(36.0)).abs();
        assert!(off <= 1.01 * error, "{v}: {off} {error}");
    }
    let said = advice(&model, Target::Tf5200);
    assert!(said[0].message.contains("reaches at 0.8 m/s"), "{said:?}");
    // Below the static friction of 18 N errors are those within the limit. 12 N + 6 N exp(-(v/vs)^2) + 30 N s/m v is 14 N
    // at 3.2124 mm/s, and again at 2/30 m/s; at 1 m/s 28 N are missing.
    model.settings.limit = 14.0;
    let low = self::text(&model);
    assert_eq!(stated(&low, "interpolated linearly, from 0 to"), 1.0);
    assert!(
        stated(&low, "against the mean of both directions") < 0.01 * 14.0,
        "{low}"
    );
    assert!(low.contains("stays within the limit of 14 N"), "{low}");
    assert_eq!(stated(&low, "The friction is larger, by"), 4.0);
    assert!((stated(&low, "# up to") - 3.2124e-3).abs() < 2e-6, "{low}");
    assert!(
        (stated(&low, "and again from") - 2.0 / 30.0).abs() < 1e-5,
        "{low}"
    );
    assert!((stated(&low, "on, by") - 28.0).abs() < 0.05, "{low}");
    model.settings.limit = 11.0;
    let least = self::text(&model);
    assert!(
        least.contains("7.00e0 N at standstill:\n# at every speed, by 3.10e1 N at 1.000 m/s."),
        "{least}"
    );
    // Ten steps of 0.1 per mille of 221 N.
    model.settings.limit = 0.2209;
    let refused = export(&model, Target::Tf5200).unwrap_err().to_string();
    assert!(
        refused.starts_with("limit = 0.2209; allowed: from a thousandth"),
        "{refused}"
    );
    model.settings.limit = 0.2211;
    export(&model, Target::Tf5200).unwrap();
}

/// One table for two directions: the limit cuts their mean, not one of them, and the knee is as near as the rest.
#[test]
fn a_limit_cuts_the_mean() {
    let side = |coulomb, static_friction| Direction {
        coulomb,
        static_friction,
        stribeck_velocity: 0.3,
        viscous: 0.02,
    };
    let curve = Stribeck::new(Shape::Gaussian, side(1.2, 1.8), side(1.0, 1.4), 0.05).unwrap();
    let mut model = model(Friction::Stribeck(curve));
    (model.rotary, model.force_unit) = (true, "N m".into());
    (model.rated_force, model.settings.limit) = (Some(6.0), 1.3);
    let text = text(&model);
    let error = stated(&text, "against the mean of both directions");
    // Mean: 1.1 N m + 0.5 N m exp(-(v/vs)^2) + 0.02 N m s/rad v.
    assert_eq!(stated(&text, "The friction is larger, by"), 0.3);
    assert!(
        (stated(&text, "and again from") - 10.0).abs() < 1e-3,
        "{text}"
    );
    let points: Vec<[f64; 2]> = (0..value(&text, "table_entries") as usize)
        .map(|i| {
            let of = |what| value(&text, &format!("table[{i}].{what}"));
            [of("in") * 1e-3_f64.to_radians(), of("out") * 6.0e-4]
        })
        .collect();
    let mut worst = 0.0_f64;
    for k in 1..200_000 {
        let v = 1e-4 * f64::from(k);
        let after = points.iter().position(|p| p[0] >= v).unwrap();
        let ([a, low], [b, high]) = (points[after - 1], points[after]);
        let force = low + (high - low) * (v - a) / (b - a);
        let due = 1.1 + 0.5 * (-(v / 0.3).powi(2)).exp() + 0.02 * v;
        worst = worst.max((force - due.min(1.3)).abs());
    }
    assert!(worst <= 1.01 * error && error < 2e-3, "{worst} {error}");
    let dir = tempfile::tempdir().unwrap();
    write(&export(&model, Target::Tf5200).unwrap(), dir.path());
    let said = run("python3", &["x_axis_frict_comp_selftest.py"], dir.path());
    assert!(said.starts_with("ok"), "{said}");
}
