//! Rows of results: the runs of a cell of the grid together.

use super::done::Done;
use super::machine::unit;
use super::metrics::metrics;
use stiction_files::study::Study;
use stiction_files::study::result::{MetricEntry, ResultRow};

/// Rows in the order of the grid, of what is done.
pub(super) fn rows(study: &Study, done: &[Done]) -> Vec<ResultRow> {
    let mut rows: Vec<ResultRow> = Vec::new();
    for cell in done.chunk_by(|a, b| a.job.cell() == b.job.cell()) {
        let job = cell[0].job;
        let family = &study.families[job.family];
        let names = metrics(study, job);
        let name = |i: usize| (names[i].to_string(), unit(&study.machine, names[i]));
        let metrics = (0..names.len()).filter_map(|i| {
            let values: Vec<f64> = cell.iter().map(|d| d.metrics[i]).collect();
            if values.iter().any(|x| x.is_nan()) {
                return None;
            }
            let (name, unit) = name(i);
            Some(entry(name, unit, values, family.kind))
        });
        let mut row = ResultRow {
            path: study.path_name(job).into(),
            controller: study.controllers[job.controller].name.clone(),
            compensator: study.compensators[job.compensator].name.clone(),
            coupled: job.coupled,
            parameters: family.name.clone(),
            runs: cell.len(),
            switched_off: cell.iter().filter(|d| d.switched_off).count(),
            metrics: metrics.collect(),
        };
        let without = rows
            .iter()
            .find(|r| r.path == row.path && r.controller == row.controller)
            .filter(|r| r.compensator == "none" && r.parameters == "exact" && !r.coupled);
        if let Some(without) = without {
            compare(&mut row, without);
        }
        rows.push(row);
    }
    rows
}

/// One metric over the runs of a row.
fn entry(name: String, unit: String, mut values: Vec<f64>, family: &str) -> MetricEntry {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = share * (values.len() - 1) as f64;
        let i = (place as usize).min(values.len().saturating_sub(2));
        let next = values.get(i + 1).unwrap_or(&values[i]);
        values[i] + (place - i as f64) * (next - values[i])
    };
    MetricEntry {
        name,
        unit,
        mean,
        least: values[0],
        largest: values[values.len() - 1],
        interval95: (family == "covariance").then(|| [at(0.025), at(0.975)]),
        reduction_percent: None,
        worst_reduction_percent: None,
    }
}

/// Largest change that is stated, %: beyond, what it is compared with is next to nothing.
const MOST_PERCENT: f64 = 1e6;

/// By how much the metrics of a row are below those without compensation.
fn compare(row: &mut ResultRow, without: &ResultRow) {
    // A period is neither good nor bad.
    for metric in row
        .metrics
        .iter_mut()
        .filter(|m| m.name != "hunting_period")
    {
        let Some(other) = without.metric(&metric.name).filter(|m| m.mean > 0.0) else {
            continue;
        };
        let reduction = |x: f64| {
            let percent = 100.0 * (1.0 - x / other.mean);
            (percent.abs() <= MOST_PERCENT).then_some(percent)
        };
        metric.reduction_percent = reduction(metric.mean);
        metric.worst_reduction_percent = reduction(metric.largest);
    }
}
