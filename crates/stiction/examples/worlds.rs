//! What the default identification claims of simulated logs, and how much of it is true, by world, axis and motion.
//!
//! `cargo run --release -p stiction --example worlds -- [seeds] [first seed] [name ...]`, with names of axes (`stage`,
//! `screw`, `joint`), motions (`commissioning`, `sine`, `trapezoid`) and worlds (`as-assumed`, `cogging`, `force-10-late`,
//! ...); all of a kind where none is named. `each` prints every run too. `twice` identifies two logs of the axis together,
//! `apart-PERCENT` two between which its friction has risen by so much; the second moves as `with-MOTION` says. With
//! `levels` each of the two has levels of its own, and the claims are of the first. `law-NAME` asks for a law, alone.
//!
//! What is claimed, and when a run is silent, is defined in `tests/suite/claims`.

mod asked;
#[path = "../tests/suite/claims/mod.rs"]
mod claims;
#[path = "../tests/suite/common/identified.rs"]
mod identified;

use asked::{Asked, Task};
use claims::Run;
use identified::identified;
use rayon::prelude::*;
use std::collections::BTreeMap;
use stiction::{Axis, LawKind, Options};
use stiction_testkit::worlds::{Machine, Motion, World, record};

fn main() {
    let asked = Asked::of_arguments(4);
    let (tasks, axes, names) = (&asked.tasks, &asked.axes, &asked.names);
    let rise = names.iter().find_map(|name| match &name[..] {
        "twice" => Some(0.0),
        name => name.strip_prefix("apart-")?.parse::<f64>().ok(),
    });
    let other = |name: &str| Motion::ALL.into_iter().find(|m| m.name() == name);
    let second = names
        .iter()
        .find_map(|name| other(name.strip_prefix("with-")?));
    let rise = rise.or(second.map(|_| 0.0));
    let levels = asked.has("levels");
    let file = match levels {
        true => Axis::parse("[terms]\ncoulomb_log = true\nsigma2_log = true\n").unwrap(),
        false => Axis::default(),
    };
    let law = names.iter().find_map(|name| name.strip_prefix("law-"));
    let law = law.map(|name| LawKind::from_name(name).expect("a law"));
    let mut options = Options::default();
    (options.law, options.compare_laws) = (law, law.is_none());
    let runs: Vec<Run> = tasks
        .par_iter()
        .map(|&(world, axis, motion, seed)| {
            let machine = Machine::all(seed)[axis].1;
            let mut logs = vec![record(&machine, motion, world, seed)];
            let mut machines = vec![machine];
            if let Some(percent) = rise {
                let later = machine.with_friction(1.0 + 0.01 * percent);
                logs.push(record(
                    &later,
                    second.unwrap_or(motion),
                    world,
                    seed + LATER,
                ));
                if !levels {
                    machines.push(later);
                }
            }
            claims::judged(&machines, identified(&machine, &logs, &file, &options))
        })
        .collect();
    if asked.has("each") {
        for (task, run) in tasks.iter().zip(&runs) {
            let truth = task.0.coupling(&Machine::all(task.3)[task.1].1);
            let truth = run.coupling.and(truth);
            let truth = truth.map_or(String::new(), |truth| format!(" of {truth:.3e}"));
            println!("{}: {run}{truth}", asked.cell(task));
        }
    }
    table(tasks, &runs, axes);
    widths(tasks, &runs, axes);
}

/// What the seed of a second log is more than that of the first.
const LATER: u64 = 1_000_000;

