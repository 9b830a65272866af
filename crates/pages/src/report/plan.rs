//! The report of a planned motion.

use super::callout;
use crate::text::plan::start;
use stiction_files::plan::{ComparedEntry, PlanFile};
use stiction_files::symbols;
use stiction_log::Motion;
use stiction_number::{Percent, four_digits as short, unit};
use stiction_parameters::Name;
use stiction_report::{
    Align, Axis, Block, Callout, Document, Figure, KeyFigure, Layer, Panel, Table, number,
};
use stiction_workflows::plan::Planned;

/// Points of a drawn motion.
const POINTS: usize = 6000;
/// Bins of a decade of speed.
const BINS: f64 = 5.0;
/// Decades of speed that are drawn, below the limit.
const DECADES: f64 = 5.0;

/// The report.
pub fn plan(planned: &Planned) -> Document {
    let file = &planned.file;
    let title = match &file.name {
        Some(name) => format!("Motion to record: {name}"),
        None => "Motion to record".into(),
    };
    let worst = |at: fn(&ComparedEntry) -> f64| {
        let own = file.compared.iter().find(|c| c.name == file.motion);
        own.map_or(String::new(), |c| within(at(c)))
    };
    let figures = vec![
        KeyFigure::new(
            "Motion, from rest to rest",
            number::sig(file.duration, 3),
            "s",
        ),
        KeyFigure::new(
            "Worst parameter, half of the axes",
            worst(|c| c.interval_percent),
            "",
        ),
        KeyFigure::new("Nine of ten axes", worst(|c| c.interval90_percent), ""),
    ];
    let document = Document::new(title)
        .subtitle(format!(
            "{} pieces; simulated on {} axes that {} allows, the whole on {} others",
            file.atom.len(),
            file.axes[0],
            planned.given.known_by(),
            file.axes[1]
        ))
        .footer(format!("stiction {} · seed {}", file.version, file.seed))
        .block(Block::KeyFigures(figures));
    let document = not_planned(file)
        .into_iter()
        .fold(document, Document::block);
    document
        .heading(2, "Motion")
        .block(motion(planned))
        .heading(2, "Force to expect")
        .block(force(planned))
        .heading(2, "Speeds")
        .block(speeds(planned))
        .heading(2, "What its log can be expected to show")
        .paragraph(
            "Halves of 95 % intervals by simulation, in percent of the value, with the factor by which fits of simulated logs \
             exceeded them.",
        )
        .block(expected(file))
        .block(beside(file))
        .heading(2, "On the machine")
        .paragraph(run_order(planned))
        .block(aborts(file))
        .heading(2, "Assumptions")
        .block(assumptions(file))
}

/// What is not planned for, each by its name.
fn not_planned(file: &PlanFile) -> Vec<Callout> {
    file.warning.iter().map(callout).collect()
}

fn within(percent: f64) -> String {
    format!("±{}", Percent::deviation(percent).short())
}

/// Units of length, speed and force.
fn units(file: &PlanFile) -> [&'static str; 3] {
    match file.kind == "rotary" {
        false => ["m", "m/s", "N"],
        true => ["rad", "rad/s", "N m"],
    }
}

fn motion(planned: &Planned) -> Figure {
    let file = &planned.file;
    let [length, speed, _] = units(file);
    let count = POINTS.max(1);
    let time: Vec<f64> = (0..=count)
        .map(|k| file.duration * k as f64 / count as f64)
        .collect();
    let at: Vec<_> = time.iter().map(|t| planned.motion.at(*t)).collect();
    let drawn = |values: Vec<f64>| Layer::line(time.clone(), values);
    let axis = || Axis::new("Time", "s");
    Figure::new("Reference")
        .panel(
            Panel::new(axis(), Axis::new("Position", length))
                .layer(drawn(at.iter().map(|x| x.position).collect())),
        )
        .panel(
            Panel::new(axis(), Axis::new("Velocity", speed))
                .layer(drawn(at.iter().map(|x| x.velocity).collect())),
        )
        .shared_x()
        .caption("By rising speed: what the axis does slowly comes first. Positions count from where it stands.")
}

fn force(planned: &Planned) -> Figure {
    let [_, _, force] = units(&planned.file);
    let band = &planned.band;
    let limits = &planned.file.limits;
    let mut panel = Panel::new(Axis::new("Time", "s"), Axis::new("Force", force)).layer(
        Layer::band(band.time.clone(), band.low.clone(), band.high.clone()).label("all axes"),
    );
    for (value, label) in [(limits.rated_force, "rated"), (limits.peak_force, "peak")] {
        panel = panel
            .layer(Layer::new(stiction_report::Shape::HLine(value)).label(label))
            .layer(Layer::new(stiction_report::Shape::HLine(-value)));
    }
    Figure::new("Force of the drive, least and largest on any axis").panel(panel)
}

