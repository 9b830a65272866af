//! What to do next, as commands to type.

use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_files::result::{Cure, Next, ResultFile};
pub use stiction_files::shell::axis_file;
use stiction_files::shell::{
    cycle_option, free_folder, new_axis_file, plain, quoted, quoted_path, text,
};
use stiction_identify::LawKind;
use stiction_number::Percent;

/// What a log that is still to be recorded is called in commands.
pub(crate) const ANOTHER_LOG: &str = "another.csv";

/// What the commands are for.
pub fn why(next: Next) -> &'static str {
    match next {
        Next::Export => {
            "the compensator as C; also cpp, ros2, st, tcpou, plcopen, rust, mujoco, modelica, urdf, sdf, isaaclab, hal, fmu, matlab, tf5200 and drive-table"
        }
        Next::LetTheDataChoose => "let the data choose the law",
        Next::AnotherLaw => "the best of the laws above that a compensator may rely on",
        Next::IdentifyTheOther => "what the other log says by itself, to compare the parameters",
        Next::CheckTheOther => "see what the other log shows, from which nothing can be identified",
        Next::FirstLog => "the first log by itself, then the others likewise",
        Next::Simulate => "fit the position of the simulated axis, which differentiates nothing",
        Next::AxisFile => "correct the axis file as said above",
        Next::Check => "see what the log shows, and what motion to record instead",
        Next::Record => {
            "record another log with the motion that is named above (docs/procedures.md), then"
        }
        Next::Again => "the same again, to the end",
        Next::Finish => {
            "the same without --no-finish: least squares after the search give intervals"
        }
    }
}

/// What is worth a try before a law is used.
pub(crate) struct Cured {
    /// Why, and what to do.
    pub what: String,
    /// The line to write into the axis file; none where another law is to be tried.
    pub line: Option<Line>,
    /// The command that then takes it in.
    pub command: String,
    /// Whether all that is worth a try has been tried, and the command is the one that uses the law.
    pub ends: bool,
}

/// A line of an axis file.
pub(crate) struct Line {
    /// The file, as a shell takes it.
    pub file: String,
    /// The table that it belongs to.
    pub table: String,
    /// The line.
    pub text: String,
    /// Whether it takes the place of the line with its key.
    pub replaces: bool,
    /// Whether the file is still to be begun.
    pub begins: bool,
}

/// What is worth a try before a law is used: a law that holds better, which leaves something else, or what takes the cause of what
/// this one leaves into the fit.
pub(crate) fn to_try(result: &ResultFile, dir: &Path) -> Option<Cured> {
    tried(result, dir)
        .or_else(|| better(result, dir))
        .or_else(|| cured(result, dir))
}

/// Where elements were asked for and one bristle holds better: what the shape of one bristle leads to is then no better than it,
/// and a command that leads back, or to a check that leads to the same identification, would go round in a circle.
fn tried(result: &ResultFile, dir: &Path) -> Option<Cured> {
    let better = result.trust.better.as_ref()?;
    let back = self::better(result, dir)?.command;
    let [own, other] = [&result.law, &better.law].map(|name| LawKind::from_name(name));
    if !result.trust.trustworthy || !own?.has_elements() || other?.has_elements() {
        return None;
    }
    let error = |name: &str, asymmetric: bool| {
        let mut laws = result.laws.iter();
        let law = laws.find(|law| law.law == name && law.asymmetric == asymmetric)?;
        let error = Percent::error(law.held_out_error_percent?);
        Some(error.decimals(2))
    };
    let mine = error(&result.law, result.asymmetric)?;
    let least = error(&better.law, better.asymmetric)?;
    let (own, other) = (&result.law, &better.law);
    Some(Cured {
        what: format!(
            "{own} holds worse than {other} ({mine} against {least} on held-out samples). Where the shape of {other} led here, both \
             are tried and neither is that of the axis: compensate with the result of {other} (without one: {back}), and look for what is left in the \
             drive train, in the instants of force and position or in forces that the log has not, rather than in another law. \
             To compensate with this law all the same"
        ),
        line: None,
        command: command(result, dir),
        ends: true,
    })
}

