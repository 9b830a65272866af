//! What a study promises of compensation, and what it does on the axis that the log came from, by world, axis and motion.
//!
//! `cargo run --release -p stiction --example promise -- [set] [seeds] [first seed] [name ...]`, with names of axes (`stage`,
//! `screw`, `joint`), motions (`commissioning`, `sine`, `trapezoid`) and worlds (`as-assumed`, `cogging`, `force-10-late`,
//! ...); all of a kind where none is named. `each` prints every promise too. The sets are those of the example `worlds`.
//!
//! The log of a world is identified with defaults, and the study that comes with the model is simulated. Its controller and
//! its compensators, with their watchdogs and drives, then run on the world itself instead of the simulated plant, without
//! and with compensation. What is left of the largest error should lie in 9 of 10 of the promised intervals. Results that may
//! not be used (exit code 1) are counted apart.

use rayon::prelude::*;
mod asked;
#[path = "../tests/suite/common/identified.rs"]
mod identified;
#[path = "../tests/suite/common/kept.rs"]
mod kept;
use asked::{Asked, all, cell};
use kept::{Kept, Told, kept};

fn main() {
    let asked = Asked::of_arguments(1);
    let cases = &asked.cases;
    let told: Vec<Told> = cases
        .par_iter()
        .map(|case| kept(&case.machine, case.motion, case.setup, case.seed))
        .collect();
    if asked.has("each") {
        for (case, told) in cases.iter().zip(&told) {
            let cell = cell(case);
            match told {
                Told::Nothing(why) => println!("{cell}: {why}"),
                Told::Promised { trusted, kept } => kept.iter().for_each(|k| {
                    let doubt = if *trusted { "" } else { ", not to be used" };
                    println!("{cell}: {k}{doubt}");
                }),
            }
        }
    }
    println!("Set *{}*.\n", asked.set.name());
    println!(
        "| world | not to be used | nothing promised | promises | below | inside | above | share inside | width |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    for world in all(cases, |case| case.world.clone()) {
        let of_world = cases
            .iter()
            .zip(&told)
            .filter(|(case, _)| case.world == world);
        row(&world, &of_world.map(|(_, told)| told).collect::<Vec<_>>());
    }
    row("all", &told.iter().collect::<Vec<_>>());
}

/// A row of the table.
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
