//! One function a command: arguments to a workflow, its outcome to the terminal and to disk.

use crate::Exit;
use crate::arguments::{self, Arguments, Command, Common};
use crate::interrupt;
use crate::progress::Bar;
use std::path::Path;
use stiction_app::{Error, LawKind, Options, Outcome, check_folder, write_atomic};

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
    };
    result.unwrap_or_else(|e| {
        eprintln!("stiction: [{}] {e}", e.code());
        if common.json {
            let error =
                serde_json::json!({ "error": { "code": e.code(), "message": e.to_string() } });
            println!("{error}");
        }
        Exit::BadInput
    })
}

fn demo(demo: &arguments::Demo, common: &Common) -> Result<Exit, Error> {
    check_folder(&demo.out, demo.force)?;
    let mut bar = Bar::new(common.json || common.quiet);
    let outcome = stiction_app::demo::demo(&demo.out, demo.seed, &mut bar);
    bar.finish();
    finish(&outcome?, &demo.out, common)
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
        println!(
            "{}",
            serde_json::to_string_pretty(&found).expect("plain data")
        );
    } else if !common.quiet {
        print!("{}", stiction_app::text::check(&found));
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
    let text = stiction_app::check::init(&check.logs[0])?;
    if file.exists() {
        return Err(Error::Output {
            path: file.to_path_buf(),
            reason: "exists already and is kept; name another file: --init OTHER.toml".into(),
        });
    }
    write_atomic(file, text.as_bytes())?;
    if common.json {
        println!("{}", serde_json::json!({ "written": file }));
    } else if !common.quiet {
        println!(
            "{} written; fill in what is missing, then: stiction check {} --axis {}",
            file.display(),
            check.logs[0].display(),
            file.display()
        );
    }
    Ok(Exit::Done)
}

fn identify(identify: &arguments::Identify, common: &Common) -> Result<Exit, Error> {
    check_folder(&identify.out, identify.force)?;
    let arguments::Method::Separable = identify.method;
    let options = Options {
        logs: identify.logs.clone(),
        axis: identify.axis.clone(),
        law: match identify.law {
            arguments::Law::CoulombViscous => LawKind::CoulombViscous,
            arguments::Law::Stribeck => LawKind::Stribeck,
            arguments::Law::Dahl => LawKind::Dahl,
            arguments::Law::Lugre => LawKind::LuGre,
        },
        asymmetric: identify.asymmetric,
        validate: identify.validate.clone(),
        split: identify.split,
        seed: identify.seed,
        compare_laws: true,
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
        println!(
            "{}",
            serde_json::to_string_pretty(&outcome.result).expect("plain data")
        );
    } else if !common.quiet {
        print!("{}", stiction_app::text::outcome(outcome));
        let names: Vec<_> = written
            .iter()
            .filter_map(|p| p.file_name().map(|n| n.to_string_lossy().into_owned()))
            .collect();
        println!("\nwritten to {}: {}", dir.display(), names.join(", "));
    }
    if outcome.result.search.status == "interrupted" {
        return Ok(Exit::Interrupted);
    }
    Ok(if outcome.result.trust.trustworthy {
        Exit::Done
    } else {
        Exit::NotTrustworthy
    })
}
