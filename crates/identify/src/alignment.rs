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
use crate::separable::optimum::Optimum;
use crate::separable::search_box::MOST_DELAY;
use crate::separable::settings::Settings;
use crate::separable::{follow, separable};
use stiction_parameters::LawKind;
use stiction_policy::delay;
use stiction_search::{Observer, Status};

/// Samples of the record from one fit to the next: each sees four to either side.
const STRIDE: f64 = 6.0;
/// Most fits.
const MOST_FITS: usize = 12;

/// Rows by which a force has to be taken later (earlier where negative), so that it belongs to the motion beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// These.
    pub rows: isize,
    /// What is left of the square of the force there, in parts of what is left as logged.
    pub left: f64,
    /// Whether that is so little that nothing else needs to be looked for.
    pub is_sure: bool,
}

/// Rows by which the force of these logs of one axis has to be taken later (earlier where negative), so that it belongs to the
/// motion beside it; `None` where the delay is within its range as logged, or no other rows explain the force better, or of an earlier
/// one much better. Where
/// it was taken `laid` rows later before, since [`lateness`](crate::lateness()) said so, the rows beyond these, and `-laid` where
/// the law explains the force as well as logged.
///
/// `near` is the end of a fit of the logs with this conditioning, whose law is fitted from there; without it LuGre. Costs nothing where its delay is
/// within its range and nothing was laid, else a few local fits.
pub fn alignment(
    logs: &[Samples],
    conditioning: &Conditioning,
    (near, laid): (Option<&(Law, Vec<f64>)>, isize),
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Option<Alignment> {
    let law = near.map_or(Law::new(LawKind::LuGre), |(law, _)| *law);
    let near = near.map(|(_, end)| end.as_slice()).unwrap_or_default();
    let (start, delay) = near.split_at_checked(law.nonlinear()).unwrap_or_default();
    let is_near_the_end = |delay: f64| delay.abs() >= delay::END_OF_RANGE * MOST_DELAY;
    if laid == 0 && !delay.first().is_some_and(|delay| is_near_the_end(*delay)) {
        return None;
    }
    let mut fit = |rows: isize| -> Option<(Optimum, f64)> {
        let moved: Vec<Samples> = logs.iter().map(|log| moved(log, rows)).collect();
        let record = condition(&moved, conditioning).ok()?;
        let terms = terms.about(&record);
        let found = match laid {
            0 => follow(start, &record, law, &terms, settings, observer),
            // Rows that no law has led to may be as wrong as the fit there.
            _ => separable(&record, law, &terms, settings, observer),
        };
        let found = found.ok()?;
        let fitted = estimate(&record, law, &terms, &found, 0.0);
        let own = fitted.fit.relative_error_percent;
        (found.status != Status::Interrupted && own.is_finite()).then_some((found, own))
    };
    let beyond = |found: &Optimum| {
        let delay = found.p.last().copied().unwrap_or(0.0);
        is_near_the_end(delay).then_some(delay.signum() as isize)
    };
    let (found, logged) = fit(0)?;
    if laid != 0 && fit(-laid).is_some_and(|(_, own)| own <= logged) {
        return Some(Alignment {
            rows: -laid,
            left: 1.0,
            is_sure: true,
        });
    }
    let record = condition(logs, conditioning).ok()?;
    let step = record.step() / median_step(&logs.first()?.time);
    let stride = (STRIDE * step).round().max(1.0) as isize;
    let mut seen = vec![0];
    let mut within = match beyond(&found) {
        None if laid == 0 => return None,
        None => Some((0, logged)),
        Some(way) => {
            let mut within: Option<(isize, f64)> = None;
            // Where force and motion go best without a law may be far off: what lies next to the rows as logged is tried as well.
            let starts = likely(logs, way).into_iter().chain([way * stride]);
            for start in starts {
                let mut rows = start;
                while !seen.contains(&rows) && rows.unsigned_abs() < MOST && seen.len() < MOST_FITS
                {
                    let (found, own) = fit(rows)?;
                    seen.push(rows);
                    match beyond(&found) {
                        None => {
                            let is_better = within.is_none_or(|(_, least)| own < least);
                            within = if is_better { Some((rows, own)) } else { within };
                            break;
                        }
                        Some(way) => rows += way * stride,
                    }
                }
            }
            within
        }
    };
    // A delay within its range may be one of several, the true one beyond an end.
    while let Some((rows, least)) = within
        && seen.len() < MOST_FITS
    {
        let beside = [rows - stride, rows + stride].into_iter();
        let new = |at: &isize| !seen.contains(at) && at.unsigned_abs() < MOST;
        let beside: Vec<isize> = beside.filter(new).collect();
        let better = beside.iter().filter_map(|at| {
            let (found, own) = fit(*at)?;
            (beyond(&found).is_none() && own < least).then_some((*at, own))
        });
        let better = better.min_by(|a, b| a.1.total_cmp(&b.1));
        seen.extend(beside);
        if better.is_none() {
            break;
        }
        within = better;
    }
    let most = if laid == 0 {
        delay::MAX_ROW_ERROR
    } else {
        delay::MAX_ALIGNED_ROW_ERROR
    };
    let (rows, own) = within.filter(|(rows, _)| *rows != 0)?;
    let is_sure = own < most * logged;
    let is_beyond = laid == 0 && rows > 0 && own < delay::MAX_LATE_ROW_ERROR * logged;
    (is_sure || is_beyond).then_some(Alignment {
        rows,
        left: (own / logged).powi(2),
        is_sure,
    })
}

/// A log whose force is taken so many rows later, within each stretch.
pub(crate) fn moved(log: &Samples, rows: isize) -> Samples {
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
