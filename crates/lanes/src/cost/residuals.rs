//! The residual force of candidates, written out.

use super::batch::{Batch, Sink};
use crate::candidate::check;
use crate::track::SAMPLE;
use crate::{Candidate, Error, Track};
use stiction_dispatch::InstructionSet;

/// Measured minus model force, N (N m), at every sample of a track, whether it counts or not: a row for each sample, a lane
/// for each of at most `N` candidates, integrated by [`Scheme::Explin`](crate::Scheme::Explin). What `out` held is replaced.
/// The measured force of a sample that does not count is taken as 0. A candidate that overflows has residuals that are not
/// finite.
///
/// The bits of a residual depend on track and candidate only, as those of [`costs`](crate::costs).
///
/// ```
/// # use stiction_lanes::{Candidate, InstructionSet, Segment, Time, Track, residuals};
/// let velocity = vec![0.05; 200]; // m/s
/// let force = vec![23.5; 200]; // N
/// # let segment = Segment { time: Time::Step(1e-3), velocity: &velocity, force: &force, keep: &[], columns: &[] };
/// # let track = Track::new(&[segment])?;
/// let candidate = Candidate::gaussian([1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3]);
/// let mut rows = Vec::new();
/// residuals::<8>(&track, &[candidate], InstructionSet::best(), &mut rows)?;
/// assert!((rows[199][0] - 0.5).abs() < 1e-9); // 20 N of Coulomb and 3 N of viscous friction
/// # Ok::<(), stiction_lanes::Error>(())
/// ```
///
/// # Errors
/// For a candidate with a parameter out of its range.
///
/// # Panics
/// With more than `N` candidates, or none.
pub fn residuals<const N: usize>(
    track: &Track,
    candidates: &[Candidate],
    instructions: InstructionSet,
    out: &mut Vec<[f64; N]>,
) -> Result<(), Error> {
    assert!((1..=N).contains(&candidates.len()), "lanes for candidates");
    check(candidates)?;
    out.clear();
    out.reserve(track.samples());
    let sink = Rows { track, out };
    if candidates.iter().any(|c| c.exponent != 2.0) {
        instructions.run(Batch::<_, N, true>::new(track, candidates, sink));
    } else {
        instructions.run(Batch::<_, N, false>::new(track, candidates, sink));
    }
    Ok(())
}

struct Rows<'a, const N: usize> {
    track: &'a Track,
    out: &'a mut Vec<[f64; N]>,
}

impl<const N: usize> Sink<N> for Rows<'_, N> {
    const MARKS: u8 = SAMPLE;
    type Output = ();

    #[inline(always)]
    fn take(&mut self, node: usize, residual: &[f64; N]) {
        let sign = f64::from(self.track.sign[node]);
        let mut row = [0.0; N];
        for j in 0..N {
            row[j] = sign * residual[j];
        }
        self.out.push(row);
    }

    #[inline(always)]
    fn end(self) {}
}
