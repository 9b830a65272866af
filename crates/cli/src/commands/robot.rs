//! `stiction robot`: logs of all joints to the model of a robot.

use super::{put, written_to};
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::interrupt;
use crate::output;
use crate::progress::Bar;
use std::path::PathBuf;
use stiction_files::robot::result::SCHEMA;
use stiction_files::{check_folder_of, check_inputs};
use stiction_pages::bundle;
use stiction_pages::text;
use stiction_workflows::Error;
use stiction_workflows::robot::{Files, Options, robot};

/// Identifies the robot and writes what was found.
pub fn run(typed: &arguments::Robot, common: &Common) -> Result<Exit, Error> {
    check_folder_of(&typed.out, SCHEMA, typed.force)?;
    let logs = typed.logs.iter().chain(&typed.validate);
    check_inputs(&typed.out, logs.chain(&typed.urdf).chain(&typed.axis))?;
    let files = Files {
        logs: typed.logs.clone(),
        urdf: typed.urdf.clone(),
        robot: typed.axis.clone(),
        validate: typed.validate.clone(),
    };
    let mut options = Options::default();
    options.split = typed.split;
    options.seed = typed.seed;
    let mut bar = Bar::new(common.json || common.quiet);
    let outcome = robot(&files, &options, &mut bar);
    bar.finish();
    let outcome = outcome?;
    let (dir, written) = put(&bundle::robot(&outcome, &typed.out), &typed.out, SCHEMA)?;
    if common.json {
        output::json(&outcome.result)?;
    } else if !common.quiet {
        let of_robot = |path: &&PathBuf| path.parent() == Some(dir.as_path());
        let own: Vec<PathBuf> = written.iter().filter(of_robot).cloned().collect();
        let files = written_to(&dir, &own);
        let joints = match written.len() - own.len() {
            0 => "",
            _ => ", joints/*/{result.json, model.toml, fit.csv}",
        };
        let files = format!("{}{joints}", files.trim_end());
        let (said, more) = match common.verbose {
            true => (text::robot_in_full(&outcome), ""),
            false => (text::robot(&outcome), " (in full: --verbose)"),
        };
        let next = text::robot_next(&outcome.result, &dir);
        output::print(&format!("{said}{files}{more}\n{next}"))?;
    }
    // An interrupt may also have come after the last search had converged.
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    Ok(outcome.verdict().into())
}
