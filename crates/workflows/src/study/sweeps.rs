//! Sweeps: what the runs of each value gave, side by side.

use super::done::Done;
use super::machine::unit;
use super::metrics::metrics;
use stiction_files::study::result::{SweepEntry, SweepMetric, SweepRow};
use stiction_files::study::{Study, Sweep};

/// The sweeps of a study, from what is done of the grid of each of their values.
pub(super) fn entries(study: &Study, done: &[Vec<Done>]) -> Vec<SweepEntry> {
    let mut left = done;
    let entries = study.sweeps.iter().map(|sweep| {
        let (points, rest) = left.split_at(sweep.points.len().min(left.len()));
        left = rest;
        entry(study, sweep, points)
    });
    entries.collect()
}

fn entry(study: &Study, sweep: &Sweep, points: &[Vec<Done>]) -> SweepEntry {
    // The grids of all values have the same places.
    let jobs = sweep.points.first().map(|p| p.study.jobs());
    let mut left: Vec<_> = points.iter().map(|done| done.iter().peekable()).collect();
    let rows = jobs.unwrap_or_default().into_iter().map(|job| {
        let runs = left.iter_mut().map(|done| done.next_if(|d| d.job == job));
        let runs: Vec<Option<&Done>> = runs.collect();
        let metric = |(i, name): (usize, &&str)| {
            let value = |run: &Option<&Done>| run.map(|d| d.metrics[i]).filter(|x| !x.is_nan());
            let values: Vec<Option<f64>> = runs.iter().map(value).collect();
            values.iter().any(Option::is_some).then(|| SweepMetric {
                name: name.to_string(),
                unit: unit(&study.machine, name),
                values,
            })
        };
        let [path, controller, compensator] = study.names(job).map(String::from);
        SweepRow {
            path,
            controller,
            compensator,
            coupled: job.coupled,
            metrics: metrics(study, job)
                .iter()
                .enumerate()
                .filter_map(metric)
                .collect(),
        }
    });
    SweepEntry {
        key: sweep.key.clone(),
        unit: sweep.unit.clone(),
        values: sweep.points.iter().map(|p| p.value).collect(),
        results: rows.collect(),
    }
}
