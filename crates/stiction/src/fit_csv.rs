//! `fit.csv`: what was measured, and what the fitted law makes of it.

use std::fmt::Write;
use stiction_files::symbols;
use stiction_workflows::identify::{Outcome, Simulated};

/// The samples of a fit, one a row.
pub(crate) fn fit_csv(outcome: &Outcome) -> String {
    match outcome.simulation() {
        Some(simulated) => of_position(outcome, simulated),
        None => of_force(outcome),
    }
}

/// Time, measured, model, residual, and the number of the log where there are several.
fn of_force(outcome: &Outcome) -> String {
    let unit = &outcome.result.fit.unit;
    let series = &outcome.law().series;
    let several = outcome.sources.len() > 1;
    let mut out = format!("time [s],measured [{unit}],model [{unit}],residual [{unit}]");
    out.push_str(if several { ",log\n" } else { "\n" });
    for i in 0..series.time.len() {
        let (u, y) = (series.measured[i], series.model[i]);
        let _ = write!(out, "{},{},{},{}", series.time[i], u, y, u - y);
        if several {
            let _ = write!(out, ",{}", series.log[i] + 1);
        }
        out.push('\n');
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
    for i in 0..signals.time.len() {
        let (x, y) = (signals.position[i], signals.simulated[i]);
        let _ = write!(
            out,
            "{},{},{},{},{},{}",
            signals.time[i],
            x,
            y,
            x - y,
            signals.velocity[i],
            signals.force[i]
        );
        if closed {
            let _ = write!(out, ",{}", signals.simulated_force[i]);
        }
        if several {
            let _ = write!(out, ",{}", signals.log[i] + 1);
        }
        out.push('\n');
    }
    out
}
