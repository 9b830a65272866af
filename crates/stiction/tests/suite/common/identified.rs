//! Recordings of simulated axes, identified. Also for the examples `worlds` and `promise`.

use stiction::{Axis, Column, Fit, Log, Options, identify};
use stiction_testkit::worlds::{Machine, Recording};

/// Identifies logs of a machine together.
pub fn identified(
    machine: &Machine,
    logs: &[Recording],
    axis: &Axis,
    options: &Options,
) -> Result<Fit, stiction::Error> {
    let logs = logs.iter().enumerate().map(|(i, log)| {
        let name = format!("log-{}.csv", i + 1);
        Log::from_columns(&name, columns(machine, log), axis)
    });
    identify(&logs.collect::<Result<Vec<_>, _>>()?, axis, options)
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
        ..Column::default()
    };
    let mut columns = vec![column("time", "s", &log.time)];
    if let Some(x) = &log.position {
        columns.push(column("position", length, x));
    }
    if let Some(v) = &log.velocity {
        columns.push(column("velocity", &format!("{length}/s"), v));
    }
    columns.push(column("force", force, &log.force));
    for (name, unit, values) in &log.beside {
        columns.push(column(name, unit, values));
    }
    columns
}
