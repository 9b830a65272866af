//! Why a compensator should not rely on a law, although it follows the log: what it says where the log has seen nothing.

use stiction_identify::{Estimate, Optimum, Status};
use stiction_parameters::Quantity;

/// Ratio of the static friction of a law to the largest friction that it has along the log, above which the log never
/// shows that force, dimensionless: a quarter more.
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
pub(super) fn unseen_force(law: &stiction_identify::FittedLaw) -> Option<String> {
    let series = &law.series;
    let friction = series.model.iter().zip(&series.other).map(|(y, x)| y - x);
    let largest = friction.fold(0.0, |most: f64, f| most.max(f.abs()));
    let levels = law.parameters.iter();
    let levels = levels.filter(|p| p.name.quantity == Quantity::Static);
    let most = levels.map(|p| p.value).fold(0.0, f64::max);
    (most > UNSEEN_FORCE_RATIO * largest).then(|| {
        let part = stiction_number::Percent::error(100.0 * (most / largest - 1.0));
        format!(
            "its static friction is {} above the largest friction along the log",
            part.digits(2)
        )
    })
}
