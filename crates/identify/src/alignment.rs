//! Rows by which the force of logs stands beside its motion, where a fit finds their delay at the end of its range.
//!
//! [`lateness`](crate::lateness()) lays the two beside each other without a law. A force that stands before its motion, or a few
//! rows behind it, is more than it can tell from friction. A law can: its delay is at the end of its range then, so it is fitted
//! again to a force that is taken so many rows later or earlier, on and on, until the delay is within its range. What is found
//! counts where far more of the force is explained there; a resonance or a filter sends the delay to its end as well, and no
//! other row helps.

use crate::conditioning::record::Samples;
use crate::conditioning::{Conditioning, condition, median_step, stretches};
use crate::estimate::estimate;
use crate::lateness::{MOST, likely};
use crate::law::Law;
use crate::law::terms::Terms;
use crate::separable::follow;
use crate::separable::optimum::Optimum;
use crate::separable::search_box::MOST_DELAY;
use crate::separable::settings::Settings;
use stiction_search::{Observer, Status};

/// Part of the range of the delay from which on it may be at the end of it on another record.
const NEAR_THE_END: f64 = 0.75;
/// Samples of the record from one fit to the next: each sees four to either side.
const STRIDE: f64 = 6.0;
/// Most fits.
const MOST_FITS: usize = 12;
/// Relative error of the fit at the rows that are found, in parts of that as logged, at most.
const LEFT: f64 = 0.5;

/// Rows by which the force of these logs of one axis has to be taken later (earlier where negative), so that it belongs to the
/// motion beside it; `None` where the delay is within its range as logged, or no other rows explain the force much better.
///
/// `near` is the end of a fit of the logs with this conditioning, whose law is fitted from there. Costs nothing where its delay is
/// within its range, else a few local fits.
pub fn alignment(
    logs: &[Samples],
    conditioning: &Conditioning,
    near: &(Law, Vec<f64>),
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Option<isize> {
    let (law, start) = near;
    let delay = start.get(law.nonlinear())?;
    if delay.abs() < NEAR_THE_END * MOST_DELAY {
        return None;
    }
    let start = start.get(..law.nonlinear())?;
    let mut fit = |rows: isize| -> Option<(Optimum, f64)> {
        let moved: Vec<Samples> = logs.iter().map(|log| moved(log, rows)).collect();
        let record = condition(&moved, conditioning).ok()?;
        let terms = terms.about(&record);
        let found = follow(start, &record, *law, &terms, settings, observer).ok()?;
        let fitted = estimate(&record, *law, &terms, &found, 0.0);
        let own = fitted.fit.relative_error_percent;
        (found.status != Status::Interrupted && own.is_finite()).then_some((found, own))
    };
    let beyond = |found: &Optimum| {
        let delay = found.p.last().copied().unwrap_or(0.0);
        found.delay_at_bound().then_some(delay.signum() as isize)
    };
    let (found, logged) = fit(0)?;
    let way = beyond(&found)?;
    let record = condition(logs, conditioning).ok()?;
    let step = record.step() / median_step(&logs.first()?.time);
    let stride = (STRIDE * step).round().max(1.0) as isize;
    let mut rows = likely(logs, way).unwrap_or(way * stride);
    let mut seen = vec![0];
    while !seen.contains(&rows) && rows.unsigned_abs() < MOST && seen.len() < MOST_FITS {
        let (found, own) = fit(rows)?;
        match beyond(&found) {
            None => return (own < LEFT * logged).then_some(rows),
            Some(way) => {
                seen.push(rows);
                rows += way * stride;
            }
        }
    }
    None
}

/// A log whose force is taken so many rows later, within each stretch.
fn moved(log: &Samples, rows: isize) -> Samples {
    let mut out = log.clone();
    out.valid.resize(log.force.len(), true);
    for stretch in stretches(log, median_step(&log.time)) {
        for row in stretch.clone() {
            match row
                .checked_add_signed(rows)
                .filter(|from| stretch.contains(from))
            {
                Some(from) => out.force[row] = log.force[from],
                None => out.valid[row] = false,
            }
        }
    }
    out
}
