//! What the ratio of two signals that ought to show the same motion says.

use stiction_policy::signal;
use stiction_say::Mismatch;

/// Sums of squares and products of what the position shows, and of what the other signal does.
pub(super) struct Sums {
    pub position: f64,
    pub other: f64,
    pub both: f64,
}

/// How the pair differs, compared over so many samples, with ratios that have a usual cause; `None` where both show the same.
pub(super) fn fault(
    sums: &Sums,
    samples: usize,
    causes: &[(f64, &'static str)],
) -> Option<Mismatch> {
    let correlation = sums.both / (sums.position * sums.other).sqrt();
    let ratio = (sums.position / sums.other).sqrt().copysign(correlation);
    if correlation.abs() < signal::MIN_CORRELATION {
        return Some(Mismatch::Uncorrelated {
            correlation,
            samples,
        });
    }
    if (ratio - 1.0).abs() <= signal::MAX_RATIO_ERROR {
        return None;
    }
    let near =
        |(value, _): &&(f64, &str)| (ratio.abs() / value - 1.0).abs() < signal::MAX_RATIO_ERROR;
    let cause = causes.iter().find(near).map(|(_, cause)| *cause);
    Some(Mismatch::Ratio { ratio, cause })
}
