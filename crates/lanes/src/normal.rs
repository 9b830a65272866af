//! Sums from which variable projection takes its next step.

use crate::curve::Curve;
use crate::exp::fma;
use crate::lane_array::chunk;
use crate::track::KEPT;
use crate::{Error, Track};
use rayon::prelude::*;
use stiction_dispatch::{InstructionSet, Kernel};
use stiction_friction::ParamError;

pub(crate) mod alone;
mod batch;
mod gram;
mod levels;
mod sums;

pub use sums::Sums;
use sums::shared;

/// The nonlinear unknowns of the separable form of the LuGre law, as logarithms.
///
/// ```text
/// eta' = kappa (v - |v| eta/gh(v)),     gh(v) = 1 + (r - 1) exp(-|v/vs|^delta)
/// u    = Fc eta + sigma1 (v - |v| eta/gh) + sigma2 v + ...
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// `ln kappa` with `kappa = sigma0/Fc` in 1/m (1/rad).
    pub ln_kappa: f64,
    /// `ln(r - 1)` with `r = Fs/Fc`.
    pub ln_excess: f64,
    /// `ln vs`, vs in m/s (rad/s).
    pub ln_velocity: f64,
    /// delta > 0: given, not estimated.
    pub exponent: f64,
}

impl Trial {
    /// Every logarithm below 230 in magnitude: numbers from 1e-100 to 1e100.
    pub(crate) fn curve(&self) -> Result<Curve, ParamError> {
        let read = |name, ln: f64| {
            if ln.abs() <= 230.0 {
                return Ok(libm::exp(ln));
            }
            Err(ParamError::new(name, ln, "a magnitude of at most 230"))
        };
        ParamError::positive("exponent", self.exponent)?;
        Ok(Curve::new(
            read("ln_kappa", self.ln_kappa)?,
            read("ln_excess", self.ln_excess)?,
            read("ln_velocity", self.ln_velocity)?,
            self.exponent,
        ))
    }
}

/// Sums for each of many trials, which advance together in lanes.
///
/// Spread over the current rayon pool. The bits of a trial's sums depend on track and trial only. An
/// overflow gives sums that are not finite.
///
/// ```
/// # use stiction_lanes::{InstructionSet, Segment, Time, Track, Trial, sums};
/// # let velocity: Vec<f64> = (0..500).map(|k| 0.02 * (k as f64 * 0.05).sin()).collect();
/// # let force: Vec<f64> = velocity.iter().map(|v| 20.0 * v.signum() + 60.0 * v).collect();
/// # let segment = Segment { time: Time::Step(1e-2), velocity: &velocity, force: &force, keep: &[], columns: &[] };
/// # let track = Track::new(&[segment])?;
/// let trial = |kappa: f64| Trial {
///     ln_kappa: kappa.ln(),
///     ln_excess: 0.5_f64.ln(),
///     ln_velocity: 5e-3_f64.ln(),
///     exponent: 2.0,
/// };
/// let found = sums(&track, &[trial(5e3), trial(6e3)], InstructionSet::best())?;
/// // Fc alone against the measured force:
/// let coulomb = found[0].shared[0][0] / found[0].own[0][0]; // N
/// assert!((15.0..25.0).contains(&coulomb));
/// # Ok::<(), stiction_lanes::Error>(())
/// ```
pub fn sums(
    track: &Track,
    trials: &[Trial],
    instructions: InstructionSet,
) -> Result<Vec<Sums>, Error> {
    let groups: Vec<Vec<Sums>> = curves(trials)?
        .par_chunks(gram::LANES)
        .map(|group| {
            if group.iter().any(|c| c.exponent != 2.0) {
                instructions.run(batch::Batch::<true>::new(track, group))
            } else {
                instructions.run(batch::Batch::<false>::new(track, group))
            }
        })
        .collect();
    Ok(groups.into_iter().flatten().collect())
}

/// Sums of eta and rate alone for each of many trials, which advance together in lanes: for a search that
/// compares trials and takes no step. A third of the time of [`sums`], and the same as those to rounding.
pub fn levels(
    track: &Track,
    trials: &[Trial],
    instructions: InstructionSet,
) -> Result<Vec<Sums<2>>, Error> {
    let groups: Vec<Vec<Sums<2>>> = curves(trials)?
        .par_chunks(gram::LANES)
        .map(|group| {
            if group.iter().any(|c| c.exponent != 2.0) {
                instructions.run(levels::Levels::<true>::new(track, group))
            } else {
                instructions.run(levels::Levels::<false>::new(track, group))
            }
        })
        .collect();
    Ok(groups.into_iter().flatten().collect())
}

fn curves(trials: &[Trial]) -> Result<Vec<Curve>, Error> {
    let curve = |(index, trial): (usize, &Trial)| {
        trial
            .curve()
            .map_err(|source| Error::Candidate { index, source })
    };
    trials.iter().enumerate().map(curve).collect()
}

/// Sums for one trial, with the samples in lanes: for a descent, which has one trial at a time.
///
/// The same as those of [`sums`] to rounding, not to the bit: they add up in another order.
pub fn sums_alone(
    track: &Track,
    trial: &Trial,
    instructions: InstructionSet,
) -> Result<Sums, Error> {
    let curve = trial
        .curve()
        .map_err(|source| Error::Candidate { index: 0, source })?;
    Ok(if curve.exponent == 2.0 {
        instructions.run(alone::Alone::<false>::new(track, curve))
    } else {
        instructions.run(alone::Alone::<true>::new(track, curve))
    })
}

/// Sums of products of the columns that all trials share, over the samples that count:
/// `[force, velocity, columns..]` with each other.
pub fn shared_sums(track: &Track) -> Vec<Vec<f64>> {
    InstructionSet::best().run(SharedSums(track))
}

struct SharedSums<'a>(&'a Track);

impl Kernel for SharedSums<'_> {
    type Output = Vec<Vec<f64>>;

    #[inline(always)]
    fn run(self) -> Vec<Vec<f64>> {
        let columns = shared(self.0);
        let mut out = vec![vec![0.0; columns.len()]; columns.len()];
        for i in 0..columns.len() {
            for j in 0..=i {
                let x = product(&self.0.marks, columns[i], columns[j]);
                out[i][j] = x;
                out[j][i] = x;
            }
        }
        out
    }
}

/// Sum of products over the samples that count; the values of all other samples are finite too, so a factor 0 removes
/// them.
#[inline(always)]
fn product(marks: &[u8], a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; gram::LANES];
    for at in (0..marks.len()).step_by(gram::LANES) {
        let marks: &[u8; gram::LANES] = chunk(marks, at);
        let (a, b): (&[f64; gram::LANES], &[f64; gram::LANES]) = (chunk(a, at), chunk(b, at));
        for l in 0..gram::LANES {
            let counts = f64::from(marks[l] & KEPT) / f64::from(KEPT);
            sums[l] = fma(counts * a[l], b[l], sums[l]);
        }
    }
    sums.iter().sum()
}
