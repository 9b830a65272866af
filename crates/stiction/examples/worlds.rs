//! What the default identification claims of simulated logs, and how much of it is true, by world, axis and motion.
//!
//! `cargo run --release -p stiction --example worlds -- [seeds] [first seed] [name ...]`, with names of axes (`stage`,
//! `screw`, `joint`), motions (`commissioning`, `sine`, `trapezoid`) and worlds (`as-assumed`, `cogging`, `force-10-late`,
//! ...); all of a kind where none is named. `each` prints every run too. `twice` identifies two logs of the axis together,
//! `apart-PERCENT` two between which its friction has risen by so much; the second moves as `with-MOTION` says.
//!
//! A value is claimed where a result may be used and lists it as a constant of the machine. A run is silent where a claimed
//! value is off by more than half an interval and a whole one: its interval misses the truth by more than its own width.

use rayon::prelude::*;
use std::collections::BTreeMap;
use stiction::{Axis, Column, Fit, Log, Options, identify};
use stiction_testkit::worlds::{Machine, Motion, Recording, World, record};

fn main() {
    let (mut numbers, mut names) = (Vec::new(), Vec::<String>::new());
    for argument in std::env::args().skip(1) {
        match argument.parse::<u64>() {
            Ok(n) => numbers.push(n),
            Err(_) => names.push(argument),
        }
    }
    let rise = names.iter().find_map(|name| match &name[..] {
        "twice" => Some(0.0),
        name => name.strip_prefix("apart-")?.parse::<f64>().ok(),
    });
    let other = |name: &str| Motion::ALL.into_iter().find(|m| m.name() == name);
    let second = names
        .iter()
        .find_map(|name| other(name.strip_prefix("with-")?));
    let rise = rise.or(second.map(|_| 0.0));
    let first = numbers.get(1).copied().unwrap_or(1);
    let seeds = first..first + numbers.first().copied().unwrap_or(4);
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
    let runs: Vec<Run> = tasks
        .par_iter()
        .map(|&(world, axis, motion, seed)| {
            let machine = Machine::all(seed)[axis].1;
            let mut logs = vec![record(&machine, motion, world, seed)];
            let mut machines = vec![machine];
            if let Some(percent) = rise {
                let later = risen(machine, 1.0 + 0.01 * percent);
                logs.push(record(
                    &later,
                    second.unwrap_or(motion),
                    world,
                    seed + LATER,
                ));
                machines.push(later);
            }
            judged(&machines, identified(&machine, &logs))
        })
        .collect();
    if names.iter().any(|n| n == "each") {
        for ((world, axis, motion, seed), run) in tasks.iter().zip(&runs) {
            println!(
                "{} {} {} {seed}: {run}",
                short(*world),
                axes[*axis],
                motion.name()
            );
        }
    }
    table(&tasks, &runs, &axes);
}

/// What the seed of a second log is more than that of the first.
const LATER: u64 = 1_000_000;

/// A machine whose friction is so many times what it was.
fn risen(machine: Machine, factor: f64) -> Machine {
    Machine {
        sigma0: factor * machine.sigma0,
        sigma1: factor * machine.sigma1,
        sigma2: factor * machine.sigma2,
        coulomb: factor * machine.coulomb,
        static_friction: factor * machine.static_friction,
        ..machine
    }
}

/// The name of a world as an argument.
fn short(world: World) -> String {
    world
        .name()
        .replace(", ", "-")
        .replace(' ', "-")
        .to_lowercase()
}

fn identified(machine: &Machine, logs: &[Recording]) -> Result<Fit, stiction::Error> {
    let axis = Axis::default();
    let logs: Result<Vec<Log>, _> = logs
        .iter()
        .enumerate()
        .map(|(i, log)| Log::from_columns(&format!("log-{}", i + 1), columns(machine, log), &axis))
        .collect();
    identify(&logs?, &axis, &Options::default())
}

fn columns(machine: &Machine, log: &Recording) -> Vec<Column> {
    let (length, force) = match machine.kind {
        "rotary" => ("rad", "N*m"),
        _ => ("m", "N"),
    };
    let column = |name: &str, unit: &str, values: &[f64]| Column {
        name: name.into(),
        unit: Some(unit.into()),
        values: values.to_vec(),
    };
    let mut columns = vec![column("time", "s", &log.time)];
    if let Some(x) = &log.position {
        columns.push(column("position", length, x));
    }
    if let Some(v) = &log.velocity {
        columns.push(column("velocity", &format!("{length}/s"), v));
    }
    columns.push(column("force", force, &log.force));
    columns
}

