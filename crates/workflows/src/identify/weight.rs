//! Terms that the axis file does not mention: a weight on a joint, and friction that grows with the torque of a robot's rigid body.

use super::condition::Conditioned;
use super::ladder::{Ladder, LinearTerms};
use super::load::{Asked, Loaded};
use super::method::Method;
use std::f64::consts::FRAC_PI_2;
use stiction_identify::{Dependence, Law, LawKind, Observer, Terms, Transmitted};
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
    let (before, after) = tried(
        &weighed,
        choice::MAX_NAMED_RICHER_ERROR,
        conditioned,
        observer,
    )?;
    Some(format!(
        "gravity is fitted beside friction: without it the law dahl leaves {} on held-out samples, with it {}; \
         gravity = false under [terms] leaves it out",
        Percent::error(before).digits(3),
        Percent::error(after).digits(3)
    ))
}

/// Takes friction in proportion to the torque of a rigid body that was identified too, where a bristle with it holds better on samples that
/// were left out, and says so.
pub(super) fn load_taken(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &mut Conditioned,
    observer: &mut dyn Observer,
) -> Option<String> {
    let sources = &loaded.sources;
    let is_open = sources.iter().all(|s| !s.external_deviations.is_empty())
        && asked.axis.terms.dependences.is_empty()
        && asked.options.procedures.method == Method::Separable;
    if !is_open {
        return None;
    }
    let record = conditioned.record.clone();
    let loaded = |terms: &Terms| {
        let dependences = vec![Dependence::CoulombTransmitted(Transmitted::default())];
        let terms = Terms {
            dependences,
            ..terms.clone()
        };
        terms.about(&record)
    };
    let most = 1.0 / choice::MAX_SIMPLER_ERROR;
    let (before, after) = tried(&loaded, most, conditioned, observer)?;
    Some(format!(
        "Coulomb friction grows with the torque of the rigid body: without that the law dahl leaves {} on held-out samples, with it {}",
        Percent::error(before).digits(3),
        Percent::error(after).digits(3)
    ))
}

/// Takes terms with which a bristle leaves less than a part of what it leaves without them on samples that were left out; both
/// errors, where they were taken.
fn tried(
    with: &dyn Fn(&Terms) -> Terms,
    most: f64,
    conditioned: &mut Conditioned,
    observer: &mut dyn Observer,
) -> Option<(f64, f64)> {
    let with = LinearTerms {
        symmetric: with(&conditioned.terms.symmetric),
        asymmetric: with(&conditioned.terms.asymmetric),
    };
    let mut error = |terms: &LinearTerms| {
        let ladder = Ladder {
            record: &conditioned.record,
            held_out: &[],
            terms,
            bent: None,
            held_delay: None,
            low_speed: conditioned.low_speed,
            symmetric: true,
            exponent_is_open: false,
        };
        let law = ladder.usual(Law::new(LawKind::Dahl));
        let climb = ladder.climb(&[law], &[], &conditioned.settings, observer);
        let rung = climb.rungs.first().filter(|_| !climb.stopped)?;
        Some(rung.held_out_error()).filter(|error| error.is_finite())
    };
    let (before, after) = (error(&conditioned.terms)?, error(&with)?);
    if after >= most * before {
        return None;
    }
    conditioned.terms = with;
    Some((before, after))
}
