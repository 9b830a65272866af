//! The page on the paper's steps: every command of it, as written, from an empty folder; and the paper's experiments on a
//! user's own axis.

use crate::page::{Page, run};
use std::path::Path;

const PAGE: Page = Page(include_str!("../../../../docs/paper.md"));

/// Writes the files of the page and runs its commands but those that `skips` names.
fn follow(dir: &Path, skips: &str) {
    for (name, text) in ["axis.toml", "study.toml"].iter().zip(PAGE.blocks("toml")) {
        std::fs::write(dir.join(name), text).unwrap();
    }
    let commands = PAGE.commands();
    assert_eq!(commands.len(), 7);
    for command in commands {
        if command.starts_with(skips) {
            continue;
        }
        let (code, out, err) = run(dir, &command);
        assert_eq!(code, 0, "{command}\n{out}\n{err}");
    }
}

#[test]
#[ignore = "soak: a third of a minute"]
fn every_command_of_the_page() {
    let dir = tempfile::tempdir().unwrap();
    follow(dir.path(), "reproduce");
    let block = std::fs::read_dir(dir.path().join("twincat")).unwrap();
    let names: Vec<String> = block
        .map(|f| f.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    assert!(
        names.iter().any(|n| n.ends_with("_Friction.TcPOU")),
        "{names:?}"
    );
    // Steps of the paper: what it identified, and what compensation then leaves.
    let text = std::fs::read_to_string(dir.path().join("dynamic/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&text).unwrap();
    let truth = [
        ("sigma0", 1.2e5),
        ("sigma1", 600.0),
        ("sigma2", 60.0),
        ("coulomb", 20.0),
        ("static", 30.0),
        ("stribeck_velocity", 5e-3),
    ];
    for (name, truth) in truth {
        let parameters = result["parameters"].as_array().unwrap();
        let found = parameters.iter().find(|p| p["name"] == name).unwrap();
        let value = found["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 0.01, "{name}: {value}");
    }
    let study = std::fs::read_to_string(dir.path().join("study/study.json")).unwrap();
    assert!(study.contains("LuGre, measured"));
}

/// The same with the experiments on that axis, which take a while: for the soak.
#[test]
#[ignore = "soak: a minute and a half"]
fn every_command_of_the_page_and_the_experiments() {
    let dir = tempfile::tempdir().unwrap();
    follow(dir.path(), "nothing");
    assert!(dir.path().join("paper/reproduce.json").exists());
}

/// Axes of four kinds: sigma0, sigma1, sigma2, Fc, Fs, vs, mass, step of the encoder. None of them was used to choose a constant
/// but that of the rotary motor, whose loop shook at the bandwidth that its fall of friction asked for.
const AXES: [(&str, &str, [&str; 8]); 4] = [
    (
        "linear motor",
        "linear",
        [
            "1e6", "1200.0", "25.0", "6.0", "8.5", "2e-3", "12 kg", "100 nm",
        ],
    ),
    (
        "ball screw",
        "linear",
        [
            "3.5e7", "3e4", "900.0", "130.0", "165.0", "4e-3", "180 kg", "100 nm",
        ],
    ),
    (
        "rotary motor",
        "rotary",
        [
            "310.0",
            "0.55",
            "0.011",
            "0.21",
            "0.29",
            "0.02",
            "0.0031 kg m2",
            "5e-6 rad",
        ],
    ),
    (
        "belt",
        "linear",
        [
            "1.6e5", "420.0", "85.0", "34.0", "47.0", "15e-3", "7.5 kg", "5 um",
        ],
    ),
];

/// The paper's steps find an axis of each kind to what they state.
#[test]
#[ignore = "soak: five minutes"]
fn axes_of_four_kinds() {
    for (name, kind, [s0, s1, s2, fc, fs, vs, mass, step]) in AXES {
        let dir = tempfile::tempdir().unwrap();
        let [force, per, speed] = match kind {
            "linear" => ["N", "/m", "m/s"],
            _ => ["N*m", "/rad", "rad/s"],
        };
        let mut model = format!(
            "schema = \"stiction.model/1\"\nkind = \"{kind}\"\nlaw = \"lugre\"\nasymmetric = false\nforce_unit = \"{force}\"\n\
             trustworthy = true\n[source]\nversion = \"0\"\nmethod = \"separable\"\nseed = 0\ninputs = []\n"
        );
        for (parameter, value, unit) in [
            ("sigma0", s0, format!("{force}{per}")),
            ("sigma1", s1, format!("{force}*s{per}")),
            ("sigma2", s2, format!("{force}*s{per}")),
            ("coulomb", fc, force.into()),
            ("static", fs, force.into()),
            ("stribeck_velocity", vs, speed.into()),
        ] {
            model.push_str(&format!(
                "[[parameter]]\nname = \"{parameter}\"\nsymbol = \"x\"\nvalue = {value}\nunit = \"{unit}\"\n\
                 identifiable = true\norigin = \"identified\"\n"
            ));
        }
        let axis =
            format!("kind = \"{kind}\"\nmass = \"{mass}\"\n[log]\nresolution = \"{step}\"\n");
        std::fs::write(dir.path().join("model.toml"), model).unwrap();
        std::fs::write(dir.path().join("axis.toml"), axis).unwrap();
        let command = "reproduce paper --model model.toml --axis axis.toml --out paper";
        let (code, out, err) = run(dir.path(), command);
        assert_eq!(code, 0, "{name}\n{out}\n{err}");
    }
}

/// Bad input to the experiments: file, line and key, what was found, what is allowed.
#[test]
fn an_axis_that_cannot_be_used() {
    let dir = tempfile::tempdir().unwrap();
    let model = include_str!("../../../../examples/export/model.toml");
    let write = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
    write("model.toml", model);
    write("axis.toml", "mass = \"4.6 kg\"\n");
    write("rotary.toml", "kind = \"rotary\"\n");
    write("unit.toml", "mass = \"46 m\"\n");
    let still = model.replace("value = 12.0", "value = 0.0");
    write("still.toml", &still.replace("11.8, 12.2", "0.0, 12.2"));
    let mut said = String::new();
    for options in [
        "1995 --model model.toml",
        "paper --axis axis.toml",
        "paper --model missing.toml",
        "paper --model model.toml",
        "paper --model model.toml --axis rotary.toml",
        "paper --model model.toml --axis unit.toml",
        "paper --model still.toml --axis axis.toml",
    ] {
        let (code, out, err) = run(dir.path(), &format!("reproduce {options} --out a --quiet"));
        assert_eq!((code, out.as_str()), (2, ""), "{options}: {err}");
        said.push_str(&format!("$ reproduce {options}\n{err}\n"));
    }
    insta::assert_snapshot!(said);
}