/// What takes the cause of what the law leaves into the fit, where something does.
fn cured(result: &ResultFile, dir: &Path) -> Option<Cured> {
    let cause = result.trust.cause.as_ref()?;
    let dir: &Path = &dir.components().collect::<PathBuf>();
    let logs = logs(result);
    let out = |suffix: &str| quoted(&format!("{}-{suffix}", text(dir)));
    Some(match cause.cure.as_ref()? {
        Cure::Law { law } => {
            let axis = axis_option(result);
            let out = out(law);
            let sides = match result.asymmetric {
                true => " --asymmetric",
                false => "",
            };
            let plan = plan_option(result);
            Cured {
                what: format!("{}; try the law {law}", cause.text),
                line: None,
                command: format!(
                    "stiction identify{logs}{axis} --law {law}{sides}{plan} --out {out}"
                ),
                ends: false,
            }
        }
        Cure::Line {
            table,
            line,
            replaces,
        } => {
            let (file, place) = match &result.axis.file {
                Some(file) => (quoted(file), format!("in {file}, under [{table}]")),
                None => {
                    let file = new_axis_file(Path::new(&result.inputs.first()?.path));
                    let place = format!("in a new file {file}, under a line [{table}]");
                    (file, place)
                }
            };
            let law = format!("{}{}{}", law(result), method(result), plan_option(result));
            let key = line.split(' ').next().unwrap_or_default();
            let out = out(key);
            let write = match replaces {
                true => format!("in place of the line {key}, write"),
                false => "write".into(),
            };
            Cured {
                what: format!(
                    "{}; {}: {place}, {write}",
                    cause.text,
                    aim(table, cause.code)
                ),
                command: format!("stiction identify{logs} --axis {file}{law} --out {out}"),
                line: Some(Line {
                    file,
                    table: table.clone(),
                    text: line.clone(),
                    replaces: *replaces,
                    begins: result.axis.file.is_none(),
                }),
                ends: false,
            }
        }
    })
}

/// What a line of a table of the axis file is for.
fn aim(table: &str, cause: Code) -> &'static str {
    match (table, cause) {
        ("log", Code::ClocksApart) => "fit the part in which they hardly do",
        ("log", _) => "fit the part where it has settled",
        ("columns", _) => "scale it",
        _ => "take that into the fit",
    }
}

/// The law that holds better than the one that was asked for.
fn better(result: &ResultFile, dir: &Path) -> Option<Cured> {
    let better = result.trust.better.as_ref()?;
    let dir: &Path = &dir.components().collect::<PathBuf>();
    let (logs, axis) = (logs(result), axis_option(result));
    let law = &better.law;
    let (option, suffix) = match better.asymmetric {
        true => (" --asymmetric", "-asymmetric"),
        false => ("", ""),
    };
    let out = quoted(&format!("{}-{law}{suffix}", text(dir)));
    Some(Cured {
        what: format!("the law {law} holds better on held-out samples"),
        line: None,
        command: format!("stiction identify{logs}{axis} --law {law}{option} --out {out}"),
        ends: false,
    })
}

/// The logs as arguments; none where they are those that the axis file lists, with what it says of their parts.
fn logs(result: &ResultFile) -> String {
    match result.axis.listed {
        true => String::new(),
        false => {
            let typed = |path: &str| format!(" {}", quoted(path));
            result.inputs.iter().map(|i| typed(&i.path)).collect()
        }
    }
}

/// The axis file as an option, where there is one.
fn axis_option(result: &ResultFile) -> String {
    let file = result.axis.file.as_ref();
    file.map_or(String::new(), |file| format!(" --axis {}", quoted(file)))
}

/// The law as it was asked for; nothing where the data chose it.
fn law(result: &ResultFile) -> String {
    match (result.law_chosen_by.as_str(), result.asymmetric) {
        ("user", true) => format!(" --law {} --asymmetric", result.law),
        ("user", false) => format!(" --law {}", result.law),
        _ => String::new(),
    }
}

/// The method, where it is not the usual one.
fn method(result: &ResultFile) -> String {
    match result.method.as_str() {
        "separable" => String::new(),
        other => format!(" --method {other}"),
    }
}

/// The plan that it was compared with.
fn plan_option(result: &ResultFile) -> String {
    let plan = result.planned.as_ref();
    plan.map_or(String::new(), |plan| {
        format!(" --plan {}", quoted(&plan.path))
    })
}

