//! A position that is renewed less often than it is logged.

use crate::findings::median;
use stiction_policy::position;

/// Most rows between two renewals that are looked for.
const MOST_ROWS: usize = 64;

/// Rows between two renewals of a position, and the first row that renews it; `None` where every row may.
///
/// A drive that samples its encoder at a lower rate than it logs repeats each value. A slow axis repeats values too, but changes
/// them on any row. Where rows are missing, they are not counted from renewal to renewal, and none is found.
pub(super) fn period(time: &[f64], position: &[f64]) -> Option<(usize, usize)> {
    let changes: Vec<usize> = (1..position.len())
        .filter(|&i| position[i].is_finite() && position[i - 1].is_finite())
        .filter(|&i| position[i] != position[i - 1])
        .collect();
    if changes.len() < position::MIN_HELD_CHANGES || !is_even(time) {
        return None;
    }
    (2..=MOST_ROWS).rev().find_map(|rows| {
        let mut on = vec![0_usize; rows];
        changes.iter().for_each(|i| on[i % rows] += 1);
        let first = (0..rows).max_by_key(|&row| on[row])?;
        (on[first] as f64 >= position::MIN_HELD_SHARE * changes.len() as f64)
            .then_some((rows, first))
    })
}

/// Whether nearly all steps of a clock are of one length.
fn is_even(time: &[f64]) -> bool {
    let mut steps: Vec<f64> = time.windows(2).map(|t| t[1] - t[0]).collect();
    let Some(median) = median(&mut steps) else {
        return false;
    };
    let odd = steps
        .iter()
        .filter(|step| (**step - median).abs() > 0.5 * median);
    odd.count() as f64 <= (1.0 - position::MIN_HELD_SHARE) * steps.len() as f64
}

/// A force as the mean over as many rows, about each row: the axis moves by all of it, and the rows between are left out. At the
/// ends, where rows are missing, it stays what it is.
pub(super) fn meaned(force: &[f64], rows: usize) -> Vec<f64> {
    let half = rows / 2;
    let mean = |at: usize| {
        let own = at
            .checked_sub(half)
            .and_then(|from| force.get(from..=at + half));
        own.map_or(force[at], |own| {
            // An even number of rows has half a row at each end.
            let ends = if rows.is_multiple_of(2) {
                0.5 * (own[0] + own[own.len() - 1])
            } else {
                0.0
            };
            (own.iter().sum::<f64>() - ends) / rows as f64
        })
    };
    (0..force.len()).map(mean).collect()
}
