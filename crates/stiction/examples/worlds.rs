//! What the default identification claims of simulated logs, and how much of it is true: coverage, lies and false alarms.
//!
//! `cargo run --release -p stiction --example worlds -- [set] [seeds] [first seed] [name ...]`, with a set of `testkit`:
//! `tuning`, on which constants are chosen, `test`, on which tests assert, or `report`, which `docs/conditioning.md` shows:
//! `worlds -- report 2`. Without a set it is the older eighteen worlds of `tuning`. Names are those of axes (`stage`,
//! `ball-screw`, ...), motions (`sine`, `places`, ...) and worlds (`as-assumed`, `belt`, `force-10-late`, ...); all of a kind
//! where none is named.
//!
//! `each` prints every run too, `cells` a row for each axis and motion of a world, and half-widths. `twice` identifies two logs
//! of the axis together, `apart-PERCENT` two between which its friction has risen by so much; the second moves as `with-MOTION`
//! says. With `levels` each of the two has levels of its own, and the claims are of the first. `law-NAME` asks for a law, alone.
//!
//! Coverage is the share of claimed 95 % intervals that hold the truth. A lie is a run that claims a value whose interval
//! misses the truth by more than its own width. A false alarm is, in a world where nothing is to be named, a run that names a
//! cause or must not be used; values that are flagged as open there are counted beside. All of it in `tests/suite/claims`.

mod asked;
#[path = "../tests/suite/claims/mod.rs"]
mod claims;
#[path = "../tests/suite/common/identified.rs"]
mod identified;
mod made;

use asked::{Asked, all, cell};
use claims::{Claim, Figures, Run};
use identified::identified;
use rayon::prelude::*;
use std::collections::BTreeMap;
use stiction_files::Axis;
use stiction_parameters::LawKind;
use stiction_testkit::worlds::{Case, Motion, World, record};
use stiction_workflows::identify::Options;

fn main() {
    let asked = Asked::of_arguments(2);
    let (cases, names) = (&asked.cases, &asked.names);
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
    let runs: Vec<Run> = cases
        .par_iter()
        .map(|case| {
            let machine = case.machine;
            let (mut logs, mut machines) = (vec![case.record()], vec![machine]);
            if let Some(percent) = rise {
                let later = machine.with_friction(1.0 + 0.01 * percent);
                let motion = second.unwrap_or(case.motion);
                logs.push(record(&later, motion, case.setup, case.seed + LATER));
                if !levels {
                    machines.push(later);
                }
            }
            let fit = identified(&machine, &logs, &file, &options);
            let truths = machines
                .iter()
                .flat_map(|machine| case.setup.truth(machine));
            claims::judged_by(&truths.collect::<Vec<_>>(), fit.map(|fit| fit.0))
        })
        .collect();
    if asked.has("each") {
        for (case, run) in cases.iter().zip(&runs) {
            let truth = run.coupling.and(case.setup.coupling(&case.machine));
            let truth = truth.map_or(String::new(), |truth| format!(" of {truth:.3e}"));
            println!("{}: {run}{truth}", cell(case));
        }
    }
    let figures = Figures::of(cases.iter().zip(&runs));
    println!("{}\n", written());
    println!("Set *{}*, {figures}.\n", asked.set.name());
    table(cases, &runs, asked.has("cells"));
    if asked.has("cells") {
        widths(cases, &runs);
    }
}

/// What the seed of a second log is more than that of the first.
const LATER: u64 = 1_000_000;

/// By what, when and where these figures were written.
fn written() -> String {
    let words: Vec<String> = std::env::args().skip(1).collect();
    format!(
        "Written by `cargo run --release -p stiction --example worlds -- {}`: {}.",
        words.join(" "),
        made::described()
    )
}

