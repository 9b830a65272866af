//! A machine of the library identified once more, by the command in its row.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;
use stiction_files::sha256;
use stiction_workflows::library::{Found, FoundJoint, Machine};

/// What a command gave.
pub struct Rebuilt {
    /// What was found, without a date.
    pub found: Found,
    /// SHA-256 of each recording.
    pub sums: Vec<String>,
    /// The files of the machine, by their paths from its folder.
    pub files: Vec<(String, String)>,
}

/// Where the inputs of a command are.
pub struct Inputs<'a> {
    /// The program.
    pub program: &'a Path,
    /// The folder of the library.
    pub library: &'a Path,
    /// The recordings.
    pub data: &'a Path,
    /// The robots of example-robot-data.
    pub urdfs: Option<&'a Path>,
}

/// Runs the command of a machine in a folder of its own, and collects what it leaves.
pub fn rebuild(machine: &Machine, inputs: &Inputs) -> Result<Rebuilt, String> {
    let said = |e: std::io::Error| format!("{}: {e}", machine.name);
    let work = tempfile::tempdir().map_err(said)?;
    let put = |file: &Path| {
        let to = work.path().join(file.file_name().unwrap_or_default());
        // The recordings may be write-protected, and a copy of that kind would be too.
        let bytes = fs::read(file).map_err(|e| format!("{}: {e}", file.display()))?;
        fs::write(to, bytes).map_err(said)
    };
    let mut sums = Vec::new();
    for recording in &machine.recordings {
        let file = inputs.data.join(&recording.file);
        put(&file)?;
        sums.push(sha256(&file).map_err(|e| e.to_string())?);
    }
    let mut files = Vec::new();
    let axis = inputs.library.join(&machine.name).join("axis.toml");
    if let Ok(text) = fs::read_to_string(&axis) {
        put(&axis)?;
        files.push(("axis.toml".into(), text));
    }
    if let Some(urdf) = &machine.urdf {
        let folder = inputs
            .urdfs
            .ok_or("no folder with the URDFs of example-robot-data")?;
        put(&folder.join(urdf))?;
    }
    let words: Vec<&str> = machine.command.split_whitespace().skip(1).collect();
    let at = words.iter().position(|word| *word == "--out");
    let out = at.and_then(|at| words.get(at + 1));
    let out = work.path().join(out.ok_or("the command has no --out")?);
    let ran = Command::new(inputs.program)
        .args(&words)
        .arg("--quiet")
        .current_dir(work.path())
        .output();
    let ran = ran.map_err(said)?;
    // 1 is a verdict.
    if !matches!(ran.status.code(), Some(0 | 1)) {
        let errors = String::from_utf8_lossy(&ran.stderr);
        return Err(format!("{}: {errors}", machine.command));
    }
    let read = |name: &str| fs::read_to_string(out.join(name)).map_err(|e| format!("{name}: {e}"));
    let json = |name: &str| -> Result<Value, String> {
        serde_json::from_str(&read(name)?).map_err(|e| format!("{name}: {e}"))
    };
    let found = if machine.urdf.is_some() {
        let result = json("robot.json")?;
        files.push(("robot.toml".into(), read("robot.toml")?));
        for joint in array(&result["joints"]) {
            if let Some(folder) = joint["fit"]["folder"].as_str() {
                let model = format!("{folder}/model.toml");
                files.push((model.clone(), read(&model)?));
            }
        }
        of_robot(&result)
    } else {
        files.push(("model.toml".into(), read("model.toml")?));
        of_axis(&json("result.json")?)
    };
    Ok(Rebuilt { found, sums, files })
}

fn array(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().into()
}

fn texts(value: &Value) -> Vec<String> {
    array(value).iter().map(text).collect()
}

/// The name of a law, with what it adds.
fn law(entry: &Value) -> String {
    let sides = match entry["asymmetric"].as_bool() {
        Some(true) => ", asymmetric",
        _ => "",
    };
    format!("{}{sides}", text(&entry["law"]))
}

fn of_axis(result: &Value) -> Found {
    let laws = array(&result["laws"]);
    let own = laws.iter().find(|law| law["reported"] == true);
    let error = own.and_then(|law| law["held_out_error_percent"].as_f64());
    Found {
        version: text(&result["version"]),
        law: law(result),
        held_out_error_percent: error.unwrap_or(f64::NAN),
        usable: result["trust"]["trustworthy"] == true,
        reasons: texts(&result["trust"]["reasons"]),
        ..Found::default()
    }
}

fn of_robot(result: &Value) -> Found {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let joints = array(&result["joints"]).iter().map(|joint| {
        let fit = &joint["fit"];
        FoundJoint {
            name: text(&joint["name"]),
            law: law(fit),
            held_out_error_percent: 100.0 * number(&fit["held_out_rms"])
                / number(&fit["torque_rms"]),
            usable: fit["compensates"] == true,
            reasons: texts(&fit["reasons"]),
        }
    });
    let joints: Vec<FoundJoint> = joints.collect();
    let mut laws: Vec<&str> = joints.iter().map(|joint| joint.law.as_str()).collect();
    laws.sort_unstable();
    laws.dedup();
    let errors = joints.iter().map(|joint| joint.held_out_error_percent);
    Found {
        version: text(&result["version"]),
        law: laws.join(", "),
        held_out_error_percent: errors.fold(0.0, f64::max),
        usable: result["trust"]["trustworthy"] == true,
        reasons: texts(&result["trust"]["reasons"]),
        joints,
        ..Found::default()
    }
}
