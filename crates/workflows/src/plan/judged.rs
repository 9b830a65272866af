//! A whole motion simulated on many axes.

use super::super::error::Error;
use super::assume::Given;
use rayon::prelude::*;
use stiction_friction::ParamError;
use stiction_plan::{Candidate, Entry, Expected, Limits, Motion};
use stiction_search::Shared;

/// A motion with what it would show.
pub(super) struct Judged {
    pub motion: Motion,
    pub expected: Expected,
    /// Seconds of motion that were simulated.
    pub simulated: f64,
}

/// Simulates a motion on every axis; `None` where the observer stopped it.
pub(super) fn judged(
    motion: Motion,
    axes: &[Candidate],
    given: &Given,
    watch: &Shared,
) -> Result<Option<Judged>, Error> {
    repeated(motion, 1, axes, given, watch)
}

/// Judges a motion so many times one after the other, of which one is simulated: what it does and tells is the same each time.
pub(super) fn repeated(
    motion: Motion,
    times: u32,
    axes: &[Candidate],
    given: &Given,
    watch: &Shared,
) -> Result<Option<Judged>, Error> {
    let (limits, rig) = (&given.nameplate.limits, &given.nameplate.rig);
    let entries: Vec<Option<Result<Entry, ParamError>>> = axes
        .par_iter()
        .enumerate()
        .map(|(i, axis)| {
            if watch.is_stopped() {
                return None;
            }
            let entry = Entry::of(&motion, axis, (limits, rig), FIRST_NUMBER + i as u32);
            watch.one_more();
            watch.go_on();
            Some(entry)
        })
        .collect();
    let Some(entries) = entries.into_iter().collect::<Option<Vec<_>>>() else {
        return Ok(None);
    };
    let entries = entries
        .into_iter()
        .collect::<Result<Vec<_>, _>>()
        .map_err(refused)?;
    let simulated = entries.iter().map(|e| e.simulated).sum();
    let (entries, motion) = match times {
        1 => (entries, motion),
        _ => {
            let each = entries.into_iter().map(|entry| entry.repeated(times));
            let atoms = motion.atoms().repeat(times as usize);
            (each.collect(), Motion::new(atoms).map_err(refused)?)
        }
    };
    Ok(Some(Judged {
        expected: Expected::of(&entries, &given.aim),
        simulated,
        motion,
    }))
}

/// Numbers of whole motions, beyond those of the pieces: they decide where the encoder stands.
const FIRST_NUMBER: u32 = 1 << 24;

/// What cannot be simulated.
pub(super) fn refused(error: ParamError) -> Error {
    let found = format!("{} = {}", error.name, stiction_number::full(error.value));
    Error::usage(found, error.allowed)
}

impl Judged {
    /// Whether the true motion keeps within stroke and speed on every axis, and the drive within the force that it can give for long. Its
    /// largest force is that of the simulated drive, which gives no more.
    pub fn keeps(&self, limits: &Limits) -> bool {
        let peaks = &self.expected.peaks;
        peaks.within(limits) && peaks.rms_force() <= limits.rated_force
    }
}
