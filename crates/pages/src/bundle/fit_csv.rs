//! `fit.csv`: what was measured, and what the fitted law makes of it.

use std::fmt::Write;
use stiction_files::symbols;
use stiction_formats::Column;
use stiction_workflows::identify::{Outcome, Simulated};

/// Bytes of one number and its comma, of most numbers.
const WIDTH: usize = 22;

/// The samples of a fit, one a row.
pub(crate) fn fit_csv(outcome: &Outcome) -> String {
    match outcome.simulation() {
        Some(simulated) => of_position(outcome, simulated),
        None => of_force(outcome),
    }
}

/// The columns of a `fit.csv`, with the bits they were written from; `None` where the text is none.
pub fn columns(text: &str) -> Option<Vec<Column>> {
    let mut lines = text.lines();
    let headers: Vec<&str> = lines.next()?.split(',').collect();
    let mut values: Vec<Vec<f64>> = headers.iter().map(|_| Vec::new()).collect();
    for line in lines {
        let mut cells = line.split(',');
        for column in &mut values {
            column.push(cells.next()?.parse().ok()?);
        }
    }
    let named = headers.iter().zip(values);
    Some(
        named
            .map(|(header, column)| Column::headed(header, column))
            .collect(),
    )
}

/// Time, measured, model, residual, where they are known position, velocity and what of the model is no friction, and the number
/// of the log where there are several.
fn of_force(outcome: &Outcome) -> String {
    let unit = &outcome.result.fit.unit;
    let series = &outcome.law().series;
    let several = outcome.sources.len() > 1;
    let mut out = format!("time [s],measured [{unit}],model [{unit}],residual [{unit}]");
    let (length, speed) = (
        symbols::length_unit(outcome.motion),
        symbols::speed_unit(outcome.motion),
    );
    let motion = [
        ("position", length, &series.position),
        ("velocity", speed, &series.velocity),
        ("other", unit.as_str(), &series.other),
    ];
    let moves = motion
        .iter()
        .all(|(_, _, values)| values.len() == series.time.len());
    if moves {
        for (name, unit, _) in motion {
            let _ = write!(out, ",{name} [{unit}]");
        }
    }
    out.push_str(if several { ",log\n" } else { "\n" });
    out.reserve(series.time.len() * if moves { 7 } else { 4 } * WIDTH);
    let mut row = Row::default();
    for i in 0..series.time.len() {
        let (u, y) = (series.measured[i], series.model[i]);
        row.numbers(&mut out, &[series.time[i], u, y, u - y]);
        if moves {
            out.push(',');
            row.numbers(&mut out, &motion.map(|(_, _, values)| values[i]));
        }
        row.end(&mut out, several.then(|| series.log[i]));
    }
    out
}

/// Position as fitted, then velocity and force.
fn of_position(outcome: &Outcome, simulated: &Simulated) -> String {
    let signals = &simulated.fit.signals;
    let length = symbols::length_unit(outcome.motion);
    let speed = symbols::speed_unit(outcome.motion);
    let force = &outcome.force_unit;
    let several = outcome.sources.len() > 1;
    let closed = simulated.fit.is_closed_loop();
    let mut out = format!(
        "time [s],measured [{length}],model [{length}],residual [{length}],velocity [{speed}],\
         force [{force}]"
    );
    if closed {
        let _ = write!(out, ",model force [{force}]");
    }
    out.push_str(if several { ",log\n" } else { "\n" });
    out.reserve(signals.time.len() * 7 * WIDTH);
    let mut row = Row::default();
    for i in 0..signals.time.len() {
        let (x, y) = (signals.position[i], signals.simulated[i]);
        let (v, f) = (signals.velocity[i], signals.force[i]);
        row.numbers(&mut out, &[signals.time[i], x, y, x - y, v, f]);
        if closed {
            out.push(',');
            row.numbers(&mut out, &[signals.simulated_force[i]]);
        }
        row.end(&mut out, several.then(|| signals.log[i]));
    }
    out
}

/// Writes numbers so that they are read back as they were. There are millions of them, and who stops a search waits for them.
#[derive(Default)]
struct Row {
    buffer: zmij::Buffer,
}

impl Row {
    fn numbers(&mut self, out: &mut String, values: &[f64]) {
        for (i, value) in values.iter().enumerate() {
            if i > 0 {
                out.push(',');
            }
            out.push_str(self.buffer.format(*value));
        }
    }

    /// The number of the log, counted from 1, where there are several.
    fn end(&mut self, out: &mut String, log: Option<usize>) {
        if let Some(log) = log {
            let _ = write!(out, ",{}", log + 1);
        }
        out.push('\n');
    }
}
