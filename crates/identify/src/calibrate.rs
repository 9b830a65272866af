//! The bias of conditioning and noise, measured on replicas and taken out.
//!
//! Encoder steps and filters make errors in the regressors. They shift the parameters, more samples do
//! not help, and no residual shows it. A [`replica`](crate::replica) of the fitted axis, conditioned and
//! fitted alike, shows the shift: its fit comes out as far from its truth as the fit of the log
//! presumably is from the axis (bootstrap bias correction: Efron and Tibshirani 1993,
//! ISBN 0-412-04231-2, section 10.6; errors in variables: Carroll et al. 2006,
//! doi 10.1201/9781420010138).

use crate::conditioning::Conditioning;
use crate::conditioning::record::Record;
use crate::estimate::{Estimate, Found, assemble};
use crate::observe::{Control, Counts, Observer, Progress, Stage};
use crate::replica::{force_noise, refitted, replica};
use crate::separable::Optimum;
use nalgebra::{DMatrix, DVector};

/// Replicas that the bias is averaged over, pass by pass.
const PASSES: [u64; 1] = [10];
/// Part of the correction that counts as one standard deviation of its own error. A replica knows the
/// encoder and the motion, not how the controller answered each step of the encoder; on simulated
/// closed loops it shows between half of the bias and all of it.
const DOUBT: f64 = 0.5;
/// Seeds of these replicas begin here: not those that the cut-offs were chosen on.
const SEED: u64 = 1000;

/// The estimate with its bias taken out and the uncertainty of that added; the estimate as it is where
/// the axis cannot be simulated, or the observer stops it.
pub fn calibrate(
    record: &Record,
    conditioning: &Conditioning,
    optimum: &Optimum,
    fitted: Estimate,
    observer: &mut dyn Observer,
) -> Estimate {
    let mut counts = Counts::default();
    let Some(noise) = force_noise(record, conditioning, &fitted, &mut counts) else {
        return fitted;
    };
    let mut bench = Bench {
        record,
        conditioning,
        noise,
        counts,
        observer,
    };
    // The bias depends on the parameters, so it is measured again where the first measure leads to.
    let mut out = fitted.clone();
    for (pass, many) in PASSES.into_iter().enumerate() {
        let Some(errors) = bench.errors(&out, pass, many) else {
            return fitted;
        };
        let found = corrected(&fitted, &errors);
        let bound = fitted.low_speed_bound;
        out = assemble(record, fitted.law, &fitted.terms, optimum, bound, &found);
    }
    out.counts.cost += bench.counts.cost;
    out.counts.sensitivities += bench.counts.sensitivities;
    out
}

/// Where replicas are made and fitted.
struct Bench<'a, 'o> {
    record: &'a Record,
    conditioning: &'a Conditioning,
    noise: f64,
    counts: Counts,
    observer: &'o mut dyn Observer,
}

impl Bench<'_, '_> {
    /// What fits of replicas of `fitted` are off by, unknowns then coefficients.
    fn errors(&mut self, fitted: &Estimate, pass: usize, many: u64) -> Option<Vec<Vec<f64>>> {
        let mut out = Vec::new();
        for i in 0..many {
            let replica = replica(self.record, fitted, self.noise, SEED + i)?;
            let refit = refitted(&replica, self.conditioning, fitted, 2, &mut self.counts)?;
            let nonlinear = refit.p.iter().zip(&replica.p).map(|(a, b)| a - b);
            let linear = refit
                .c
                .iter()
                .zip(fitted.coefficients())
                .map(|(a, b)| a - b);
            out.push(nonlinear.chain(linear).collect());
            let progress = Progress {
                stage: Stage::Calibration,
                fraction: (pass as f64 + (i + 1) as f64 / many as f64) / PASSES.len() as f64,
                counts: self.counts,
                best: f64::INFINITY,
            };
            if self.observer.progress(&progress) == Control::Stop {
                return None;
            }
        }
        Some(out)
    }
}

/// The fit with the mean error of its replicas taken out.
fn corrected(fitted: &Estimate, errors: &[Vec<f64>]) -> Found {
    let width = errors[0].len();
    let many = errors.len() as f64;
    let mean: Vec<f64> = (0..width)
        .map(|i| errors.iter().map(|e| e[i]).sum::<f64>() / many)
        .collect();
    let scatter = DMatrix::from_fn(width, width, |i, j| {
        let product = |e: &Vec<f64>| (e[i] - mean[i]) * (e[j] - mean[j]);
        errors.iter().map(product).sum::<f64>() / (many - 1.0)
    });
    let shift = DVector::from_column_slice(&mean);
    let nonlinear = fitted.unknowns().len();
    let terms = fitted.terms.columns(&fitted.law);
    let p = fitted.unknowns().iter().zip(&mean).map(|(x, b)| x - b);
    let c = fitted
        .coefficients()
        .iter()
        .zip(&mean[nonlinear..])
        .zip(&terms)
        .map(|((&x, &b), term)| match term.nonnegative {
            // Never to zero or below.
            true => (x - b).max(0.5 * x),
            false => x - b,
        });
    Found {
        p: p.collect(),
        c: c.collect(),
        doubt: Some(&scatter / many + DOUBT * DOUBT * &shift * shift.transpose()),
        scatter: Some(scatter),
    }
}
