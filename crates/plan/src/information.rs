//! What a run tells of the parameters: sums over its samples, which add over the pieces of a motion.

use crate::candidate::{Candidate, PARAMETERS};
use crate::rig::Rig;
use crate::run::Run;
use stiction_identify::lugre_along;
use stiction_signal::{SignalError, Sos, gradient, gradient_sixth_order};

/// Unknowns of a fit: the logarithms of the parameters, the offset over Coulomb friction, and the delay in samples.
pub(crate) const UNKNOWNS: usize = PARAMETERS + 2;
/// Entries of a symmetric matrix of them.
pub(crate) const ENTRIES: usize = UNKNOWNS * (UNKNOWNS + 1) / 2;

/// Pairs of cut-offs that an identification is likely to choose among: the rate over each, in common and on the position.
const PAIRS: [(f64, f64); PAIR_COUNT] = [(10.0, 10.0), (20.0, 5.0), (10.0, 20.0), (40.0, 10.0)];
pub(crate) const PAIR_COUNT: usize = 4;
/// Order of the filters, as in an identification.
const ORDER: usize = 4;

/// Sums over samples for a pair of cut-offs, in N^2 (N^2 m^2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sums {
    /// `J^T J`, the lower triangle by rows.
    pub gram: [f64; ENTRIES],
    /// Covariance of `J^T r` over where the encoder stands in its step.
    pub scatter: [f64; ENTRIES],
    /// Mean of `J^T r`: what the encoder and the filters add whatever the noise.
    pub bias: [f64; UNKNOWNS],
}

impl Sums {
    pub const ZERO: Sums = Sums {
        gram: [0.0; ENTRIES],
        scatter: [0.0; ENTRIES],
        bias: [0.0; UNKNOWNS],
    };

    pub fn add(&mut self, other: &Sums, sign: f64) {
        let add = |to: &mut [f64], from: &[f64]| {
            to.iter_mut().zip(from).for_each(|(a, b)| *a += sign * b);
        };
        add(&mut self.gram, &other.gram);
        add(&mut self.scatter, &other.scatter);
        add(&mut self.bias, &other.bias);
    }
}

/// Those of every pair of cut-offs.
pub(crate) type Information = [Sums; PAIR_COUNT];

/// `J^T J` and `J^T r` of a run.
#[derive(Clone, Copy, Debug)]
struct Products {
    gram: [f64; ENTRIES],
    gradient: [f64; UNKNOWNS],
}

/// Information of a motion, from runs with the encoder in several places of its step.
pub(crate) fn information(candidate: &Candidate, rig: &Rig, runs: &[Run]) -> Option<Information> {
    let all: Vec<[Products; PAIR_COUNT]> = runs
        .iter()
        .map(|run| products(candidate, rig, run).ok())
        .collect::<Option<_>>()?;
    let count = all.len() as f64;
    let mut out = [Sums::ZERO; PAIR_COUNT];
    for (pair, sums) in out.iter_mut().enumerate() {
        for products in &all {
            let Products { gram, gradient } = &products[pair];
            for (sum, x) in sums.gram.iter_mut().zip(gram) {
                *sum += x / count;
            }
            for (sum, x) in sums.bias.iter_mut().zip(gradient) {
                *sum += x / count;
            }
        }
        for products in &all {
            let off: [f64; UNKNOWNS] =
                std::array::from_fn(|i| products[pair].gradient[i] - sums.bias[i]);
            for i in 0..UNKNOWNS {
                for j in 0..=i {
                    sums.scatter[i * (i + 1) / 2 + j] += off[i] * off[j] / (count - 1.0).max(1.0);
                }
            }
        }
    }
    Some(out)
}

