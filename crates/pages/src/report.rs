//! `report.html`: an identification as a person reads it.

mod comparison;
mod dependences;
mod drift;
mod elements;
mod figures;
mod formula;
mod ladder;
mod plan;
mod procedure;
mod reproduction;
mod robot;
mod searched;
mod sign;
mod simulation;
pub(crate) mod study;
mod tables;

use crate::glossary::explained;
use crate::inputs;
use crate::names::{chosen_by, is_of_the_counts, law_of, without_offset};
use crate::next;
use crate::trust::{compensation, constants, why_not};
use std::path::Path;
use stiction_files::Warning;
use stiction_files::compare_file::CompareFile;
use stiction_files::result::{Action, Input, Origin, ResultFile};
use stiction_number::Percent;
use stiction_report::{Block, Callout, Document, KeyFigure, Severity, Text, number};
use stiction_workflows::drift::DriftOutcome;
use stiction_workflows::identify::Outcome;
use stiction_workflows::plan::Planned;
use stiction_workflows::reproduce::Reproduction;
use stiction_workflows::robot::RobotOutcome;
use stiction_workflows::study::StudyOutcome;

/// The report of one identification.
pub fn identification(outcome: &Outcome) -> Document {
    identification_in(outcome, Path::new("result"))
}

/// The same of a result that goes into a folder, by which its commands call those that follow.
pub fn identification_in(outcome: &Outcome, folder: &Path) -> Document {
    explained(sections(outcome, folder))
}

/// The report of a comparison of searches.
pub fn comparison(file: &CompareFile) -> Document {
    explained(comparison::comparison(file))
}

/// The report of friction over time.
pub fn drift(outcome: &DriftOutcome) -> Document {
    explained(drift::drift(outcome))
}

/// The report of a study.
pub fn study(outcome: &StudyOutcome) -> Document {
    explained(study::study(outcome))
}

/// The report of a planned motion.
pub fn plan(planned: &Planned) -> Document {
    explained(plan::plan(planned))
}

/// The report of reproduced experiments.
pub fn reproduction(outcome: &Reproduction) -> Document {
    explained(reproduction::reproduction(outcome))
}

/// The report of a robot whose files go into a folder, by which its commands call those that follow.
pub fn robot(outcome: &RobotOutcome, folder: &Path) -> Document {
    explained(robot::robot(outcome, folder))
}

/// An identification, section by section.
fn sections(outcome: &Outcome, folder: &Path) -> Document {
    let result = &outcome.result;
    let name = result.axis.name.clone().unwrap_or_else(|| {
        result
            .inputs
            .first()
            .map_or_else(String::new, |i| file_name(&i.path))
    });
    let law = law_of(result);
    let mut document = Document::new(format!("Friction of {name}"))
        .subtitle(format!(
            "{law}{}, identified from {}",
            chosen_by(&result.law_chosen_by),
            logs(result.inputs.len())
        ))
        .footer(format!(
            "stiction {} · method {} · seed {} · {} evaluations",
            result.version, result.method, result.seed, result.search.evaluations
        ));
    let [use_it, constants] = verdicts(outcome);
    document = document.block(use_it);
    for input in &result.inputs {
        for callout in of_input(input) {
            document = document.block(callout);
        }
    }
    document = document.paragraph(next_step(result, folder));
    // A static map and a step response have no force for each sample.
    let sampled = matches!(result.method.as_str(), "separable" | "static-then-dynamic")
        || result.searched.is_some();
    document = match outcome.simulation() {
        Some(simulated) => simulation::sections(document, outcome, simulated),
        None if sampled => measured_force(document, outcome),
        None => document,
    };
    for block in procedure::sections(outcome) {
        document = document.block(block);
    }
    document = document
        .block(Block::KeyFigures(key_figures(outcome)))
        .heading(2, "Parameters")
        .block(tables::parameters(outcome))
        .block(constants);
    if !outcome.truth.is_empty() {
        document = document.block(tables::truth(outcome));
    }
    document = document.block(formula::with_numbers(outcome));
    if !result.warnings.is_empty() {
        document = document.heading(2, "Warnings");
        for warning in &result.warnings {
            document = document.block(callout(warning));
        }
    }
    if !result.laws.is_empty() {
        document = document
            .heading(2, "Which law")
            .block(tables::laws(outcome));
        if let Some(note) = without_offset(&result.laws) {
            document = document.paragraph(note);
        }
        document = document.block(ladder::figure(outcome));
    }
    if !result.elements.is_empty() {
        document = document
            .heading(2, "How many elements")
            .block(elements::tried(outcome));
    }
    if sampled {
        document = how_sure(document, outcome);
    } else {
        document = document
            .heading(2, "How sure")
            .block(figures::correlation(outcome));
    }
    for block in searched::sections(outcome) {
        document = document.block(block);
    }
    document = document.heading(2, "What was read, and how it was conditioned");
    for input in &result.inputs {
        document = document.block(tables::input(input));
    }
    document.block(Block::List(
        result
            .axis
            .conditioning
            .iter()
            .map(|note| Text::from(note.as_str()))
            .collect(),
    ))
}

