//! What a terminal shows: plain text tables, the same on every width.

mod against_plan;
mod batch;
mod brief;
mod check;
mod comparison;
mod drift;
mod export;
mod followed;
mod library;
pub(crate) mod plan;
mod procedure;
mod record;
mod reproduction;
mod robot;
mod searched;
mod study;
mod table;

use crate::deviation::Deviation;
use crate::inputs;
use crate::names::{
    as_good, chosen_by, force_noise, is_of_the_counts, law_beside, law_of, parameters_shown,
    simulated_runs, without_offset,
};
use crate::next;
pub use crate::next::{axis_file, why};
use crate::trust::{compensation, constants, use_it};
pub use batch::batch;
pub use brief::brief;
pub use check::{Changed, ChangedRow, Row, Told, changed, check, check_in_short, started, told};
pub use comparison::{announced_comparison, comparison};
pub use drift::drift;
pub use export::{exported, exported_robot};
pub use followed::{FollowedWords, followed};
pub use library::{library, machine, machine_in};
pub use plan::planned;
pub use procedure::{planned_log, procedure_commands};
pub use record::recorded;
pub use reproduction::reproduction;
pub use robot::{robot, robot_in_full, robot_next};
use std::fmt::Write;
use std::path::Path;
use stiction_files::result::{
    Action, FrictionCurveEntry, LawEntry, LevelAlongEntry, Origin, ResultFile, SimulationEntry,
};
use stiction_files::symbols;
use stiction_number::{Percent, four_digits as short, quantity, r_squared, sig, unit};
use stiction_workflows::identify::Outcome;
pub use study::{announced, started_study, study};
use table::table;

/// The outcome of an identification in full.
pub fn outcome(outcome: &Outcome) -> String {
    let result = &outcome.result;
    let mut out = String::new();
    for input in &result.inputs {
        let _ = writeln!(
            out,
            "{}{}: {} samples at {} Hz",
            stiction_files::shell::shown(&input.path),
            inputs::part(input),
            input.samples,
            short(input.rate_hz)
        );
        if let Some((assumed, lines)) = inputs::assumed(input) {
            let _ = writeln!(out, "{assumed}\n    {}", lines.join("\n    "));
        }
        for left_out in [inputs::not_enabled(input), inputs::left_out(input)] {
            let _ = left_out.map(|text| writeln!(out, "{text}"));
        }
    }
    if let Some(text) = inputs::unsettled(&result.axis) {
        let _ = writeln!(out, "{text}");
    }
    let _ = writeln!(
        out,
        "\n{}{}",
        law_of(result),
        chosen_by(&result.law_chosen_by)
    );
    if let Some(others) = as_good(&result.laws) {
        let _ = writeln!(out, "as good: {others}");
    }
    let mut rows = vec![
        [
            "parameter",
            "",
            "value",
            "unit",
            "another day",
            "95 % interval",
            "another motion",
            "",
        ]
        .map(String::from)
        .to_vec(),
    ];
    for p in parameters_shown(result) {
        let deviation = Deviation::of(p, result);
        let interval = match p.range() {
            Some((f64::NEG_INFINITY, high)) => format!("at most {}", short(high)),
            Some((low, f64::INFINITY)) => format!("at least {}", short(low)),
            _ if deviation == Deviation::Unbounded => "not bounded".into(),
            Some((low, high)) => format!("{} .. {}", short(low), short(high)),
            None if p.origin == Origin::Given => String::new(),
            None => "not bounded".into(),
        };
        rows.push(vec![
            p.name.clone(),
            p.symbol.clone(),
            match deviation {
                Deviation::Unbounded => "-".into(),
                _ => short(p.value),
            },
            unit(&p.unit),
            deviation.cell(&unit(&p.unit)),
            interval,
            match deviation {
                Deviation::Given | Deviation::Unbounded => String::new(),
                _ => Deviation::of_transfer(p, result).cell(&unit(&p.unit)),
            },
            if p.identifiable {
                String::new()
            } else {
                "NOT IDENTIFIABLE".into()
            },
        ]);
    }
    out.push_str(&table(
        &rows,
        &[false, false, true, false, true, true, true, false],
    ));
    let fit = &result.fit;
    let _ = writeln!(
        out,
        "\nfit         {} relative error, {} {} rms, R2 {}",
        Percent::error(fit.relative_error_percent).fine(),
        short(fit.rmse),
        unit(&fit.unit),
        fit.r2.map_or("-".into(), r_squared)
    );
    if let Some(curve) = &result.friction_curve {
        let _ = writeln!(out, "friction    {}", friction(curve));
    }
    if let Some(line) = line(result) {
        let _ = writeln!(out, "simulators  {line}");
    }
    for along in &result.level_along {
        let _ = writeln!(out, "stroke      {}", level_along(along, outcome));
    }
    if let Some(simulation) = &result.simulation {
        let _ = writeln!(out, "simulation  {}", simulated(simulation));
    }
    if let Some(low) = &result.low_speed {
        let _ = writeln!(
            out,
            "low speed   {} {} rms below {} {}",
            short(low.fit.rmse),
            unit(&low.fit.unit),
            short(low.bound),
            low.bound_unit
        );
    }
    if is_of_the_counts(result) {
        let _ = writeln!(
            out,
            "counts      the axis rests in much of the log: parameters and intervals come from the counts of the encoder, the \
             errors above from the fit of the force"
        );
    }
    for (i, v) in result.validation.iter().enumerate() {
        let _ = writeln!(
            out,
            "validation  {} relative error, {} {} rms on {}{}",
            Percent::error(v.fit.relative_error_percent).fine(),
            short(v.fit.rmse),
            unit(&v.fit.unit),
            v.path,
            result
                .simulation
                .as_ref()
                .map_or(String::new(), |entry| simulated_unseen(entry, i))
        );
    }
    if let Some(simulation) = &result.simulation
        && let Some(note) = force_noise(simulation)
    {
        let _ = writeln!(out, "            {note}");
    }
    if !outcome.truth.is_empty() {
        out.push_str("\nagainst the truth\n");
        out.push_str(&truth(outcome));
    }
    out.push_str(&searched::sections(result));
    out.push_str(&procedure::sections(result));
    if !result.laws.is_empty() {
        out.push_str("\nlaws on held-out samples\n");
        out.push_str(&laws(outcome));
    }
    if !result.elements.is_empty() {
        out.push_str("\nelements on blocks left out\n");
        out.push_str(&elements(outcome));
    }
    out.push_str(&against_plan::section(result.planned.as_ref()));
    for warning in &result.warnings {
        let _ = writeln!(out, "\nwarning [{}] {}", warning.code, warning.message);
    }
    out.push_str(&verdicts(result));
    out
}

