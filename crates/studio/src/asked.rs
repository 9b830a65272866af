//! Work that the page asks for, as a command of the command line: the same words, the same engine, the same files.

use crate::named::{read_axis, read_study};
use crate::refused::Refused;
use crate::workspace::Workspace;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use stiction::commands::shell::quoted;
use stiction::commands::{
    Bundle, Files, Known, PlanOptions, Want, check_folder_of, check_inputs, identify, plan,
    plan_motion, study, text,
};
use stiction::{
    Error, ExportOptions, LawKind, Method, Observer, Options, Procedures, Target, Verdict, bundle,
};

/// A piece of work.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Asked {
    Check {
        log: String,
        axis: Option<String>,
    },
    Identify {
        logs: Vec<String>,
        axis: Option<String>,
        /// `None` lets the data choose.
        law: Option<String>,
        #[serde(default)]
        asymmetric: bool,
        method: Option<String>,
        #[serde(default)]
        validate: Vec<String>,
        split: Option<f64>,
        out: String,
    },
    Simulate {
        study: String,
        out: String,
    },
    Plan {
        axis: String,
        /// s.
        time: Option<f64>,
        model: Option<String>,
        #[serde(default)]
        wants: Vec<String>,
        out: String,
    },
    Export {
        model: String,
        target: String,
        /// s.
        cycle_time: f64,
        gain: Option<f64>,
        limit: Option<f64>,
        rated_force: Option<f64>,
        #[serde(default)]
        adapt: bool,
        out: String,
        #[serde(default)]
        force: bool,
    },
}

/// What became of it.
#[derive(Clone, Debug)]
pub struct Done {
    pub verdict: Verdict,
    /// What the command line prints.
    pub text: String,
    /// The folder that the files are in; another one than was asked for where work was stopped and a complete result was there.
    pub folder: Option<String>,
    pub written: Vec<String>,
    /// The outcome as `--json` gives it, where no file has it.
    pub json: Option<serde_json::Value>,
}

