//! A study whose axis is moved by sliders.

use crate::client::{Served, open};
use crate::work::ended;
use serde_json::{Value, json};
use std::collections::BTreeMap;

const STUDY: &str = "[axis]\nknown = \"motor\"\nrate = \"4 kHz\"\n\n\
    [[path]]\nname = \"slow\"\nkind = \"sine\"\namplitude = \"1 mm\"\nfrequency = \"4 Hz\"\n\n\
    [[path]]\nname = \"long\"\nkind = \"sine\"\namplitude = \"1 mm\"\nfrequency = \"1 Hz\"\ncycles = 100\n\n\
    [[controller]]\nkind = \"cascade\"\nbandwidth = \"30 Hz\"\nforce_limit = \"200 N\"\n\n\
    [[compensator]]\nkind = \"coulomb\"\nwatchdog = false\n\n\
    [[compensator]]\nkind = \"lugre\"\nwatchdog = false\n";

fn trial(served: &Served, asked: &Value) -> Value {
    let answer = served.ask("POST", "/api/trial", &asked.to_string());
    assert_eq!(answer.status, 200, "{}", answer.text());
    answer.json()
}

/// A row of a study has these metrics, to the last bit.
fn agree(row: &Value, metrics: &[(&str, &Value)]) {
    for (name, value) in metrics {
        let all = row["metrics"].as_array().unwrap();
        let found = all.iter().find(|own| own["name"] == *name).unwrap();
        assert_eq!(**value, found["mean"], "{} {name}", row["compensator"]);
    }
}

