//! `stiction batch`: many logs, each identified as `stiction identify` does it.

use super::{law, method};
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::interrupt;
use crate::large;
use crate::looking::looking;
use crate::output;
use crate::progress::Bar;
use std::io::Write;
use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_files::batch::SCHEMA;
use stiction_files::shell::text as path_text;
use stiction_files::{check_folder_of, check_inputs, has_runs};
use stiction_pages::bundle;
use stiction_workflows::Error;
use stiction_workflows::batch::Batch;
use stiction_workflows::identify::Options;

/// Runs the batch, writes its table and says what became of the logs.
pub fn run(typed: &arguments::Batch, common: &Common) -> Result<Exit, Error> {
    let dir = &typed.out;
    check_folder_of(dir, SCHEMA, typed.force)?;
    let mut options = Options::default();
    options.law = law(typed.law);
    options.asymmetric = typed.asymmetric;
    options.split = typed.split;
    options.seed = typed.seed;
    options.procedures.method = method(typed.method);
    let axis = typed.axis.as_deref();
    let batch = looking(common.json || common.quiet, || {
        Batch::new(&typed.inputs, axis, &options, typed.reports, dir)
    })?;
    check_inputs(
        dir,
        batch
            .inputs()
            .chain(typed.inputs.iter().map(|path| path.as_path())),
    )?;
    if let Some(said) = left_out(batch.beside_results()) {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&said));
    }
    let left = has_runs(dir);
    let (journal, gone) = batch.keep(dir, typed.resume)?;
    if gone > 0 {
        let (count, are) = match gone {
            1 => ("1 log".to_string(), "is"),
            many => (format!("{many} logs"), "are"),
        };
        let said = format!(
            "{count} of the table in {} {are} none of this batch, and will not be in its table any more",
            dir.display()
        );
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&said));
    }
    let said = match (typed.resume, left, journal.len()) {
        (true, _, 0) => Some(format!(
            "{} holds nothing of an earlier call: every log is identified",
            dir.display()
        )),
        (false, true, _) => Some(format!(
            "{} held logs of a call that was not finished: it begins anew; --resume would have taken them",
            dir.display()
        )),
        _ => None,
    };
    if let Some(said) = said {
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&said));
    }
    let mut bar = Bar::new(common.json || common.quiet);
    let report = |outcome: &stiction_workflows::identify::Outcome, name: &str| {
        let folder = dir.join(name);
        bundle::identification_in(outcome, &folder).write(&folder)?;
        Ok(())
    };
    let done = batch.run(&journal, &report, &mut bar);
    bar.finish();
    let done = done?;
    let file = batch.write(dir, &journal, &done)?;
    if common.json {
        output::json(&file)?;
    } else if !common.quiet {
        output::print(&stiction_pages::text::batch(&file, dir))?;
        let logs: Vec<&Path> = batch.inputs().collect();
        let failed = |log: &Path| file.failed.iter().any(|f| Path::new(&f.log.path) == log);
        let unread = file.failed.iter().filter(|f| f.code == Code::LogFormat);
        let left = unread
            .map(|f| Path::new(&f.log.path))
            .find_map(|none| without(none, &typed.inputs, &logs, &failed));
        if let Some(command) = left {
            output::print(&format!(
                "where that is no log, to leave it out:\nnext: {command}\n"
            ))?;
        }
    }
    if !done.is_whole() {
        large::how_to_resume();
        return Ok(Exit::Interrupted);
    }
    journal.end();
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    Ok(stiction_workflows::verdict::of_batch(&file).into())
}

/// The same batch of the logs of a folder that end otherwise than one that is none, where it alone ends so, the others have one
/// ending and not all of them failed.
fn without(
    none: &Path,
    inputs: &[PathBuf],
    logs: &[&Path],
    failed: &dyn Fn(&Path) -> bool,
) -> Option<String> {
    let [folder] = inputs else { return None };
    if path_text(folder).contains(['*', '?', '[']) {
        return None;
    }
    let others = || {
        logs.iter()
            .filter(|log| log.extension() != none.extension())
    };
    if others().count() + 1 < logs.len() {
        return None;
    }
    let ending = others().next()?.extension()?.to_str()?;
    let is_plain =
        |log: &&Path| log.parent() == Some(folder) && log.extension() == Some(ending.as_ref());
    let is_one = folder.is_dir() && others().all(is_plain);
    let is_one = is_one && others().any(|log| !failed(log));
    is_one.then(|| crate::next::in_place_of(folder, &folder.join(format!("*.{ending}"))))
}

/// Says which logs lie beside results and are not identified.
fn left_out(logs: &[PathBuf]) -> Option<String> {
    /// So many are named.
    const NAMED: usize = 3;
    let mut names: Vec<String> = logs.iter().take(NAMED).map(|log| path_text(log)).collect();
    if logs.len() > NAMED {
        names.push(format!("and {} more", logs.len() - NAMED));
    }
    let count = match logs.len() {
        0 => return None,
        1 => "1 log lies".to_string(),
        many => format!("{many} logs lie"),
    };
    Some(format!(
        "{count} beside the result of an earlier command, and what is in such a folder is left out: {}; name a log to have it identified too",
        names.join(", ")
    ))
}
