//! The load of an axis that changes while it runs, and what is found of it.

use super::axis::mass_unit;
use super::rows::{COLORS, drawn};
use stiction_files::study::result::{ResultRow, SimulatedAxis};
use stiction_number::quantity;
use stiction_report::{Align, Axis, Color, Figure, Layer, Panel, Table, Text, number};
use stiction_workflows::study::{LoadCourse, StudyOutcome};

/// A run in which the load is looked for, with its color in the other figures.
struct Looked<'a> {
    name: &'a str,
    course: &'a LoadCourse,
    color: Color,
}

/// Mass and level of friction over time, with the numbers at the end; nothing where they are not looked for.
pub(super) fn blocks(outcome: &StudyOutcome, rows: &[ResultRow]) -> Option<(Figure, Table)> {
    let (rows, _) = drawn(rows);
    let looked: Vec<Looked> = rows
        .iter()
        .zip(COLORS)
        .filter_map(|(row, color)| {
            let course = outcome.trace(row)?.load.as_ref()?;
            let found = !course.found_level.is_empty();
            found.then_some(Looked {
                name: &row.compensator,
                course,
                color,
            })
        })
        .collect();
    let truth = looked.first()?.course;
    let axis = &outcome.file.axis;
    let panel = |label: &str, unit: &str, of: Part| {
        let panel = Panel::new(Axis::new("Time", "s"), Axis::new(label, unit)).height(150.0);
        let truth = Layer::steps(truth.time.clone(), of(truth).0.clone());
        let panel = panel.layer(truth.color(Color::Grey).width(2.5).label("true"));
        looked
            .iter()
            .fold(panel, |panel, run| match of(run.course).1 {
                found if found.is_empty() => panel,
                found => panel.layer(
                    Layer::line(run.course.time.clone(), found.clone())
                        .color(run.color)
                        .label(run.name),
                ),
            })
    };
    let figure = Figure::new("The load found while running");
    let level = panel("Friction, of the law", "", level);
    let figure = match looked.iter().all(|run| run.course.found_mass.is_empty()) {
        true => figure.panel(level),
        false => figure
            .panel(panel("Mass", mass_unit(axis), mass))
            .panel(level),
    };
    let figure = figure.shared_x().caption(
        "The whole run, with the parameters of the axis itself at its beginning. A load estimate learns while the axis \
         accelerates, an adaptation while it slides.",
    );
    Some((figure, table(axis, &looked)))
}

/// True and found values of a course.
type Part = fn(&LoadCourse) -> (&Vec<f64>, &Vec<f64>);

fn mass(course: &LoadCourse) -> (&Vec<f64>, &Vec<f64>) {
    (&course.mass, &course.found_mass)
}

fn level(course: &LoadCourse) -> (&Vec<f64>, &Vec<f64>) {
    (&course.level, &course.found_level)
}

fn table(axis: &SimulatedAxis, looked: &[Looked]) -> Table {
    let columns = [
        ("Compensator", Align::Left),
        ("Mass, true", Align::Right),
        ("Found", Align::Right),
        ("Friction, true", Align::Right),
        ("Found", Align::Right),
    ];
    let unit = mass_unit(axis);
    let last = |values: &[f64], unit: &str| {
        let text = values.last().map(|x| quantity(*x, unit));
        Text::from(text.unwrap_or_else(|| "n/a".into()))
    };
    let times = |values: &[f64]| {
        let text = values.last().map(|x| format!("× {}", number::sig(*x, 3)));
        Text::from(text.unwrap_or_else(|| "n/a".into()))
    };
    let table = Table::new(columns).caption("The load at the end of the run.");
    looked.iter().fold(table, |table, run| {
        table.row([
            Text::from(run.name),
            last(&run.course.mass, unit),
            last(&run.course.found_mass, unit),
            times(&run.course.level),
            times(&run.course.found_level),
        ])
    })
}
