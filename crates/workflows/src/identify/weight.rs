//! A weight on a joint that the axis file does not mention.

use super::condition::Conditioned;
use super::ladder::{Ladder, LinearTerms};
use super::load::{Asked, Loaded};
use super::method::Method;
use std::f64::consts::FRAC_PI_2;
use stiction_identify::{Law, LawKind, Observer, Terms};
use stiction_log::Motion;
use stiction_number::Percent;
use stiction_policy::choice;

/// Takes gravity into the fit of a joint where a bristle with it holds clearly better on samples that were left out, and says so. On less than a quarter turn any force that changes along the position looks like a weight.
pub(super) fn taken(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &mut Conditioned,
    observer: &mut dyn Observer,
) -> Option<String> {
    let log = &loaded.sources[0].log;
    let is_open = asked.axis.leaves_gravity_open()
        && log.motion == Motion::Rotary
        && asked.options.procedures.method == Method::Separable
        && conditioned.record.stroke() > FRAC_PI_2;
    if !is_open {
        return None;
    }
    let weighed = |terms: &Terms| Terms {
        gravity: true,
        ..terms.clone()
    };
    let with = LinearTerms {
        symmetric: weighed(&conditioned.terms.symmetric),
        asymmetric: weighed(&conditioned.terms.asymmetric),
    };
    let mut error = |terms: &LinearTerms| {
        let ladder = Ladder {
            record: &conditioned.record,
            held_out: &[],
            terms,
            bent: None,
            held_delay: None,
            low_speed: conditioned.low_speed,
            exponent_is_open: false,
        };
        let law = ladder.usual(Law::new(LawKind::Dahl));
        let climb = ladder.climb(&[law], &[], &conditioned.settings, observer);
        let rung = climb.rungs.first().filter(|_| !climb.stopped)?;
        Some(rung.held_out_error()).filter(|error| error.is_finite())
    };
    let (before, after) = (error(&conditioned.terms)?, error(&with)?);
    if after >= choice::MAX_NAMED_RICHER_ERROR * before {
        return None;
    }
    conditioned.terms = with;
    Some(format!(
        "gravity is fitted beside friction: without it the law dahl leaves {} on held-out samples, with it {}; \
         gravity = false under [terms] leaves it out",
        Percent::error(before).digits(3),
        Percent::error(after).digits(3)
    ))
}
