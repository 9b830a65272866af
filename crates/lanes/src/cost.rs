//! Cost of candidates along a track.

use crate::candidate::check;
use crate::{Candidate, Error, Track};
use rayon::prelude::*;
use stiction_dispatch::InstructionSet;

mod alone;
mod batch;
mod explicit;
mod residuals;
mod terms;

use batch::{Batch, Squares};
pub use residuals::residuals;
pub use terms::Scheme;

/// Number of candidates that share the lanes of a batch.
const LANES: usize = 16;
/// Number of candidates up to which evaluating them one by one is faster than in half-empty lanes
/// (`cargo bench -p stiction-lanes`).
const MOST_ALONE: usize = 4;

/// Sum of squares of measured minus model force over the samples that count, N^2 (N^2 m^2), for each
/// candidate; infinite where the integration of a candidate diverges or overflows, never NaN.
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
        (..=8, _) => in_lanes::<8>(track, group, power, instructions),
        _ => in_lanes::<LANES>(track, group, power, instructions),
    }
}

fn in_lanes<const N: usize>(
    track: &Track,
    group: &[Candidate],
    power: bool,
    instructions: InstructionSet,
) -> Vec<f64> {
    let sink = Squares::<N>::new();
    let costs = match power {
        false => instructions.run(Batch::<_, N, false>::new(track, group, sink)),
        true => instructions.run(Batch::<_, N, true>::new(track, group, sink)),
    };
    costs[..group.len()].to_vec()
}
