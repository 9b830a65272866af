//! The report of friction over time: what changed, and the course of each parameter that did.

use crate::apart::apart;
use crate::drift::{DAY, few, noise_of, quiet, row, unclear, unnamed, untimed};
use stiction_files::drift_file::{Alarm, DriftFile};
use stiction_number::counted;
use stiction_report::{Align, Axis, Color, Dash, Document, Figure, Layer, Panel, Table};
use stiction_workflows::drift::{DriftOutcome, Shown};

/// Most courses that are drawn.
const MOST: usize = 24;

/// The report.
pub fn drift(outcome: &DriftOutcome) -> Document {
    let file = &outcome.file;
    let failed = match file.input.failed {
        0 => String::new(),
        failed => format!(", {failed} of them failed"),
    };
    let mut document = Document::new("Friction over time")
        .subtitle(format!(
            "{} of {}{failed}",
            counted(file.input.logs, "log"),
            counted(file.machines, "machine")
        ))
        .footer(format!("stiction {} · {}", file.version, file.input.path));
    let said = match file.alarmed_machines() {
        0 => sentence(&quiet(file)),
        machines => format!(
            "{machines} of {} changed.",
            counted(file.machines, "machine")
        ),
    };
    document = document.paragraph(said);
    let unnamed = (file.input.unnamed > 0).then(|| unnamed(file));
    for said in [unclear(file), untimed(file), unnamed]
        .into_iter()
        .flatten()
    {
        document = document.paragraph(sentence(&said));
    }
    for line in apart(&file.apart).lines() {
        document = document.paragraph(line.to_string());
    }
    if let Some(said) = few(file) {
        document = document.paragraph(format!("{said}."));
    }
    if !file.alarms.is_empty() {
        document = document.heading(2, "What changed").block(alarms(file));
    }
    for shown in outcome.shown.iter().take(MOST) {
        document = document.block(course(file, shown));
    }
    let quiet = outcome
        .quiet
        .iter()
        .take(MOST.saturating_sub(outcome.shown.len()));
    if quiet.len() > 0 {
        document = document.heading(2, "What did not, or not surely");
    }
    for shown in quiet {
        document = document.block(course(file, shown));
    }
    if outcome.shown.len() > MOST {
        let more = format!("{} more are in drift.json.", outcome.shown.len() - MOST);
        document = document.paragraph(more);
    }
    document
        .heading(2, "What each parameter does by itself")
        .paragraph(format!(
            "From all machines together. A parameter has changed where the median of the last 5, 10 or 20 logs is further from \
             that of the first {} than its limit; the limits are those at which at most {:.1} % of machines in which nothing \
             changes would be alarmed within {} days, by any parameter.",
            file.reference_logs,
            100.0 * file.alarmed,
            file.horizon_days
        ))
        .block(noise(file))
}

/// A line of the terminal as a sentence.
fn sentence(line: &str) -> String {
    let mut letters = line.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    format!("{}.", first.chain(letters).collect::<String>())
}

fn alarms(file: &DriftFile) -> Table {
    let mut table = Table::new([
        ("Machine", Align::Left),
        ("Parameter", Align::Left),
        ("What", Align::Left),
        ("Since", Align::Left),
        ("Found", Align::Left),
        ("Before", Align::Right),
        ("After", Align::Right),
        ("Change", Align::Right),
        ("95 % interval", Align::Right),
    ]);
    for alarm in &file.alarms {
        table = table.row(row(file, alarm));
    }
    table
}

fn noise(file: &DriftFile) -> Table {
    let mut table = Table::new([
        ("Parameter", Align::Left),
        ("Law", Align::Left),
        ("Machines", Align::Right),
        ("Logs", Align::Right),
        ("Scatter between logs", Align::Right),
        ("Slow wandering", Align::Right),
        ("Changed from", Align::Right),
    ]);
    for entry in &file.noise {
        let [scatter, wandering, limit] = noise_of(entry);
        table = table.row([
            entry.parameter.clone(),
            entry.law.clone(),
            entry.machines.to_string(),
            entry.logs.to_string(),
            scatter,
            wandering,
            limit,
        ]);
    }
    table
}

/// One parameter of a machine over time.
fn course(file: &DriftFile, shown: &Shown) -> Figure {
    let points = &shown.followed.points;
    let first = points.first().map_or(0.0, |point| point.time);
    let days = |time: f64| (time - first) / DAY;
    let judged = &shown.judged;
    let x: Vec<f64> = points.iter().map(|point| days(point.time)).collect();
    let (low, high): (Vec<f64>, Vec<f64>) = judged.intervals().unzip();
    let unit = shown.unit.as_str();
    let mut panel = Panel::new(
        Axis::new("Time since the first log", "d"),
        Axis::new(shown.parameter.clone(), unit),
    )
    .layer(
        Layer::hline(judged.reference)
            .color(Color::Grey)
            .dash(Dash::Dashed)
            .label("First logs"),
    )
    .layer(
        Layer::band(x.clone(), low, high)
            .color(Color::Blue)
            .opacity(0.2)
            .label("95 % interval of a log"),
    )
    .layer(
        Layer::points(x, judged.corrected.clone())
            .color(Color::Blue)
            .width(4.0)
            .label("Logs"),
    );
    let own = |alarm: &&Alarm| {
        alarm.machine == shown.machine
            && alarm.parameter == shown.parameter
            && alarm.law == shown.law
            && alarm.limit.is_none()
    };
    for (k, alarm) in file.alarms.iter().filter(own).enumerate() {
        let since = Layer::vline(days(alarm.since)).color(Color::Vermilion);
        let found = Layer::vline(days(alarm.found))
            .color(Color::Vermilion)
            .dash(Dash::Dotted);
        // From there to the next change, or the end.
        let next = file
            .alarms
            .iter()
            .filter(own)
            .map(|a| a.since)
            .filter(|t| *t > alarm.since);
        let last = points.last().map_or(first, |point| point.time);
        let x = vec![days(alarm.since), days(next.fold(last, f64::min))];
        let at = |size: f64| match alarm.relative {
            true => alarm.before * (1.0 + size),
            false => alarm.before + size,
        };
        if let Some([low, high]) = alarm.ci95 {
            let band = Layer::band(x.clone(), vec![at(low); 2], vec![at(high); 2]);
            let level = Layer::line(x, vec![alarm.after; 2]).color(Color::Vermilion);
            panel = panel
                .layer(band.color(Color::Vermilion).opacity(0.2))
                .layer(level);
        }
        panel = match k {
            0 => panel
                .layer(since.label("Since"))
                .layer(found.label("Found")),
            _ => panel.layer(since).layer(found),
        };
    }
    let machine = if shown.machine.is_empty() {
        String::new()
    } else {
        format!(" of {}", shown.machine)
    };
    Figure::new(format!("{}{machine} ({})", shown.parameter, shown.law))
        .panel(panel)
        .caption("Without what temperature does. The interval is that of the log and of the scatter between logs.")
}
