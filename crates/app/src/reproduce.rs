//! Published experiments run again, each number beside its reference.

mod paper;
mod watch;

pub use paper::{Budget, zhang_2025};
pub(crate) use paper::{
    Cornered, Dynamics, Fed, LoadFound, PARAMETERS, Paper, Presliding, Searched, Statics, Tracked,
};

use crate::output::Bundle;
use crate::report;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use stiction_identify::Control;
use stiction_servo::c95::{self, Experiment};
use watch::Watch;

/// Name of the schema.
pub const SCHEMA: &str = "stiction.reproduce/1";

/// What goes into `reproduce.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReproduceFile {
    /// `stiction.reproduce/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// Which publication: `1995` or `paper`.
    pub name: String,
    /// `complete` or `interrupted`.
    #[serde(default = "complete")]
    pub status: String,
    /// Whether every number is within its tolerance.
    pub all_within: bool,
    /// Every number, in the order of the experiments.
    pub checks: Vec<CheckEntry>,
    /// Figures of ours beside claims of the publication, which are not of the same experiment.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub claims: Vec<ClaimEntry>,
    /// What was assumed where the publication gives no number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assumptions: Vec<String>,
}

fn complete() -> String {
    "complete".into()
}

/// One number beside its reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckEntry {
    /// Letter or name of the experiment.
    pub experiment: String,
    /// What it is.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// What it should be.
    pub reference: f64,
    /// What it is here.
    pub found: f64,
    /// How far off it may be, in `unit`.
    pub tolerance: f64,
    /// Whether it is not farther off.
    pub within: bool,
}

/// A metric of ours without and with compensation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClaimEntry {
    /// What it is.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// What drives the compensation.
    pub compensation: String,
    /// Without compensation.
    pub without: f64,
    /// With it.
    pub with: f64,
    /// By how much it is less, percent.
    pub reduction_percent: f64,
    /// What the publication claims, in its words; may be empty.
    pub published: String,
}

/// Everything that came out, in memory.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// What goes into `reproduce.json`.
    pub file: ReproduceFile,
    pub(crate) body: Body,
}

/// What the report draws.
#[derive(Clone, Debug)]
pub(crate) enum Body {
    Canudas1995(Vec<Experiment>),
    Zhang2025(Box<Paper>),
}

impl ReproduceFile {
    /// A complete reproduction of a publication, in which nothing has been done yet.
    fn of(name: &str) -> Self {
        ReproduceFile {
            schema: SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            name: name.into(),
            status: complete(),
            all_within: true,
            checks: Vec::new(),
            claims: Vec::new(),
            assumptions: Vec::new(),
        }
    }
}

impl CheckEntry {
    /// A number that may be off by the part `relative` of its reference.
    fn relative(
        experiment: &str,
        name: &str,
        unit: &str,
        reference: f64,
        found: f64,
        relative: f64,
    ) -> Self {
        let tolerance = relative * reference.abs();
        CheckEntry {
            experiment: experiment.into(),
            name: name.into(),
            unit: unit.into(),
            reference,
            found,
            tolerance,
            within: (found - reference).abs() <= tolerance,
        }
    }
}

/// The experiments B to G of Canudas de Wit et al. 1995 (doi 10.1109/9.376053). `watch` is told how many of how many are
/// done, also within the longest, and may stop the work: those that are done by then are kept.
pub fn canudas_1995(watch: &mut (dyn FnMut(usize, usize) -> Control + Send)) -> Reproduction {
    let watch = Watch::new(c95::ALL.len(), watch);
    let experiments: Vec<Option<Experiment>> = c95::ALL
        .par_iter()
        .map(|run| {
            let go_on = || !watch.stopped();
            let experiment = run(&go_on).expect("the settings of 1995 are valid");
            if experiment.is_some() {
                watch.add();
            }
            experiment
        })
        .collect();
    let all = experiments.iter().all(Option::is_some);
    let experiments: Vec<Experiment> = experiments.into_iter().flatten().collect();
    let checks: Vec<CheckEntry> = experiments
        .iter()
        .flat_map(|e| e.checks.iter().map(|check| (e.letter, check)))
        .map(|(letter, check)| CheckEntry {
            experiment: letter.to_string(),
            name: check.name.clone(),
            unit: check.unit.into(),
            reference: check.reference,
            found: check.found,
            tolerance: check.tolerance,
            within: check.holds(),
        })
        .collect();
    Reproduction {
        file: ReproduceFile {
            status: if all { "complete" } else { "interrupted" }.into(),
            all_within: checks.iter().all(|c| c.within),
            checks,
            ..ReproduceFile::of("1995")
        },
        body: Body::Canudas1995(experiments),
    }
}

impl Reproduction {
    /// `report.html` and `reproduce.json`.
    pub fn bundle(&self) -> Bundle {
        let mut bundle = Bundle::default();
        bundle.add("report.html", report::reproduction(self).to_html());
        let json = serde_json::to_string_pretty(&self.file).expect("plain data");
        bundle.add("reproduce.json", json + "\n");
        bundle
    }
}
