//! What the steps of an identification need of its logs: their samples, their names, what was found in them.

use crate::error::Error;
use crate::source::Source;
use stiction_codes::Code;
use stiction_files::result::Action;
use stiction_files::{Axis, Warning};
use stiction_identify as engine;
use stiction_identify::Samples;
use stiction_identify::procedure::Run;
use stiction_log::{Finding, Severity};

/// Samples of every source, for runs to borrow.
pub(super) fn samples(sources: &[Source]) -> Result<Vec<Samples>, Error> {
    sources.iter().map(Source::samples).collect()
}

/// A source as a procedure sees it.
pub(super) fn run_of<'a>(source: &'a Source, samples: &'a Samples, axis: &Axis) -> Run<'a> {
    Run {
        samples,
        reference: source.log.reference.as_deref(),
        resolution: axis.conditioning.resolution.or(source.log.quantum),
    }
}

/// An engine's refusal with the logs it is about.
pub(super) fn refused(sources: &[Source], source: engine::Error) -> Error {
    // The engine knows logs by their number; a message gives the path.
    let one = source.log().and_then(|log| sources.get(log - 1));
    let named = one.map_or(sources, std::slice::from_ref);
    let logs = paths(named);
    Error::Identify {
        inputs: logs.join(", "),
        source,
        action: Box::new(Action::Check { logs }),
    }
}

/// The path of a log by its number.
pub(super) fn path_of(sources: &[Source], log: usize) -> String {
    sources
        .get(log)
        .map_or_else(String::new, |s| stiction_files::shell::text(&s.path))
}

/// Paths as given.
pub(super) fn paths(sources: &[Source]) -> Vec<String> {
    sources
        .iter()
        .map(|s| stiction_files::shell::text(&s.path))
        .collect()
}

/// Most logs that are each named with what was found in them; of more, one stands for all.
const MOST_NAMED: usize = 3;

/// What the reader warned of, with the log it is about; what was found in many logs is said once.
pub(super) fn log_warnings(sources: &[Source]) -> Vec<Warning> {
    let mut out = Vec::new();
    let mut said: Vec<Code> = Vec::new();
    for source in sources {
        for finding in warnings_of(source) {
            if said.contains(&finding.code) {
                continue;
            }
            let same = |s: &&Source| warnings_of(s).any(|f| f.code == finding.code);
            let alike = sources.iter().filter(same).count();
            let path = source.path.display();
            if alike <= MOST_NAMED {
                let message = format!("{path}: {}", finding.message);
                out.push(Warning::new(finding.code, message));
                continue;
            }
            said.push(finding.code);
            let message = format!(
                "in {alike} of {} logs, the first {path}: {}",
                sources.len(),
                finding.message
            );
            out.push(Warning::new(finding.code, message));
        }
    }
    out
}

/// Whether the force of a log does the work of one that brakes.
pub(super) fn has_wrong_sign(source: &Source) -> bool {
    wrong_sign(source).is_some()
}

fn wrong_sign(source: &Source) -> Option<&Finding> {
    let mut findings = source.log.findings.iter();
    findings.find(|finding| finding.code == Code::ForceSign)
}

/// What makes a validation on other logs than the fitted ones worth nothing: a force of the wrong sign. All else that the reader
/// warns of matters to what is fitted alone.
pub(super) fn validation_warnings(held_out: &[Source], fitted: &[Source]) -> Vec<Warning> {
    let alike = fitted.iter().any(has_wrong_sign);
    let wrong = held_out
        .iter()
        .filter_map(|log| Some((log, wrong_sign(log)?)));
    let one = |(log, finding): (&Source, &Finding)| {
        let message = match finding.message.split_once("; ").filter(|_| !alike) {
            // The axis file is that of the fitted logs too.
            Some((found, _)) => format!(
                "{found}, and that of the fitted logs does not: turn the sign in this file, or validate on another"
            ),
            None => finding.message.clone(),
        };
        let path = log.path.display();
        Warning::new(
            Code::ForceSign,
            format!("{path}, which is not fitted: {message}"),
        )
    };
    wrong.map(one).collect()
}

fn warnings_of(source: &Source) -> impl Iterator<Item = &Finding> {
    let findings = source.log.findings.iter();
    findings.filter(|f| f.severity == Severity::Warning)
}
