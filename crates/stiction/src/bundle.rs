//! What goes into an output folder: the outcome of a workflow as files, with its report.

use crate::fit_csv::fit_csv;
use serde::Serialize;
use stiction_files::compare_file::CompareFile;
use stiction_files::study::template::{Shown, template};
use stiction_files::{Bundle, ModelFile};
use stiction_pages::report;
use stiction_workflows::identify::Outcome;
use stiction_workflows::reproduce::Reproduction;
use stiction_workflows::study::StudyOutcome;

/// The files of an identification: `result.json`, `model.toml`, `report.html`, `fit.csv`, and where a study takes the law
/// `study.toml`.
pub fn identification(outcome: &Outcome) -> Bundle {
    let mut bundle = Bundle::default();
    let model = ModelFile::from_result(&outcome.result);
    bundle.add("model.toml", model.to_toml());
    bundle.add("fit.csv", fit_csv(outcome));
    bundle.add("report.html", report::identification(outcome).to_html());
    if let Some(study) = study_of(outcome) {
        bundle.add("study.toml", study);
    }
    bundle.add("result.json", json(&outcome.result));
    bundle
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

/// The files of a study: `report.html`, `study.json`, and `trajectories.csv`, `contours.csv` with the courses of the
/// runs.
pub fn study(outcome: &StudyOutcome) -> Bundle {
    let mut bundle = Bundle::default();
    bundle.add("report.html", report::study(outcome).to_html());
    let names = ["trajectories.csv", "contours.csv"];
    for (name, rows) in names.into_iter().zip(&outcome.courses) {
        if !rows.is_empty() {
            bundle.add(name, rows.as_str());
        }
    }
    bundle.add("study.json", json(&outcome.file));
    bundle
}

/// The files of a reproduction: `report.html` and `reproduce.json`.
pub fn reproduction(outcome: &Reproduction) -> Bundle {
    let mut bundle = Bundle::default();
    bundle.add("report.html", report::reproduction(outcome).to_html());
    bundle.add("reproduce.json", json(&outcome.file));
    bundle
}

fn json(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).expect("plain data") + "\n"
}
