//! Why a compensator should not rely on a law, although it follows the log: what it says where the log has seen nothing.

use stiction_identify::{Estimate, FittedLaw, Optimum, Status};
use stiction_number::Percent;
use stiction_parameters::Quantity;

/// Part of the samples that are not above what counts as the largest friction of a log, dimensionless: single samples may be
/// noise.
const LARGEST_SHARE: f64 = 0.999;
/// Ratio of the static friction of a law to the largest friction of the log, above which the log never shows that force,
/// dimensionless: a quarter more.
const UNSEEN_FORCE_RATIO: f64 = 1.25;

/// Why a compensator should not rely on a fitted law; `None` where it may.
pub(super) fn reason(estimate: &Estimate, optimum: &Optimum) -> Option<String> {
    if !matches!(optimum.status, Status::Converged | Status::Interrupted) {
        return Some(format!("its search ended with {}", optimum.status.name()));
    }
    unseen_force(estimate)
}

/// Whether a parameter of the law stands at the end of its search range: the log follows from the law, but also from
/// another one.
pub(super) fn at_its_end(optimum: &Optimum) -> bool {
    (0..optimum.law.nonlinear()).any(|i| optimum.bounds.at_bound(&optimum.p, i))
}

/// Says that the law has a static friction that the log never shows.
pub(super) fn unseen_force(law: &FittedLaw) -> Option<String> {
    let levels = law.parameters.iter();
    let levels = levels.filter(|p| p.name.quantity == Quantity::Static);
    let most = levels.map(|p| p.value).fold(0.0, f64::max);
    let largest = largest_friction(law);
    (most > UNSEEN_FORCE_RATIO * largest).then(|| {
        let part = Percent::error(100.0 * (most / largest - 1.0));
        format!(
            "its static friction is {} above the largest friction of the log",
            part.digits(2)
        )
    })
}

/// The largest friction of a log: of the measured force without the terms beside the law, but for single samples.
pub(super) fn largest_friction(law: &FittedLaw) -> f64 {
    let series = &law.series;
    let friction = series.measured.iter().zip(&series.other);
    let mut friction: Vec<f64> = friction.map(|(u, other)| (u - other).abs()).collect();
    if friction.is_empty() {
        return 0.0;
    }
    let at = (LARGEST_SHARE * (friction.len() - 1) as f64) as usize;
    *friction.select_nth_unstable_by(at, f64::total_cmp).1
}
