//! `stiction demo`: the log of a known axis, and what is identified of it.

use super::finish;
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::output;
use crate::progress::Bar;
use std::io::Write;
use std::path::Path;
use stiction_files::{Kept, check_folder};
use stiction_workflows::Error;

/// Writes the log, identifies it and says what was found beside the truth.
pub fn run(demo: &arguments::Demo, common: &Common) -> Result<Exit, Error> {
    check_folder(
        &demo.out,
        demo.force || stiction_workflows::demo::is_begun(&demo.out),
    )?;
    if demo.procedures {
        return procedure_logs(demo, common);
    }
    if let Some(plan) = &demo.plan {
        return planned_log(plan, demo, common);
    }
    let mut bar = Bar::new(common.json || common.quiet);
    let done = stiction_workflows::demo::demo(&demo.out, demo.seed, &mut bar);
    bar.finish();
    let (outcome, kept) = done?;
    say_kept(kept);
    finish(&outcome, &demo.out, common)
}

/// Says which files that the demo did not write are kept.
fn say_kept(kept: impl IntoIterator<Item = Kept>) {
    for (from, to) in kept {
        let (from, to) = (from.display(), to.display());
        let line = format!("{from} is not what is written now: it is kept as {to}");
        // With standard error closed there is nowhere to say it.
        let _ = writeln!(std::io::stderr(), "stiction: {}", output::line(&line));
    }
}

fn planned_log(plan: &Path, demo: &arguments::Demo, common: &Common) -> Result<Exit, Error> {
    let (log, kept) = stiction_workflows::demo::planned(plan, &demo.out, demo.seed)?;
    say_kept(kept);
    if common.json {
        output::json(&serde_json::json!({ "written": [log.to_string_lossy()] }))?;
    } else if !common.quiet {
        let truth = stiction_workflows::demo::truth_of_demo();
        output::print(&stiction_pages::text::planned_log(plan, &log, &truth))?;
    }
    Ok(Exit::Done)
}

fn procedure_logs(demo: &arguments::Demo, common: &Common) -> Result<Exit, Error> {
    let (written, kept) = stiction_workflows::demo::procedures(&demo.out, demo.seed)?;
    say_kept(kept);
    if common.json {
        let paths: Vec<_> = written.iter().map(|p| p.to_string_lossy()).collect();
        output::json(&serde_json::json!({ "written": paths }))?;
    } else if !common.quiet {
        output::print(&stiction_pages::text::procedure_commands(
            &demo.out,
            &written,
            &stiction_workflows::demo::truth_of_demo(),
        ))?;
    }
    Ok(Exit::Done)
}
