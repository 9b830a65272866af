//! Load, temperature and position in the axis file: from columns of a log to parameters in files.

use crate::common;
use crate::common::{Asked, Bench, both_ways, noise, options};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use stiction_files::ModelFile;
use stiction_files::result::Origin;
use stiction_identify::Silent;
use stiction_parameters::LawKind;
use stiction_workflows::identify::Outcome;

const LOAD_MEAN: f64 = 100.0;

/// `Fc = 20 N + 0.1 (N - 100 N) - 0.4 N/K (T - 300 K)`, viscous 60 N s/m, mass 9 kg.
fn log(bench: &Bench, name: &str, asymmetric: bool) -> PathBuf {
    let mut text =
        String::from("Time [s],Position [mm],Force [N],Normal load [N],Temperature [degC]\n");
    for i in 0..8000 {
        let t = i as f64 / common::RATE;
        let [x, v, a] = both_ways(t);
        let load = LOAD_MEAN + 40.0 * (1.3 * t).sin();
        let kelvin = 300.0 + 5.0 * (0.7 * t).cos();
        let mut level = 20.0 + 0.1 * (load - LOAD_MEAN) - 0.4 * (kelvin - 300.0);
        if asymmetric && v < 0.0 {
            level += 3.0 + 0.05 * (load - LOAD_MEAN);
        }
        let sign = f64::from(i8::from(v > 0.0) - i8::from(v < 0.0));
        let force = level * sign + 60.0 * v + 9.0 * a + 0.5 * noise(11, i);
        let _ = writeln!(
            text,
            "{t:.4},{:.6},{force:.4},{load:.3},{:.4}",
            1e3 * x,
            kelvin - 273.15
        );
    }
    bench.write(name, &text)
}

fn with_axis(bench: &Bench, log: &Path, text: &str, law: LawKind) -> Asked {
    let mut options = options(&[log], law);
    options.files.axis = Some(bench.write("axis.toml", text));
    options
}

fn run(options: &Asked) -> Outcome {
    options.identify(&mut Silent).unwrap()
}

const TERMS: &str = "[terms]\ncoulomb_load = true\ncoulomb_temperature = true\n";

#[test]
fn load_and_temperature_reach_every_file() {
    let bench = Bench::new();
    let file = log(&bench, "log.csv", false);
    let outcome = run(&with_axis(&bench, &file, TERMS, LawKind::CoulombViscous));
    let result = &outcome.result;
    assert!(result.trust.trustworthy, "{:?}", result.trust);
    for (name, truth, unit) in [
        ("coulomb_load", 0.1, "1"),
        ("coulomb_temperature", -0.4, "N/K"),
        ("sigma2", 60.0, "N*s/m"),
        ("mass", 9.0, "kg"),
    ] {
        let p = result.parameters.iter().find(|p| p.name == name).unwrap();
        assert!((p.value / truth - 1.0).abs() < 0.03, "{name} = {}", p.value);
        // The central differences shift the mass by (w h)^2/3, which its interval does not know of.
        let [low, high] = p.ci95.unwrap().map(|x| x.expect("a closed interval"));
        let inside = low <= truth && truth <= high;
        assert!(inside || name == "mass", "{name}: {low} .. {high}");
        assert_eq!(p.unit, unit);
        assert!(p.identifiable);
    }
    let given = |name: &str| {
        let p = result.parameters.iter().find(|p| p.name == name).unwrap();
        assert_eq!(p.origin, Origin::Given);
        (p.value, p.unit.as_str())
    };
    let (load, unit) = given("load_reference");
    assert!(
        (load - LOAD_MEAN).abs() < 8.0 && unit == "N",
        "{load} {unit}"
    );
    let (kelvin, unit) = given("temperature_reference");
    assert!(
        (kelvin - 300.0).abs() < 2.0 && unit == "K",
        "{kelvin} {unit}"
    );
    // The Coulomb level holds at the references.
    let coulomb = 20.0 + 0.1 * (load - LOAD_MEAN) - 0.4 * (kelvin - 300.0);
    let found = result
        .parameters
        .iter()
        .find(|p| p.name == "coulomb")
        .unwrap();
    let [low, high] = found.ci95.unwrap().map(|x| x.expect("a closed interval"));
    assert!(
        low <= coulomb && coulomb <= high,
        "{coulomb}: {low} .. {high}"
    );

    let bundle = stiction_pages::bundle::identification(&outcome);
    let text = |wanted: &str| {
        let (_, bytes) = bundle
            .files()
            .iter()
            .find(|(name, _)| *name == wanted)
            .unwrap();
        std::str::from_utf8(bytes).unwrap().to_string()
    };
    let model = ModelFile::parse(&text("model.toml")).unwrap();
    for name in ["coulomb_load", "load_reference", "temperature_reference"] {
        assert!(model.parameter.iter().any(|p| p.name == name), "{name}");
    }
    assert!(model.covariance.names.iter().any(|n| n == "coulomb_load"));
    let report = text("report.html");
    stiction_testkit::assert_tables_fit(&report);
    assert!(report.contains("Coulomb friction per normal load"));
    assert!(report.contains("<mi>L</mi>"), "the level in the formula");
    insta::assert_snapshot!(
        stiction_pages::text::outcome(&outcome).replace(&format!("{}/", bench.dir().display()), "")
    );
}

