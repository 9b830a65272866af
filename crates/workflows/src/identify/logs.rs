//! What the steps of an identification need of its logs: their samples, their names, what was found in them.

use crate::error::Error;
use crate::source::Source;
use stiction_codes::Code;
use stiction_files::result::Action;
use stiction_files::{Axis, Warning};
use stiction_identify as engine;
use stiction_identify::Samples;
use stiction_identify::procedure::Run;
use stiction_log::{Finding, Found, Severity};
use stiction_say::{Notice, Turn, Whose};

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
    log_warnings_but(sources, |_| false)
}

/// The same but for some kinds.
pub(super) fn log_warnings_but(
    sources: &[Source],
    passed_over: impl Fn(&Found) -> bool,
) -> Vec<Warning> {
    let mut out = Vec::new();
    let mut said: Vec<Code> = Vec::new();
    for source in sources {
        for finding in warnings_of(source) {
            if said.contains(&finding.code()) || passed_over(&finding.kind) {
                continue;
            }
            let same = |s: &&Source| warnings_of(s).any(|f| f.code() == finding.code());
            let alike = sources.iter().filter(same).count();
            let whose = match alike <= MOST_NAMED {
                true => Whose::Fitted,
                false => {
                    said.push(finding.code());
                    Whose::Many(alike, sources.len())
                }
            };
            out.push(warning(source, finding, whose));
        }
    }
    out
}

/// Whether the force of a log does the work of one that brakes, or has lost its sign.
pub(super) fn has_wrong_sign(source: &Source) -> bool {
    source.log.finds(brakes)
}

fn brakes(found: &Found) -> bool {
    matches!(found, Found::ForceBrakes { .. } | Found::Magnitude { .. })
}

/// What is said of a finding.
fn warning(source: &Source, finding: &Finding, whose: Whose) -> Warning {
    let notice = Notice::InLog {
        log: source.path.display().to_string(),
        whose,
        found: Box::new(finding.kind.clone()),
        axis_file: finding.axis_file().to_string(),
    };
    notice.into()
}

/// What makes a validation on other logs than the fitted ones worth nothing: a force of the wrong sign. All else that the reader
/// warns of matters to what is fitted alone.
pub(super) fn validation_warnings(held_out: &[Source], fitted: &[Source]) -> Vec<Warning> {
    let alike = fitted.iter().any(has_wrong_sign);
    let one = |log: &Source| {
        let finding = log.log.findings.iter().find(|own| brakes(&own.kind))?;
        let mut finding = finding.clone();
        if let (Found::ForceBrakes { turn, .. }, false) = (&mut finding.kind, alike) {
            // The axis file is that of the fitted logs too.
            *turn = Turn::Validation;
        }
        Some(warning(log, &finding, Whose::Validated))
    };
    held_out.iter().filter_map(one).collect()
}

fn warnings_of(source: &Source) -> impl Iterator<Item = &Finding> {
    let findings = source.log.findings.iter();
    findings.filter(|f| f.severity == Severity::Warning)
}
