//! What to do next, as a sentence and a command to type.

use std::path::{Path, PathBuf};
use stiction_codes::Code;
use stiction_files::result::{Action, BetterLaw, ResultFile};
pub use stiction_files::shell::axis_file;
use stiction_files::shell::{
    cycle_option, free_folder, new_axis_file, plain, quoted, quoted_path, text,
};
use stiction_identify::LawKind;
use stiction_number::Percent;

/// What a log that is still to be recorded is called in commands.
pub(crate) const ANOTHER_LOG: &str = "another.csv";

/// What an action is for.
#[rustfmt::skip] // One line a sentence.
pub fn why(action: &Action) -> &'static str {
    match action {
        Action::Export => "the compensator as C; also cpp, ros2, st, tcpou, plcopen, rust, mujoco, modelica, urdf, sdf, isaaclab, newton, bam, domain-json, hal, fmu, matlab, tf5200 and drive-table",
        Action::LetTheDataChoose => "let the data choose the law",
        Action::Law { .. } => "the best of the laws above that a compensator may rely on",
        Action::Identify { logs } if logs.is_empty() => "identify the log",
        Action::Identify { .. } => "what the other log says by itself, to compare the parameters",
        Action::Check { logs } if logs.is_empty() => "see what the log shows, and what motion to record instead",
        Action::Check { .. } => "see what the other log shows, from which nothing can be identified",
        Action::FirstLog => "the first log by itself, then the others likewise",
        Action::Listed => "all logs that the axis file lists",
        Action::Simulate => "fit the simulated position instead, which needs no differentiation",
        Action::Line { .. } | Action::Remove { .. } | Action::AxisFile => "correct the axis file as said above",
        Action::Record => "record another log with the motion that is named above (docs/procedures.md), then",
        Action::Again => "the same again, to the end",
        Action::Finish => "the same without --no-finish: least squares after the search give intervals",
    }
}

