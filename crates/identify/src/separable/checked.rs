//! Whether a record has enough samples, motion and force for a law.

use crate::conditioning::record::{Record, extent};
use crate::error::Error;
use crate::law::Law;
use crate::law::terms::Terms;
use crate::separable::objective::Objective;

/// The objective of a record with samples and force enough for this law.
pub(crate) fn checked<'a>(
    record: &'a Record,
    law: Law,
    terms: &Terms,
) -> Result<Objective<'a>, Error> {
    terms.check(record)?;
    let unknowns = law.nonlinear() + terms.columns(&law).len();
    if record.kept() < 10 * unknowns {
        return Err(Error::TooFewSamples {
            found: record.kept(),
            needed: 10 * unknowns,
            losses: record.losses(),
        });
    }
    let full = Objective::new(record, law, terms);
    if !full.energy().is_finite() {
        return Err(Error::Setting {
            name: "force",
            found: full.energy(),
            allowed: "numbers whose squares add up to a finite number",
        });
    }
    if let Some(value) = constant(full.force()) {
        return Err(Error::NoForce { value });
    }
    Ok(full)
}

/// The value of a force that is constant apart from rounding in the filters.
fn constant(force: &[f64]) -> Option<f64> {
    let (low, high) = extent(force);
    let still = high - low <= 1e-9 * low.abs().max(high.abs());
    still.then_some(high)
}
