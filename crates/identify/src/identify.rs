//! A law fitted to a record: the search, the delay, the estimate.

use crate::conditioning::record::Record;
use crate::error::Error;
use crate::estimate::{Estimate, estimate};
use crate::law::Law;
use crate::law::terms::{Delay, Terms};
use crate::observe::Observer;
use crate::separable::levenberg::Status;
use crate::separable::{Optimum, Settings, separable};

/// Fits a law by the separable method and states its parameters.
///
/// A fitted delay that comes to the end of its range is something else that the law does not explain:
/// it is taken as none and the law fitted again, as the terms of the estimate then say.
///
/// # Errors
/// Those of [`separable`].
pub fn identify(
    record: &Record,
    law: Law,
    terms: &Terms,
    low_speed_bound: f64,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<(Estimate, Optimum), Error> {
    let optimum = separable(record, law, terms, settings, observer)?;
    if terms.delay == Delay::Fitted
        && optimum.delay_at_bound()
        && optimum.status != Status::Interrupted
    {
        let still = Terms {
            delay: Delay::NONE,
            ..terms.clone()
        };
        let optimum = separable(record, law, &still, settings, observer)?;
        let estimate = estimate(record, law, &still, &optimum, low_speed_bound);
        return Ok((estimate, optimum));
    }
    let estimate = estimate(record, law, terms, &optimum, low_speed_bound);
    Ok((estimate, optimum))
}
