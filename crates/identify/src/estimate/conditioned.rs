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
use crate::estimate::Estimate;
use crate::law::physical::physical;
use crate::misfit::Energies;
use crate::parameter::physical::Physical;
use crate::refit::{Asked, Refit, force_noise, refitted};
use crate::replica::{Axis, Replica};
use crate::separable::logs::Logs;
use crate::watch::Watch;
use stiction_search::Control;

/// Replicas that the shift is averaged over (decision 0014).
const REPLICA_COUNT: u64 = 10;
/// First seed of these replicas; they differ from those that the cut-offs were chosen on.
const FIRST_SEED: u64 = 1000;
/// Factor by which a variance from ten replicas is enlarged because they are few: the square of Student's
/// 97.5 % quantile of 9 degrees of freedom over the normal one.
const TEN_REPLICAS_FACTOR: f64 = 1.332;
/// Seeds of the replicas of replicas begin here.
const FIRST_SECOND_SEED: u64 = 2000;
/// Part of the shift that counts as one standard deviation of its own error: on simulated closed loops
/// the replicas show the shift to about a tenth of its value.
const SHIFT_DOUBT: f64 = 0.1;

/// Shift of each parameter, SI, and how the fits of the replicas scatter.
#[derive(Clone, Debug)]
pub(super) struct Shift {
    pub bias: Vec<f64>,
    /// Variance from one replica to the next.
    scatter: Vec<f64>,
    /// Variance that the residuals of the replicas state, on average.
    stated: Vec<f64>,
    /// Squared difference between the shift of a replica and that of a replica of it, less what chance
    /// explains.
    change: Vec<f64>,
    /// What comes back of the residuals of the replicas.
    pub energies: Vec<Energies>,
    /// What the logs of each replica tell, where there are several.
    pub told: Vec<Told>,
}

impl Shift {
    /// Variance of a parameter from which the shift was taken off, `residual` being what the residual
    /// of the log states.
    ///
    /// A residual made of encoder steps is correlated with the motion and repeats with it, which makes
    /// the parameters look less certain than they are. The replicas show by how much: the variance is
    /// taken larger or smaller as they scatter more or less than they state (calibration by a bootstrap:
    /// Beran 1987, doi 10.1093/biomet/74.3.457), and is enlarged because they are few. Added to it are
    /// the variance of the mean shift and the possible error of the shift itself: a tenth of it, and the
    /// amount by which it changes from the replicas to replicas of them (an iterated bootstrap: Hall
    /// 1992, doi 10.1007/978-1-4612-4384-7, section 1.4).
    pub fn total(&self, i: usize, residual: f64) -> f64 {
        let calibration = TEN_REPLICAS_FACTOR * self.scatter[i] / self.stated[i];
        let calibrated = residual
            * if calibration.is_finite() {
                calibration
            } else {
                1.0
            };
        let doubt = SHIFT_DOUBT * self.bias[i];
        calibrated + self.scatter[i] / REPLICA_COUNT as f64 + doubt * doubt + self.change[i]
    }
}

/// Measures what the conditioning added to the parameters `raw`; `None` where the motion does not
/// come from a position, the axis cannot be simulated, or the observer stops it.
pub(super) fn shift(
    record: &Record,
    fitted: &Estimate,
    raw: &[Physical],
    logs: Option<&Logs>,
    watch: &mut Watch,
) -> Option<Shift> {
    let conditioning = record.conditioning?;
    let axis = Axis::of(record, fitted)?;
    let noise = force_noise(record, &axis, &conditioning, fitted, &mut watch.counts)?;
    asked(watch)?;
    let mut first = Shifts::default();
    let mut second = Shifts::default();
    let mut stated = vec![0.0; raw.len()];
    let (mut energies, mut told) = (Vec::new(), Vec::new());
    for i in 0..REPLICA_COUNT {
        let (found, replica) = once(
            record,
            fitted,
            &axis,
            noise,
            (FIRST_SEED + i, Asked::All(logs)),
            watch,
        )?;
        asked(watch)?;
        let all = found.refit.all.as_ref()?;
        for (sum, p) in stated.iter_mut().zip(&found.parameters) {
            *sum += p.variance(&all.unknowns.covariance) / REPLICA_COUNT as f64;
        }
        energies.push(all.energies);
        told.extend(all.told.clone());
        first.0.push(found.shift.clone());
        // A replica that cannot be simulated is left out. Of a replica of a replica only the shift is asked for, and to
        // first order.
        if let Ok(again) = condition(&replica.logs, &conditioning)
            && let next = found.as_fitted(fitted, &replica)
            && let Some(axis) = Axis::of(&again, &next)
            && let Some((next, _)) = once(
                &again,
                &next,
                &axis,
                noise,
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
        stated,
        change: all.map(|i| second.change(&first, i)).collect(),
        energies,
        told,
    })
}

/// Shifts of all parameters, replica by replica.
#[derive(Default)]
struct Shifts(Vec<Vec<f64>>);

impl Shifts {
    fn mean(&self, i: usize) -> f64 {
        self.0.iter().map(|s| s[i]).sum::<f64>() / self.0.len() as f64
    }

    /// Variance from one replica to the next.
    fn variance(&self, i: usize) -> f64 {
        let mean = self.mean(i);
        let spread: f64 = self.0.iter().map(|s| (s[i] - mean).powi(2)).sum();
        spread / (self.0.len() as f64 - 1.0)
    }

    /// Square of the difference of the means, less the part that chance explains.
    fn change(&self, other: &Self, i: usize) -> f64 {
        let difference = self.mean(i) - other.mean(i);
        let chance =
            self.variance(i) / self.0.len() as f64 + other.variance(i) / other.0.len() as f64;
        // NaN with fewer than two replicas; `max` then gives zero.
        (difference * difference - chance).max(0.0)
    }
}

/// Whether to go on: `None` if the observer stops it.
fn asked(watch: &mut Watch) -> Option<()> {
    (watch.report(f64::INFINITY) == Control::Continue).then_some(())
}

/// What the fit of one replica found.
struct Found {
    refit: Refit,
    parameters: Vec<Physical>,
    shift: Vec<f64>,
}

impl Found {
    /// The estimate with the results of this replica in place of the original ones.
    fn as_fitted(&self, fitted: &Estimate, replica: &Replica) -> Estimate {
        let mut out = fitted.clone();
        out.p.clone_from(&self.refit.p);
        out.coefficients.clone_from(&self.refit.c);
        out.fitted.terms = replica.terms.clone();
        for p in &self.parameters {
            if let Some(own) = out
                .fitted
                .parameters
                .iter_mut()
                .find(|own| own.name == p.name)
            {
                own.value = p.value;
            }
        }
        out
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
    let shift = truth.iter().zip(&parameters).map(|(a, b)| step(a, b));
    let found = Found {
        shift: shift.collect(),
        parameters,
        refit,
    };
    Some((found, replica))
}

/// Difference of two values; of their logarithms where both are positive by nature.
fn step(from: &Physical, to: &Physical) -> f64 {
    if from.is_positive() && from.value > 0.0 && to.value > 0.0 {
        from.value * libm::log(to.value / from.value)
    } else {
        to.value - from.value
    }
}
