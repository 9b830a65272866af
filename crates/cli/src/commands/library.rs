//! `stiction library`: machines that are identified already.

use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::output;
use stiction_pages::text;
use stiction_workflows::Error;
use stiction_workflows::library::Library;

/// Lists the machines, shows one, or writes its files.
pub fn run(typed: &arguments::Library, common: &Common) -> Result<Exit, Error> {
    let library = Library::new();
    let Some(name) = &typed.machine else {
        return said(common, &library, || text::library(&library));
    };
    let machine = library.machine(name)?;
    let Some(dir) = &typed.out else {
        return said(common, machine, || text::machine(machine));
    };
    let written = machine.write(dir, typed.force)?;
    said(common, machine, || text::machine_in(machine, &written, dir))
}

/// Prints what was asked for.
fn said(
    common: &Common,
    json: &impl serde::Serialize,
    text: impl FnOnce() -> String,
) -> Result<Exit, Error> {
    if common.json {
        output::json(json)?;
    } else if !common.quiet {
        output::print(&text())?;
    }
    Ok(Exit::Done)
}
