//! One function a command: arguments to a workflow, its outcome to the terminal and to disk.

use crate::Exit;
use crate::arguments::{self, Arguments, Command, Common};
use crate::interrupt;
use crate::output;
use crate::progress::Bar;
use std::path::Path;
use stiction_app::{
    Error, ExportOptions, LawKind, Method, Options, Outcome, Procedures, Target, check_folder,
    check_inputs, write_atomic,
};

/// Runs a command; every error is printed here, once.
pub fn run(arguments: &Arguments) -> Exit {
    interrupt::listen();
    if let Some(threads) = arguments.common.threads {
        stiction_app::set_threads(usize::from(threads));
    }
    let common = &arguments.common;
    let result = match &arguments.command {
        Command::Demo(demo) => self::demo(demo, common),
        Command::Check(check) => self::check(check, common),
        Command::Identify(identify) => self::identify(identify, common),
        Command::Export(export) => self::export(export, common),
    };
    result.unwrap_or_else(|e| {
        eprintln!("stiction: [{}] {e}", e.code());
        if common.json {
            let error =
                serde_json::json!({ "error": { "code": e.code(), "message": e.to_string() } });
            // The same was said on standard error; there is nowhere else to complain.
            let _ = output::json(&error);
        }
        Exit::BadInput
    })
}

fn demo(demo: &arguments::Demo, common: &Common) -> Result<Exit, Error> {
    check_folder(&demo.out, demo.force)?;
    if demo.procedures {
        return procedure_logs(demo, common);
    }
    let mut bar = Bar::new(common.json || common.quiet);
    let outcome = stiction_app::demo::demo(&demo.out, demo.seed, &mut bar);
    bar.finish();
    finish(&outcome?, &demo.out, common)
}

fn procedure_logs(demo: &arguments::Demo, common: &Common) -> Result<Exit, Error> {
    let written = stiction_app::demo::procedures(&demo.out, demo.seed)?;
    if common.json {
        let paths: Vec<_> = written.iter().map(|p| p.to_string_lossy()).collect();
        output::json(&serde_json::json!({ "written": paths }))?;
    } else if !common.quiet {
        output::print(&stiction_app::text::procedure_commands(&demo.out, &written))?;
    }
    Ok(Exit::Done)
}

fn check(check: &arguments::Check, common: &Common) -> Result<Exit, Error> {
    if let Some(file) = &check.init {
        return init(check, file, common);
    }
    let mut bar = Bar::new(common.json || common.quiet);
    let found = stiction_app::check::check(&check.logs, check.axis.as_deref(), &mut bar);
    bar.finish();
    let found = found?;
    if common.json {
        output::json(&found)?;
    } else if !common.quiet {
        output::print(&stiction_app::text::check(&found))?;
    }
    if interrupt::asked() {
        return Ok(Exit::Interrupted);
    }
    let refused = found.logs.iter().any(|log| log.refused.is_some());
    Ok(if refused {
        Exit::NotTrustworthy
    } else {
        Exit::Done
    })
}

fn init(check: &arguments::Check, file: &Path, common: &Common) -> Result<Exit, Error> {
    // A dangling link is something too, and renaming onto it would replace it.
    if file.symlink_metadata().is_ok() {
        return Err(Error::Output {
            path: file.to_path_buf(),
            reason: "exists already and is kept; name another file: --init OTHER.toml".into(),
        });
    }
    let text = stiction_app::check::init(&check.logs[0])?;
    write_atomic(file, text.as_bytes())?;
    if common.json {
        output::json(&serde_json::json!({ "written": file.to_string_lossy() }))?;
    } else if !common.quiet {
        output::print(&format!(
            "{} written; fill in what is missing, then: stiction check {} --axis {}\n",
            file.display(),
            check.logs[0].display(),
            file.display()
        ))?;
    }
    Ok(Exit::Done)
}

fn identify(identify: &arguments::Identify, common: &Common) -> Result<Exit, Error> {
    check_folder(&identify.out, identify.force)?;
    let inputs = [
        &identify.logs,
        &identify.validate,
        &identify.statics,
        &identify.break_away,
    ];
    let files = inputs.into_iter().flatten();
    check_inputs(
        &identify.out,
        files.chain(&identify.model).chain(&identify.axis),
    )?;
    let options = Options {
        logs: identify.logs.clone(),
        axis: identify.axis.clone(),
        law: match identify.law {
            arguments::Law::Auto => None,
            arguments::Law::CoulombViscous => Some(LawKind::CoulombViscous),
            arguments::Law::Stribeck => Some(LawKind::Stribeck),
            arguments::Law::Dahl => Some(LawKind::Dahl),
            arguments::Law::Lugre => Some(LawKind::LuGre),
            arguments::Law::ElastoPlastic => Some(LawKind::ElastoPlastic),
            arguments::Law::MaxwellSlip => Some(LawKind::MaxwellSlip),
            arguments::Law::Gms => Some(LawKind::Gms),
        },
        asymmetric: identify.asymmetric,
        validate: identify.validate.clone(),
        split: identify.split,
        seed: identify.seed,
        compare_laws: true,
        procedures: Procedures {
            method: match identify.method {
                arguments::Method::Separable => Method::Separable,
                arguments::Method::OutputError => Method::OutputError,
                arguments::Method::Static => Method::Static,
                arguments::Method::StaticThenDynamic => Method::StaticThenDynamic,
                arguments::Method::PreslidingStep => Method::PreslidingStep,
            },
            statics: identify.statics.clone(),
            model: identify.model.clone(),
            break_away: identify.break_away.clone(),
        },
    };
    let mut bar = Bar::new(common.json || common.quiet);
    let outcome = stiction_app::identify(&options, &mut bar);
    bar.finish();
    finish(&outcome?, &identify.out, common)
}

/// Writes the files, says what was found, and what it is worth.
fn finish(outcome: &Outcome, dir: &Path, common: &Common) -> Result<Exit, Error> {
    let written = outcome.bundle().write(dir)?;
    if common.json {
        output::json(&outcome.result)?;
    } else if !common.quiet {
        let names: Vec<_> = written
            .iter()
            .filter_map(|p| p.file_name().map(|n| n.to_string_lossy().into_owned()))
            .collect();
        output::print(&format!(
            "{}\nwritten to {}: {}\n",
            stiction_app::text::outcome(outcome),
            dir.display(),
            names.join(", ")
        ))?;
    }
    // An interrupt may also have come while laws were compared, after the search had converged.
    if outcome.result.search.status == "interrupted" || interrupt::asked() {
        return Ok(Exit::Interrupted);
    }
    Ok(if outcome.result.trust.trustworthy {
        Exit::Done
    } else {
        Exit::NotTrustworthy
    })
}

fn export(export: &arguments::Export, common: &Common) -> Result<Exit, Error> {
    let options = ExportOptions {
        model: export.model.clone(),
        target: match export.target {
            arguments::Target::C => Target::C,
            arguments::Target::St => Target::St,
            arguments::Target::Tcpou => Target::TcPou,
            arguments::Target::Plcopen => Target::PlcOpen,
            arguments::Target::Rust => Target::Rust,
            arguments::Target::Mujoco => Target::Mujoco,
        },
        name: export.name.clone(),
        cycle_time: export.cycle_time,
        limit: export.limit,
    };
    let exported = stiction_app::export(&options, &export.out)?;
    if common.json {
        output::json(&exported)?;
    } else if !common.quiet {
        output::print(&stiction_app::text::exported(&exported, &export.out))?;
    }
    Ok(if exported.trustworthy {
        Exit::Done
    } else {
        Exit::NotTrustworthy
    })
}
