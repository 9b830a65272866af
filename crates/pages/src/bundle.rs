//! What goes into an output folder: the outcome of a workflow as files, with its report.

mod fit_csv;

use crate::report;
pub use fit_csv::columns as fit_columns;
use fit_csv::fit_csv;
use serde::Serialize;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use stiction_files::compare_file::CompareFile;
use stiction_files::robot::model;
use stiction_files::study::template::{Shown, template};
use stiction_files::{Bundle, ModelFile, check_folder_of, shell, visible};
use stiction_workflows::drift::DriftOutcome;
use stiction_workflows::identify::Outcome;
use stiction_workflows::plan::{Carrier, Planned};
use stiction_workflows::reproduce::Reproduction;
use stiction_workflows::robot::RobotOutcome;
use stiction_workflows::study::StudyOutcome;

/// The files of an identification: `result.json`, `model.toml`, `report.html`, `fit.csv`, and where a study takes the law
/// `study.toml`.
pub fn identification(outcome: &Outcome) -> Bundle {
    with_report(outcome, report::identification(outcome).to_html())
}

/// The same for a folder, by which the commands in the report call those that follow.
pub fn identification_in(outcome: &Outcome, folder: &Path) -> Bundle {
    with_report(
        outcome,
        report::identification_in(outcome, folder).to_html(),
    )
}

fn with_report(outcome: &Outcome, report: String) -> Bundle {
    let mut bundle = Bundle::default();
    bundle.add("model.toml", model_of(outcome));
    bundle.add("fit.csv", fit_csv(outcome));
    bundle.add("report.html", report);
    match study_of(outcome) {
        Some(study) => bundle.add("study.toml", visible::toml(study)),
        None => bundle.lacks("study.toml"),
    }
    bundle.add("result.json", json(&outcome.result));
    bundle
}

fn model_of(outcome: &Outcome) -> String {
    ModelFile::from_result(&outcome.result).to_toml()
}

/// The files of a robot: `robot.json`, `robot.toml`, `report.html`, and of each joint that was fitted `result.json`, `model.toml` and
/// `fit.csv` in `joints/NAME`. The folder is the one that they are for: by it the robot file names the URDF, and the commands in the
/// report those that follow.
pub fn robot(outcome: &RobotOutcome, folder: &Path) -> Bundle {
    let mut bundle = Bundle::default();
    for joint in &outcome.joints {
        let file = |name: &str| format!("{}/{name}", joint.folder);
        match &joint.outcome {
            Ok(outcome) => {
                bundle.add(file("model.toml"), model_of(outcome));
                bundle.add(file("fit.csv"), fit_csv(outcome));
                bundle.add(file("result.json"), json(&outcome.result));
            }
            Err(_) => ["model.toml", "fit.csv", "result.json"]
                .into_iter()
                .for_each(|name| bundle.lacks(file(name))),
        }
    }
    let urdf = shell::text(&seen_from(folder, &outcome.urdf.path));
    let text = model::text(&outcome.result, &urdf);
    bundle.add("robot.toml", visible::toml(text));
    bundle.add("report.html", report::robot(outcome, folder).to_html());
    bundle.add("robot.json", json(&outcome.result));
    bundle
}

/// A path from a folder instead of from where the program runs.
fn seen_from(folder: &Path, path: &Path) -> PathBuf {
    let is_plain = |part: Component| matches!(part, Component::Normal(_));
    let down: Vec<Component> = folder
        .components()
        .filter(|part| *part != Component::CurDir)
        .collect();
    if path.is_absolute() || down.iter().all(|part| is_plain(*part)) {
        let up = down.iter().map(|_| "..");
        return up.collect::<PathBuf>().join(path);
    }
    std::path::absolute(path).unwrap_or_else(|_| path.into())
}

/// A study of what was identified, on motion like that of its logs.
fn study_of(outcome: &Outcome) -> Option<String> {
    let log = &outcome.sources.first()?.log;
    let forces = log.force.as_ref()?.iter();
    let shown = Shown {
        motion: outcome.motion,
        rate: log.rate_hz,
        step: log.quantum,
        force: forces.fold(0.0, |most: f64, f| most.max(f.abs())),
    };
    template(&outcome.result, &shown)
}

/// The files of a comparison: `compare.json` and `report.html`.
pub fn comparison(file: &CompareFile) -> Bundle {
    let mut bundle = Bundle::default();
    bundle.add("report.html", report::comparison(file).to_html());
    bundle.add("compare.json", json(file));
    bundle
}

/// The files of friction over time: `drift.json` and `report.html`.
pub fn drift(outcome: &DriftOutcome) -> Bundle {
    let mut bundle = Bundle::default();
    bundle.add("report.html", report::drift(outcome).to_html());
    bundle.add("drift.json", json(&outcome.file));
    bundle
}

/// The files of a study: `report.html`, `study.json`, and `trajectories.csv`, `contours.csv` with the courses of the
/// runs.
pub fn study(outcome: &StudyOutcome) -> Bundle {
    let mut bundle = Bundle::default();
    bundle.add("report.html", report::study(outcome).to_html());
    let names = ["trajectories.csv", "contours.csv"];
    for (name, rows) in names.into_iter().zip(&outcome.courses) {
        match rows.is_empty() {
            false => bundle.add(name, rows.as_str()),
            true => bundle.lacks(name),
        }
    }
    bundle.add("study.json", json(&outcome.file));
    bundle
}