/// The command that leads on from the result in a folder.
pub(crate) fn command(result: &ResultFile, dir: &Path) -> String {
    // Without a slash or a dot at its end, to which a suffix would be added.
    let dir: &Path = &dir.components().collect::<PathBuf>();
    let folder = quoted_path(dir);
    let another = |suffix: &str| quoted(&format!("{}-{suffix}", text(dir)));
    let next = result.trust.next;
    let typed = |path: &String| format!(" {}", quoted(path));
    let mut log: String = match next {
        Next::IdentifyTheOther | Next::CheckTheOther => {
            result.trust.other.iter().map(typed).collect()
        }
        Next::FirstLog => (result.inputs.iter().take(1))
            .map(|i| typed(&i.path))
            .collect(),
        _ => logs(result),
    };
    log.push_str(&axis_option(result));
    let as_asked = format!("{}{}", law(result), method(result));
    let plan = plan_option(result);
    match next {
        Next::Export => {
            let model = quoted_path(&dir.join("model.toml"));
            let code = quoted_path(&free_folder(&dir.join("c")));
            let cycle = cycle_option(result.rate_hz());
            format!("stiction export {model} --target c{cycle} --out {code}")
        }
        Next::AnotherLaw => better(result, dir).map_or_else(
            || format!("stiction identify{log} --out {}", another("auto")),
            |better| better.command,
        ),
        Next::LetTheDataChoose => {
            format!("stiction identify{log}{plan} --out {}", another("auto"))
        }
        Next::IdentifyTheOther => {
            format!(
                "stiction identify{log}{as_asked} --out {}",
                another("other")
            )
        }
        Next::FirstLog => format!(
            "stiction identify{log}{as_asked} --out {}",
            another("first")
        ),
        Next::Simulate => format!(
            "stiction identify{log} --method output-error --out {}",
            another("simulated")
        ),
        Next::AxisFile => match &result.axis.file {
            Some(_) => {
                let again = text(dir).ends_with("-corrected");
                let out = if again { folder } else { another("corrected") };
                format!("stiction identify{log}{as_asked}{plan} --out {out}")
            }
            None => format!(
                "stiction check{log} --init {}",
                new_axis_file(Path::new(&result.inputs[0].path))
            ),
        },
        Next::Check | Next::CheckTheOther => format!("stiction check{log}"),
        Next::Record => {
            if result.method == "presliding-step" {
                let out = another("again");
                return format!(
                    "stiction identify{log} --method presliding-step --static {ANOTHER_LOG} --out {out}"
                );
            }
            format!(
                "stiction identify {ANOTHER_LOG}{}{as_asked} --out {}",
                axis_option(result),
                another("again")
            )
        }
        Next::Again | Next::Finish => {
            format!("stiction identify{log}{as_asked}{plan} --out {folder}")
        }
    }
}

/// The command that plans the motion which would settle what the logs leave open; `None` where they leave nothing open that a plan is
/// made for, or the axis file does not say what the axis may do.
pub(crate) fn planned(result: &ResultFile, dir: &Path) -> Option<String> {
    let axis = result.axis.file.as_ref().filter(|_| result.axis.limits)?;
    let mut open = result.parameters.iter().filter(|p| !p.identifiable);
    let settles = |name: &str| PLANNED.iter().any(|own| name.starts_with(own));
    let is_fit = result.method == "separable";
    // What has to be read in another way first says nothing of the axis.
    if matches!(result.trust.next, Next::AxisFile | Next::FirstLog) {
        return None;
    }
    // What these leave open no motion settles.
    let of_the_drive_train = [Code::Resonance, Code::Backlash, Code::UnmodelledDynamics];
    let cause = result.trust.cause.as_ref();
    if cause.is_some_and(|cause| of_the_drive_train.contains(&cause.code)) {
        return None;
    }
    // Or where a plan promised less.
    let mut beside = result.planned.iter().flat_map(|plan| &plan.parameters);
    let wider = beside.any(|p| p.status == "wider");
    if !is_fit || !(wider || open.any(|p| settles(&p.name))) {
        return None;
    }
    let known = match result.inputs.as_slice() {
        [log] => format!(" --log {}", quoted(&log.path)),
        _ => format!(" --model {}", quoted_path(&dir.join("model.toml"))),
    };
    let dir: &Path = &dir.components().collect::<PathBuf>();
    let out = quoted(&format!("{}-plan", text(dir)));
    let law = match result.asymmetric {
        true => " --asymmetric",
        false => "",
    };
    Some(format!(
        "stiction plan {}{known}{law} --out {out}",
        quoted(axis)
    ))
}

/// What the names of parameters begin with that a motion is planned for.
const PLANNED: [&str; 10] = [
    "sigma0",
    "sigma1",
    "sigma2",
    "coulomb",
    "static",
    "stribeck_velocity",
    "mass",
    "gravity_",
    "cogging",
    "quadratic_viscous",
];

/// The command that runs a study of the result in a folder.
pub(crate) fn simulate(study: &Path, dir: &Path) -> String {
    let [study, out] = [study.to_path_buf(), dir.join("study")];
    let [study, out] = [study, out].map(|path| quoted_path(&path));
    format!("stiction simulate {study} --out {out}")
}

/// An argument as a shell takes it.
pub(crate) fn argument(text: &str) -> String {
    match text.strip_prefix('-') {
        // An option stays one.
        Some(_) if text.chars().all(plain) => text.to_string(),
        // One with its value too, which a path that begins with a dash is not.
        Some(rest) if rest.starts_with('-') && text.contains('=') => {
            quoted(text).replacen("./-", "-", 1)
        }
        _ => quoted(text),
    }
}
