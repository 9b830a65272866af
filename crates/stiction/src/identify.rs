//! Logs to a law.

use crate::{Axis, Error, Fit, Log, Observer, Silent};
use stiction_workflows::check::Check;
use stiction_workflows::identify as workflow;

pub use stiction_workflows::identify::{Files, Options};

/// Identifies from files as the command line does: logs that the axis file lists, and parts of them, are used as it says.
///
/// # Errors
/// As [`identify`], and where a file cannot be read.
pub fn identify_files(
    files: &Files,
    options: &Options,
    observer: &mut dyn Observer,
) -> Result<Fit, Error> {
    let outcome = workflow::identify(files, options, observer)?;
    Ok(Fit { outcome })
}

/// Identifies the friction of an axis from its logs, with intervals and a verdict.
///
/// The logs have been read with the same `axis`: it also says which terms stand beside the friction law, and how the
/// logs are filtered.
///
/// # Errors
/// Where the logs do not go together, lack a channel, or nothing can be identified from them. A result that should not be
/// trusted is not an error: see [`Fit::is_trustworthy`].
pub fn identify(logs: &[Log], axis: &Axis, options: &Options) -> Result<Fit, Error> {
    identify_validated(logs, &[], axis, options)
}

/// [`identify`], with logs that are not fitted: the result says how well the law predicts them, and is not trustworthy where
/// it does not.
///
/// # Errors
/// As [`identify`].
pub fn identify_validated(
    logs: &[Log],
    validate: &[Log],
    axis: &Axis,
    options: &Options,
) -> Result<Fit, Error> {
    identify_observed(logs, validate, axis, options, &mut Silent)
}

/// [`identify_validated`], with someone who sees the progress and may stop the work; what was found by then is kept, with
/// `interrupted` as the status of the search.
///
/// # Errors
/// As [`identify`].
pub fn identify_observed(
    logs: &[Log],
    validate: &[Log],
    axis: &Axis,
    options: &Options,
    observer: &mut dyn Observer,
) -> Result<Fit, Error> {
    let sources = |logs: &[Log]| logs.iter().map(|log| log.source.clone()).collect();
    let (fitted, held_out) = (sources(logs), sources(validate));
    let outcome = workflow::identify_logs(options, axis, fitted, held_out, observer)?;
    Ok(Fit { outcome })
}

/// What was read of logs that are in memory, and what they can and cannot determine.
///
/// # Errors
/// Where the axis does not go with a log.
pub fn check(logs: &[Log], axis: &Axis, observer: &mut dyn Observer) -> Result<Check, Error> {
    let sources: Vec<_> = logs.iter().map(|log| log.source.clone()).collect();
    stiction_workflows::check::check_logs(&sources, axis, observer)
}