/// One row for each world, axis and motion, and for all; with `cells` for each axis and motion of a world, too.
fn table(cases: &[Case], runs: &[Run], cells: bool) {
    println!(
        "| world, axis or motion | runs | trusted | lies | claimed | inside | open | half-width | largest error | largest, half-widths | named |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---|---|---|");
    let of = |wanted: &dyn Fn(&Case) -> bool| -> Vec<&Run> {
        let both = cases.iter().zip(runs);
        both.filter(|(case, _)| wanted(case))
            .map(|(_, run)| run)
            .collect()
    };
    let axes = all(cases, |case| case.axis);
    let motions = all(cases, |case| case.motion.name());
    for world in all(cases, |case| case.world.clone()) {
        for &axis in axes.iter().filter(|_| cells) {
            for &motion in &motions {
                let here =
                    |c: &Case| (&c.world[..], c.axis, c.motion.name()) == (&world, axis, motion);
                row(&format!("{world}, {axis}, {motion}"), &of(&here));
            }
        }
        row(&world, &of(&|c| c.world == world));
    }
    for axis in axes {
        row(&format!("all of {axis}"), &of(&|c| c.axis == axis));
    }
    for motion in motions {
        row(
            &format!("all of {motion}"),
            &of(&|c| c.motion.name() == motion),
        );
    }
    row("all", &of(&|_| true));
}

/// Half of the interval of each parameter by motion, where everything is as assumed: what a motion costs.
fn widths(cases: &[Case], runs: &[Run]) {
    let as_assumed = |case: &Case| case.world == World::Faithful.name();
    let names = all(cases, |case| case.motion.name());
    let mut found = BTreeMap::<(&str, &str), Vec<Vec<f64>>>::new();
    for (case, run) in cases.iter().zip(runs).filter(|both| as_assumed(both.0)) {
        let column = names.iter().position(|name| *name == case.motion.name());
        for claim in &run.claims {
            let sided = claim.name.trim_end_matches("_pos").trim_end_matches("_neg");
            let by_motion = found.entry((sided, case.axis));
            let by_motion = by_motion.or_insert_with(|| vec![Vec::new(); names.len()]);
            by_motion[column.expect("one of all motions")].push(half_width(claim));
        }
    }
    if found.is_empty() {
        return;
    }
    println!("\n| half-width of | axis | {} |", names.join(" | "));
    println!("|---|---|{}", "---:|".repeat(names.len()));
    for ((name, axis), by_motion) in found {
        let cells = by_motion.into_iter().map(|widths| percent(middle(widths)));
        let cells: Vec<String> = cells.collect();
        println!("| {name} | {axis} | {} |", cells.join(" | "));
    }
}

/// Half of the interval of a claim, in parts of the truth.
fn half_width(claim: &Claim) -> f64 {
    (claim.part / claim.at_once).abs()
}

fn middle(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

fn percent(part: Option<f64>) -> String {
    part.map_or(String::new(), |w| format!("{:.2} %", 100.0 * w))
}

fn row(head: &str, runs: &[&Run]) {
    if runs.is_empty() {
        return;
    }
    let claims = || runs.iter().flat_map(|r| &r.claims);
    let inside = claims().filter(|c| c.at_once.abs() <= 1.0).count();
    let open: usize = runs.iter().filter(|r| r.trusted).map(|r| r.open).sum();
    let worst = |by: fn(&Claim) -> f64| {
        claims()
            .max_by(|a, b| by(a).abs().total_cmp(&by(b).abs()))
            .map(|c| (c.name.clone(), by(c)))
    };
    let part = worst(|c| c.part).map_or(String::new(), |(name, x)| {
        format!("{name} {:+.1} %", 100.0 * x)
    });
    let halves = worst(|c| c.transfer).map_or(String::new(), |(name, x)| format!("{name} {x:+.1}"));
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
        "| {head} | {} | {} | {} | {} | {:.3} | {open} | {width} | {part} | {halves} | {} |",
        runs.len(),
        runs.iter().filter(|r| r.trusted).count(),
        runs.iter().filter(|r| r.is_silent()).count(),
        claims().count(),
        inside as f64 / claims().count().max(1) as f64,
        codes.join(", ")
    );
}
