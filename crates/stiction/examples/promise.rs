//! What a study promises of compensation, and what it does on the axis that the log came from, by world, axis and motion.
//!
//! `cargo run --release -p stiction --example promise -- [seeds] [first seed] [name ...]`, with names of axes (`stage`,
//! `screw`, `joint`), motions (`commissioning`, `sine`, `trapezoid`) and worlds (`as-assumed`, `cogging`, `force-10-late`,
//! ...); all of a kind where none is named. `each` prints every promise too.
//!
//! The log of a world is identified with defaults, and the study that comes with the model is simulated. Its controller and
//! its compensators, with their watchdogs and drives, then run on the world itself instead of the simulated plant, without
//! and with compensation. What is left of the largest error should lie in 9 of 10 of the promised intervals. Results that may
//! not be used (exit code 1) are counted apart.

use rayon::prelude::*;
use stiction_testkit::worlds::{Machine, Motion, World};

#[path = "../tests/suite/common/kept.rs"]
mod kept;
use kept::{Kept, Told, kept};

fn main() {
    let (mut numbers, mut names) = (Vec::new(), Vec::<String>::new());
    for argument in std::env::args().skip(1) {
        match argument.parse::<u64>() {
            Ok(n) => numbers.push(n),
            Err(_) => names.push(argument),
        }
    }
    let first = numbers.get(1).copied().unwrap_or(1);
    let seeds = first..first + numbers.first().copied().unwrap_or(1);
    let wanted = |kind: &[String], name: &str| {
        let of_kind = |n: &&String| kind.contains(n);
        let mut asked = names.iter().filter(of_kind).peekable();
        asked.peek().is_none() || asked.any(|n| n == name)
    };
    let axes: Vec<String> = Machine::all(0).map(|(name, _)| name.to_owned()).to_vec();
    let motions = Motion::ALL.map(|m| m.name().to_owned()).to_vec();
    let worlds = World::ALL.map(short).to_vec();
    let mut tasks = Vec::new();
    for world in World::ALL
        .into_iter()
        .filter(|w| wanted(&worlds, &short(*w)))
    {
        for axis in (0..axes.len()).filter(|&i| wanted(&axes, &axes[i])) {
            for motion in Motion::ALL
                .into_iter()
                .filter(|m| wanted(&motions, m.name()))
            {
                tasks.extend(seeds.clone().map(|seed| (world, axis, motion, seed)));
            }
        }
    }
    let told: Vec<Told> = tasks
        .par_iter()
        .map(|&(world, axis, motion, seed)| kept(&Machine::all(seed)[axis].1, motion, world, seed))
        .collect();
    if names.iter().any(|n| n == "each") {
        for ((world, axis, motion, seed), told) in tasks.iter().zip(&told) {
            let cell = format!("{} {} {} {seed}", short(*world), axes[*axis], motion.name());
            match told {
                Told::Nothing(why) => println!("{cell}: {why}"),
                Told::Promised { trusted, kept } => kept.iter().for_each(|k| {
                    let doubt = if *trusted { "" } else { ", not to be used" };
                    println!("{cell}: {k}{doubt}");
                }),
            }
        }
    }
    println!(
        "| world | not to be used | nothing promised | promises | below | inside | above | share inside | width |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    for world in World::ALL {
        let of_world = tasks.iter().zip(&told).filter(|(task, _)| task.0 == world);
        row(
            &world.name(),
            &of_world.map(|(_, told)| told).collect::<Vec<_>>(),
        );
    }
    row("all", &told.iter().collect::<Vec<_>>());
}

/// The name of a world as an argument.
fn short(world: World) -> String {
    let name = world.name().replace(", ", "-");
    name.replace(' ', "-").to_lowercase()
}

fn row(name: &str, told: &[&Told]) {
    if told.is_empty() {
        return;
    }
    let mut all: Vec<&Kept> = Vec::new();
    let (mut doubted, mut nothing) = (0, 0);
    for told in told {
        match told {
            Told::Nothing(_) => nothing += 1,
            Told::Promised { trusted: false, .. } => doubted += 1,
            Told::Promised { kept, .. } => all.extend(kept),
        }
    }
    let count = |test: &dyn Fn(&Kept) -> bool| all.iter().filter(|k| test(k)).count();
    let inside = count(&|k| k.is_kept());
    let mut widths: Vec<f64> = all.iter().map(|k| k.promised[1] - k.promised[0]).collect();
    widths.sort_by(f64::total_cmp);
    let width = widths.get(widths.len() / 2).copied().unwrap_or(f64::NAN);
    println!(
        "| {name} | {doubted} | {nothing} | {} | {} | {inside} | {} | {:.3} | {width:.1} |",
        all.len(),
        count(&|k| k.found < k.promised[0]),
        count(&|k| k.found > k.promised[1]),
        inside as f64 / all.len().max(1) as f64,
    );
}
