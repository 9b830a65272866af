//! What the engines count and measure, as it goes into files.

use stiction_files::result::{Evaluations, FitEntry};
use stiction_identify::Fit;
use stiction_search::Counts;

/// How well a model explains a signal, with its name and unit.
pub(crate) fn fit(fit: &Fit, signal: &str, unit: &str) -> FitEntry {
    FitEntry {
        signal: signal.into(),
        unit: unit.into(),
        rmse: fit.rmse,
        relative_error_percent: fit.relative_error_percent,
        r2: Some(fit.r2).filter(|x| x.is_finite()),
        samples: fit.samples,
        effective_samples: fit.effective_samples,
    }
}

/// Evaluations by kind; one on the coarse record costs `share` of one on the full record.
pub(crate) fn evaluations(counts: &Counts, share: f64) -> Evaluations {
    Evaluations {
        costs: counts.costs,
        derivatives: counts.derivatives,
        coarse_costs: counts.coarse_costs,
        coarse_derivatives: counts.coarse_derivatives,
        full_records: counts.full_records(share),
    }
}
