//! `stiction check`: what a log holds, and the axis file that it begins.

use super::is_new;
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::interrupt;
use crate::output;
use crate::progress::Bar;
use std::path::{Path, PathBuf};
use stiction_files::Axis;
use stiction_files::{Error as FileError, visible, write_atomic};
use stiction_workflows::Error;

/// Reads the logs and says what they hold, or begins an axis file.
pub fn run(check: &arguments::Check, common: &Common) -> Result<Exit, Error> {
    if let Some(file) = &check.init {
        return init(check, file, common);
    }
    interrupt::nothing_to_keep();
    let mut bar = Bar::new(common.json || common.quiet);
    let found = stiction_workflows::check::check(&check.logs, check.axis.as_deref(), &mut bar);
    bar.finish();
    let found = found?;
    if common.json {
        output::json(&found)?;
    } else if !common.quiet {
        output::print(&match common.verbose {
            true => stiction_pages::text::check(&found),
            false => stiction_pages::text::check_in_short(&found),
        })?;
    }
    Ok(found.verdict().into())
}

fn init(check: &arguments::Check, file: &Path, common: &Common) -> Result<Exit, Error> {
    is_new(file)?;
    let listed = match (check.logs.first(), &check.axis) {
        (None, Some(axis)) => Axis::read(axis)?.logs.first().map(|log| log.file.clone()),
        (log, _) => log.cloned(),
    };
    let Some(log) = &listed else {
        let reason = "needs a log, here or under [[log]] of the axis file";
        return Err(FileError::output(file, reason).into());
    };
    let started = stiction_workflows::check::init(log, check.axis.as_deref())?;
    let mut logs: Vec<&Path> = check.logs.iter().map(PathBuf::as_path).collect();
    if logs.is_empty() {
        logs.push(log);
    }
    write_atomic(file, visible::toml(started.text.clone()).as_bytes())?;
    if common.json {
        output::json(&serde_json::json!({
            "written": file.to_string_lossy(),
            "changes": started.changes,
            "undecided": started.undecided,
        }))?;
    } else if !common.quiet {
        output::print(&stiction_pages::text::started(&started, &logs, file))?;
    }
    Ok(Exit::Done)
}