/// Each direction has its own dependence beside an asymmetric law.
#[test]
fn each_direction_has_its_own() {
    let bench = Bench::new();
    let file = log(&bench, "log.csv", true);
    for law in [LawKind::CoulombViscous, LawKind::Stribeck] {
        let mut options = with_axis(&bench, &file, TERMS, law);
        options.asymmetric = true;
        let outcome = run(&options);
        for (name, truth) in [("coulomb_load_pos", 0.1), ("coulomb_load_neg", 0.15)] {
            let parameters = &outcome.result.parameters;
            let found = parameters.iter().find(|p| p.name == name).unwrap();
            assert!(
                (found.value - truth).abs() < 0.01,
                "{law}: {name} = {}",
                found.value
            );
        }
    }
}

/// Without the terms the same log leaves much more, and the ladder fits them beside every law.
#[test]
fn the_terms_count() {
    let bench = Bench::new();
    let file = log(&bench, "log.csv", false);
    let without = run(&options(&[&file], LawKind::CoulombViscous));
    let mut with = with_axis(&bench, &file, TERMS, LawKind::CoulombViscous);
    with.compare_laws = true;
    let with = run(&with);
    assert!(without.result.fit.rmse > 3.0 * with.result.fit.rmse);
    assert!(with.result.laws.len() >= 4);
    for law in &with.result.laws {
        assert!(law.fitted_error_percent < without.result.fit.relative_error_percent);
    }
}

/// A term whose column is missing is refused with the term and the key to fill in, also where only a
/// validation log lacks it.
#[test]
fn a_missing_column_is_named() {
    let bench = Bench::new();
    let whole = log(&bench, "log.csv", false);
    let bare = bench.good("bare.csv", 1);
    for key in ["coulomb_load", "coulomb_temperature", "sigma2_temperature"] {
        let axis = format!("[terms]\n{key} = true\n");
        let alone = with_axis(&bench, &bare, &axis, LawKind::CoulombViscous);
        let mut validated = with_axis(&bench, &whole, &axis, LawKind::CoulombViscous);
        validated.files.validate = vec![bare.clone()];
        for options in [alone, validated] {
            let error = options.identify(&mut Silent).unwrap_err();
            assert_eq!(error.code().as_str(), "log-missing");
            let message = error.to_string();
            let channel = key.rsplit_once('_').unwrap().1;
            for part in ["bare.csv", key, &format!("[columns] {channel} =")] {
                assert!(message.contains(part), "{message}");
            }
        }
    }
    let axis = with_axis(
        &bench,
        &whole,
        "[terms]\ncoulomb_pitch = [\"0 mm\"]\n",
        LawKind::CoulombViscous,
    );
    let error = axis.identify(&mut Silent).unwrap_err();
    assert_eq!(error.code().as_str(), "bad-config");
    assert!(error.to_string().contains("terms.coulomb_pitch"), "{error}");
}

/// A log with other temperatures in some of its rows.
fn with_temperatures(
    bench: &Bench,
    name: &str,
    file: &Path,
    other: impl Fn(usize) -> Option<&'static str>,
) -> PathBuf {
    let text = std::fs::read_to_string(file).unwrap();
    let mut out = String::new();
    for (i, line) in text.lines().enumerate() {
        match i.checked_sub(1).and_then(&other) {
            Some(cell) => {
                let kept = line.rsplit_once(',').unwrap().0;
                let _ = writeln!(out, "{kept},{cell}");
            }
            None => {
                let _ = writeln!(out, "{line}");
            }
        }
    }
    bench.write(name, &out)
}

