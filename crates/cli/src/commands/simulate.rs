//! `stiction simulate`: a study.

use super::{is_new, put, written_to};
use crate::arguments::{self, Common};
use crate::exit::Exit;
use crate::interrupt;
use crate::large;
use crate::output;
use crate::progress::Bar;
use std::path::{Path, PathBuf};
use stiction_files::study::Study;
use stiction_files::{check_folder_of, check_inputs, visible, write_atomic};
use stiction_pages::bundle;
use stiction_workflows::Error;
use stiction_workflows::study::{ExportedC, compare_exported};

/// Simulates the study and writes what came out, or begins one.
pub fn run(simulate: &arguments::Simulate, common: &Common) -> Result<Exit, Error> {
    // The arguments have both but for --init.
    let (Some(study), Some(dir)) = (&simulate.study, &simulate.out) else {
        let file = simulate.init.as_deref().unwrap_or(Path::new("study.toml"));
        let models = [&simulate.model, &simulate.second_model];
        return init_study(file, models.map(Option::as_deref), common);
    };
    check_folder_of(dir, stiction_files::study::result::SCHEMA, simulate.force)?;
    let study = Study::read_within(study, simulate.max_samples)?;
    let inputs: Vec<PathBuf> = study.inputs().map(PathBuf::from).collect();
    check_inputs(dir, &inputs)?;
    let exported = simulate.exported_c.as_deref();
    let exported = exported.map(|dir| ExportedC::open(dir, &study));
    let exported = exported.transpose()?;
    large::announce(stiction_pages::text::announced(&study), common);
    let runs = large::keeping(dir, simulate.resume, |dir, resume| {
        let exported = exported.as_ref();
        Ok(stiction_workflows::study::keep(
            &study, exported, dir, resume,
        )?)
    })?;
    let mut bar = Bar::new(common.json || common.quiet);
    let mut outcome = stiction_workflows::study::simulate_keeping(&study, &runs, &mut bar);
    bar.finish();
    if let Some(exported) = exported.filter(|_| !interrupt::stops()) {
        compare_exported(&mut outcome, &study, &exported, &runs)?;
    }
    let schema = stiction_files::study::result::SCHEMA;
    let (dir, written) = put(&bundle::study(&outcome), dir, schema)?;
    large::kept(runs, outcome.file.status == "complete");
    if common.json {
        output::json(&outcome.file)?;
    } else if !common.quiet {
        let text = stiction_pages::text::study(&outcome);
        output::print(&format!("{text}\n{}", written_to(&dir, &written)))?;
    }
    // Exported C may be what was left out.
    if interrupt::stopped() {
        return Ok(Exit::Interrupted);
    }
    Ok(outcome.verdict().into())
}

fn init_study(
    file: &Path,
    [model, second]: [Option<&Path>; 2],
    common: &Common,
) -> Result<Exit, Error> {
    is_new(file)?;
    let started = stiction_files::study::start(model, second, file)?;
    write_atomic(file, visible::toml(started.text.clone()).as_bytes())?;
    if common.json {
        output::json(&serde_json::json!({
            "written": file.to_string_lossy(),
            "undecided": started.undecided,
        }))?;
    } else if !common.quiet {
        output::print(&stiction_pages::text::started_study(&started, file))?;
    }
    Ok(Exit::Done)
}
