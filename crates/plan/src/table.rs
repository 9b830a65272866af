//! Every piece on every axis that is thought possible.

use crate::atom::Atom;
use crate::candidate::Candidate;
use crate::information::{Extent, Information, information};
use crate::limits::Limits;
use crate::rig::Rig;
use crate::run::{Peaks, Run, run};
use stiction_friction::ParamError;
use stiction_servo::noise::Noise;
use stiction_servo::trajectory::Trajectory;

/// How often each piece is run on each axis, with the encoder elsewhere in its step: two give its scatter.
const PHASES: usize = 2;

/// What a motion does and tells on a candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub(crate) information: Information,
    /// The largest of what happened in any of its runs.
    pub peaks: Peaks,
    /// Seconds of motion that were simulated.
    pub simulated: f64,
}

impl Entry {
    /// Simulates a motion that is all of a log on a candidate. `number` decides where the encoder stands in its step.
    ///
    /// # Errors
    /// Where the candidate or the loop cannot be simulated.
    pub fn of(
        motion: &impl Trajectory,
        candidate: &Candidate,
        with: (&Limits, &Rig),
        number: u32,
    ) -> Result<Entry, ParamError> {
        Entry::of_extent(motion, candidate, with, number, Extent::Log)
    }

    /// The same of a motion that is a part of one.
    ///
    /// # Errors
    /// Where the candidate or the loop cannot be simulated.
    pub fn of_piece(
        motion: &impl Trajectory,
        candidate: &Candidate,
        with: (&Limits, &Rig),
        number: u32,
    ) -> Result<Entry, ParamError> {
        Entry::of_extent(motion, candidate, with, number, Extent::Piece)
    }

    /// That of the same motion so many times, one after the other.
    #[must_use]
    pub fn repeated(mut self, times: u32) -> Entry {
        self.information.repeat(f64::from(times));
        self
    }

    fn of_extent(
        motion: &impl Trajectory,
        candidate: &Candidate,
        (limits, rig): (&Limits, &Rig),
        number: u32,
        extent: Extent,
    ) -> Result<Entry, ParamError> {
        let phase = |k: usize| Noise::new(u64::from(number) * PHASES as u64 + k as u64).uniform();
        let runs: Vec<Run> = (0..PHASES)
            .map(|k| run(motion, candidate, rig, limits.peak_force, phase(k)))
            .collect::<Result<_, _>>()?;
        let found = information(candidate, rig, &runs, extent);
        Ok(Entry {
            // A piece too short to be filtered tells nothing.
            information: found.unwrap_or_else(|| Information::none_of(candidate)),
            peaks: runs
                .iter()
                .map(|run| run.peaks)
                .reduce(Peaks::with)
                .unwrap_or_default(),
            simulated: PHASES as f64 * motion.duration(),
        })
    }
}

impl Peaks {
    /// The larger of both; means of what are means.
    #[must_use]
    pub fn with(self, other: Peaks) -> Peaks {
        Peaks {
            position: [
                self.position[0].min(other.position[0]),
                self.position[1].max(other.position[1]),
            ],
            speed: self.speed.max(other.speed),
            force: self.force.max(other.force),
            force_square: self.force_square.max(other.force_square),
            error: self.error.max(other.error),
            saturated: self.saturated.max(other.saturated),
            followed: self.followed.min(other.followed),
        }
    }

    /// Root mean square of the force, N (N m).
    pub fn rms_force(&self) -> f64 {
        libm::sqrt(self.force_square)
    }

    /// Whether the true motion stays within stroke and speed, end zones left out of account: they are there for this.
    pub fn within(&self, limits: &Limits) -> bool {
        let [low, high] = limits.stroke;
        self.position[0] >= low && self.position[1] <= high && self.speed <= limits.speed
    }
}

/// Pieces by axes.
#[derive(Clone, Debug)]
pub struct Table {
    /// The pieces.
    pub atoms: Vec<Atom>,
    /// For each piece an entry for each axis.
    pub entries: Vec<Vec<Entry>>,
}

impl Table {
    /// Only pieces that keep the true motion within the limits on every axis.
    #[must_use]
    pub fn safe(self, limits: &Limits) -> Table {
        let both = self.atoms.into_iter().zip(self.entries);
        let safe =
            both.filter(|(_, entries)| entries.iter().all(|entry| entry.peaks.within(limits)));
        let (atoms, entries) = safe.unzip();
        Table { atoms, entries }
    }
}
