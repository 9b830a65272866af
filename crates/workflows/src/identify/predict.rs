//! The force that a fitted law predicts for another log.

use super::conditioning::conditioned;
use super::load::check_together;
use super::outcome::{Found, Outcome};
use crate::entries;
use crate::error::Error;
use crate::source::Source;
use stiction_files::result::FitEntry;
use stiction_identify as engine;
use stiction_identify::{Conditioning, Cutoff, Fit, Series};
use stiction_number::short;

/// The force that a fitted law predicts for a log.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Prediction {
    /// The signals at the samples that count: time in s, position, velocity, measured and modelled force.
    pub series: Series,
    /// How well the law predicts them.
    pub quality: FitEntry,
}

/// Predicts the force along another log, conditioned as those that were fitted; nothing is fitted again.
///
/// # Errors
/// Where the log is of another kind of axis or lacks a channel that the law needs, and after a method that does not model
/// the force sample by sample.
pub fn predict(outcome: &Outcome, log: &Source) -> Result<Prediction, Error> {
    let Found::Force(fitted) = &outcome.found else {
        return Err(Error::usage(
            format!(
                "the method {} does not model the force sample by sample",
                outcome.result.method
            ),
            "predict with a fit of separable, static-then-dynamic or a search; output-error simulates the logs that it is to be \
             validated on",
        ));
    };
    // A log may be predicted that was fitted: only the kinds of axis must agree.
    let first = &outcome.sources[0];
    if first.sha256 != log.sha256 {
        check_together(std::slice::from_ref(first), std::slice::from_ref(log))?;
    }
    log.check_channels(&fitted.estimate.terms)?;
    if first.log.external.is_some() && log.log.external.is_none() {
        return Err(Error::usage(
            format!("{}: no force from outside, and the fit has one", log.name()),
            "a log with a column of what acts from outside; a joint of a robot is predicted with the whole robot: stiction robot --validate",
        ));
    }
    check_rate(&fitted.conditioning, log)?;
    let record = conditioned(std::slice::from_ref(log), &fitted.conditioning)?;
    // A law with elements depends on past motion: it is judged from where the start no longer has an effect.
    let record = match fitted.estimate.law.kind.has_elements() {
        true => record.settled(),
        false => record,
    };
    let series = engine::predict(&record, &fitted.estimate);
    let quality = Fit::new(&series.measured, &series.residual()).ok_or_else(|| {
        let source = engine::Error::NoForce { value: 0.0 };
        Error::identify(log.path.display().to_string(), source)
    })?;
    let quality = entries::fit(&quality, "force", &outcome.force_unit);
    Ok(Prediction { series, quality })
}

/// Refuses a log that is sampled too slowly for the filters of the fit.
fn check_rate(conditioning: &Conditioning, log: &Source) -> Result<(), Error> {
    let cutoffs = [conditioning.source_cutoff, conditioning.common_cutoff];
    let hertz = cutoffs.into_iter().filter_map(|cutoff| match cutoff {
        Cutoff::Hz(frequency) => Some(frequency),
        Cutoff::Auto | Cutoff::Off => None,
    });
    let highest = hertz.fold(0.0, f64::max);
    let rate = log.log.rate_hz;
    if rate > 2.0 * highest {
        return Ok(());
    }
    Err(Error::usage(
        format!(
            "{} has {} samples a second, and the fit filters at {} Hz",
            log.path.display(),
            short(rate),
            short(highest)
        ),
        format!(
            "a log with more than {} samples a second, or a fit with lower cut-offs under [conditioning] of the axis file",
            short(2.0 * highest)
        ),
    ))
}
