//! Rows of results: the runs of a cell of the grid together.

use super::done::Done;
use super::doubt::most_shaken;
use super::machine::unit;
use super::metrics::metrics;
use std::slice;
use stiction_files::study::result::{MetricEntry, PromiseEntry, ResultRow};
use stiction_files::study::{Job, PROMISE_DRAWS, Scheme, Study};

/// Rows in the order of the grid, of what is done.
pub(super) fn rows(study: &Study, done: &[Done]) -> Vec<ResultRow> {
    let mut rows: Vec<ResultRow> = Vec::new();
    let mut bare: &[Done] = &[];
    let place = |job: Job| (job.path, job.controller);
    for cell in done.chunk_by(|a, b| a.job.cell() == b.job.cell()) {
        let job = cell[0].job;
        if bare.first().is_some_and(|b| place(b.job) != place(job)) {
            bare = &[];
        }
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
        let promised = family.kind == "promised";
        if promised {
            if row.compensator == "none" && !row.coupled {
                bare = cell;
            } else {
                promise(&mut row, cell, bare, names);
            }
        }
        let without = rows
            .iter()
            .find(|r| r.path == row.path && r.controller == row.controller)
            .filter(|r| r.compensator == "none" && r.parameters == "exact" && !r.coupled)
            .filter(|_| !promised);
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
        left90_percent: None,
        reduction_percent: None,
        worst_reduction_percent: None,
    }
}

/// What is left of each metric on each axis that was drawn, compared with the same axis without compensation.
fn promise(row: &mut ResultRow, cell: &[Done], bare: &[Done], names: &[&str]) {
    for metric in &mut row.metrics {
        let Some(i) = names.iter().position(|name| *name == metric.name) else {
            continue;
        };
        let left = cell.iter().filter_map(|with| {
            let without = bare.iter().find(|b| b.job.belief == with.job.belief)?;
            Some(100.0 * with.metrics[i] / without.metrics[i])
        });
        let mut left: Vec<f64> = left.filter(|x| x.is_finite()).collect();
        left.sort_by(f64::total_cmp);
        // Axes on which a run could not be made would be missing at one end.
        if left.len() == PROMISE_DRAWS as usize {
            metric.left90_percent = Some([0.05, 0.95].map(|share| within(&left, share)));
        }
    }
}

/// What the rows promise of the largest error: nothing of a loop that is unstable with the compensator or without.
pub(super) fn promises(study: &Study, rows: &[ResultRow]) -> Vec<PromiseEntry> {
    let gain = |name: &str| {
        let named = study.compensators.iter().find(|c| c.name == name)?;
        match &named.value {
            Scheme::Model(model) if model.adaptation.is_none() => Some(model.gain),
            _ => None,
        }
    };
    let steady = |row: &ResultRow| {
        let mut compared = rows.iter().filter(|r| {
            (&r.path, &r.controller) == (&row.path, &row.controller)
                && (r.scheme() == row.scheme() || r.scheme() == "none")
        });
        compared.all(|r| most_shaken(study, slice::from_ref(r)).is_none())
    };
    let promised = rows.iter().filter_map(|row| {
        let metric = row.judged()?;
        Some(PromiseEntry {
            path: row.path.clone(),
            controller: row.controller.clone(),
            compensator: row.compensator.clone(),
            coupled: row.coupled,
            metric: metric.name.clone(),
            left90_percent: metric.left90_percent.filter(|_| steady(row))?,
            draws: row.runs,
            gain: gain(&row.compensator),
        })
    });
    promised.collect()
}

/// The value below which a further draw lies with that probability: the draws divide the line into parts that it falls into
/// equally often (Weibull's plotting position).
fn within(sorted: &[f64], share: f64) -> f64 {
    let place = (share * (sorted.len() + 1) as f64 - 1.0).clamp(0.0, (sorted.len() - 1) as f64);
    let i = place as usize;
    let next = sorted.get(i + 1).unwrap_or(&sorted[i]);
    sorted[i] + (place - i as f64) * (next - sorted[i])
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