/// Dropouts of the sensor are named, with their place, and do not move the coefficient.
#[test]
fn dropouts_of_a_temperature_are_bridged() {
    let bench = Bench::new();
    let whole = log(&bench, "log.csv", false);
    let coefficient = |file: &Path| {
        let outcome = run(&with_axis(&bench, file, TERMS, LawKind::CoulombViscous));
        let parameters = &outcome.result.parameters;
        let p = parameters
            .iter()
            .find(|p| p.name == "coulomb_temperature")
            .unwrap()
            .clone();
        (p.value, outcome.result.warnings)
    };
    let (clean, _) = coefficient(&whole);
    let faulty = with_temperatures(&bench, "faulty.csv", &whole, |i| match i {
        1000 => Some("-273.15"),
        2000..2030 => Some("850"),
        _ if i % 500 == 7 => Some("0.0"),
        _ if i % 3 == 1 => Some(""),
        _ => None,
    });
    let (found, warnings) = coefficient(&faulty);
    assert!(
        (found - clean).abs() < 0.002,
        "{found}, of the whole log {clean}"
    );
    let said: Vec<_> = warnings
        .iter()
        .filter(|w| w.code.as_str() == "sensor-dropout")
        .collect();
    assert_eq!(said.len(), 2, "{warnings:?}");
    for part in [
        "faulty.csv",
        "data row 1001",
        "Temperature [degC]",
        "-273.15 degC",
        "below 0 K",
    ] {
        assert!(said[0].message.contains(part), "{}", said[0].message);
    }
}

/// A column that is mostly empty is refused where the law asks for it, with the reason, and is no cause elsewhere.
#[test]
fn a_column_that_is_mostly_empty_is_not_used() {
    let bench = Bench::new();
    let whole = log(&bench, "log.csv", false);
    let half = with_temperatures(&bench, "half.csv", &whole, |i| (i >= 3500).then_some(""));
    let axis = "[terms]\ncoulomb_temperature = true\n";
    let asked = with_axis(&bench, &half, axis, LawKind::CoulombViscous);
    let error = asked.identify(&mut Silent).unwrap_err();
    assert_eq!(error.code().as_str(), "log-missing");
    let message = error.to_string();
    for part in [
        "half.csv",
        "coulomb_temperature",
        "left out: temperature: 4500 of 8000 cells missing",
    ] {
        assert!(message.contains(part), "{message}");
    }
    let axis = "[terms]\ncoulomb_load = true\n";
    let outcome = run(&with_axis(&bench, &half, axis, LawKind::CoulombViscous));
    let codes: Vec<_> = outcome
        .result
        .warnings
        .iter()
        .map(|w| w.code.as_str())
        .collect();
    assert!(codes.contains(&"missing-cells"), "{codes:?}");
    assert!(!codes.contains(&"temperature-dependence"), "{codes:?}");
}

/// The cause of what a law leaves leads: in the verdict, among the warnings, and with its cure as what to do next. Taken, it
/// is gone.
#[test]
fn the_cause_of_what_is_left_leads() {
    let bench = Bench::new();
    let file = log(&bench, "log.csv", false);
    let said = |axis: Option<&str>| {
        let asked = match axis {
            Some(axis) => with_axis(&bench, &file, axis, LawKind::CoulombViscous),
            None => options(&[&file], LawKind::CoulombViscous),
        };
        let outcome = run(&asked);
        let text = stiction_pages::text::outcome(&outcome);
        let verdict = text
            .lines()
            .find(|l| l.starts_with("for compensation"))
            .unwrap();
        let next = stiction_pages::text::next(&outcome.result, Path::new("out"), None);
        let first = outcome
            .result
            .warnings
            .first()
            .map_or("none", |w| w.code.as_str());
        bench.plain(&format!("{verdict}\nfirst warning: {first}\n{next}"))
    };
    let open = said(None);
    let beside = said(Some("[columns]\nload = \"Normal load\"\n"));
    let taken = said(Some("[terms]\ncoulomb_load = true\n"));
    let both = said(Some(TERMS));
    insta::assert_snapshot!(format!(
        "nothing taken\n{open}\nwith an axis file\n{beside}\nthe load taken\n{taken}\nboth taken\n{both}"
    ));
}

