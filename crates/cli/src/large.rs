//! Work that may be long: how large it is, what is kept of it while it lasts, how to go on.

use crate::arguments::Common;
use crate::{next, output};
use std::io::Write;
use std::path::Path;
use stiction_files::{Runs, has_runs};
use stiction_workflows::Error;

/// Says how large the work is before it begins.
pub fn announce(size: Option<String>, common: &Common) {
    if let Some(size) = size.filter(|_| !(common.json || common.quiet)) {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&size));
    }
}

/// Keeps runs in a folder as they are done, and says what becomes of those that an earlier call has left there.
pub fn keeping(
    dir: &Path,
    resume: bool,
    keep: impl FnOnce(&Path, bool) -> Result<Runs, Error>,
) -> Result<Runs, Error> {
    let left = has_runs(dir);
    let runs = keep(dir, resume)?;
    let said = match (resume, left, runs.before()) {
        (true, false, _) => Some(format!(
            "{} holds no runs of an earlier call: it begins with the first",
            dir.display()
        )),
        (true, true, before) => Some(format!("{before} of {} runs are taken", runs.all())),
        (false, true, _) => Some(format!(
            "{} held runs of a call that was not finished: it begins anew; --resume would have taken them",
            dir.display()
        )),
        (false, false, _) => None,
    };
    if let Some(said) = said {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&said));
    }
    Ok(runs)
}

/// Removes runs whose work is whole; says how to go on where it is not.
pub fn kept(runs: Runs, whole: bool) {
    let fault = runs.fault();
    let said = match (whole, fault) {
        (true, _) => return runs.end(),
        (false, Some(fault)) => format!("what was done could not be kept: {fault}"),
        (false, None) => return how_to_resume(),
    };
    // As above.
    let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&said));
}

/// Says how to go on with work that was stopped.
pub fn how_to_resume() {
    let command = stiction_pages::text::command(next::resumed().into_iter());
    output::complain(&next::after("to go on where it was stopped:", &command));
}
