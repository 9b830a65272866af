//! A force that was logged much later than its motion is taken as it belongs.

use super::load::{Asked, Loaded};
use crate::error::Error;
use crate::source::Source;
use stiction_identify::{Delay, lateness};

/// Lays force and motion beside each other, where no delay is given and whole records are fitted.
pub(super) fn aligned(asked: Asked, mut loaded: Loaded) -> Result<Loaded, Error> {
    let is_sought = asked.axis.terms.delay == Delay::Fitted;
    if !is_sought || !asked.options.procedures.method.fits_force() {
        return Ok(loaded);
    }
    let samples: Result<Vec<_>, Error> = loaded.sources.iter().map(Source::fitted).collect();
    let Some(rows) = lateness(&samples?) else {
        return Ok(loaded);
    };
    for source in loaded.sources.iter_mut().chain(&mut loaded.held_out) {
        source.log.take_force_later(rows);
    }
    Ok(loaded)
}
