//! What encoder steps, filters and noise do to an estimate, measured on replicas.
//!
//! They make errors in the regressors. Those shift the parameters, more samples do not help, and no
//! residual shows it. A [`replica`](crate::replica) of the fitted axis, conditioned and fitted alike,
//! shows the shift: its fit comes out as far from its truth as the fit of the log presumably is from
//! the axis (bootstrap of the bias: Efron and Tibshirani 1993, ISBN 0-412-04231-2, chapter 10; errors
//! in variables: Carroll et al. 2006, doi 10.1201/9781420010138).

use crate::conditioning::record::Record;
use crate::estimate::Estimate;
use crate::law::physical::{Physical, physical};
use crate::observe::{Control, Counts, Observer, Progress, Stage};
use crate::replica::{force_noise, refitted, replica};

/// Replicas that the shift is averaged over.
const REPLICAS: u64 = 10;
/// Seeds of these replicas begin here: not those that the cut-offs were chosen on.
const SEED: u64 = 1000;
/// What a variance from ten replicas must be larger by to stand for that of many: the square of Student's
/// 97.5 % quantile of 9 degrees of freedom over the normal one.
const FEW: f64 = 1.332;
/// Part of the shift that counts as one standard deviation of its own error: on simulated closed loops
/// the replicas show the shift to about a tenth.
const DOUBT: f64 = 0.1;

/// Shift of each parameter, SI, and how the fits of the replicas scatter.
#[derive(Clone, Debug)]
pub(super) struct Shift {
    pub bias: Vec<f64>,
    /// Variance from one replica to the next.
    scatter: Vec<f64>,
    /// Variance that the residuals of the replicas state, on average.
    stated: Vec<f64>,
}

impl Shift {
    /// Variance of a parameter from which the shift was taken off, `residual` being what the residual
    /// of the log states.
    ///
    /// A residual made of encoder steps repeats itself with the motion, which makes it look less certain
    /// than it is. The replicas show by how much (calibration by a bootstrap: Beran 1987,
    /// doi 10.1093/biomet/74.3.457), but they are few and bound to one motion: the geometric mean of the
    /// variance before calibration and, three times, after it is used, and not less than the replicas
    /// scatter. To it come the variance of the mean shift, and what the shift may itself be wrong by.
    pub fn total(&self, i: usize, residual: f64) -> f64 {
        let root = (FEW * self.scatter[i] / self.stated[i]).sqrt();
        let calibration = root * root.sqrt();
        let calibrated = residual
            * if calibration.is_finite() {
                calibration
            } else {
                1.0
            };
        let doubt = DOUBT * self.bias[i];
        calibrated.max(self.scatter[i]) + self.scatter[i] / REPLICAS as f64 + doubt * doubt
    }
}

/// Measures what the conditioning added to the parameters `raw`; `None` where the motion does not
/// come from a position, the axis cannot be simulated, or the observer stops it.
pub(super) fn shift(
    record: &Record,
    fitted: &Estimate,
    raw: &[Physical],
    counts: &mut Counts,
    observer: &mut dyn Observer,
) -> Option<Shift> {
    let conditioning = record.conditioning?;
    let noise = force_noise(record, &conditioning, fitted, counts)?;
    let linear = fitted.terms.columns(&fitted.law);
    let at = |p: &[f64], c: &[f64]| physical(&fitted.law, &linear, record.step(), p, c);
    let mut shifts: Vec<Vec<f64>> = Vec::new();
    let mut stated = vec![0.0; raw.len()];
    for i in 0..REPLICAS {
        let replica = replica(record, fitted, noise, SEED + i)?;
        let refit = refitted(&replica, &conditioning, fitted, 2, true, counts)?;
        let truth = at(&replica.p, fitted.coefficients());
        let found = at(&refit.p, &refit.c);
        shifts.push(truth.iter().zip(&found).map(|(a, b)| step(a, b)).collect());
        let surety = &refit.unknowns?.covariance;
        for (sum, p) in stated.iter_mut().zip(&found) {
            *sum += p.variance(surety) / REPLICAS as f64;
        }
        let progress = Progress {
            stage: Stage::Calibration,
            fraction: (i + 1) as f64 / REPLICAS as f64,
            counts: *counts,
            best: f64::INFINITY,
        };
        if observer.progress(&progress) == Control::Stop {
            return None;
        }
    }
    let many = shifts.len() as f64;
    let bias: Vec<f64> = (0..raw.len())
        .map(|i| shifts.iter().map(|s| s[i]).sum::<f64>() / many)
        .collect();
    let scatter = (0..raw.len())
        .map(|i| {
            let spread: f64 = shifts.iter().map(|s| (s[i] - bias[i]).powi(2)).sum();
            spread / (many - 1.0)
        })
        .collect();
    Some(Shift {
        bias,
        scatter,
        stated,
    })
}

/// From one value to another, in the logarithm where both are positive by nature.
fn step(from: &Physical, to: &Physical) -> f64 {
    if from.positive && from.value > 0.0 && to.value > 0.0 {
        from.value * libm::log(to.value / from.value)
    } else {
        to.value - from.value
    }
}
