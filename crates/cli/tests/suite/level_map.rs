//! A level of friction that changes along a long stroke: from the log of a simulated axis to a map, and from its model to the C
//! that compensates it.

use serde_json::Value;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use stiction_testkit::gate;
use stiction_testkit::worlds::{Level, Machine, Motion, Setup, World, record};
use tempfile::TempDir;

const SEED: u64 = 11;
/// Places over which means along the stroke are taken.
const FINE: usize = 1000;

/// A gantry: 1 m of stroke, 100 nm, 1 kHz.
fn gantry(seed: u64) -> Machine {
    Machine {
        top_speed: 1.0,
        acceleration: 5.0,
        count: 1e-7,
        rate: 1000.0,
        bandwidth: 25.0,
        ..Machine::stage(seed)
    }
}

fn run(folder: &Path, arguments: &str) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
        .args(arguments.split(' '))
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    crate::split(output)
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    let all = value.as_array().into_iter().flatten();
    all.filter_map(Value::as_f64).collect()
}

/// A log of the gantry, identified with this line under `[terms]`.
fn identified(level: Option<Level>, line: &str) -> (TempDir, Value, String) {
    let setup = Setup {
        level,
        ..World::Faithful.into()
    };
    let log = record(&gantry(SEED), Motion::Crossings(SEED), setup, SEED);
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("log.csv", &log.to_csv("linear"));
    write("axis.toml", &format!("[terms]\n{line}\n"));
    let command = "identify log.csv --axis axis.toml --law lugre --out out";
    let (_, out, _) = run(folder.path(), command);
    let result = json(&folder.path().join("out/result.json"));
    (folder, result, out)
}

/// The truth of a parameter: levels in their mean along the stroke.
fn truth(name: &str, level: Option<Level>) -> f64 {
    let all = gantry(SEED).truth();
    let (_, value) = all.into_iter().find(|(own, _)| *own == name).unwrap();
    let mean = level.map_or(1.0, |level| along(|part| level.at(part)));
    match name {
        "coulomb" | "static" | "sigma0" => value * mean,
        _ => value,
    }
}

/// The mean over the stroke.
fn along(of: impl Fn(f64) -> f64) -> f64 {
    let parts = (0..FINE).map(|i| (i as f64 + 0.5) / FINE as f64);
    parts.map(of).sum::<f64>() / FINE as f64
}

/// Whether the interval of a parameter holds its truth; `None` where it is left open.
fn holds(result: &Value, name: &str, level: Option<Level>) -> Option<bool> {
    let parameters = result["parameters"].as_array().unwrap();
    let p = parameters.iter().find(|p| p["name"] == name).unwrap();
    let ends = numbers(&p["ci95"]);
    let truth = truth(name, level);
    (p["identifiable"] == true).then(|| ends[0] <= truth && truth <= ends[1])
}

/// How many of the places where the level is stated have it within its band, how many there are, and the largest error as a part of
/// the level.
fn inside(result: &Value, level: Level) -> (usize, usize, f64) {
    let stated = &result["level_along"][0];
    let [x, own, low, high] = ["position", "level", "low", "high"].map(|key| numbers(&stated[key]));
    let truth: Vec<f64> = (x.iter().map(|x| gantry(SEED).coulomb * level.at(*x))).collect();
    let holds = |i: &usize| low[*i] <= truth[*i] && truth[*i] <= high[*i];
    let error = own
        .iter()
        .zip(&truth)
        .map(|(own, truth)| (own / truth - 1.0).abs());
    (
        (0..x.len()).filter(holds).count(),
        x.len(),
        error.fold(0.0, f64::max),
    )
}

/// A wave, a bump and a ramp of 30 % are found as they are along the stroke, and what else the log determines beside them.
#[test]
fn a_level_is_found_along_the_stroke() {
    let (mut held, mut of) = (0, 0);
    let levels = [Level::Wave(0.3), Level::Bump(0.3), Level::Ramp(0.3)];
    for level in gate(1, levels) {
        let (_folder, result, out) = identified(Some(level), "coulomb_position = \"map\"");
        let (own, places, error) = inside(&result, level);
        assert!(places == 17 && error < 0.02, "{level:?}: {places} {error}");
        (held, of) = (held + own, of + places);
        // The bristles of this world do not stiffen with the level, as those of the law do.
        for name in ["coulomb", "sigma2", "mass"] {
            assert_ne!(
                holds(&result, name, Some(level)),
                Some(false),
                "{level:?}: {name}\n{out}"
            );
        }
        assert!(
            !out.contains("coulomb_map") && out.contains("stroke      coulomb in N"),
            "{out}"
        );
    }
    assert!(10 * held >= 9 * of, "{held} of {of}");
}

