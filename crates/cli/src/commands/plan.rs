//! `stiction plan`: the motion to record.

use super::{put, written_to};
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::interrupt;
use crate::output;
use crate::progress::Bar;
use std::io::Write;
use std::path::Path;
use stiction_files::shell::text as path_text;
use stiction_files::{check_folder_of, check_inputs};
use stiction_pages::bundle;
use stiction_parameters::LawKind;
use stiction_workflows::Error;
use stiction_workflows::plan::{
    Carrier, Known, PlanOptions, Want, limits_to_fill_in, plan as plan_motion,
};

/// Writes the lines of `[limits]` that an axis file lacks for a plan, as they are pasted.
pub fn limits(error: &Error, plan: &arguments::Plan) {
    let Error::File(refused) = error else { return };
    // What is missing has no line.
    let is_lacking = |(file, line): &(&Path, Option<usize>)| *file == plan.axis && line.is_none();
    if !refused.to_correct().iter().any(is_lacking) {
        return;
    }
    if let Some(lines) = limits_to_fill_in(&plan.axis, plan.log.as_deref()) {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(
            std::io::stderr(),
            "stiction: lines for {}, under [limits], to be filled in:\n{}",
            output::line(&path_text(&plan.axis)),
            output::plain(&lines)
        );
    }
}

/// Designs the motion and writes it.
pub fn run(plan: &arguments::Plan, common: &Common) -> Result<Exit, Error> {
    let schema = stiction_files::plan::SCHEMA;
    check_folder_of(&plan.out, schema, plan.force)?;
    let files = [Some(&plan.axis), plan.model.as_ref(), plan.log.as_ref()];
    check_inputs(&plan.out, files.into_iter().flatten())?;
    let model = plan.model.clone().map(Known::Model);
    let options = PlanOptions {
        time: plan.time,
        probe: plan.stage == arguments::Stage::Probe,
        asymmetric: plan.asymmetric,
        law: plan.law.map(|law| match law {
            arguments::PlannedLaw::Lugre => LawKind::LuGre,
            arguments::PlannedLaw::MaxwellSlip => LawKind::MaxwellSlip,
            arguments::PlannedLaw::Gms => LawKind::Gms,
        }),
        known: model.or(plan.log.clone().map(Known::Log)),
        seed: plan.seed,
        wants: (plan.wants.iter())
            .map(|text| Want::parse(text))
            .collect::<Result<_, _>>()?,
        carriers: plan.formats.iter().copied().map(carrier).collect(),
        start: plan.start.clone(),
    };
    let mut bar = Bar::new(common.json || common.quiet);
    let planned = plan_motion(&plan.axis, &options, &mut bar);
    bar.finish();
    let Some(planned) = planned? else {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(
            std::io::stderr(),
            "stiction: stopped before there was a motion; nothing is written"
        );
        return Ok(Exit::Interrupted);
    };
    let (dir, written) = put(&bundle::plan(&planned), &plan.out, schema)?;
    if common.json {
        output::json(&planned.file)?;
    } else if !common.quiet {
        let text = stiction_pages::text::planned(&planned, &plan.axis, &dir);
        output::print(&format!("{text}\n{}", written_to(&dir, &written)))?;
    }
    match interrupt::stopped() {
        true => Ok(Exit::Interrupted),
        false => Ok(planned.verdict().into()),
    }
}

fn carrier(form: arguments::Form) -> Carrier {
    match form {
        arguments::Form::St => Carrier::St,
        arguments::Form::Cam => Carrier::Cam,
        arguments::Form::Feed => Carrier::Feed,
        arguments::Form::Csp => Carrier::Csp,
        arguments::Form::Ros2 => Carrier::Ros2,
        arguments::Form::Halstreamer => Carrier::Halstreamer,
        arguments::Form::Gcode => Carrier::Gcode,
    }
}