/// Characters of a message that is shown whole.
const SHORT_MESSAGE: usize = 160;

/// A message, of a long one the first sentence.
fn first_sentence(message: &str) -> &str {
    if message.chars().count() <= SHORT_MESSAGE {
        return message;
    }
    let ends = [". ", "; "].into_iter().filter_map(|end| message.find(end));
    &message[..ends.min().unwrap_or(message.len())]
}

/// What the result may be used for, as compensation and as constants.
fn verdicts(result: &ResultFile) -> String {
    let trust = &result.trust;
    let mut out = String::new();
    let _ = writeln!(out, "\nfor compensation  {}", use_it(trust));
    if let Some(seen) = &trust.compensation {
        let _ = writeln!(out, "                  {}", compensation(seen, result));
    }
    let _ = writeln!(
        out,
        "as constants      {}",
        constants(result, str::to_string)
    );
    out
}

/// A command with its arguments, as a shell takes them.
pub fn command(arguments: impl Iterator<Item = String>) -> String {
    let quoted: Vec<String> = arguments
        .map(|argument| next::argument(&argument))
        .collect();
    format!("stiction {}", quoted.join(" "))
}

/// What to do next with a result, as data: its command is [`next()`].
pub fn next_action(result: &ResultFile) -> Action {
    next::steps(result, Path::new("result"), next::free)
        .first
        .action
}

/// What to do next with the result in a folder; `study` is one that was written there.
pub fn next(result: &ResultFile, dir: &Path, study: Option<&Path>) -> String {
    let mut out = String::new();
    if let Some(study) = study.filter(|_| result.trust.next == Action::Export) {
        let _ = writeln!(
            out,
            "what it does on this axis, simulated\n  {}",
            next::simulate(study, dir)
        );
    }
    let force = result.axis.force_unit.as_str();
    if result.trust.next == Action::Export && study.is_none() && !["N", "N*m"].contains(&force) {
        let wanted = match result.axis.kind.as_str() {
            "rotary" => "N m",
            _ => "N",
        };
        let per = match force {
            "1" => "%".to_string(),
            _ => unit(force).to_string(),
        };
        let how = match force {
            "V" => ", or for the voltage of a motor with [drive] (docs/axis.md#drive)",
            _ => "",
        };
        let _ = writeln!(
            out,
            "no study to simulate, since the force is in {per}: with a scale of its column, such as \"2.5 {wanted}/{per}\" in \
             the axis file{how}, identify writes one"
        );
    }
    let next::Steps { first, or } = next::steps(result, dir, next::free);
    let _ = writeln!(out, "{}", first.what);
    if let Some(line) = first.line {
        out.push_str(&written(&line));
    }
    let _ = writeln!(out, "next: {}", first.command);
    if let Some(or) = or {
        let line = or.line.as_ref().map_or(String::new(), written);
        let _ = writeln!(out, "or: {}\n{line}  {}", or.what, or.command);
    }
    if let Some(command) = next::planned(result, dir) {
        let _ = writeln!(
            out,
            "the motion to record for what is open, within [limits]\n  {command}"
        );
    }
    out
}

