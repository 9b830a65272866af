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

/// Replicas that the bias is averaged over.
const REPLICAS: u64 = 10;
/// Part of the correction that counts as one standard deviation of its own error. A replica knows the
/// encoder and the motion, not how the controller answered each step of the encoder; on simulated
/// closed loops it shows between half of the bias and all of it.
const DOUBT: f64 = 0.5;
/// Largest shift that is taken out, relative; of a signed coefficient any.
const MOST: f64 = 0.2;
/// Largest rise of the residual that taking the bias out may cost.
const RISE: f64 = 1.02;
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
    let Some(errors) = bench.errors(&fitted) else {
        return fitted;
    };
    let bias = Bias::new(&errors);
    let state = |found: Found| {
        let bound = fitted.low_speed_bound;
        assemble(record, fitted.law, &fitted.terms, optimum, bound, &found)
    };
    let mut out = match bias.corrected(&fitted) {
        Some(found) => state(found),
        None => state(bias.widened(&fitted)),
    };
    // The bias of a law that holds costs next to nothing in the residual. Where it does, what is left
    // there is not noise, and a replica, whose law holds, says little of this axis.
    if out.fit.rmse > RISE * fitted.fit.rmse {
        out = state(bias.widened(&fitted));
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
    fn errors(&mut self, fitted: &Estimate) -> Option<Vec<Vec<f64>>> {
        let mut out = Vec::new();
        for i in 0..REPLICAS {
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
                fraction: (i + 1) as f64 / REPLICAS as f64,
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

/// What fits of replicas are off by.
struct Bias {
    mean: DVector<f64>,
    scatter: DMatrix<f64>,
    many: f64,
}

impl Bias {
    fn new(errors: &[Vec<f64>]) -> Self {
        let width = errors.first().map_or(0, Vec::len);
        let many = errors.len() as f64;
        let mean = DVector::from_fn(width, |i, _| {
            errors.iter().map(|e| e[i]).sum::<f64>() / many
        });
        let scatter = DMatrix::from_fn(width, width, |i, j| {
            let product = |e: &Vec<f64>| (e[i] - mean[i]) * (e[j] - mean[j]);
            errors.iter().map(product).sum::<f64>() / (many - 1.0)
        });
        Self {
            mean,
            scatter,
            many,
        }
    }

    /// The fit with the bias taken out; `None` where an unknown would move far. The data do not hold
    /// it then, its replicas run off, and what is measured on them tells how little is known, not where
    /// to go.
    fn corrected(&self, fitted: &Estimate) -> Option<Found> {
        let (p, c) = (fitted.unknowns(), fitted.coefficients());
        let terms = fitted.terms.columns(&fitted.law);
        let size =
            p.iter().map(|_| 1.0).chain(c.iter().zip(&terms).map(
                |(c, term)| match term.nonnegative {
                    true => c.abs(),
                    false => f64::INFINITY,
                },
            ));
        for (i, size) in size.enumerate() {
            let accident = 2.0 * (self.scatter[(i, i)] / self.many).sqrt();
            if size > 0.0 && self.mean[i].abs() > MOST * size + accident {
                return None;
            }
        }
        let mut rest = self.mean.iter();
        let mut less = |x: &[f64]| x.iter().zip(&mut rest).map(|(x, b)| x - b).collect();
        Some(Found {
            p: less(p),
            c: less(c),
            doubt: Some(&self.scatter / self.many + DOUBT * DOUBT * self.square()),
            scatter: Some(self.scatter.clone()),
        })
    }

    /// The fit as it is, with the bias as part of its uncertainty.
    fn widened(&self, fitted: &Estimate) -> Found {
        Found {
            p: fitted.unknowns().to_vec(),
            c: fitted.coefficients().to_vec(),
            doubt: Some(self.square()),
            scatter: Some(self.scatter.clone()),
        }
    }

    fn square(&self) -> DMatrix<f64> {
        &self.mean * self.mean.transpose()
    }
}