/// The name of a world as an argument.
/// One row for each cell, for each motion of a world, for each world, and for all.
fn table(tasks: &[Task], runs: &[Run], axes: &[String]) {
    println!(
        "| world | axis | motion | runs | trusted | silent | claimed | inside | open | half-width | largest error | largest, half-widths | codes |"
    );
    println!("|---|---|---|---:|---:|---:|---:|---:|---:|---:|---|---|---|");
    let of = |wanted: &dyn Fn(&Task) -> bool| -> Vec<&Run> {
        let both = tasks.iter().zip(runs);
        both.filter(|(task, _)| wanted(task))
            .map(|(_, run)| run)
            .collect()
    };
    let mut cells: Vec<(World, usize, Motion)> = tasks.iter().map(|t| (t.0, t.1, t.2)).collect();
    cells.dedup();
    for &(world, axis, motion) in &cells {
        let head = [&world.name(), &axes[axis], motion.name()];
        row(&head, &of(&|t| (t.0, t.1, t.2) == (world, axis, motion)));
    }
    let mut worlds: Vec<World> = cells.iter().map(|cell| cell.0).collect();
    worlds.dedup();
    for world in worlds {
        for motion in Motion::ALL {
            row(
                &[&world.name(), "all", motion.name()],
                &of(&|t| (t.0, t.2) == (world, motion)),
            );
        }
        row(&[&world.name(), "all", "all"], &of(&|t| t.0 == world));
    }
    row(&["all", "all", "all"], &of(&|_| true));
}

/// Half of the interval of each parameter by motion, where everything is as assumed: what a motion costs.
fn widths(tasks: &[Task], runs: &[Run], axes: &[String]) {
    let mut found = BTreeMap::<(&str, usize), [Vec<f64>; Motion::ALL.len()]>::new();
    for ((world, axis, motion, _), run) in tasks.iter().zip(runs) {
        let column = Motion::ALL.iter().position(|m| m == motion);
        for claim in run.claims.iter().filter(|_| *world == World::Faithful) {
            let sided = claim.0.trim_end_matches("_pos").trim_end_matches("_neg");
            let by_motion = found.entry((sided, *axis)).or_default();
            by_motion[column.expect("one of all motions")].push(half_width(claim));
        }
    }
    if found.is_empty() {
        return;
    }
    let names = Motion::ALL.map(Motion::name);
    println!("\n| half-width of | axis | {} |", names.join(" | "));
    println!("|---|---|{}", "---:|".repeat(names.len()));
    for ((name, axis), by_motion) in found {
        let cells = by_motion.map(|widths| percent(middle(widths)));
        println!("| {name} | {} | {} |", axes[axis], cells.join(" | "));
    }
}

/// Half of the interval of a claim, in parts of the truth.
fn half_width(claim: &(String, f64, f64)) -> f64 {
    (claim.1 / claim.2).abs()
}

fn middle(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

fn percent(part: Option<f64>) -> String {
    part.map_or(String::new(), |w| format!("{:.2} %", 100.0 * w))
}

fn row(head: &[&str], runs: &[&Run]) {
    if runs.is_empty() {
        return;
    }
    let claims = || runs.iter().flat_map(|r| &r.claims);
    let inside = claims().filter(|c| c.2.abs() <= 1.0).count();
    let open: usize = runs.iter().filter(|r| r.trusted).map(|r| r.open).sum();
    let worst = |by: fn(&(String, f64, f64)) -> f64| {
        claims()
            .max_by(|a, b| by(a).abs().total_cmp(&by(b).abs()))
            .map(|c| (c.0.clone(), by(c)))
    };
    let part = worst(|c| c.1).map_or(String::new(), |(name, x)| {
        format!("{name} {:+.1} %", 100.0 * x)
    });
    let halves = worst(|c| c.2).map_or(String::new(), |(name, x)| format!("{name} {x:+.1}"));
    let width = percent(middle(claims().map(half_width).collect()));
    let mut codes = BTreeMap::<&str, usize>::new();
    for code in runs.iter().flat_map(|r| &r.codes) {
        *codes.entry(code).or_default() += 1;
    }
    let refused = runs.iter().filter(|r| r.refused.is_some()).count();
    if refused > 0 {
        codes.insert("refused", refused);
    }
    let codes: Vec<String> = codes
        .iter()
        .map(|(code, n)| format!("{code} {n}"))
        .collect();
    println!(
        "| {} | {} | {} | {} | {} | {:.3} | {open} | {width} | {part} | {halves} | {} |",
        head.join(" | "),
        runs.len(),
        runs.iter().filter(|r| r.trusted).count(),
        runs.iter().filter(|r| r.is_silent()).count(),
        claims().count(),
        inside as f64 / claims().count().max(1) as f64,
        codes.join(", ")
    );
}
