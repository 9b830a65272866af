//! `stiction drift`: what changed on which machine.

use super::{put, written_to};
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::interrupt;
use crate::output;
use stiction_files::drift_file::SCHEMA;
use stiction_files::{check_folder_of, check_inputs};
use stiction_pages::bundle;
use stiction_workflows::Error;
use stiction_workflows::drift::{Limit, Times, drift};

/// Follows the table, writes the report where it is wanted, and says what changed.
pub fn run(typed: &arguments::Drift, common: &Common) -> Result<Exit, Error> {
    if let Some(dir) = &typed.out {
        check_folder_of(dir, SCHEMA, typed.force)?;
        check_inputs(dir, [&typed.results])?;
    }
    let limits: Result<Vec<Limit>, Error> =
        typed.limit.iter().map(|text| Limit::read(text)).collect();
    interrupt::nothing_to_keep();
    let times = match typed.times {
        None => Times::Table,
        Some(arguments::Times::Names) => Times::Names,
        Some(arguments::Times::Files) => Times::Files,
    };
    let outcome = drift(&typed.results, &limits?, times)?;
    let written = match &typed.out {
        None => String::new(),
        Some(dir) => {
            let (dir, written) = put(&bundle::drift(&outcome), dir, SCHEMA)?;
            format!("\n{}", written_to(&dir, &written))
        }
    };
    if common.json {
        output::json(&outcome.file)?;
    } else if !common.quiet {
        let text = stiction_pages::text::drift(&outcome.file, typed.out.as_deref());
        // What leads on stays last, with the line above it that says what for.
        let line = |at: usize| text[..at].rfind('\n').map_or(0, |before| before + 1);
        let at = text.find("\nnext: ").map_or(text.len(), line);
        let (said, next) = text.split_at(at);
        output::print(&format!("{said}{written}{next}"))?;
    }
    Ok(stiction_workflows::verdict::of_drift(&outcome.file).into())
}