/// The files of a plan: `plan.toml`, `setpoints.csv` and each other form of the set points, `report.html`.
pub fn plan(planned: &Planned) -> Bundle {
    let mut bundle = Bundle::default();
    for carrier in Carrier::ALL {
        let carried = planned.carried.iter().find(|c| c.carrier == carrier);
        match carried {
            Some(carried) => bundle.add(carrier.file(), carried.text.as_str()),
            None => bundle.lacks(carrier.file()),
        }
    }
    bundle.add("report.html", report::plan(planned).to_html());
    bundle.add("plan.toml", planned.file.to_toml());
    bundle
}

/// The files of a reproduction: `report.html` and `reproduce.json`.
pub fn reproduction(outcome: &Reproduction) -> Bundle {
    let mut bundle = Bundle::default();
    bundle.add("report.html", report::reproduction(outcome).to_html());
    bundle.add("reproduce.json", json(&outcome.file));
    bundle
}

/// Where an outcome that was stopped early goes: beside `dir` where that holds a complete one of this schema, which is kept;
/// `None` where `dir` itself may take it. `stopped` says that it was, also where it does not say so itself: a search that had
/// ended when what follows it was stopped.
pub fn beside_complete(
    bundle: &Bundle,
    dir: &Path,
    schema: &str,
    stopped: bool,
) -> Option<PathBuf> {
    let file = file_of(schema);
    let (_, content) = bundle.files().iter().find(|(name, _)| *name == file)?;
    let early = stopped || says_early(&file, content);
    if !early || !holds_complete(dir, schema) {
        return None;
    }
    // Without a slash or a dot at its end.
    let plain: PathBuf = dir.components().collect();
    let named = |end: &str| {
        let mut name = plain.clone().into_os_string();
        name.push(end);
        PathBuf::from(name)
    };
    let beside = (1..MOST_NAMES).map(|k| match k {
        1 => named("-interrupted"),
        k => named(&format!("-interrupted-{k}")),
    });
    let beside = beside.filter(|_| plain.file_name().is_some());
    // Within it where nothing can be written beside it.
    let mut names = beside.chain([plain.join("interrupted")]);
    names.find(|other| {
        check_folder_of(other, schema, false).is_ok() && !holds_complete(other, schema)
    })
}

/// Most names that are tried.
const MOST_NAMES: u32 = 100;

/// The file of a schema: `result.json` of `stiction.result/1`.
fn file_of(schema: &str) -> String {
    let kind = schema.trim_start_matches("stiction.").split('/').next();
    let kind = kind.unwrap_or_default();
    match kind {
        "plan" => "plan.toml".into(),
        _ => format!("{kind}.json"),
    }
}

/// Whether a folder holds an outcome of this schema that was not stopped early.
fn holds_complete(dir: &Path, schema: &str) -> bool {
    let name = file_of(schema);
    let file = dir.join(&name);
    if !file.is_file() {
        return false;
    }
    let mut content = Vec::new();
    let read =
        std::fs::File::open(file).and_then(|file| file.take(MOST_BYTES).read_to_end(&mut content));
    read.is_ok() && is_outcome(&name, &content) && !says_early(&name, &content)
}

/// Whether a file of that name is one that says how its work ended.
fn is_outcome(name: &str, content: &[u8]) -> bool {
    match name.ends_with(".toml") {
        true => status_of_plan(content).is_some(),
        false => serde_json::from_slice::<serde_json::Value>(content).is_ok(),
    }
}

/// Whether a file of that name says that its work was stopped early.
fn says_early(name: &str, content: &[u8]) -> bool {
    match name.ends_with(".toml") {
        true => status_of_plan(content).is_some_and(|status| status != "complete"),
        false => serde_json::from_slice(content).is_ok_and(|value| stopped_early(&value)),
    }
}

/// The status of a plan, which stands before its tables.
fn status_of_plan(content: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(content).ok()?;
    let mut lines = text.lines().take_while(|line| !line.starts_with('['));
    let status = lines.find_map(|line| line.strip_prefix("status = \""))?;
    status.strip_suffix('"')
}

/// Whether a user, a budget or the time ended the work before it was done; least squares after a search end it.
fn stopped_early(value: &serde_json::Value) -> bool {
    let is = |place: &str, states: &[&str]| {
        let state = value.pointer(place).and_then(|state| state.as_str());
        state.is_some_and(|state| states.contains(&state))
    };
    let early = ["interrupted", "budget"];
    is("/status", &early)
        || is("/search/status", &early)
        || (is("/trust/next", &["finish"])
            && is("/searched/status", &["interrupted", "budget", "time"]))
}

/// Largest file that is looked into, bytes.
const MOST_BYTES: u64 = 256 << 20;

fn json(value: &impl Serialize) -> String {
    visible::json(serde_json::to_string_pretty(value).expect("plain data") + "\n")
}