/// The figures of a fit of the force.
fn measured_force(mut document: Document, outcome: &Outcome) -> Document {
    document = document
        .heading(2, "Force in time")
        .block(figures::time(outcome))
        .heading(2, "Friction and velocity")
        .block(figures::velocity_map(outcome));
    let close: Vec<Block> = [
        figures::friction_curve(outcome),
        figures::level_along(outcome),
        figures::low_speed(outcome),
        figures::presliding(outcome),
        figures::residual_over_position(outcome),
        elements::virgin(outcome),
    ]
    .into_iter()
    .flatten()
    .map(Block::from)
    .collect();
    if !close.is_empty() {
        document = document.block(Block::Columns(close));
    }
    if !outcome.validation.is_empty() {
        document = document
            .heading(2, "Validation")
            .block(tables::validation(outcome));
        for (path, series) in &outcome.validation {
            document = document.block(figures::validation(outcome, path, series));
        }
    }
    document
}

/// What the residual tells, and how the parameters are correlated.
fn how_sure(document: Document, outcome: &Outcome) -> Document {
    let mut document = document.heading(2, "How sure").paragraph(sureness(outcome));
    if let Some(left) = figures::left(outcome) {
        document = document.block(left);
    }
    let mut side_by_side = vec![figures::autocorrelation(outcome).into()];
    // A single evaluation does not converge.
    if outcome.law().history.len() > 1 {
        side_by_side.push(figures::convergence(outcome).into());
    }
    document
        .block(Block::Columns(side_by_side))
        .block(figures::correlation(outcome))
}

/// A warning as a page shows it.
fn callout(warning: &Warning) -> Callout {
    Callout {
        severity: Severity::Warning,
        code: warning.code.to_string(),
        text: Text::of_message(&warning.message),
        link: String::new(),
    }
}

/// What has to be known of a log before its results.
fn of_input(input: &Input) -> Vec<Callout> {
    let said = |severity, text: String| Callout {
        severity,
        code: String::new(),
        text: Text::of_message(&format!("{}: {text}", file_name(&input.path))),
        link: String::new(),
    };
    let assumed = inputs::assumed(input)
        .map(|(text, lines)| said(Severity::Warning, format!("{text} {}", lines.join("; "))));
    let left_out = [inputs::not_enabled(input), inputs::left_out(input)];
    let left_out = left_out.into_iter().flatten();
    let left_out = left_out.map(|text| said(Severity::Info, text));
    assumed.into_iter().chain(left_out).collect()
}

/// What the result may be used for: to compensate, and as constants of the machine.
fn verdicts(outcome: &Outcome) -> [Callout; 2] {
    let result = &outcome.result;
    let trust = &result.trust;
    let seen = trust.compensation.as_ref().map(|seen| {
        let seen = compensation(seen, result);
        format!(" The law {seen}.")
    });
    let seen = seen.unwrap_or_default();
    let (use_it, text) = match trust.trustworthy {
        true => (
            match trust.cause {
                None => Severity::Good,
                Some(_) => Severity::Info,
            },
            format!(
                "May be used to compensate friction on motion like that of the logs{}.{seen}",
                trust.cause.as_ref().map_or(String::new(), |cause| format!(
                    ", though {}",
                    crate::trust::cause(cause)
                ))
            ),
        ),
        false => (
            Severity::Error,
            format!("Do not compensate with this law: {}.{seen}", why_not(trust)),
        ),
    };
    let known = match (trust.constants.is_empty(), trust.open.is_empty()) {
        (_, true) => Severity::Good,
        (true, false) => Severity::Warning,
        (false, false) => Severity::Info,
    };
    let symbol = |name: &str| {
        let of_name = result.parameters.iter().find(|p| p.name == name);
        of_name.map_or(name, |p| p.symbol.as_str()).to_string()
    };
    let callout = |severity, text: &str| Callout {
        severity,
        code: String::new(),
        text: Text::of_message(text),
        link: String::new(),
    };
    [
        callout(use_it, &text),
        callout(
            known,
            &format!("Constants of the machine: {}.", constants(result, symbol)),
        ),
    ]
}