impl Asked {
    /// What it is called.
    pub fn kind(&self) -> &'static str {
        match self {
            Asked::Check { .. } => "check",
            Asked::Identify { .. } => "identify",
            Asked::Simulate { .. } => "simulate",
            Asked::Plan { .. } => "plan",
            Asked::Export { .. } => "export",
        }
    }

    /// The file that it is about.
    pub fn about(&self) -> String {
        match self {
            Asked::Check { log, .. } => log.clone(),
            Asked::Identify { logs, axis, .. } => match logs.as_slice() {
                [] => axis.clone().unwrap_or_default(),
                logs => logs.join(", "),
            },
            Asked::Simulate { study, .. } => study.clone(),
            Asked::Plan { axis, .. } => axis.clone(),
            Asked::Export { model, .. } => model.clone(),
        }
    }

    /// The folder that it writes into.
    pub fn out(&self) -> Option<&str> {
        match self {
            Asked::Check { .. } => None,
            Asked::Identify { out, .. }
            | Asked::Simulate { out, .. }
            | Asked::Plan { out, .. }
            | Asked::Export { out, .. } => Some(out),
        }
    }

    /// The command line that does the same in the folder of the page.
    pub fn command(&self) -> String {
        let mut words = vec!["stiction".to_string(), self.kind().into()];
        let file = |words: &mut Vec<String>, name: &String| words.push(quoted(name));
        match self {
            Asked::Check { log, axis } => {
                file(&mut words, log);
                option(&mut words, "--axis", axis.as_deref());
            }
            Asked::Identify {
                logs,
                axis,
                law,
                asymmetric,
                method,
                validate,
                split,
                ..
            } => {
                logs.iter().for_each(|log| file(&mut words, log));
                option(&mut words, "--axis", axis.as_deref());
                option(&mut words, "--law", law.as_deref());
                if *asymmetric {
                    words.push("--asymmetric".into());
                }
                option(&mut words, "--method", method.as_deref());
                if !validate.is_empty() {
                    words.push("--validate".into());
                    validate.iter().for_each(|log| file(&mut words, log));
                }
                number(&mut words, "--split", *split);
            }
            Asked::Simulate { study, .. } => file(&mut words, study),
            Asked::Plan {
                axis,
                time,
                model,
                wants,
                ..
            } => {
                file(&mut words, axis);
                let time = time.map(|time| format!("{time}s"));
                option(&mut words, "--time", time.as_deref());
                option(&mut words, "--model", model.as_deref());
                for want in wants {
                    option(&mut words, "--want", Some(want));
                }
            }
            Asked::Export {
                model,
                target,
                cycle_time,
                gain,
                limit,
                rated_force,
                adapt,
                force,
                ..
            } => {
                file(&mut words, model);
                option(&mut words, "--target", Some(target));
                number(&mut words, "--cycle-time", Some(*cycle_time));
                number(&mut words, "--gain", *gain);
                number(&mut words, "--limit", *limit);
                number(&mut words, "--rated-force", *rated_force);
                if *adapt {
                    words.push("--adapt".into());
                }
                if *force {
                    words.push("--force".into());
                }
            }
        }
        option(&mut words, "--out", self.out());
        words.join(" ")
    }

    /// Does it.
    pub fn run(
        &self,
        workspace: &Workspace,
        observer: &mut dyn Observer,
        stopped: &dyn Fn() -> bool,
    ) -> Result<Done, Refused> {
        match self {
            Asked::Check { log, axis } => check(workspace, log, axis.as_deref(), observer),
            Asked::Identify { .. } => self.identify(workspace, observer, stopped),
            Asked::Simulate { study, out } => simulate(workspace, (study, out), observer, stopped),
            Asked::Plan { .. } => self.plan(workspace, observer, stopped),
            Asked::Export { .. } => self.export(workspace),
        }
    }

    fn identify(
        &self,
        workspace: &Workspace,
        observer: &mut dyn Observer,
        stopped: &dyn Fn() -> bool,
    ) -> Result<Done, Refused> {
        let Asked::Identify {
            logs,
            axis,
            law,
            asymmetric,
            method,
            validate,
            split,
            out,
        } = self
        else {
            return Err(Refused::internal("another kind of work"));
        };
        let dir = workspace.place(out)?;
        let schema = stiction::result::SCHEMA;
        check_folder_of(&dir, schema, false)?;
        let all = |names: &[String]| -> Result<Vec<PathBuf>, Refused> {
            names.iter().map(|name| workspace.file(name)).collect()
        };
        let files = Files {
            logs: all(logs)?,
            validate: all(validate)?,
            axis: axis.as_ref().map(|axis| workspace.file(axis)).transpose()?,
        };
        if let Some(axis) = axis {
            let logs = files.logs.iter().chain(&files.validate);
            let logs: Vec<&Path> = logs.map(PathBuf::as_path).collect();
            let read = read_axis(workspace, axis, &logs)?;
            check_inputs(&dir, read.logs.iter().map(|log| &log.file))?;
        }
        let inputs = files.logs.iter().chain(&files.validate).chain(&files.axis);
        check_inputs(&dir, inputs)?;
        let mut options = Options::default();
        let unknown = |what: &str, name: &str| Refused::bad(format!("{name}: no such {what}"));
        options.law = match law.as_deref() {
            None | Some("auto") => None,
            Some(name) => Some(LawKind::from_name(name).ok_or_else(|| unknown("law", name))?),
        };
        options.asymmetric = *asymmetric;
        options.split = *split;
        options.procedures = Procedures {
            method: match method.as_deref() {
                None => Procedures::default().method,
                Some(name) => Method::from_name(name).ok_or_else(|| unknown("method", name))?,
            },
            ..Procedures::default()
        };
        let outcome = identify(&files, &options, observer)?;
        let files = bundle::identification_in(&outcome, &dir);
        let (folder, written) = put(&files, (&dir, out), schema, stopped())?;
        Ok(Done {
            verdict: ended(outcome.verdict(), stopped()),
            text: text::outcome(&outcome),
            folder: Some(folder),
            written,
            json: None,
        })
    }

    fn plan(
        &self,
        workspace: &Workspace,
        observer: &mut dyn Observer,
        stopped: &dyn Fn() -> bool,
    ) -> Result<Done, Refused> {
        let Asked::Plan {
            axis,
            time,
            model,
            wants,
            out,
        } = self
        else {
            return Err(Refused::internal("another kind of work"));
        };
        let dir = workspace.place(out)?;
        check_folder_of(&dir, plan::SCHEMA, false)?;
        read_axis(workspace, axis, &[])?;
        let file = workspace.file(axis)?;
        let model = model
            .as_ref()
            .map(|name| workspace.file(name))
            .transpose()?;
        check_inputs(&dir, model.iter().chain([&file]))?;
        let wants = wants.iter().map(|text| Want::parse(text));
        let options = PlanOptions {
            time: *time,
            known: model.map(Known::Model),
            wants: wants.collect::<Result<_, _>>()?,
            ..PlanOptions::default()
        };
        let Some(planned) = plan_motion(&file, &options, observer)? else {
            return Ok(Done {
                verdict: Verdict::Interrupted,
                text: "stopped before there was a motion; nothing is written".into(),
                folder: None,
                written: Vec::new(),
                json: None,
            });
        };
        let (folder, written) = put(
            &bundle::plan(&planned),
            (&dir, out),
            plan::SCHEMA,
            stopped(),
        )?;
        let met = planned.file.wanted.iter().all(|wish| wish.met);
        let whole = planned.file.status == "complete";
        let verdict = match (whole, met) {
            (false, _) => Verdict::Interrupted,
            (true, true) => Verdict::Trustworthy,
            (true, false) => Verdict::NotTrustworthy,
        };
        Ok(Done {
            verdict: ended(verdict, stopped()),
            text: text::planned(&planned, &file, Path::new(&folder)),
            folder: Some(folder),
            written,
            json: serde_json::to_value(&planned.file).ok(),
        })
    }

    fn export(&self, workspace: &Workspace) -> Result<Done, Refused> {
        let Asked::Export {
            model,
            target,
            cycle_time,
            gain,
            limit,
            rated_force,
            adapt,
            out,
            force,
        } = self
        else {
            return Err(Refused::internal("another kind of work"));
        };
        let dir = workspace.place(out)?;
        let mut targets = Target::ALL.into_iter();
        let target = targets
            .find(|own| own.name() == target)
            .ok_or_else(|| Refused::bad(format!("{target}: no such target")))?;
        let mut options = ExportOptions::new(target, *cycle_time);
        options.gain = *gain;
        options.limit = *limit;
        options.rated_force = *rated_force;
        options.adapt = *adapt;
        let exported = stiction::export_file(workspace.file(model)?, &options)?;
        match force {
            true => exported.write_over(&dir)?,
            false => exported.write(&dir)?,
        }
        Ok(Done {
            verdict: exported.verdict(),
            text: text::exported(&exported, Path::new(out)),
            folder: Some(out.clone()),
            written: exported.written.clone(),
            json: serde_json::to_value(&exported).ok(),
        })
    }
}

