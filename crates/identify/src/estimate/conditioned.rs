//! What encoder steps, filters and noise do to an estimate, measured on replicas.
//!
//! They make errors in the regressors. Those shift the parameters, more samples do not help, and no
//! residual shows it. A [`replica`](crate::replica) of the fitted axis, conditioned and fitted alike,
//! shows the shift: its fit comes out as far from its truth as the fit of the log presumably is from
//! the axis (bootstrap of the bias: Efron and Tibshirani 1993, ISBN 0-412-04231-2, chapter 10; errors
//! in variables: Carroll et al. 2006, doi 10.1201/9781420010138).

use crate::agreement::Told;
use crate::conditioning::condition;
use crate::conditioning::record::Record;
use crate::effects;
use crate::estimate::Estimate;
use crate::estimate::windows::Windows;
use crate::law::physical::physical;
use crate::parameter::physical::Physical;
use crate::refit::{Asked, Refit, force_noise, refitted, without_noise};
use crate::replica::{Axis, Replica};
use crate::separable::logs::Logs;
use crate::shifts::{REPLICA_COUNT, SHIFT_DOUBT, Shifts, TEN_REPLICAS_FACTOR, as_found, between};
use crate::watch::Watch;
use stiction_search::{Control, Counts};

/// First seed of these replicas; they differ from those that the cut-offs were chosen on.
const FIRST_SEED: u64 = 1000;
/// Replicas whose residual is looked through.
const SHOWN: u64 = 3;
/// Seeds of the replicas of replicas begin here.
const FIRST_SECOND_SEED: u64 = 2000;

/// Shift of each parameter, SI, and how the fits of the replicas scatter.
#[derive(Clone, Debug)]
pub(super) struct Shift {
    pub bias: Vec<f64>,
    /// Variance from one replica to the next, without what noise of the force makes to first order.
    scatter: Vec<f64>,
    /// Squared difference between the shift of a replica and that of a replica of it, less what chance
    /// explains.
    change: Vec<f64>,
    /// Variance that other cut-offs show and the replicas do not.
    windows: Vec<f64>,
    /// What the logs of each replica tell, where there are several.
    pub told: Vec<Told>,
    /// What the residuals of some of them show, where that was asked for.
    pub effects: Vec<effects::Found>,
}

impl Shift {
    /// Variance of a parameter from which the shift was taken off, `strokes` being what strokes of the log differ by.
    ///
    /// What encoder steps do may repeat with the motion, which no stroke shows: then the replicas scatter by more, and count,
    /// enlarged because they are few. Added are the variance of the mean shift and the possible error of the shift itself: a
    /// tenth of it, the amount by which it changes from the replicas to replicas of them (an iterated bootstrap: Hall
    /// 1992, doi 10.1007/978-1-4612-4384-7, section 1.4), and what other cut-offs show beyond it.
    pub fn total(&self, i: usize, strokes: f64) -> f64 {
        let doubt = SHIFT_DOUBT * self.bias[i];
        strokes.max(TEN_REPLICAS_FACTOR * self.scatter[i])
            + self.scatter[i] / REPLICA_COUNT as f64
            + doubt * doubt
            + self.change[i]
            + self.windows[i]
    }
}

