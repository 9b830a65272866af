//! The experiments of Canudas de Wit et al. 1995.

use super::outcome::{Body, Reproduction};
use super::watch::Watch;
use rayon::prelude::*;
use stiction_files::reproduce_file::{CheckEntry, ReproduceFile};
use stiction_search::Observer;
use stiction_servo::c95::{self, Experiment};

/// The experiments B to G of Canudas de Wit et al. 1995 (doi 10.1109/9.376053). The observer is told the number of
/// steps done and their total, also within the longest experiment, and may stop the work: experiments done by then
/// are kept.
pub fn canudas_1995(observer: &mut dyn Observer) -> Reproduction {
    let watch = Watch::new(c95::ALL.len(), observer);
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
