//! A study whose axis is moved by sliders.

use crate::client::{Served, open};
use crate::work::ended;
use serde_json::{Value, json};

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

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// What is tried at the values of the model is what the study finds, to the last bit.
#[test]
fn a_path_that_is_tried_is_that_of_the_study() {
    let served = open();
    std::fs::write(served.path().join("study.toml"), STUDY).unwrap();
    let asked = json!({ "kind": "simulate", "study": "study.toml", "out": "study" });
    let id = served.ask("POST", "/api/jobs", &asked.to_string()).json();
    assert_eq!(ended(&served, id.as_u64().unwrap())["state"], "done");
    let text = std::fs::read_to_string(served.path().join("study/study.json")).unwrap();
    let study: Value = serde_json::from_str(&text).unwrap();
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
            for metric in ["rms_error", "peak_error", "reversal_peak"] {
                let all = of_study.unwrap()["metrics"].as_array().unwrap();
                let found = all.iter().find(|own| own["name"] == metric).unwrap();
                assert_eq!(run[metric], found["mean"], "{compensator} {metric}");
            }
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
