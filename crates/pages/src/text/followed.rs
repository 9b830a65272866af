//! Friction over time for whoever shows it with elements of its own.

use crate::apart::apart;
use crate::drift::{few, quiet, row, unclear, unnamed};
use stiction_files::drift_file::DriftFile;
use stiction_number::counted;

/// What is said of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct FollowedWords {
    /// What changed, in a line.
    pub verdict: String,
    /// What limits that.
    pub notes: Vec<String>,
    /// Of each alarm since when it was, and when it was found.
    pub times: Vec<[String; 2]>,
}

/// What is said of a table.
pub fn followed(file: &DriftFile) -> FollowedWords {
    let verdict = match file.alarmed_machines() {
        0 => quiet(file),
        machines => format!(
            "{machines} of {} changed",
            counted(file.machines, "machine")
        ),
    };
    let few = few(file).filter(|_| file.alarms.is_empty());
    let unnamed = (file.input.unnamed > 0).then(|| unnamed(file));
    let untimed = (!file.timed).then(|| {
        "some logs have no time: they are taken in the order of the table, one a day".to_string()
    });
    let notes = [unclear(file), untimed, unnamed, few];
    let apart = apart(&file.apart);
    let times = file.alarms.iter().map(|alarm| {
        let [_, _, _, since, found, ..] = row(file, alarm);
        [since, found]
    });
    FollowedWords {
        verdict,
        notes: notes
            .into_iter()
            .flatten()
            .chain(apart.lines().map(String::from))
            .collect(),
        times: times.collect(),
    }
}