/// `J` along the true motion and the residual that the law leaves at the true parameters when it is driven by the encoder, both
/// filtered and thinned as an identification does.
fn products(
    candidate: &Candidate,
    rig: &Rig,
    run: &Run,
) -> Result<[Products; PAIR_COUNT], SignalError> {
    let (rate, step) = (rig.rate, 1.0 / rig.rate);
    let columns = jacobian(candidate, step, run)?;
    let mut out = [Products {
        gram: [0.0; ENTRIES],
        gradient: [0.0; UNKNOWNS],
    }; PAIR_COUNT];
    let mut done = [false; PAIR_COUNT];
    for first in 0..PAIR_COUNT {
        if done[first] {
            continue;
        }
        // All pairs with this common filter.
        let common = PAIRS[first].0;
        let pairs: Vec<usize> = (first..PAIR_COUNT)
            .filter(|&p| PAIRS[p].0 == common)
            .collect();
        let mut filtered = columns.clone();
        for &pair in &pairs {
            done[pair] = true;
            filtered.push(residual(candidate, rig, run, rate / PAIRS[pair].1)?);
        }
        let filter = Sos::butterworth_low_pass(ORDER, rate / common, rate)?;
        let mut views: Vec<&mut [f64]> = filtered.iter_mut().map(Vec::as_mut_slice).collect();
        filter.zero_phase_columns(&mut views)?;
        let thin = ((common / 2.5) as usize).max(1);
        let product = |a: &[f64], b: &[f64]| {
            let both = a.iter().zip(b).step_by(thin);
            thin as f64 * both.map(|(x, y)| x * y).sum::<f64>()
        };
        let mut gram = [0.0; ENTRIES];
        for i in 0..UNKNOWNS {
            for j in 0..=i {
                gram[i * (i + 1) / 2 + j] = product(&filtered[i], &filtered[j]);
            }
        }
        for (k, &pair) in pairs.iter().enumerate() {
            let residual = &filtered[UNKNOWNS + k];
            out[pair] = Products {
                gram,
                gradient: std::array::from_fn(|i| product(&filtered[i], residual)),
            };
        }
    }
    Ok(out)
}

/// Derivatives of the force with respect to the unknowns along the true motion.
fn jacobian(candidate: &Candidate, step: f64, run: &Run) -> Result<Vec<Vec<f64>>, SignalError> {
    let Candidate {
        sigma0,
        sigma1,
        sigma2,
        coulomb,
        static_friction,
        stribeck_velocity,
        mass,
    } = *candidate;
    let (kappa, excess) = (sigma0 / coulomb, candidate.excess());
    let along = lugre_along(kappa, excess, stribeck_velocity, step, &run.velocity, true);
    // The force about an instant is the mean over the periods beside it, and so are these differences.
    let acceleration = gradient(&run.velocity, step)?;
    let n = run.velocity.len();
    let slope =
        |k: usize, i: usize| coulomb * along.eta_slope[k][i] + sigma1 * along.rate_slope[k][i];
    // ln (Fs/Fc - 1) grows this much faster than ln Fs.
    let steeper = static_friction / (static_friction - coulomb);
    let column = |f: &dyn Fn(usize) -> f64| (0..n).map(f).collect::<Vec<f64>>();
    let force = column(&|i| {
        coulomb * along.eta[i]
            + sigma1 * along.rate[i]
            + sigma2 * run.velocity[i]
            + mass * acceleration[i]
    });
    Ok(vec![
        column(&|i| slope(0, i)),
        column(&|i| sigma1 * along.rate[i]),
        column(&|i| sigma2 * run.velocity[i]),
        column(&|i| coulomb * along.eta[i] - slope(0, i) - steeper * slope(1, i)),
        column(&|i| steeper * slope(1, i)),
        column(&|i| slope(2, i)),
        column(&|i| mass * acceleration[i]),
        vec![coulomb; n],
        gradient(&force, 1.0)?,
    ])
}

/// What the law leaves of the force at the true parameters, driven by the filtered encoder.
fn residual(
    candidate: &Candidate,
    rig: &Rig,
    run: &Run,
    cutoff: f64,
) -> Result<Vec<f64>, SignalError> {
    let step = 1.0 / rig.rate;
    let filter = Sos::butterworth_low_pass(ORDER, cutoff, rig.rate)?;
    let position = filter.zero_phase(&run.reading)?;
    let velocity = gradient_sixth_order(&position, step)?;
    let acceleration = gradient_sixth_order(&velocity, step)?;
    let kappa = candidate.sigma0 / candidate.coulomb;
    let (excess, vs) = (candidate.excess(), candidate.stribeck_velocity);
    let along = lugre_along(kappa, excess, vs, step, &velocity, false);
    let left = run.force.iter().enumerate().map(|(i, force)| {
        force
            - candidate.coulomb * along.eta[i]
            - candidate.sigma1 * along.rate[i]
            - candidate.sigma2 * velocity[i]
            - candidate.mass * acceleration[i]
    });
    Ok(left.collect())
}