/// The same in short: the line to write and the command to type.
pub fn next_in_short(result: &ResultFile, dir: &Path, study: Option<&Path>) -> String {
    let next::Steps { first, or } = next::steps(result, dir, next::free);
    let uses = result.trust.next == Action::Export && first.line.is_none() && or.is_none();
    let simulate = study.filter(|_| uses).map_or(String::new(), |study| {
        format!("to simulate it first: {}\n", next::simulate(study, dir))
    });
    let line = first.line.as_ref().map_or(String::new(), written);
    let or = match or.filter(|or| or.line.is_none()) {
        Some(or) => format!("or use it as it is: {}\n", or.command),
        None => String::new(),
    };
    let next = format!("{simulate}{line}next: {}\n{or}", first.command);
    let planned = next::planned(result, dir);
    let planned =
        planned.map(|command| format!("to plan the motion for what is open: {command}\n"));
    format!("{next}{}", planned.unwrap_or_default())
}

/// How a line gets into its file.
fn written(line: &next::Line) -> String {
    let lines = line.text.lines().map(|line| format!("    {line}\n"));
    format!("{}\n{}", line.place(), lines.collect::<String>())
}

/// Coulomb and viscous friction with the mass, as simulators take them; `None` where they are not known.
fn line(result: &ResultFile) -> Option<String> {
    let curve = result.friction_curve.as_ref()?;
    let line = curve.line.as_ref()?;
    let stated = |value: f64, half: Option<f64>, of: &str| {
        let part = half.map(|half| Percent::deviation(100.0 * half / value.abs()));
        match part.filter(|part| part.is_bounded()) {
            Some(part) => format!("{} {} ± {}", sig(value, 3), unit(of), part.digits(2)),
            None => format!("{} {}", sig(value, 3), unit(of)),
        }
    };
    let mass = result.parameters.iter().find(|p| p.name == "mass");
    let mass = mass.map_or(String::new(), |p| {
        let half = p.half_width.map(|half| half.repeat);
        format!(", {} {}", p.symbol, stated(p.value, half, &p.unit))
    });
    Some(format!(
        "Coulomb {}, viscous {}{mass}",
        stated(line.coulomb.value, Some(line.coulomb.repeat), &curve.unit),
        stated(
            line.viscous.value,
            Some(line.viscous.repeat),
            &line.viscous_unit
        ),
    ))
}

/// Half width of a 95 % interval for another day, relative, up to which friction at a speed is stated.
const DETERMINED: f64 = 0.2;

/// Friction at three speeds.
fn friction(curve: &FrictionCurveEntry) -> String {
    let at = curve.at.iter().map(|at| {
        let part = at.repeat / at.force.abs();
        let speed = format!("at {}", quantity(at.speed, &curve.speed_unit));
        match part <= DETERMINED {
            true => format!(
                "{} {} ± {} {speed}",
                sig(at.force, 3),
                unit(&curve.unit),
                Percent::deviation(100.0 * part).digits(2)
            ),
            false => format!("not determined {speed}"),
        }
    });
    at.collect::<Vec<_>>().join(", ")
}

/// The level at both ends of the stroke, in its middle and halfway between.
fn level_along(along: &LevelAlongEntry, outcome: &Outcome) -> String {
    let last = along.position.len().saturating_sub(1);
    let at = |quarter: usize| {
        let i = quarter * last / 4;
        let half = 0.5 * (along.high[i] - along.low[i]);
        let (level, place) = (short(along.level[i]), short(along.position[i]));
        format!("{level} ± {} at {place}", short(half))
    };
    let places: Vec<String> = (0..=4).map(at).collect();
    let (force, length) = (&outcome.force_unit, symbols::length_unit(outcome.motion));
    format!(
        "{} in {force}, places in {length}: {}",
        along.name,
        places.join(", ")
    )
}

