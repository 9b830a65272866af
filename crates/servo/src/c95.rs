//! The experiments of Canudas de Wit, Olsson, Astrom, Lischinsky 1995 (doi 10.1109/9.376053) with the expected
//! numbers: the block of the paper's Table I, constant sigma1.
//!
//! References come from an adaptive Radau integration at a relative tolerance of 1e-9 to 1e-10, not from this workspace.
//! The letters B to G are this project's names for them.

mod break_away;
mod drift;
mod experiment;
mod hunting;
mod lag;
mod presliding;
mod stick_slip;

pub use experiment::{Check, Curve, Experiment};
use stiction_friction::ParamError;

/// An experiment to run. It asks its argument now and then whether to go on; `None` where it was stopped.
pub type Run = fn(&dyn Fn() -> bool) -> Result<Option<Experiment>, ParamError>;

/// All of them, B to G.
pub const ALL: [Run; 6] = [
    |go_on| whole(presliding::run, go_on),
    |go_on| whole(lag::run, go_on),
    |go_on| whole(break_away::run, go_on),
    |go_on| whole(stick_slip::run, go_on),
    hunting::run,
    |go_on| whole(drift::run, go_on),
];

/// Runs one that takes less than a second, and so need not ask.
fn whole(
    run: fn() -> Result<Experiment, ParamError>,
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Experiment>, ParamError> {
    match go_on() {
        true => run().map(Some),
        false => Ok(None),
    }
}