/// What a run claims, and what of it holds.
#[derive(Clone, Debug, Default)]
struct Run {
    refused: Option<String>,
    trusted: bool,
    law: String,
    /// Every claimed value: name, error in parts of the truth, error in halves of its interval.
    claims: Vec<(String, f64, f64)>,
    /// Values that are listed as open.
    open: usize,
    codes: Vec<&'static str>,
}

impl Run {
    /// Whether a claimed interval misses by more than its width.
    fn is_silent(&self) -> bool {
        self.claims.iter().any(|c| c.2.abs() > 3.0)
    }
}

impl std::fmt::Display for Run {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        if let Some(why) = &self.refused {
            return write!(f, "refused: {why}");
        }
        write!(
            f,
            "{} {}",
            self.law,
            if self.trusted {
                "trusted"
            } else {
                "not trusted"
            }
        )?;
        for (name, part, halves) in &self.claims {
            let mark = if halves.abs() > 3.0 {
                "!!"
            } else if halves.abs() > 1.0 {
                "!"
            } else {
                ""
            };
            write!(f, ", {name} {:+.1} % ({halves:+.1}){mark}", 100.0 * part)?;
        }
        write!(f, "; {} open; {}", self.open, self.codes.join(" "))
    }
}

/// A claim about several machines holds as far as it does for the one that it holds least for.
fn judged(machines: &[Machine], fit: Result<Fit, stiction::Error>) -> Run {
    let fit = match fit {
        Ok(fit) => fit,
        Err(e) => {
            return Run {
                refused: Some(e.to_string()),
                ..Run::default()
            };
        }
    };
    let trust = &fit.result().trust;
    let mut run = Run {
        trusted: fit.is_trustworthy(),
        law: fit.law_kind().name().to_owned(),
        open: trust.open.len(),
        codes: fit.warnings().iter().map(|w| w.code.as_str()).collect(),
        ..Run::default()
    };
    run.codes.sort_unstable();
    run.codes.dedup();
    if !run.trusted {
        return run;
    }
    for p in fit
        .parameters()
        .filter(|p| trust.constants.iter().any(|c| c == p.name()))
    {
        let base = p.name().trim_end_matches("_pos").trim_end_matches("_neg");
        let Some((low, high)) = p.interval() else {
            continue;
        };
        let centre = 0.5 * (low + high);
        let truths = machines.iter().flat_map(Machine::truth);
        let claims = truths.filter(|t| t.0 == base).map(|(_, truth)| {
            let halves = (centre - truth) / (0.5 * (high - low));
            (p.name().to_owned(), p.value() / truth - 1.0, halves)
        });
        let least = claims.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
        run.claims.extend(least);
    }
    run
}

/// World, axis, motion.
type Cell = (World, usize, Motion);

fn table(tasks: &[(World, usize, Motion, u64)], runs: &[Run], axes: &[String]) {
    println!(
        "| world | axis | motion | runs | trusted | silent | claimed | inside | open | largest error | largest, half-widths | codes |"
    );
    println!("|---|---|---|---:|---:|---:|---:|---:|---:|---|---|---|");
    let mut cells: Vec<(Cell, Vec<&Run>)> = Vec::new();
    for (task, run) in tasks.iter().zip(runs) {
        let cell = (task.0, task.1, task.2);
        match cells.last_mut().filter(|c| c.0 == cell) {
            Some(last) => last.1.push(run),
            None => cells.push((cell, vec![run])),
        }
    }
    for ((world, axis, motion), runs) in cells {
        row(&[&world.name(), &axes[axis], motion.name()], &runs);
    }
    row(&["all", "", ""], &runs.iter().collect::<Vec<_>>());
}

fn row(head: &[&str], runs: &[&Run]) {
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
        "| {} | {} | {} | {} | {} | {:.3} | {open} | {part} | {halves} | {} |",
        head.join(" | "),
        runs.len(),
        runs.iter().filter(|r| r.trusted).count(),
        runs.iter().filter(|r| r.is_silent()).count(),
        claims().count(),
        inside as f64 / claims().count().max(1) as f64,
        codes.join(", ")
    );
}
