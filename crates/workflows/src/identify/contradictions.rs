//! What the axis file states of the axis, a mass, a delay or a Stribeck exponent, and the log shows to be another.
//!
//! A force of inertia that is missing or too much looks like a resonance, a low-pass of the force or a delay, and a force that is
//! taken at another instant like backlash or friction of another shape, so that it is looked for before these.

use super::condition::Conditioned;
use super::load::{Asked, Loaded};
use stiction_files::{Warning, symbols};
use stiction_identify as engine;
use stiction_identify::{
    Delay, Effect, Law, LawKind, Mass, Observer, Parameter, Settings, Status, Terms,
};
use stiction_parameters::{Name, Quantity};
use stiction_policy::agreement;
use stiction_say::{Notice, Stated as Kind};

/// Says what is stated, what the log shows, and what to do; `None` where it is what is stated, nothing is stated, or the log does not tell.
pub(super) fn named(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &Conditioned,
    observer: &mut dyn Observer,
) -> Option<Warning> {
    let (record, axis) = (&conditioned.record, asked.axis);
    let terms = conditioned.terms(false);
    let log = &loaded.sources[0].log;
    let delay = matches!(terms.delay, Delay::Given(delay) if delay != 0.0);
    let mass = matches!(terms.mass, Mass::Given(_));
    let states = delay || mass || axis.stribeck_exponent.is_some();
    (asked.options.procedures.method.fits_force() && record.moves_both_ways() && states)
        .then_some(())?;
    let settings = Settings {
        near: None,
        ..conditioned.settings.clone()
    };
    let law = Law {
        exponent: axis.exponent(),
        ..Law::new(LawKind::LuGre)
    };
    let mut fit = |law: Law, terms: &Terms| {
        let found = engine::fit_law(record, law, terms, 0.0, &settings, observer).ok()?;
        (found.1.status != Status::Interrupted).then_some(found)
    };
    let (held, optimum) = fit(law, terms)?;
    let effect = engine::effects(record, &optimum, &held).first()?.effect;
    let open = terms.clone();
    let unit = symbols::unit(
        Name::from(Quantity::Mass).dimension(),
        log.motion,
        &log.force_unit,
        "",
    );
    let has_curve = |law: LawKind| law.has_stribeck() && !law.has_elements();
    let stated = match (effect, terms.mass, terms.delay, axis.stribeck_exponent) {
        // Of a force in amperes it is the scale that is not known.
        (Effect::Mass(_), Mass::Given(mass), ..)
            if log.force_unit == symbols::force_unit(log.motion) =>
        {
            Stated {
                stated: Kind::Mass,
                law,
                open: Terms {
                    mass: Mass::Fitted,
                    ..open
                },
                quantity: Quantity::Mass,
                scale: 1.0,
                value: mass,
                unit,
            }
        }
        (Effect::Delay(_), _, Delay::Given(delay), _) => Stated {
            stated: Kind::Delay,
            law,
            open: Terms {
                delay: Delay::Fitted,
                ..open
            },
            quantity: Quantity::Delay,
            scale: 1e3,
            value: 1e3 * delay,
            unit: "ms".into(),
        },
        (Effect::Curve, _, _, Some(exponent)) if asked.options.law.is_none_or(has_curve) => {
            Stated {
                stated: Kind::Exponent,
                law: law.with_fitted_exponent(),
                open,
                quantity: Quantity::StribeckExponent,
                scale: 1.0,
                value: exponent,
                unit: String::new(),
            }
        }
        _ => return None,
    };
    let (free, _) = fit(stated.law, &stated.open)?;
    let found = free.parameter(stated.quantity)?;
    let (low, high) = found.ci95?;
    let notice = Notice::Contradicted {
        stated: stated.stated,
        value: stated.value,
        shown: [found.value, low, high].map(|x| stated.scale * x),
        unit: stated.unit,
        left: (free.fit.rmse / held.fit.rmse).powi(2),
    };
    Some(notice.into())
}

/// What an axis file states and a log contradicts.
struct Stated {
    stated: Kind,
    /// The law and the terms with which it is fitted instead.
    law: Law,
    open: Terms,
    quantity: Quantity,
    /// From SI to the unit of the message, and that.
    scale: f64,
    unit: String,
    /// In that unit.
    value: f64,
}

/// Says that the mass that was found is not the one of `[limits]`, which is meant within a factor of two; `None` where it is, none is
/// given, or the log leaves it open.
pub(super) fn against_limits(
    asked: Asked,
    loaded: &Loaded,
    found: &[Parameter],
) -> Option<Warning> {
    let log = &loaded.sources[0].log;
    let mass = asked.axis.limits.as_ref()?.mass?;
    (log.force_unit == symbols::force_unit(log.motion)).then_some(())?;
    let found = of(found, Quantity::Mass).filter(|p| p.identified && p.identifiable)?;
    let (low, high) = found.ci95?;
    (low > agreement::MAX_LIMIT_RATIO * mass || high < mass / agreement::MAX_LIMIT_RATIO)
        .then_some(())?;
    let unit = symbols::unit(found.name.dimension(), log.motion, &log.force_unit, "");
    let notice = Notice::LimitsMass {
        limit: mass,
        shown: [found.value, low, high],
        unit,
    };
    Some(notice.into())
}

fn of(parameters: &[Parameter], name: Quantity) -> Option<Parameter> {
    parameters.iter().find(|p| p.name == name).cloned()
}
