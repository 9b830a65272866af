//! The sine over the delay of the loop.

use stiction_number::quantity;
use stiction_report::{Align, Document, Table};
use stiction_workflows::reproduce::Paper;

pub(super) fn sections(document: Document, paper: &Paper) -> Document {
    if paper.delayed.is_empty() {
        return document;
    }
    let length = paper.stage.units().length;
    let columns = [
        ("Delay, periods of 0.1 ms", Align::Right),
        ("Largest error at reversals, without", Align::Right),
        ("LuGre, reference velocity", Align::Right),
        ("LuGre, measured velocity", Align::Right),
        ("Rms error, without", Align::Right),
        ("LuGre, reference velocity", Align::Right),
        ("LuGre, measured velocity", Align::Right),
    ];
    let table = paper
        .delayed
        .iter()
        .fold(Table::new(columns), |table, run| {
            let peaks = run
                .tracking
                .iter()
                .map(|t| quantity(t.reversal_peak, length));
            let rms = run.tracking.iter().map(|t| quantity(t.rms, length));
            let delay = run.periods.to_string();
            table.row(std::iter::once(delay).chain(peaks).chain(rms))
        });
    document
        .heading(2, "A delay of the loop")
        .paragraph(
            "The paper feeds its law by a velocity that is measured, and argues with the sampling delay. The same sine under the fuzzy \
             PID, with a delay between controller and amplifier: the reference velocity is known ahead, so that the force of the law \
             comes in time; the measured one is late by the delay, and by its own difference.",
        )
        .block(table)
}