/// Measures what the conditioning added to the parameters `raw`; `None` where the motion does not
/// come from a position, the axis cannot be simulated, or the observer stops it.
pub(super) fn shift(
    record: &Record,
    fitted: &Estimate,
    raw: &[Physical],
    (logs, shows): (Option<&Logs>, bool),
    watch: &mut Watch,
) -> Option<Shift> {
    let conditioning = record.conditioning?;
    let axis = Axis::of(record, fitted)?;
    let noise = force_noise(record, &axis, &conditioning, fitted, &mut watch.counts)?;
    asked(watch)?;
    let mut windows = Windows::of(record, fitted, raw, &mut watch.counts);
    asked(watch)?;
    let mut first = Shifts::default();
    // Those of the first without noise and to first order, which is all that is asked of the second.
    let mut alike = Shifts::default();
    let mut second = Shifts::default();
    let (mut told, mut shown) = (Vec::new(), Vec::new());
    for i in 0..REPLICA_COUNT {
        let (found, replica) = once(
            record,
            fitted,
            &axis,
            noise,
            (FIRST_SEED + i, Asked::All(logs, shows && i < SHOWN)),
            watch,
        )?;
        asked(watch)?;
        told.extend(found.refit.told.clone());
        shown.extend(found.refit.effects.iter().cloned());
        let of = (record, fitted);
        let quiet = replica.without_noise();
        let still = Still::of(&quiet, of, &found, &mut watch.counts);
        asked(watch)?;
        let (at, shift) = match &still.first {
            Some(first) => (&quiet, first),
            None => (&replica, &found.shift),
        };
        windows.count(at, of, (&found.truth, shift), &mut watch.counts);
        asked(watch)?;
        alike.0.push(shift.clone());
        first.0.push(still.shift);
        // A replica that cannot be simulated is left out. Of a replica of a replica only the shift is asked for, to first
        // order and without noise.
        if let Ok(again) = condition(&replica.logs, &conditioning)
            && let refit = &found.refit
            && let next = as_found(fitted, &replica, (&refit.p, &refit.c), &found.parameters)
            && let Some(axis) = Axis::of(&again, &next)
            && let Some((next, _)) = once(
                &again,
                &next,
                &axis,
                0.0,
                (FIRST_SECOND_SEED + i, Asked::Unknowns),
                watch,
            )
        {
            second.0.push(next.shift);
        }
        watch.fraction = (i + 1) as f64 / REPLICA_COUNT as f64;
        asked(watch)?;
    }
    let all = 0..raw.len();
    Some(Shift {
        bias: all.clone().map(|i| first.mean(i)).collect(),
        scatter: all.clone().map(|i| first.variance(i)).collect(),
        change: all.map(|i| second.change(&alike, i)).collect(),
        windows: windows.variance(raw.len()),
        told,
        effects: shown,
    })
}

/// Whether to go on: `None` if the observer stops it.
fn asked(watch: &mut Watch) -> Option<()> {
    (watch.report(f64::INFINITY) == Control::Continue).then_some(())
}

/// What the fit of one replica found.
struct Found {
    refit: Refit,
    truth: Vec<Physical>,
    parameters: Vec<Physical>,
    shift: Vec<f64>,
}

/// What the fit of a replica finds without what noise of its force makes to first order.
struct Still {
    /// The whole shift.
    shift: Vec<f64>,
    /// That without any noise, to first order; `None` where noise moves the fit too far for that, and stays in the shift.
    first: Option<Vec<f64>>,
}

impl Still {
    /// From the same replica without noise, beside what was found with it.
    fn of(
        quiet: &Replica,
        (record, fitted): (&Record, &Estimate),
        found: &Found,
        counts: &mut Counts,
    ) -> Self {
        let linear = fitted.terms.columns(&fitted.law);
        let at = |p: &[f64], c: &[f64]| physical(&fitted.law, &linear, record.step(), p, c);
        let how = record.conditioning.as_ref().zip(found.refit.first.as_ref());
        let still = how.and_then(|(conditioning, first)| {
            let still = without_noise(quiet, conditioning, fitted, counts)?;
            Some((still, first))
        });
        let Some((still, noisy)) = still else {
            return Self {
                shift: found.shift.clone(),
                first: None,
            };
        };
        let first = between(&found.truth, &at(&still.p, &still.c));
        let noisy = between(&found.truth, &at(&noisy.p, &noisy.c));
        let each = found.shift.iter().zip(noisy.iter().zip(&first));
        Self {
            shift: each
                .map(|(all, (noisy, first))| all - noisy + first)
                .collect(),
            first: Some(first),
        }
    }
}

/// Makes one replica and fits it.
fn once(
    record: &Record,
    fitted: &Estimate,
    axis: &Axis,
    noise: f64,
    (seed, what): (u64, Asked),
    watch: &mut Watch,
) -> Option<(Found, Replica)> {
    let linear = fitted.terms.columns(&fitted.law);
    let at = |p: &[f64], c: &[f64]| physical(&fitted.law, &linear, record.step(), p, c);
    let replica = axis.replica(noise, seed)?;
    asked(watch)?;
    let refit = refitted(
        &replica,
        &record.conditioning?,
        fitted,
        what,
        &mut watch.counts,
    )?;
    let truth = at(&replica.p, fitted.coefficients());
    let parameters = at(&refit.p, &refit.c);
    let found = Found {
        shift: between(&truth, &parameters),
        truth,
        parameters,
        refit,
    };
    Some((found, replica))
}
