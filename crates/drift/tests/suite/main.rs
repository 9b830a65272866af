//! What the test of changes promises, on fleets that are not what it takes them for; the whole table: `examples/fleet.rs`.

mod invariant;
mod world;

use world::{World, fared};

/// Noise of the size that docs/fleet.md gives figures for.
const USUAL: World = World {
    interval: 0.006,
    scatter: 0.008,
    wandering: 0.01,
    temperature: 0.006,
    load: 0.004,
};

#[test]
fn quiet_machines_are_seldom_alarmed_and_steps_are_found_within_five_logs() {
    let fared = fared(&USUAL, 500, 60, 100);
    assert!(fared.false_alarms <= 0.05, "{fared:?}");
    assert!(fared.steps >= 0.95, "{fared:?}");
    assert!(fared.creeps >= 0.9, "{fared:?}");
}
