//! Published experiments run again, each number beside its reference.

use crate::output::Bundle;
use crate::report;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use stiction_servo::c95::{self, Experiment};

/// Name of the schema.
pub const SCHEMA: &str = "stiction.reproduce/1";

/// What goes into `reproduce.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReproduceFile {
    /// `stiction.reproduce/1`.
    pub schema: String,
    /// Version of stiction.
    pub version: String,
    /// Which publication: `1995`.
    pub name: String,
    /// Whether every number is within its tolerance.
    pub all_within: bool,
    /// Every number, in the order of the experiments.
    pub checks: Vec<CheckEntry>,
}

/// One number beside its reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckEntry {
    /// Letter of the experiment.
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

/// Everything that came out, in memory.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// What goes into `reproduce.json`.
    pub file: ReproduceFile,
    pub(crate) experiments: Vec<Experiment>,
}

/// The experiments B to G of Canudas de Wit et al. 1995 (doi 10.1109/9.376053).
pub fn canudas_1995() -> Reproduction {
    let experiments: Vec<Experiment> = c95::ALL
        .par_iter()
        .map(|run| run().expect("the settings of 1995 are valid"))
        .collect();
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
            schema: SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            name: "1995".into(),
            all_within: checks.iter().all(|c| c.within),
            checks,
        },
        experiments,
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
