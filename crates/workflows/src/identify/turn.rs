//! The reversal that shows most of presliding.

use std::ops::Range;
use stiction_parameters::{ParameterSet, Quantity, Side};
use stiction_policy::motion;

/// The way after a reversal on which the bristles of a law turn over, m (rad); `None` where it has none.
pub fn presliding_length(values: &ParameterSet) -> Option<f64> {
    let stiffness = values.get(Quantity::Sigma0).filter(|s| *s > 0.0)?;
    let level = values.on(Quantity::Coulomb, Side::Positive)?;
    Some(motion::TURN_OVER * level / stiffness)
}

/// The sample of the slowest reversal, the one with most samples within `length` of it, and these samples: at most a tenth of all
/// to each side.
pub fn slowest_turn(
    velocity: &[f64],
    position: &[f64],
    length: f64,
) -> Option<(usize, Range<usize>)> {
    let n = velocity.len().min(position.len());
    let turns = (1..n).filter(|&i| velocity[i - 1] * velocity[i] < 0.0);
    let reach = |turn: usize| {
        let origin = position[turn];
        let near = |i: usize| (position[i] - origin).abs() <= length;
        let most = n / 10 + 20;
        let mut end = turn;
        while end + 1 < n && end - turn < most && near(end) {
            end += 1;
        }
        let mut start = turn;
        while start > 0 && turn - start < most && near(start) {
            start -= 1;
        }
        (turn, start..end + 1)
    };
    turns.map(reach).max_by_key(|(_, window)| window.len())
}
