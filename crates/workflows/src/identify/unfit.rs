//! Why a compensator should not rely on a law, although it follows the log: what it says where the log has seen nothing.

use crate::source::Source;
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
    above(law, largest_friction(law), "friction")
}

/// The same where the largest force of the logs is all that is known.
pub(super) fn above_every_force(law: &FittedLaw, sources: &[Source]) -> Option<String> {
    let forces = sources
        .iter()
        .filter_map(|source| source.log.force.as_ref());
    let largest = forces.flatten().fold(0.0, |most: f64, f| most.max(f.abs()));
    above(law, largest, "force")
}

/// Names the largest level of a law where it is far above a force.
fn above(law: &FittedLaw, largest: f64, what: &str) -> Option<String> {
    let level = |quantity: Quantity| {
        let levels = law.parameters.iter();
        let levels = levels.filter(|p| p.name.quantity == quantity);
        levels.map(|p| p.value).fold(0.0, f64::max)
    };
    let (coulomb, fixed) = (level(Quantity::Coulomb), level(Quantity::Static));
    let (name, most) = match fixed >= coulomb {
        true => ("static friction", fixed),
        false => ("Coulomb friction", coulomb),
    };
    (most > UNSEEN_FORCE_RATIO * largest).then(|| {
        let part = Percent::error(100.0 * (most / largest - 1.0));
        format!(
            "its {name} is {} above the largest {what} of the log",
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