/// What was simulated, and how far off its force and the encoder's steps are.
fn simulated(entry: &SimulationEntry) -> String {
    let mut out = format!("{} loop, {}", entry.kind, simulated_runs(entry));
    if let Some(whole) = &entry.whole {
        let _ = write!(
            out,
            "; {} simulated whole",
            Percent::error(whole.relative_error_percent).fine()
        );
    }
    if let (None, Some(s)) = (&entry.whole, &entry.short_horizon) {
        let _ = write!(
            out,
            "; {} over {} s at a time",
            Percent::error(s.fit.relative_error_percent).fine(),
            short(s.seconds)
        );
    }
    if let Some(force) = &entry.force {
        let _ = write!(
            out,
            "; {} {} relative error, {} {} rms",
            force.signal,
            Percent::error(force.relative_error_percent).fine(),
            short(force.rmse),
            unit(&force.unit)
        );
    }
    if let Some(floor) = entry.quantisation_floor {
        let _ = write!(
            out,
            "; encoder steps alone {} {} rms",
            short(floor),
            entry.position.unit
        );
    }
    out
}

/// How an unseen log was simulated.
fn simulated_unseen(entry: &SimulationEntry, i: usize) -> String {
    let mut out = match entry.validation_runs.get(i) {
        None => return String::new(),
        Some(1) => ", simulated whole from one start".to_string(),
        Some(n) => format!(", its {n} stretches without gaps simulated whole"),
    };
    if let Some(horizon) = &entry.short_horizon
        && let Some(Some(fit)) = horizon.validation.get(i)
    {
        let _ = write!(
            out,
            "; {} over {} s at a time",
            Percent::error(fit.relative_error_percent).fine(),
            short(horizon.seconds)
        );
    }
    out
}

fn truth(outcome: &Outcome) -> String {
    let mut rows = vec![
        ["parameter", "true", "identified", "error", ""]
            .map(String::from)
            .to_vec(),
    ];
    for (name, truth) in &outcome.truth {
        let Some(p) = outcome.result.parameters.iter().find(|p| p.name == *name) else {
            continue;
        };
        let inside = p
            .range()
            .is_some_and(|(low, high)| low <= *truth && *truth <= high);
        rows.push(vec![
            name.clone(),
            short(*truth),
            short(p.value),
            if *truth == 0.0 {
                format!("{} {}", short(p.value), unit(&p.unit))
            } else {
                Percent::error(100.0 * (p.value / truth - 1.0)).signed(2)
            },
            if inside {
                String::new()
            } else {
                "outside its interval".into()
            },
        ]);
    }
    table(&rows, &[false, true, true, true, false])
}

fn laws(outcome: &Outcome) -> String {
    let mut rows = vec![
        [
            "law",
            "parameters",
            "fitted",
            "held out",
            "near zero speed",
            "ΔAIC",
            "ΔBIC",
            "",
        ]
        .map(String::from)
        .to_vec(),
    ];
    let percent = |x: Option<f64>| x.map_or("-".into(), |x| Percent::error(x).decimals(2));
    let above = |x: Option<f64>| x.map_or("-".into(), |x| format!("+{x:.0}"));
    for l in &outcome.result.laws {
        rows.push(vec![
            law_beside(l),
            l.parameters.to_string(),
            percent(Some(l.fitted_error_percent)),
            percent(l.held_out_error_percent),
            percent(l.held_out_low_speed_error_percent),
            above(l.aic_difference),
            above(l.bic_difference),
            remark(l),
        ]);
    }
    let table = table(&rows, &[false, true, true, true, true, true, true, false]);
    match without_offset(&outcome.result.laws) {
        None => table,
        Some(note) => format!("{table}{note}\n"),
    }
}

fn elements(outcome: &Outcome) -> String {
    let mut rows = vec![
        ["elements", "fitted", "held out", ""]
            .map(String::from)
            .to_vec(),
    ];
    let percent = |x: f64| Percent::error(x).decimals(2);
    for score in &outcome.result.elements {
        rows.push(vec![
            score.elements.to_string(),
            percent(score.fitted_error_percent),
            score.held_out_error_percent.map_or("-".into(), percent),
            if score.chosen { "chosen" } else { "" }.to_string(),
        ]);
    }
    table(&rows, &[true, true, true, false])
}

fn remark(law: &LawEntry) -> String {
    match (&law.held_back, law.best, law.reported) {
        (None, true, true) => "best".into(),
        (None, true, false) => "best, not reported".into(),
        (None, false, true) => "reported".into(),
        (None, false, false) => String::new(),
        (Some(why), true, true) => format!("best, but {why}"),
        (Some(why), true, false) => format!("best, not taken: {why}"),
        (Some(why), false, true) => format!("reported, but {why}"),
        (Some(_), false, false) => String::new(),
    }
}