/// A load that does not change cannot tell its coefficient: flagged, and the rest stands.
#[test]
fn a_constant_load_is_flagged() {
    let bench = Bench::new();
    let good = bench.good("good.csv", 2);
    let text = std::fs::read_to_string(&good).unwrap();
    let mut lines = text.lines();
    let mut out = format!("{},Normal load [N]\n", lines.next().unwrap());
    for line in lines {
        let _ = writeln!(out, "{line},80");
    }
    let file = bench.write("constant.csv", &out);
    let axis = "[columns]\nload = \"Normal load\"\n[terms]\ncoulomb_load = true\n";
    let outcome = run(&with_axis(&bench, &file, axis, LawKind::CoulombViscous));
    let load = outcome
        .result
        .parameters
        .iter()
        .find(|p| p.name == "coulomb_load")
        .unwrap();
    assert!(!load.identifiable && load.std.is_none(), "{load:?}");
    let warning = outcome
        .result
        .warnings
        .iter()
        .find(|w| w.message.contains("coulomb_load"));
    assert!(warning.unwrap().message.contains("Record several loads"));
    assert!(
        outcome.result.trust.trustworthy,
        "{:?}",
        outcome.result.trust
    );
}

/// A joint under a cascade at 1 kHz whose level rises by a quarter over .8 rad, along sines from the whole stroke to presliding. The
/// command that is logged is held from its sample to the next.
fn level_along_the_stroke() -> String {
    const SINES: [(f64, f64, f64); 7] = [
        (0.8, 0.398, 3.0),
        (0.356, 0.358, 3.0),
        (0.009_55, 1.0, 3.0),
        (0.003_82, 1.0, 3.0),
        (0.001_91, 1.0, 3.0),
        (0.006, 1.5, 3.0),
        (0.56, 0.239, 4.0),
    ];
    let (step, fine, count) = (1e-3, 1e-5, TAU / 524_288.0);
    let wanted = |mut t: f64| {
        for (amplitude, frequency, periods) in SINES {
            let ends = periods / frequency;
            if t < ends {
                let near = (2.0 * frequency * t.min(ends - t)).min(1.0);
                let begun = 0.5 - 0.5 * (0.5 * TAU * near).cos();
                return begun * amplitude * (TAU * frequency * t).sin();
            }
            t -= ends;
        }
        0.0
    };
    let duration: f64 = SINES.iter().map(|(_, f, n)| n / f).sum();
    let gain = MASS * TAU * 20.0;
    let (mut x, mut v, mut z) = (0.0_f64, 0.0_f64, 0.0_f64);
    let (mut before, mut integral) = (0.0, 0.0);
    let mut text = String::from("Time [s],Position [rad],Torque [Nm]\n");
    for k in 0..(duration / step) as usize {
        let t = k as f64 * step;
        let read = (x / count).floor() * count;
        let ahead = (wanted(t) - wanted((t - step).max(0.0))) / step;
        let error = 0.25 * TAU * 20.0 * (wanted(t) - read) + 0.9 * ahead - (read - before) / step;
        before = read;
        integral += gain * TAU * 5.0 * error * step;
        let force = gain * error + integral;
        let logged = force + 0.14 * noise(3, k);
        let _ = writeln!(text, "{t:.3},{read:.9},{logged:.5}");
        for _ in 0..(step / fine).round() as usize {
            let level = 9.0 + 3.0 * (-(v / 0.03) * (v / 0.03)).exp();
            let rate = v - STIFFNESS * v.abs() * z / level;
            let spring = (1.0 + 0.25 * x / 0.8) * STIFFNESS * z;
            v += fine * (force - spring - SIGMA1 * rate - 14.0 * v) / MASS;
            z += fine * rate;
            x += fine * v;
        }
    }
    text
}

const MASS: f64 = 1.2;
const STIFFNESS: f64 = 12e3;
const SIGMA1: f64 = 60.0;

/// A replica whose level follows the recorded motion instead of its own bristles shows a delay that is half a sample beside the
/// true one, and micro-damping that makes up for it.
#[test]
fn a_level_along_the_stroke_moves_no_delay() {
    let bench = Bench::new();
    let file = bench.write("log.csv", &level_along_the_stroke());
    let declared = "[terms]\ncoulomb_position = true\n";
    let result = run(&with_axis(&bench, &file, declared, LawKind::LuGre)).result;
    assert!(result.trust.trustworthy, "{:?}", result.trust);
    for (name, truth) in [
        ("delay", -5e-4),
        ("sigma0", STIFFNESS),
        ("sigma1", SIGMA1),
        ("mass", MASS),
    ] {
        let p = result.parameters.iter().find(|p| p.name == name).unwrap();
        let [low, high] = p.ci95.unwrap().map(|x| x.expect("a closed interval"));
        let off = (p.value - truth).abs() / (0.5 * (high - low));
        assert!(off < 1.5, "{name}: {low} .. {high}, {off:.2} half-widths");
        let at_once = p.half_width.unwrap().at_once;
        let narrow = name == "delay" || at_once < 0.025 * truth;
        assert!(narrow, "{name}: {at_once}");
    }
}
