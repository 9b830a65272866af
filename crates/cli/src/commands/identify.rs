//! `stiction identify`: logs to a law.

use super::{finish, law, method};
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::progress::Bar;
use stiction_files::Axis;
use stiction_files::{check_apart, check_folder, check_inputs};
use stiction_workflows::Error;
use stiction_workflows::identify::Files;
use stiction_workflows::identify::{CostKind, Method, Options, Procedures, Searching};

/// Identifies the logs and writes what was found.
pub fn run(identify: &arguments::Identify, common: &Common) -> Result<Exit, Error> {
    check_folder(&identify.out, identify.force)?;
    let inputs = [
        &identify.logs,
        &identify.validate,
        &identify.statics,
        &identify.break_away,
    ];
    let axis = identify
        .axis
        .as_ref()
        .and_then(|axis| Axis::read(axis).ok());
    let listed = axis.iter().flat_map(|axis| &axis.logs).map(|log| &log.file);
    let files = inputs.into_iter().flatten().chain(listed);
    check_inputs(
        &identify.out,
        files
            .chain(&identify.model)
            .chain(&identify.plan)
            .chain(&identify.axis)
            .chain(&identify.searching.resume),
    )?;
    if let Some(checkpoint) = &identify.searching.checkpoint {
        check_apart(&identify.out, checkpoint)?;
    }
    let files = Files {
        logs: identify.logs.clone(),
        axis: identify.axis.clone(),
        validate: identify.validate.clone(),
    };
    let mut options = Options::default();
    options.law = law(identify.law);
    options.asymmetric = identify.asymmetric;
    options.split = identify.split;
    options.seed = identify.seed;
    options.procedures = Procedures {
        method: method(identify.method),
        statics: identify.statics.clone(),
        model: identify.model.clone(),
        break_away: identify.break_away.clone(),
        plan: identify.plan.clone(),
    };
    options.searching = searching(&identify.searching);
    let mut bar = Bar::new(common.json || common.quiet);
    let outcome = stiction_workflows::identify::identify(&files, &options, &mut bar);
    bar.finish();
    finish(&outcome?, &identify.out, common)
}

fn searching(typed: &arguments::Searching) -> Searching {
    let names = Method::SEARCHES;
    let name = |search: &String| names.into_iter().find(|name| name == search);
    Searching {
        search: typed.search.as_ref().and_then(name),
        no_finish: typed.no_finish,
        cost: typed.cost.map(|cost| match cost {
            arguments::Cost::Six => CostKind::Six,
            arguments::Cost::Separable => CostKind::Separable,
        }),
        evaluations: typed.evaluations,
        target: typed.target,
        time: typed.time,
        checkpoint: typed.checkpoint.clone(),
        resume: typed.resume.clone(),
    }
}
