//! What is wrong, odd or worth knowing about a recording, each with a stable code.
//!
//! A *warning* may change what an identification finds; a *note* says what was assumed or seen.
//! What no rule can mend is an [`Error`](crate::Error) instead. Thresholds stand as constants beside
//! their check. They are this project's choices, held by tests: `tests/suite/mapping_faults.rs` asks that random clean logs
//! get no warning and that every fault put into them is found, `tests/suite/binary/mapping_recordings.rs` fixes what is found in
//! measured recordings. In short:
//!
//! | code | found when | handled by |
//! |---|---|---|
//! | `gap` | a time step above 1.5 median steps | kept as it is; above 5 missing samples the record is split |
//! | `duplicate-time` | a step of exactly 0 | first sample kept; refused above 5 % |
//! | `time-missing` | a time stamp that is not a number | row dropped; refused above 5 % |
//! | `time-wrap` | a backward step of a full 16-, 31- or 32-bit counter | unwrapped; any other backward step is refused |
//! | `jitter` | rms of the step above 1 % (note) or 5 % (warning) of its median, gaps apart | time stamps used as recorded |
//! | `missing-cells` | cells that are not a number, or above 1e30 | up to 5 in a row interpolated linearly and excluded; longer runs dropped; refused above half |
//! | `sensor-dropout` | a temperature at or below 0 K, or a temperature or load that steps off its course and back | as missing cells; left out where most of it is |
//! | `zero-filled` | position, force or load 0 in many samples whose neighbours are far from it | as missing cells |
//! | `short-column` | a column ends before the others | all cut to the shortest; refused if that costs over 1 % |
//! | `saturation` | force constant at its extreme for 5 samples or more and not a staircase; or at a given limit | samples excluded |
//! | `force-spike` | single samples beyond all others by more than three times their range | interpolated linearly and excluded |
//! | `force-dead` | force below 3 % of its usual size for 0.25 s and more while the axis moves, and hardly any or noise | samples excluded |
//! | `coarse-force` | force in steps of more than a fiftieth of its range | kept |
//! | `held-position` | the position changes at every n-th row only, n up to 64 | rows between left out |
//! | `stuck-encoder` | position frozen while the velocity, the reference or the jump after it shows motion | samples excluded |
//! | `rest-at-end` | the axis stands still for 1 s or more at the start or the end | left out of fits of the whole record, up to 0.02 s beside the motion; kept where the force varies on purpose |
//! | `rest-between` | the same between two motions | fitted; a warning above a third of the samples |
//! | `position-jump` | a step above half the range and 50 times the usual one | record split there |
//!
//! *Excluded* samples stay in the log, with the reason, so that a state can be carried through
//! them; they should not be fitted to. Single missing samples and small jitter are left to
//! resampling: they cost less than a split. A position that rests while the force builds up is
//! friction, not a fault, so a stuck encoder is only reported with evidence of motion from another signal.

mod acceleration;
mod clock;
mod dead;
mod encoder;
mod finding;
mod force;
mod motion;
mod ratio;
pub(crate) mod rest;
mod spike;
mod stray;
mod stuck;
mod velocity;

use crate::log::Log;
use crate::mapping::Mapping;
pub(crate) use encoder::{begins_again, quantum};
pub use finding::{Finding, Severity};
pub(crate) use finding::{extremes, median};
pub(crate) use force::{levels, sign_of_another_clock};
pub(crate) use stiction_number::{counted as count, full, short};
pub use stiction_say::Found;

/// Inspects a log whose columns are complete, adds what it finds, and excludes what it must.
pub(crate) fn inspect(log: &mut Log, mapping: &Mapping) {
    clock::gaps(log);
    clock::jitter(log);
    motion::few_samples(log);
    encoder::jumps(log);
    encoder::steps(log, mapping);
    stray::strays(log);
    stuck::stuck(log);
    spike::spikes(log);
    force::saturation(log, mapping);
    force::steps(log);
    dead::dead(log);
    force::sign(log);
    velocity::consistency(log);
    acceleration::consistency(log);
    motion::kind_of_motion(log);
    motion::constant_columns(log);
    rest::rests(log, mapping);
}