fn check(
    workspace: &Workspace,
    log: &str,
    axis: Option<&str>,
    observer: &mut dyn Observer,
) -> Result<Done, Refused> {
    let logs = [workspace.file(log)?];
    if let Some(axis) = axis {
        read_axis(workspace, axis, &[&logs[0]])?;
    }
    let file = axis.map(|axis| workspace.file(axis)).transpose()?;
    let found = stiction::commands::check::check(&logs, file.as_deref(), observer)?;
    Ok(Done {
        verdict: found.verdict(),
        text: text::check(&found),
        folder: None,
        written: Vec::new(),
        json: serde_json::to_value(&found).ok(),
    })
}

fn simulate(
    workspace: &Workspace,
    (name, out): (&str, &str),
    observer: &mut dyn Observer,
    stopped: &dyn Fn() -> bool,
) -> Result<Done, Refused> {
    let dir = workspace.place(out)?;
    let schema = study::result::SCHEMA;
    check_folder_of(&dir, schema, false)?;
    let read = read_study(workspace, name)?;
    let inputs: Vec<PathBuf> = read.inputs().map(PathBuf::from).collect();
    check_inputs(&dir, &inputs)?;
    let outcome = stiction::simulate(&read, observer);
    let (folder, written) = put(&bundle::study(&outcome), (&dir, out), schema, stopped())?;
    Ok(Done {
        verdict: ended(outcome.verdict(), stopped()),
        text: text::study(&outcome),
        folder: Some(folder),
        written,
        json: None,
    })
}

/// Writes files into a folder, or beside it where they are of work that was stopped and a complete result is there; the name of
/// the folder, and of the files in it.
fn put(
    bundle: &Bundle,
    (dir, name): (&Path, &str),
    schema: &str,
    stopped: bool,
) -> Result<(String, Vec<String>), Error> {
    let beside = bundle::beside_complete(bundle, dir, schema, stopped);
    let out = beside.as_deref().unwrap_or(dir);
    let written = bundle.write(out)?;
    let name = match (beside.as_ref(), name.rsplit_once('/')) {
        (None, _) => name.to_string(),
        // Beside a folder it is named after that, within it `interrupted`.
        (Some(other), before) => {
            let last = other.file_name().unwrap_or_default().to_string_lossy();
            match (other.starts_with(dir), before) {
                (true, _) => format!("{name}/{last}"),
                (false, Some((before, _))) => format!("{before}/{last}"),
                (false, None) => last.into_owned(),
            }
        }
    };
    let names = written.iter().filter_map(|path| path.file_name());
    let names = names.map(|name| name.to_string_lossy().into_owned());
    Ok((name, names.collect()))
}

fn ended(verdict: Verdict, stopped: bool) -> Verdict {
    match stopped {
        true => Verdict::Interrupted,
        false => verdict,
    }
}

fn option(words: &mut Vec<String>, name: &str, value: Option<&str>) {
    if let Some(value) = value {
        words.extend([name.to_string(), quoted(value)]);
    }
}

fn number(words: &mut Vec<String>, name: &str, value: Option<f64>) {
    let value = value.map(|value| value.to_string());
    option(words, name, value.as_deref());
}