/// Where the level does not change there is no map, and nothing else is another than without asking for one.
#[test]
fn a_log_without_a_change_has_no_map() {
    let (_folder, result, _) = identified(None, "coulomb_position = \"map\"");
    let (_folder, plain, _) = identified(None, "coulomb_position = false");
    assert!(result["level_along"].is_null());
    let count = |result: &Value| result["parameters"].as_array().unwrap().len();
    assert_eq!(count(&result), count(&plain));
    for name in ["coulomb", "sigma2", "mass", "sigma0", "static"] {
        assert_ne!(holds(&result, name, None), Some(false), "{name}");
    }
}

/// A bump that no straight line describes leads to the map, also where the line is there already.
#[test]
fn a_bump_leads_to_the_map() {
    let lines = ["coulomb_position = true", "coulomb_position = false"];
    for line in gate(1, lines) {
        let (_folder, result, out) = identified(Some(Level::Bump(0.3)), line);
        assert_eq!(result["effects"][0]["code"], "position-dependence", "{out}");
        assert!(
            out.contains(
                "in place of the line coulomb_position, write\n    coulomb_position = \"map\"\n"
            ),
            "{out}"
        );
    }
}

/// The model of the axis as it is, a bump as far as twelve cosines have it.
fn exact(level: Level) -> String {
    let machine = gantry(SEED);
    let mut text = String::from("kind = \"linear\"\nlaw = \"lugre\"\n");
    let mut add = |name: &str, value: f64, unit: &str| {
        let _ = write!(
            text,
            "[[parameter]]\nname = \"{name}\"\nvalue = {value:e}\nunit = \"{unit}\"\n"
        );
    };
    for (name, unit) in [
        ("sigma0", "N/m"),
        ("sigma1", "N*s/m"),
        ("sigma2", "N*s/m"),
        ("coulomb", "N"),
        ("static", "N"),
        ("stribeck_velocity", "m/s"),
        ("mass", "kg"),
    ] {
        add(name, truth(name, Some(level)), unit);
    }
    let size = machine.coulomb;
    match level {
        Level::Wave(part) => {
            add("coulomb_pitch1_sin", part * size, "N");
            add("coulomb_pitch1_cos", 0.0, "N");
        }
        Level::Ramp(part) => add("coulomb_map1", part * size, "N"),
        Level::Bump(_) => {
            for k in 1..=12 {
                let cosine = |part: f64| (f64::from(k) * PI * part).cos();
                let amplitude = 2.0 * size * along(|part| level.at(part) * cosine(part));
                add(&format!("coulomb_map{}", k + 1), amplitude, "N");
            }
        }
    }
    add("position_reference", 0.5, "m");
    add("position_stroke", 1.0, "m");
    let pitch = match level {
        Level::Wave(_) => "[pitch]\ncoulomb = [1.0]\n",
        _ => "",
    };
    text + "[range]\nposition = [0.0, 1.0]\n" + pitch
}

const STUDY: &str = r#"
[axis]
model      = "exact.toml"
rate       = "1 kHz"
delay      = "1 ms"
encoder    = "100 nm"
peak_force = "400 N"

[[path]]
kind      = "sine"
amplitude = "220 mm"
frequency = "0.1 Hz"
cycles    = 1

[[controller]]
kind      = "cascade"
bandwidth = "25 Hz"

[[compensator]]
name     = "lugre"
kind     = "lugre"
gain     = 1.0
watchdog = false
ramp     = "0 s"
"#;

/// On the axis as it is, exported C with what a log shows of it: what is left of the error (rms) without compensation and with it.
fn left(level: Level, line: &str) -> [f64; 2] {
    let (folder, _, _) = identified(Some(level), line);
    let path = folder.path();
    std::fs::write(path.join("exact.toml"), exact(level)).unwrap();
    std::fs::write(path.join("study.toml"), STUDY).unwrap();
    let settings = "--cycle-time 1e-3 --gain 1 --window 0 --ramp 0";
    run(
        path,
        &format!("export out/model.toml --target c {settings} --out c"),
    );
    let (_, out, err) = run(path, "simulate study.toml --exported-c c --out study");
    assert!(out.contains("exported C in c"), "{out}{err}");
    let study = json(&path.join("study/study.json"));
    let errors = &study["exported_c"]["runs"][0]["metrics"][0];
    ["without", "c"].map(|key| errors[key].as_f64().unwrap())
}

/// The C with a map leaves hardly more of a wave than the same motion leaves on an axis without one, and the C with one level leaves
/// much more.
#[test]
fn compensation_with_a_map_is_as_good_as_without_a_change() {
    let [none, map] = left(Level::Wave(0.3), "coulomb_position = \"map\"");
    let [_, flat] = left(Level::Wave(0.0), "coulomb_position = false");
    let [_, one] = left(Level::Wave(0.3), "coulomb_position = false");
    assert!(map < 0.02 * none && map < 1.3 * flat, "{none} {map} {flat}");
    assert!(one > 4.0 * map, "{map} {one}");
}