/// How long the motion is at which speed, beside the Stribeck velocities that are thought possible.
fn speeds(planned: &Planned) -> Figure {
    let file = &planned.file;
    let [_, speed, _] = units(file);
    let bins = (BINS * DECADES) as usize;
    let lowest = file.limits.speed * libm::exp10(-DECADES);
    let mut seconds = vec![0.0; bins];
    let samples = 20 * POINTS;
    for k in 0..samples {
        let t = file.duration * (k as f64 + 0.5) / samples as f64;
        let v = planned.motion.at(t).velocity.abs();
        let bin = BINS * libm::log10((v / lowest).max(1e-300));
        if bin >= 0.0 {
            seconds[(bin as usize).min(bins - 1)] += file.duration / samples as f64;
        }
    }
    let middle = |i: usize| lowest * libm::exp10((i as f64 + 0.5) / BINS);
    let places: Vec<f64> = (0..bins).map(middle).collect();
    let mut panel = Panel::new(
        Axis::new("Speed of the reference", speed).log(),
        Axis::new("Time in a fifth of a decade", "s"),
    );
    if let Some(range) = file.prior.iter().find(|p| p.name == "stribeck_velocity") {
        let [low, high] = range.range;
        let label = "Stribeck velocities thought possible";
        panel = panel.layer(Layer::new(stiction_report::Shape::VBand(low, high)).label(label));
    }
    Figure::new("Speeds").panel(panel.layer(Layer::bars(places, seconds)))
}

fn expected(file: &PlanFile) -> Table {
    let columns = [
        ("Parameter", Align::Left),
        ("Half of the axes", Align::Right),
        ("Nine of ten", Align::Right),
    ];
    let rows = file.parameter.iter();
    rows.fold(Table::new(columns), |table, p| {
        let of = match &p.of {
            Some(of) => format!(" of {of}"),
            None => String::new(),
        };
        table.row([
            p.name.clone(),
            format!("{}{of}", within(p.interval_percent)),
            format!("{}{of}", within(p.interval90_percent)),
        ])
    })
}

fn beside(file: &PlanFile) -> Table {
    let columns = [
        ("Worst parameter of a motion", Align::Left),
        ("Duration, s", Align::Right),
        ("Half of the axes", Align::Right),
        ("Nine of ten", Align::Right),
        ("", Align::Left),
    ];
    file.compared.iter().fold(Table::new(columns), |table, c| {
        let said = if c.keeps_limits { "" } else { "breaks a limit" };
        table.row([
            c.name.clone(),
            number::sig(c.duration, 3),
            within(c.interval_percent),
            within(c.interval90_percent),
            said.into(),
        ])
    })
}

fn run_order(planned: &Planned) -> String {
    let file = &planned.file;
    let [length, ..] = units(file);
    let feedforward = match planned.given.logged.has_full_feedforward() {
        true => {
            " The following error is that of a loop with velocity and acceleration feedforward; without them it is many times as large."
        }
        false => "",
    };
    let [low, high] = file.limits.stroke;
    format!(
        "Bring the axis {}to where it may go {} {length} to negative and {} {length} to positive positions; the motion returns there. \
         Run setpoints.csv first at 30 % override and look: that run is not for identification. Then run it at 100 % and record \
         time, position and force at {} Hz, without long rests before and after.{feedforward}",
        start(planned),
        short(-low),
        short(high),
        short(file.rig.rate)
    )
}

fn aborts(file: &PlanFile) -> Table {
    let [length, speed, force] = units(file);
    let columns = [
        ("", Align::Left),
        ("Largest on any simulated axis", Align::Right),
        ("Abort above", Align::Right),
        ("Unit", Align::Left),
    ];
    let rows = [
        (
            "Following error",
            file.largest.following_error,
            file.abort.following_error,
            length,
        ),
        ("Speed", file.largest.speed, file.abort.speed, speed),
        ("Force", file.largest.force, file.abort.force, force),
    ];
    rows.into_iter()
        .fold(Table::new(columns), |table, (name, found, above, of)| {
            table.row([
                name.to_string(),
                number::sig(found, 4),
                number::sig(above, 4),
                of.into(),
            ])
        })
}

/// SI unit of a range; none of a ratio.
fn of_range(name: &str, file: &PlanFile) -> String {
    let motion = match file.kind == "rotary" {
        true => Motion::Rotary,
        false => Motion::Linear,
    };
    match name.parse::<Name>() {
        Ok(name) => symbols::unit(name.dimension(), motion, symbols::force_unit(motion), ""),
        Err(_) if name == "presliding length" => symbols::length_unit(motion).into(),
        Err(_) => String::new(),
    }
}

fn assumptions(file: &PlanFile) -> Table {
    let columns = [
        ("What", Align::Left),
        ("Value", Align::Right),
        ("Unit", Align::Left),
    ];
    let assumed = file.assumed.iter().map(|a| {
        let with = if a.unit == "1" {
            String::new()
        } else {
            unit(&a.unit)
        };
        [
            format!("{} (not given)", a.key),
            number::sig(a.value, 3),
            with,
        ]
    });
    let prior = file.prior.iter().map(|p| {
        let [low, high] = p.range;
        let range = format!("{} to {}", number::sig(low, 3), number::sig(high, 3));
        [p.name.clone(), range, unit(&of_range(&p.name, file))]
    });
    assumed.chain(prior).fold(Table::new(columns), Table::row)
}
