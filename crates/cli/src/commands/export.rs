//! `stiction export`: a model to code.

use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::next::with_value;
use crate::output;
use clap::ValueEnum;
use stiction_files::{Looks, looks};
use stiction_workflows::Error;
use stiction_workflows::export::{Draws, ExportOptions, Feedforward, Target, Width};

/// Writes the code.
pub fn run(export: &arguments::Export, common: &Common) -> Result<Exit, Error> {
    let named = export.target.to_possible_value().expect("each is one");
    let mut targets = Target::ALL.into_iter();
    let target = targets.find(|own| own.name() == named.get_name());
    let target = target.expect("both lists are of the same targets");
    let mut options = ExportOptions::new(target, export.cycle_time);
    options.name.clone_from(&export.name);
    options.limit = export.limit;
    options.rated_force = export.rated_force;
    options.gain = export.gain;
    options.safety.ramp = export.ramp;
    options.safety.dead_zone = export.dead_zone;
    options.safety.slew = export.slew;
    options.safety.window = export.window;
    options.adapt = export.adapt;
    options.draws = export.draws.map(|count| Draws {
        count,
        seed: export.seed,
        width: match export.width {
            arguments::Width::Repeatability => Width::Repeatability,
            arguments::Width::Transfer => Width::Transfer,
        },
    });
    let parts = export.feedforward.iter().map(String::as_str);
    options.feedforward = Feedforward::from_names(parts).map_err(fed_line)?;
    if looks(&export.model) == Some(Looks::Robot) {
        return robot(export, &options, common);
    }
    if export.urdf.is_some() {
        return Err(Error::Usage {
            found: "a URDF for the model of one axis".into(),
            allowed: "the robot.toml of a robot takes one".into(),
        });
    }
    let exported =
        stiction_workflows::export::export_file(&export.model, &options).map_err(fed_line)?;
    exported.write(&export.out, export.force)?;
    if common.json {
        output::json(&exported)?;
    } else if !common.quiet {
        output::print(&stiction_pages::text::exported(&exported, &export.out))?;
    }
    Ok(exported.verdict().into())
}

/// Writes the files of all joints of a robot.
fn robot(
    export: &arguments::Export,
    options: &ExportOptions,
    common: &Common,
) -> Result<Exit, Error> {
    let exported = stiction_workflows::export::export_robot_file(
        &export.model,
        export.urdf.as_deref(),
        options,
    )?;
    exported.write(&export.out, export.force)?;
    if common.json {
        output::json(&exported)?;
    } else if !common.quiet {
        output::print(&stiction_pages::text::exported_robot(
            &exported,
            &export.out,
        ))?;
    }
    Ok(exported.verdict().into())
}

/// An error about what is fed forward, with the line that works.
fn fed_line(error: Error) -> Error {
    let Error::NotFed { found, instead } = error else {
        return error;
    };
    let line = with_value("feedforward", &instead.join(","));
    Error::Usage {
        found: found.into(),
        allowed: format!("what works: {line}").into(),
    }
}