/// The command that leads on.
fn next_step(result: &ResultFile, folder: &Path) -> Text {
    let next = &result.trust.next;
    // It was typed with options that a result does not keep.
    if matches!(next, Action::Again | Action::Finish) {
        return format!("Next: {}.", next::why(next)).into();
    }
    let next::Steps { first, or } = next::steps(result, folder, |name| name.into());
    let said = |step: next::Step| {
        let line = step.line.as_ref().map_or(String::new(), |line| {
            format!(": {}", line.text.replace('\n', " and "))
        });
        // The report does not depend on where it is written.
        let (there, command) = match step.action {
            Action::Export => (
                "In the folder of this report",
                next::command(&Action::Export, result, Path::new(""), |name| name.into()),
            ),
            _ => ("In the folder it was identified in", step.command),
        };
        (format!("{}{line}. {there}: ", step.what), command)
    };
    let (what, command) = said(first);
    let step = Text::from(format!("Next: {what}")).code(command);
    match or.map(said) {
        Some((what, command)) => step.plain(format!(" Or: {what}")).code(command),
        None => step,
    }
}

fn key_figures(outcome: &Outcome) -> Vec<KeyFigure> {
    let result = &outcome.result;
    let fit = &result.fit;
    let mut out = vec![
        KeyFigure::new(
            "Relative error",
            Percent::error(fit.relative_error_percent).digits(3),
            "",
        )
        .note(match &result.simulation {
            None => "100 rms(residual) / rms(measured)",
            Some(_) => "100 rms(residual) / rms(position about its mean)",
        }),
        KeyFigure::new("Residual", number::sig(fit.rmse, 3), fit.unit.as_str()).note(format!(
            "rms, R² {}",
            number::r_squared(fit.r2.unwrap_or(f64::NAN)).replace('-', "−")
        )),
    ];
    if let Some(low) = &result.low_speed {
        out.push(
            KeyFigure::new(
                "Near zero speed",
                number::sig(low.fit.rmse, 3),
                fit.unit.as_str(),
            )
            .note(format!(
                "rms below {} {}",
                number::sig(low.bound, 3),
                low.bound_unit
            )),
        );
    }
    if let Some(v) = result.validation.last() {
        out.push(
            KeyFigure::new(
                "On unseen data",
                number::sig(v.fit.rmse, 3),
                fit.unit.as_str(),
            )
            .note(format!(
                "rms, {}",
                Percent::error(v.fit.relative_error_percent).digits(3)
            )),
        );
    }
    let total = result
        .parameters
        .iter()
        .filter(|p| p.origin == Origin::Identified)
        .count();
    let known = result
        .parameters
        .iter()
        .filter(|p| p.origin == Origin::Identified && p.identifiable)
        .count();
    out.push(
        KeyFigure::new("Identifiable", format!("{known} of {total}"), "")
            .note("interval of another day within ±20 % of the value, of levels within ±20 % of the Coulomb level"),
    );
    out
}

fn sureness(outcome: &Outcome) -> String {
    if is_of_the_counts(&outcome.result) {
        return "Parameters and intervals are those of an axis that is simulated under the logged force and compared with the counts of \
                the encoder: the wider of what the likelihood of the counts states and what leaving out each twentieth of the log in \
                turn shows. The residual is that of the fit of the force, which they do not come from."
            .into();
    }
    let fit = &outcome.result.fit;
    let worth = fit.effective_samples.max(0.0) as usize;
    let resembles = match worth < fit.samples {
        true => "neighbouring residuals resemble each other, and the intervals count that",
        false => "neighbouring residuals do not resemble each other",
    };
    format!(
        "The residual is worth about {} independent samples of {}: {resembles}. What is left outside the \
         band in the autocorrelation is friction, cogging or dynamics that the law does not describe.",
        number::count(worth as u64),
        number::count(fit.samples as u64)
    )
}

fn logs(n: usize) -> String {
    if n == 1 {
        "one log".into()
    } else {
        format!("{n} logs")
    }
}

fn file_name(path: &str) -> String {
    std::path::Path::new(path)
        .file_name()
        .map_or_else(|| path.to_string(), |n| n.to_string_lossy().into_owned())
}
