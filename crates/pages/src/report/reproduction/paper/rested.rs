//! Standstill after a move: standing error, limit cycle, chattering.

use super::simulated::{column, over_time};
use stiction_number::quantity;
use stiction_report::{Align, Color, Document, Figure, Layer, Table};
use stiction_servo::axis::Sample;
use stiction_workflows::reproduce::{Compensation, Control, Hold, Paper, Rested, Units};

/// What is drawn, with its colour.
const DRAWN: [(Compensation, Color); 4] = [
    (Compensation::Nothing, Color::Grey),
    (Compensation::StribeckMeasured, Color::Vermilion),
    (Compensation::Measured, Color::Orange),
    (Compensation::Reference, Color::Blue),
];

pub(super) fn sections(document: Document, paper: &Paper) -> Document {
    if paper.rested.is_empty() {
        return document;
    }
    let units = paper.stage.units();
    document
        .heading(2, "Standstill after a move")
        .paragraph(
            "The reference stops and stands for 3 s. Without an integral the axis stays where friction holds it: a standing error. With \
             one it comes nearer, and may hunt: the integral builds up to break-away, the axis jumps, and again. The steady curve fed by the measured \
             velocity knows no presliding: at zero velocity its force jumps with each count of the encoder, from the static level one \
             way to that of the other. The bristles of LuGre give a force that depends on the way, not on the sign of the velocity.",
        )
        .block(table(&paper.rested, units))
        .block(figure(&paper.rested, units))
}

fn name(hold: Hold) -> &'static str {
    match hold {
        Hold::Pd => "PID without its integral",
        Hold::Control(control) => control.name(),
    }
}

fn table(runs: &[Rested], units: Units) -> Table {
    let columns = [
        ("Held by", Align::Left),
        ("Compensation", Align::Left),
        ("Standing error", Align::Right),
        ("Amplitude of the limit cycle", Align::Right),
        ("Its period", Align::Right),
        ("Swing of the compensating force", Align::Right),
    ];
    runs.iter().fold(Table::new(columns), |table, run| {
        table.row([
            name(run.hold).into(),
            run.compensation.name().into(),
            quantity(run.standing, units.length),
            run.hunting
                .map_or("none".into(), |h| quantity(h.amplitude, units.length)),
            run.hunting
                .and_then(|h| h.period)
                .map_or("–".into(), |s| quantity(s, "s")),
            quantity(run.swing, units.force),
        ])
    })
}

fn figure(runs: &[Rested], units: Units) -> Figure {
    let mut error = over_time("Position error", units.length).height(160.0);
    let mut force = over_time("Compensating force", units.force).height(160.0);
    for (compensation, color) in DRAWN {
        let pid = Hold::Control(Control::Pid);
        let mut drawn = runs.iter();
        let Some(run) = drawn.find(|r| r.hold == pid && r.compensation == compensation) else {
            continue;
        };
        let line = |of: fn(&Sample) -> f64| {
            Layer::line(column(&run.samples, |s| s.time), column(&run.samples, of)).color(color)
        };
        error = error.layer(line(Sample::error).label(compensation.name()));
        force = force.layer(line(|s| s.compensation));
    }
    Figure::new("Standstill under the PID")
        .panel(error)
        .panel(force)
        .shared_x()
}
