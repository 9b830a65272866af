//! Whether the default gain leaves more than the identification leaves open.

use super::{ExportOptions, Reserve, Target};
use stiction_files::ModelFile;
use stiction_parameters::{Name, Quantity};
use stiction_policy::interval;

/// The gain of an export that asked for none, where friction is known better than it needs.
pub(super) fn of(file: &ModelFile, options: &ExportOptions, gain: f64) -> Option<Reserve> {
    let target = options.target;
    let has_gain = !target.is_simulated() && !target.is_map() && target != Target::DriveTable;
    if !has_gain || options.gain.is_some() || gain >= 1.0 || !file.trustworthy {
        return None;
    }
    let levels = file.parameter.iter().filter(|p| {
        let quantity = p.name.parse::<Name>().map(|name| name.quantity);
        matches!(quantity, Ok(Quantity::Coulomb | Quantity::Static))
    });
    // What the log shows of the level at other places and times counts as what is open.
    let moved = 100.0 * file.remaining.as_ref()?.level;
    let mut within = Some(moved);
    for p in levels.filter(|p| p.origin != "given") {
        let half = p.ci95.filter(|_| p.identifiable).map(|[low, high]| {
            let far = (high - p.value).max(p.value - low);
            100.0 * far / p.value.abs()
        });
        within = within.zip(half).map(|(a, b)| a.max(b));
    }
    let within = within.filter(|within| *within <= interval::MAX_RESERVE_HALF_WIDTH)?;
    Some(Reserve {
        gain,
        known_within_percent: within,
    })
}
