//! `stiction export`: a model to code.

use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::output;
use std::path::Path;
use stiction::commands::shell::{quoted, text as path_text};
use stiction::{Error, ExportOptions, Feedforward, Target};

/// Writes the code.
pub fn run(export: &arguments::Export, common: &Common) -> Result<Exit, Error> {
    let target = match export.target {
        arguments::Target::C => Target::C,
        arguments::Target::Cpp => Target::Cpp,
        arguments::Target::Ros2 => Target::Ros2,
        arguments::Target::St => Target::St,
        arguments::Target::Tcpou => Target::TcPou,
        arguments::Target::Plcopen => Target::PlcOpen,
        arguments::Target::Rust => Target::Rust,
        arguments::Target::Mujoco => Target::Mujoco,
        arguments::Target::Modelica => Target::Modelica,
        arguments::Target::Urdf => Target::Urdf,
        arguments::Target::Sdf => Target::Sdf,
        arguments::Target::Isaaclab => Target::IsaacLab,
        arguments::Target::Hal => Target::Hal,
        arguments::Target::Fmu => Target::Fmu,
        arguments::Target::Matlab => Target::Matlab,
        arguments::Target::Tf5200 => Target::Tf5200,
        arguments::Target::DriveTable => Target::DriveTable,
    };
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
    let parts = export.feedforward.iter().map(String::as_str);
    options.feedforward = Feedforward::from_names(parts).map_err(fed_line)?;
    let exported = stiction::export_file(&export.model, &options).map_err(fed_line)?;
    exported.write(&export.out, export.force)?;
    if common.json {
        output::json(&exported)?;
    } else if !common.quiet {
        output::print(&stiction::commands::text::exported(&exported, &export.out))?;
    }
    Ok(exported.verdict().into())
}

/// An error about what is fed forward, with the line that works.
fn fed_line(error: Error) -> Error {
    let Error::NotFed { found, instead } = error else {
        return error;
    };
    let parts = instead.join(",");
    let given = std::env::args_os().skip(1);
    let given: Vec<String> = given.map(|a| path_text(Path::new(&a))).collect();
    let mut line = vec!["stiction".to_string()];
    let mut rest = given.iter();
    while let Some(word) = rest.next() {
        if word == "--feedforward" {
            line.extend([word.clone(), parts.clone()]);
            rest.next();
        } else if word.starts_with("--feedforward=") {
            line.push(format!("--feedforward={parts}"));
        } else if word.starts_with('-') {
            line.push(word.clone());
        } else {
            line.push(quoted(word));
        }
    }
    Error::Usage {
        found: found.into(),
        allowed: format!("what works: {}", line.join(" ")).into(),
    }
}
