//! Whether a log says more of a parameter than is known of any machine, and than the ends of a search do.

use crate::parameter::physical::Physical;
use crate::parameter::{NORMAL_Q95, Parameter};
use crate::scatter::Scatter;
use crate::separable::optimum::Optimum;
use stiction_policy::interval;

/// Flags the parameters that the log alone leaves open, and what is known of any machine does not: what is stated would be what was
/// assumed.
pub(super) fn flag_what_says_no_more_than_before(
    unknowns: &Scatter,
    raw: &[Physical],
    parameters: &mut [Parameter],
) {
    for p in raw.iter().filter(|p| p.is_positive()) {
        let [alone, both] = [unknowns.alone(p), unknowns.beside_prior(p)];
        let known = interval::MAX_HALF_WIDTH / NORMAL_Q95 * p.value;
        if alone <= interval::MIN_PRIOR_VARIANCE * both || alone <= known * known {
            continue;
        }
        let own = parameters.iter_mut().find(|own| own.name == p.name);
        if let Some(own) = own.filter(|own| own.identified && own.identifiable) {
            own.identifiable = false;
            own.reason = "the log alone says hardly more of it than is known of any machine".into();
        }
    }
}

/// Flags the parameters that go along with an unknown at the end of its search range, where nothing but that end holds them.
pub(super) fn flag_what_an_end_holds(
    optimum: &Optimum,
    unknowns: &Scatter,
    raw: &[Physical],
    parameters: &mut [Parameter],
) {
    let ends = (0..optimum.p.len()).filter(|i| optimum.bounds.at_bound(&optimum.p, *i));
    for i in ends {
        for p in raw.iter().filter(|p| p.nonlinear != Some(i)) {
            let with = p.with(&unknowns.bread, i);
            let both = p.variance(&unknowns.bread) * unknowns.bread[(i, i)];
            let own = parameters.iter_mut().find(|own| own.name == p.name);
            let own = own.filter(|own| own.identified && own.identifiable);
            if let Some(own) = own.filter(|_| with * with > interval::MIN_SHARED_VARIANCE * both) {
                own.identifiable = false;
                own.reason = "moves with what is at the bound of its search range".into();
            }
        }
    }
}
