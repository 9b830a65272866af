//! How often quiet machines are alarmed and changes are found, in fleets of several kinds: the table of `docs/fleet.md`.
//!
//! `cargo run --release -p stiction-drift --example fleet`

#[path = "../tests/suite/world.rs"]
mod world;

use world::{World, fared};

fn main() {
    let seeds = std::env::args()
        .nth(1)
        .and_then(|x| x.parse().ok())
        .unwrap_or(4);
    let usual = World {
        interval: 0.006,
        scatter: 0.008,
        wandering: 0.01,
        temperature: 0.006,
        load: 0.004,
    };
    let worlds = [
        ("usual", usual),
        (
            "half the noise",
            World {
                interval: 0.003,
                scatter: 0.004,
                wandering: 0.005,
                ..usual
            },
        ),
        (
            "scatter 1.5 %",
            World {
                scatter: 0.015,
                ..usual
            },
        ),
        (
            "wandering 2 %",
            World {
                wandering: 0.02,
                ..usual
            },
        ),
        (
            "temperature 1.5 %/K",
            World {
                temperature: 0.015,
                ..usual
            },
        ),
        (
            "intervals 2 %",
            World {
                interval: 0.02,
                ..usual
            },
        ),
    ];
    println!(
        "{:22} {:>8} {:>8} {:>8}",
        "500 machines, 60 days", "alarmed", "steps", "creeps"
    );
    for (name, world) in worlds {
        let mut sums = [0.0; 3];
        for seed in 0..seeds {
            let fared = fared(&world, 500, 60, 100 + seed);
            for (sum, part) in sums
                .iter_mut()
                .zip([fared.false_alarms, fared.steps, fared.creeps])
            {
                *sum += 100.0 * part / seeds as f64;
            }
        }
        println!(
            "{name:22} {:>6.1} % {:>6.1} % {:>6.1} %",
            sums[0], sums[1], sums[2]
        );
    }
}