/// What to do, with the command that does it.
pub(crate) struct Step {
    /// What it does.
    pub action: Action,
    /// Why, and what to do.
    pub what: String,
    /// The line to write into the axis file first.
    pub line: Option<Line>,
    /// The command.
    pub command: String,
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

impl Line {
    /// Where to write it.
    pub fn place(&self) -> String {
        let Self { file, table, .. } = self;
        match (self.begins, self.replaces) {
            (true, _) => format!("write a new file {file}:\n    [{table}]"),
            (false, true) => format!(
                "in {file}, in place of the line {}, write",
                Action::key(&self.text)
            ),
            (false, false) => format!("in {file}, under [{table}], write"),
        }
    }
}

/// Where a command writes: into the folder of this name, or one beside it that is free.
pub(crate) type Place = fn(&str) -> PathBuf;

/// A folder that is free, so that a command that is pasted replaces nothing.
pub(crate) fn free(name: &str) -> PathBuf {
    free_folder(Path::new(name))
}

/// What leads on from a result.
pub(crate) struct Steps {
    /// What to do.
    pub first: Step,
    /// What else may be done with a result that may be used as it is.
    pub or: Option<Step>,
}

/// What leads on from the result in a folder: what the cause of the error, or a better law, asks for before what the verdict does.
pub(crate) fn steps(result: &ResultFile, dir: &Path, place: Place) -> Steps {
    let step = |what: String, action: &Action| Step {
        action: action.clone(),
        what,
        line: line(action, result),
        command: command(action, result, dir, place),
    };
    let trust = &result.trust;
    let own = || step(why(&trust.next).into(), &trust.next);
    let (first, ends) = if let Some(what) = tried(result, dir, place) {
        (Some(step(what, &trust.next)), true)
    } else if let Some(better) = &trust.better {
        let what = format!("the law {} has a smaller held-out error", better.law);
        (Some(step(what, &of_law(better))), false)
    } else if let Some((cause, cure)) = trust
        .cause
        .as_ref()
        .and_then(|cause| Some((cause, cause.cure.as_ref()?)))
    {
        let what = match cure {
            Action::Law { law, .. } => format!("try the law {law}"),
            Action::Line { table, .. } => aim(table, cause.code).into(),
            other => why(other).into(),
        };
        (Some(step(format!("{}; {what}", cause.text), cure)), false)
    } else {
        (None, true)
    };
    let Some(first) = first else {
        let (first, or) = (own(), None);
        return Steps { first, or };
    };
    // One more pitch is worth little: a result that may be used is used, or the steps never end.
    let is_more = first
        .line
        .as_ref()
        .is_some_and(|line| line.replaces && PITCHES.contains(&Action::key(&line.text)));
    match trust.trustworthy && !ends {
        true if is_more => Steps {
            first: own(),
            or: Some(first),
        },
        uses => Steps {
            first,
            or: uses.then(own),
        },
    }
}

/// Keys of the axis file that list pitches.
const PITCHES: [&str; 2] = ["cogging", "coulomb_pitch"];

/// Where elements were asked for and one bristle predicts better: what the shape of one bristle leads to is then no better than it, and
/// a command that leads back would go round in a circle.
fn tried(result: &ResultFile, dir: &Path, place: Place) -> Option<String> {
    let better = result.trust.better.as_ref()?;
    let [own, other] = [&result.law, &better.law].map(|name| LawKind::from_name(name));
    if !result.trust.trustworthy || !own?.has_elements() || other?.has_elements() {
        return None;
    }
    let error = |name: &str, asymmetric: bool| {
        let mut laws = result.laws.iter();
        let law = laws.find(|law| law.law == name && law.asymmetric == asymmetric)?;
        Some(Percent::error(law.held_out_error_percent?).decimals(2))
    };
    let mine = error(&result.law, result.asymmetric)?;
    let least = error(&better.law, better.asymmetric)?;
    let (own, other) = (&result.law, &better.law);
    let back = command(&of_law(better), result, dir, place);
    Some(format!(
        "{own} has a larger held-out error than {other} ({mine} against {least}). Both are tried and neither has the shape of this friction: \
         compensate with the result of {other} (without one: {back}), and look for the rest in the drive train, in the time stamps or in \
         forces that the log has not. To compensate with {own} all the same"
    ))
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

/// Identifies with a law that predicts better than the one that was asked for.
fn of_law(better: &BetterLaw) -> Action {
    Action::Law {
        law: better.law.clone(),
        asymmetric: better.asymmetric,
    }
}

/// The axis file, or the one to be begun.
fn file_of(result: &ResultFile) -> String {
    let begun = || result.inputs.first().map(|i| Path::new(&i.path));
    match &result.axis.file {
        Some(file) => quoted(file),
        None => begun().map_or(String::new(), new_axis_file),
    }
}

fn line(action: &Action, result: &ResultFile) -> Option<Line> {
    let Action::Line {
        table,
        line,
        replaces,
    } = action
    else {
        return None;
    };
    Some(Line {
        file: file_of(result),
        table: table.clone(),
        text: line.clone(),
        replaces: *replaces,
        begins: result.axis.file.is_none(),
    })
}

/// The logs as arguments; none where they are those that the axis file lists, with what it says of their parts.
fn logs(result: &ResultFile) -> String {
    match result.axis.listed {
        true => String::new(),
        false => typed(result.inputs.iter().map(|input| &input.path)),
    }
}

fn typed<'a>(paths: impl Iterator<Item = &'a String>) -> String {
    paths.map(|path| format!(" {}", quoted(path))).collect()
}

/// An option, where it has a value.
fn option(name: &str, value: Option<&String>) -> String {
    value.map_or(String::new(), |value| {
        format!(" --{name} {}", quoted(value))
    })
}

/// A law as options.
fn law_option(law: &str, asymmetric: bool) -> String {
    let sides = if asymmetric { " --asymmetric" } else { "" };
    format!(" --law {law}{sides}")
}

/// The command of an action on the result in a folder.
pub(crate) fn command(action: &Action, result: &ResultFile, dir: &Path, place: Place) -> String {
    // Without a slash or a dot at its end, to which a suffix would be added.
    let dir: &Path = &dir.components().collect::<PathBuf>();
    let own = logs(result);
    let axis = option("axis", result.axis.file.as_ref());
    let plan = option("plan", result.planned.as_ref().map(|plan| &plan.path));
    let law = match result.law_chosen_by.as_str() {
        "user" => law_option(&result.law, result.asymmetric),
        _ => String::new(),
    };
    let asked = match result.method.as_str() {
        "separable" => law,
        other => format!("{law} --method {other}"),
    };
    let into = |suffix: &str| quoted_path(&place(&format!("{}-{suffix}", text(dir))));
    let identify = |logs: &str, axis: &str, how: &str, out: &str| {
        format!("stiction identify{logs}{axis}{how} --out {out}")
    };
    match action {
        Action::Export => {
            let model = quoted_path(&dir.join("model.toml"));
            let code = quoted_path(&place(&text(&dir.join("c"))));
            let cycle = cycle_option(result.rate_hz());
            format!("stiction export {model} --target c{cycle} --out {code}")
        }
        Action::Law { law, asymmetric } => {
            let sides = if *asymmetric { "-asymmetric" } else { "" };
            let how = format!("{}{plan}", law_option(law, *asymmetric));
            identify(&own, &axis, &how, &into(&format!("{law}{sides}")))
        }
        Action::LetTheDataChoose => identify(&own, &axis, &plan, &into("auto")),
        Action::Identify { logs } => identify(&typed(logs.iter()), &axis, &asked, &into("other")),
        Action::FirstLog => {
            let first = typed(result.inputs.iter().take(1).map(|input| &input.path));
            identify(&first, &axis, &asked, &into("first"))
        }
        Action::Simulate => identify(&own, &axis, " --method output-error", &into("simulated")),
        Action::Line { line, .. } => {
            let axis = format!(" --axis {}", file_of(result));
            let how = format!("{asked}{plan}");
            identify(&own, &axis, &how, &into(Action::key(line)))
        }
        Action::AxisFile if result.axis.file.is_none() => {
            format!("stiction check{own} --init {}", file_of(result))
        }
        Action::AxisFile | Action::Remove { .. } => {
            let out = match text(dir).ends_with("-corrected") {
                true => quoted_path(dir),
                false => into("corrected"),
            };
            identify(&own, &axis, &format!("{asked}{plan}"), &out)
        }
        Action::Check { logs } => match logs.is_empty() {
            true => format!("stiction check{own}{axis}"),
            false => format!("stiction check{}{axis}", typed(logs.iter())),
        },
        Action::Record if result.method == "presliding-step" => {
            let how = format!(" --method presliding-step --static {ANOTHER_LOG}");
            identify(&own, &axis, &how, &into("again"))
        }
        Action::Record => identify(&format!(" {ANOTHER_LOG}"), &axis, &asked, &into("again")),
        Action::Listed | Action::Again | Action::Finish => {
            identify(&own, &axis, &format!("{asked}{plan}"), &quoted_path(dir))
        }
    }
}

/// The command that plans the motion which would settle what the logs do not determine; `None` where they determine all that a plan is
/// made for, or the axis file does not say what the axis may do.
pub(crate) fn planned(result: &ResultFile, dir: &Path) -> Option<String> {
    let axis = result.axis.file.as_ref().filter(|_| result.axis.limits)?;
    let mut open = result.parameters.iter().filter(|p| !p.identifiable);
    let settles = |name: &str| PLANNED.iter().any(|own| name.starts_with(own));
    let is_fit = result.method == "separable";
    // What has to be read in another way first says nothing of the axis.
    if matches!(result.trust.next, Action::AxisFile | Action::FirstLog) {
        return None;
    }
    // What these leave undetermined no motion settles.
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
