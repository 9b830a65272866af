//! Cost of candidates along a track.

use crate::candidate::check;
use crate::curve::Curve;
use crate::dispatch::InstructionSet;
use crate::{Candidate, Error, Track};
use rayon::prelude::*;

mod alone;
mod batch;
mod explicit;

/// How the bristle equation is integrated between the samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// EXPLIN, as [`stiction_friction::LuGre::step_record`]: second order, bounded for every candidate.
    #[default]
    Explin,
    /// Forward Euler from sample to sample, as in Zhang et al. 2025 (doi 10.1371/journal.pone.0322844,
    /// eq. 12); a stiff candidate explodes.
    Euler,
    /// Classical Runge-Kutta of order 4 from sample to sample, the velocity linear between; a stiff candidate
    /// explodes.
    RungeKutta,
}

/// Candidates that share the lanes of a batch.
const LANES: usize = 16;
/// Candidates up to which they are faster one by one than in half-empty lanes (`cargo bench -p
/// stiction-lanes`).
const MOST_ALONE: usize = 4;

/// Sum of squares of measured minus model force over the samples that count, N^2 (N^2 m^2), for each
/// candidate; infinite where a candidate explodes or overflows, never NaN.
///
/// Batches are spread over the threads of the current rayon pool. The bits of a cost depend on track,
/// candidate and scheme only: not on the other candidates, their order or number, the threads or the
/// instruction set.
pub fn costs(
    track: &Track,
    candidates: &[Candidate],
    scheme: Scheme,
    instructions: InstructionSet,
) -> Result<Vec<f64>, Error> {
    check(candidates)?;
    let groups: Vec<Vec<f64>> = candidates
        .par_chunks(LANES)
        .map(|group| match scheme {
            Scheme::Explin => explin(track, group, instructions),
            _ => instructions.run(explicit::Explicit::<LANES>::new(track, group, scheme)),
        })
        .collect();
    let number = |cost: f64| if cost.is_nan() { f64::INFINITY } else { cost };
    Ok(groups.into_iter().flatten().map(number).collect())
}

fn explin(track: &Track, group: &[Candidate], instructions: InstructionSet) -> Vec<f64> {
    let power = group.iter().any(|c| c.exponent != 2.0);
    match (group.len(), power) {
        (..=MOST_ALONE, _) => group
            .iter()
            .map(|c| match c.exponent == 2.0 {
                true => instructions.run(alone::Alone::<false>::new(track, c)),
                false => instructions.run(alone::Alone::<true>::new(track, c)),
            })
            .collect(),
        (..=8, false) => instructions.run(batch::Batch::<8, false>::new(track, group)),
        (..=8, true) => instructions.run(batch::Batch::<8, true>::new(track, group)),
        (_, false) => instructions.run(batch::Batch::<LANES, false>::new(track, group)),
        (_, true) => instructions.run(batch::Batch::<LANES, true>::new(track, group)),
    }
}

/// One candidate as the cost needs it.
#[derive(Clone, Copy, Debug)]
struct Terms {
    curve: Curve,
    /// `-Fc`.
    level: f64,
    /// `-sigma1/kappa`, which multiplies `-kappa v/g`.
    damping: f64,
    /// `-(sigma1 + sigma2)`.
    speed: f64,
}

impl Terms {
    fn new(c: &Candidate) -> Self {
        let kappa = c.stiffness / c.coulomb;
        let excess = (c.static_friction - c.coulomb) / c.coulomb;
        Terms {
            curve: Curve::new(kappa, excess, c.stribeck_velocity, c.exponent),
            level: -c.coulomb,
            damping: -c.micro_damping / kappa,
            speed: -(c.micro_damping + c.viscous),
        }
    }
}

/// Measured minus model force, in the direction of motion, at a node with deflection `y`.
#[inline(always)]
fn residual(terms: &Terms, y: f64, q: f64, speed: f64, force: f64) -> f64 {
    let rest = crate::exp::fma(terms.speed, speed, force);
    let weight = crate::exp::fma(terms.damping, q, terms.level);
    crate::exp::fma(y, weight, rest)
}
