//! Recordings of simulated axes, identified. Also for the examples `worlds` and `promise`.
#![allow(dead_code)]

use stiction_files::result::{HalfWidthEntry, ParameterEntry, ResultFile};
use stiction_files::{Axis, Warning};
use stiction_identify::Silent;
use stiction_log::Column;
use stiction_parameters::LawKind;
use stiction_testkit::worlds::{Machine, Recording};
use stiction_workflows::Error;
use stiction_workflows::identify::{Options, Outcome, identify_logs};
use stiction_workflows::source::{Source, in_memory};

/// What was found, and its parameters by the names in files.
#[derive(Clone, Debug)]
pub struct Fit(pub Outcome);

impl Fit {
    pub fn result(&self) -> &ResultFile {
        &self.0.result
    }

    pub fn parameters(&self) -> impl Iterator<Item = Parameter<'_>> {
        self.0.result.parameters.iter().map(Parameter)
    }

    pub fn parameter(&self, name: &str) -> Option<Parameter<'_>> {
        self.parameters().find(|p| p.name() == name)
    }

    pub fn warnings(&self) -> &[Warning] {
        &self.0.result.warnings
    }

    pub fn is_trustworthy(&self) -> bool {
        self.0.result.trust.trustworthy
    }

    pub fn law_kind(&self) -> LawKind {
        self.0.law().law.kind
    }
}

#[derive(Clone, Copy)]
pub struct Parameter<'a>(&'a ParameterEntry);

impl<'a> Parameter<'a> {
    pub fn name(&self) -> &'a str {
        &self.0.name
    }

    pub fn value(&self) -> f64 {
        self.0.value
    }

    pub fn unit(&self) -> &'a str {
        &self.0.unit
    }

    pub fn interval(&self) -> Option<(f64, f64)> {
        self.0.range()
    }

    pub fn half_widths(&self) -> Option<HalfWidthEntry> {
        self.0.half_width
    }

    pub fn is_identifiable(&self) -> bool {
        self.0.identifiable
    }
}

/// Identifies logs together.
pub fn identify(logs: &[Source], axis: &Axis, options: &Options) -> Result<Fit, Error> {
    identify_logs(options, axis, logs.to_vec(), Vec::new(), &mut Silent).map(Fit)
}

/// Identifies logs of a machine together.
pub fn identified(
    machine: &Machine,
    logs: &[Recording],
    axis: &Axis,
    options: &Options,
) -> Result<Fit, Error> {
    let logs = logs.iter().enumerate().map(|(i, log)| {
        let name = format!("log-{}.csv", i + 1);
        in_memory(&name, columns(machine, log), axis)
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