/// Simulates a study file as a whole, and gives `study.json`.
fn simulated(served: &Served, study: &str, out: &str) -> Value {
    let asked = json!({ "kind": "simulate", "study": study, "out": out });
    let id = served.ask("POST", "/api/jobs", &asked.to_string()).json();
    let job = ended(served, id.as_u64().unwrap());
    assert_eq!(job["state"], "done", "{job}");
    let text = std::fs::read_to_string(served.path().join(out).join("study.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// What is tried at the values of the model is what the study finds, to the last bit.
#[test]
fn a_path_that_is_tried_is_that_of_the_study() {
    let served = open();
    std::fs::write(served.path().join("study.toml"), STUDY).unwrap();
    let study = simulated(&served, "study.toml", "study");
    for (place, name) in [(1, "coulomb"), (2, "lugre")] {
        let asked = json!({ "study": "study.toml", "compensator": place });
        let tried = trial(&served, &asked);
        assert_eq!(tried["seconds"], tried["whole_seconds"]);
        for (run, compensator) in [(0, "none"), (1, name)] {
            let of_study = study["results"].as_array().unwrap().iter().find(|row| {
                row["path"] == "slow"
                    && row["compensator"] == compensator
                    && row["parameters"] == "exact"
            });
            let run = &tried["runs"][run];
            let metrics = [
                ("rms_error", &run["rms_error"]),
                ("peak_error", &run["peak_error"]),
                ("reversal_peak", &run["reversal_peaks"][0]),
            ];
            agree(of_study.unwrap(), &metrics);
        }
    }
}

#[test]
fn a_parameter_moves_the_axis_and_not_the_compensator() {
    let served = open();
    std::fs::write(served.path().join("study.toml"), STUDY).unwrap();
    let at = trial(&served, &json!({ "study": "study.toml" }));
    let knobs = at["knobs"].as_array().unwrap();
    let knob = knobs.iter().find(|own| own["name"] == "coulomb").unwrap();
    assert_eq!(knob["range"], "given");
    assert_eq!(at["runs"][1]["compensator"], "lugre");
    let peak = |tried: &Value| number(&tried["runs"][1]["peak_error"]);
    let moved = |end: &str| {
        let asked = json!({ "study": "study.toml", "values": { "coulomb": knob[end] } });
        let moved = trial(&served, &asked);
        // The same again is the same.
        assert!(trial(&served, &asked) == moved);
        peak(&moved)
    };
    // Three quarters of what the model has are more of a lower friction, and less of a higher one.
    let (low, high) = (moved("low"), moved("high"));
    assert!(low < 0.98 * peak(&at), "{low}");
    assert!(high > 1.02 * peak(&at), "{high}");
    // A long path is cut to what can be simulated while somebody waits.
    let long = trial(&served, &json!({ "study": "study.toml", "path": 1 }));
    assert!(number(&long["seconds"]) < number(&long["whole_seconds"]));
    assert!(
        !long["runs"][1]["reversal"]["time"]
            .as_array()
            .unwrap()
            .is_empty()
    );
}

#[test]
fn what_cannot_be_tried_is_refused_in_words() {
    let served = open();
    std::fs::write(served.path().join("study.toml"), STUDY).unwrap();
    for (asked, said) in [
        (
            json!({ "study": "study.toml", "values": { "coulomb": 1e6 } }),
            "allowed: from",
        ),
        (
            json!({ "study": "study.toml", "values": { "speed": 1.0 } }),
            "cannot be moved",
        ),
        (json!({ "study": "study.toml", "path": 2 }), "path 2"),
        (
            json!({ "study": "study.toml", "compensator": 9 }),
            "compensator 9",
        ),
        (json!({ "study": "none.toml" }), "none.toml"),
        (json!({ "study": "../study.toml" }), "study.toml"),
    ] {
        let answer = served.ask("POST", "/api/trial", &asked.to_string());
        assert!(
            (400..500).contains(&answer.status),
            "{asked}: {}",
            answer.status
        );
        assert!(answer.text().contains(said), "{asked}: {}", answer.text());
    }
}

const LUGRE: &str = "law = \"lugre\"\nparameter = [\n\
    { name = \"sigma0\", value = 2e6, unit = \"N/m\", ci95 = [1.8e6, 2.2e6] },\n\
    { name = \"sigma1\", value = 1500, unit = \"N*s/m\" },\n\
    { name = \"sigma2\", value = 30, unit = \"N*s/m\" },\n\
    { name = \"coulomb\", value = 12, unit = \"N\" },\n\
    { name = \"static\", value = 18, unit = \"N\" },\n\
    { name = \"stribeck_velocity\", value = 0.003, unit = \"m/s\" },\n\
    { name = \"mass\", value = 4.6, unit = \"kg\" },\n]\n";

/// What somebody does who has only the page: two axes of one model along a circle.
fn two_axes() -> Served {
    let served = open();
    std::fs::write(served.path().join("model.toml"), LUGRE).unwrap();
    let asked =
        json!({ "model": "model.toml", "second": "model.toml", "name": "circle-study.toml" });
    let line = served.ask("POST", "/api/study/command", &asked.to_string());
    assert_eq!(
        line.json(),
        "stiction simulate --init circle-study.toml --model model.toml --second-model model.toml"
    );
    let begun = served.ask("POST", "/api/study", &asked.to_string());
    assert_eq!(begun.status, 200, "{}", begun.text());
    served
}

#[test]
fn two_axes_are_begun_tried_and_drawn_along_a_circle() {
    let served = two_axes();
    let tried = trial(
        &served,
        &json!({ "study": "circle-study.toml", "compensator": 1 }),
    );
    assert_eq!(tried["paths"], json!(["circle"]));
    assert_eq!(tried["seconds"], tried["whole_seconds"]);
    assert_eq!(tried["knobs"], tried["second_knobs"]);
    let study = simulated(&served, "circle-study.toml", "circle");
    let rows = study["results"].as_array().unwrap();
    let row = |compensator: &str| {
        rows.iter()
            .find(|row| row["compensator"] == compensator && row["parameters"] == "exact")
            .unwrap()
    };
    for (run, compensator) in [(0, "none"), (1, "coulomb")] {
        let run = &tried["runs"][run];
        let metrics = [
            ("contour_rms", &run["rms_error"]),
            ("contour_peak", &run["peak_error"]),
            ("reversal_peak_x", &run["reversal_peaks"][0]),
            ("reversal_peak_y", &run["reversal_peaks"][1]),
        ];
        agree(row(compensator), &metrics);
    }
    // Drawn as it is tried and as it was simulated: the last of the runs beside that without compensation.
    let drawn = served
        .ask("GET", "/api/contour?folder=circle&run=2", "")
        .json();
    let names: Vec<&Value> = drawn["runs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|run| &run["name"])
        .collect();
    assert_eq!(names, ["none", "lugre"]);
    assert_eq!(drawn["unit"], "m");
    assert_eq!(drawn["plane"]["magnified"], tried["plane"]["magnified"]);
    let largest = |run: &Value| {
        let all = run["deviation"].as_array().unwrap().iter();
        all.fold(0.0_f64, |most, own| most.max(number(own).abs()))
    };
    let peak = |row: &Value| {
        let all = row["metrics"].as_array().unwrap();
        number(
            &all.iter()
                .find(|own| own["name"] == "contour_peak")
                .unwrap()["mean"],
        )
    };
    for (run, compensator) in [(0, "none"), (1, "lugre")] {
        let (drawn, peak) = (largest(&drawn["runs"][run]), peak(row(compensator)));
        assert!((drawn - peak).abs() < 0.02 * peak, "{drawn} {peak}");
    }
    // The first turn is the run-up.
    let first = number(&drawn["runs"][0]["time"][0]);
    assert!(
        (first - number(&tried["from_seconds"])).abs() < 1e-3,
        "{first}"
    );
    let alone = served
        .ask("GET", "/api/contour?folder=circle&run=0", "")
        .json();
    assert_eq!(alone["runs"].as_array().unwrap().len(), 1);
    for path in [
        "folder=circle&run=9",
        "folder=none&run=0",
        "folder=..&run=0",
    ] {
        let answer = served.ask("GET", &format!("/api/contour?{path}"), "");
        assert!(
            (400..500).contains(&answer.status),
            "{path}: {}",
            answer.text()
        );
    }
}

#[test]
fn each_axis_of_a_contour_moves_by_itself() {
    let served = two_axes();
    let peaks = |values: Value, second: Value| {
        let asked =
            json!({ "study": "circle-study.toml", "values": values, "second_values": second });
        let tried = trial(&served, &asked);
        [0, 1].map(|axis| number(&tried["runs"][0]["reversal_peaks"][axis]))
    };
    let at = peaks(json!({}), json!({}));
    let more = json!({ "coulomb": 14.0 });
    let (x, y) = (peaks(more.clone(), json!({})), peaks(json!({}), more));
    // They start a quarter of a turn apart, and are two axes all the same.
    assert!(x[0] > 1.05 * at[0] && x[1] == at[1], "{x:?} {at:?}");
    assert!(y[1] > 1.05 * at[1] && y[0] == at[0], "{y:?} {at:?}");
    let path = STUDY.replace("known = \"motor\"", "model = \"model.toml\"");
    std::fs::write(served.path().join("study.toml"), path).unwrap();
    for (asked, said) in [
        (
            json!({ "study": "circle-study.toml", "second_values": { "coulomb": 99.0 } }),
            "second axis: coulomb = 99.00; allowed: from 9.600 to 14.40",
        ),
        (
            json!({ "study": "study.toml", "second_values": { "coulomb": 12.0 } }),
            "a path has one axis",
        ),
    ] {
        let answer = served.ask("POST", "/api/trial", &asked.to_string());
        assert_eq!(answer.status, 400, "{}", answer.text());
        assert!(answer.text().contains(said), "{}", answer.text());
    }
}

#[test]
fn a_study_that_cannot_be_begun_is_refused_in_words() {
    let served = open();
    std::fs::write(served.path().join("model.toml"), LUGRE).unwrap();
    std::fs::write(served.path().join("gms_model.toml"), elements("gms")).unwrap();
    let rotary = LUGRE
        .replace("law =", "kind = \"rotary\"\nlaw =")
        .replace("unit = \"N", "unit = \"N*m");
    let rotary = rotary
        .replace("N*m/m", "N*m/rad")
        .replace("N*m*s/m", "N*m*s/rad")
        .replace("m/s\"", "rad/s\"");
    std::fs::write(
        served.path().join("turning_model.toml"),
        rotary.replace("\"kg\"", "\"kg*m^2\""),
    )
    .unwrap();
    for (second, name, said) in [
        (
            "gms_model.toml",
            "circle-study.toml",
            "lugre or dahl on both axes",
        ),
        (
            "turning_model.toml",
            "circle-study.toml",
            "linear, as the first axis",
        ),
        ("none.toml", "circle-study.toml", "none.toml"),
        ("../model.toml", "circle-study.toml", "within the folder"),
        ("model.toml", "circle.toml", "has study in its name"),
        ("model.toml", "study.csv", "ends in .toml"),
        ("model.toml", "../study.toml", "within the folder"),
    ] {
        let asked = json!({ "model": "model.toml", "second": second, "name": name });
        let answer = served.ask("POST", "/api/study", &asked.to_string());
        assert!(
            (400..500).contains(&answer.status),
            "{asked}: {}",
            answer.status
        );
        assert!(answer.text().contains(said), "{asked}: {}", answer.text());
        assert!(!served.path().join(name).exists());
    }
}

/// A law of three elements.
fn elements(law: &str) -> String {
    let mut all = vec![
        ("stiffness_1", 1e6, "N/m", ""),
        ("stiffness_2", 4e5, "N/m", ""),
        ("stiffness_3", 2e5, "N/m", ""),
        ("yield_1", 4e-6, "m", ""),
        ("yield_2", 1e-5, "m", ""),
        ("yield_3", 2e-5, "m", ""),
        ("sigma2", 30.0, "N*s/m", ""),
        ("mass", 4.6, "kg", ""),
    ];
    // 4 N of each.
    all.extend(match law {
        "gms" => vec![
            ("coulomb", 9.0, "N", ""),
            ("static", 12.0, "N", ", ci95 = [11.5, 12.5]"),
            ("stribeck_velocity", 3e-3, "m/s", ""),
            ("attraction", 50.0, "1/s", ""),
        ],
        _ => vec![("coulomb", 12.0, "N", ", ci95 = [11.5, 12.5]")],
    });
    let line = |(name, value, unit, more): &(&str, f64, &str, &str)| {
        format!("    {{ name = \"{name}\", value = {value}, unit = \"{unit}\"{more} }},\n")
    };
    let lines: Vec<String> = all.iter().map(line).collect();
    format!("law = \"{law}\"\nparameter = [\n{}]\n", lines.concat())
}

/// A study of a model, with the whole law as its best compensator.
fn study_of(served: &Served, model: &str, law: &str) {
    std::fs::write(served.path().join("model.toml"), model).unwrap();
    let study = STUDY.replace("known = \"motor\"", "model = \"model.toml\"");
    let study = study.replace("\"lugre\"", &format!("\"{law}\""));
    std::fs::write(served.path().join("study.toml"), study).unwrap();
}

#[test]
fn the_elements_of_a_law_move_together() {
    for law in ["maxwell-slip", "gms"] {
        let served = open();
        study_of(&served, &elements(law), law);
        let at = trial(&served, &json!({ "study": "study.toml" }));
        let knobs = at["knobs"].as_array().unwrap().iter();
        let knobs: BTreeMap<&str, &Value> = knobs
            .map(|own| (own["name"].as_str().unwrap(), own))
            .collect();
        assert!(
            !knobs
                .keys()
                .any(|name| name.contains('_') && !name.starts_with("stribeck"))
        );
        // The sum of the stiffnesses, which the model does not have.
        let stiffness = knobs["sigma0"];
        assert_eq!(
            (number(&stiffness["value"]), &stiffness["unit"]),
            (1.6e6, &json!("N/m"))
        );
        assert_eq!(stiffness["elements"], 3);
        let level = if law == "gms" { "static" } else { "coulomb" };
        assert_eq!(number(&knobs[level]["high"]), 12.5);
        // The axis as modelled, and what each of them changes of it.
        let same = trial(
            &served,
            &json!({ "study": "study.toml", "values": { "sigma0": 1.6e6 } }),
        );
        assert_eq!(same["runs"], at["runs"]);
        let peak = |name: &str, value: &Value| {
            let asked = json!({ "study": "study.toml", "values": { name: value } });
            number(&trial(&served, &asked)["runs"][0]["peak_error"])
        };
        let before = number(&at["runs"][0]["peak_error"]);
        assert!(peak(level, &knobs[level]["high"]) > before, "{law}");
        let (soft, stiff) = (
            peak("sigma0", &stiffness["low"]),
            peak("sigma0", &stiffness["high"]),
        );
        assert!(soft != before && stiff != before && soft != stiff, "{law}");
        // Elements by themselves are not moved.
        let asked = json!({ "study": "study.toml", "values": { "stiffness_1": 1e6 } });
        let answer = served.ask("POST", "/api/trial", &asked.to_string());
        assert!(
            answer.text().contains("cannot be moved; allowed: sigma0,"),
            "{}",
            answer.text()
        );
    }
}

/// The break-away ratio of an elasto-plastic law has an end that no law reaches.
#[test]
fn an_open_break_away_ratio_moves_to_both_sides() {
    let served = open();
    let ratio =
        "    { name = \"breakaway_ratio\", value = 0.7, unit = \"1\", ci95 = [0.6, inf] },\n]";
    let model = LUGRE.replace("\"lugre\"", "\"elasto-plastic\"");
    let end = model.rfind(']').unwrap();
    let model = format!("{}{ratio}\n", &model[..end]);
    study_of(&served, &model, "elasto-plastic");
    let at = trial(&served, &json!({ "study": "study.toml" }));
    let knobs = at["knobs"].as_array().unwrap();
    let knob = knobs
        .iter()
        .find(|own| own["name"] == "breakaway_ratio")
        .unwrap();
    assert_eq!(
        (&knob["range"], number(&knob["low"])),
        (&json!("open"), 0.6)
    );
    assert!((number(&knob["high"]) - 0.9).abs() < 1e-12, "{knob}");
    let asked = json!({ "study": "study.toml", "values": { "breakaway_ratio": knob["high"] } });
    assert!(trial(&served, &asked)["runs"] != at["runs"]);
}
