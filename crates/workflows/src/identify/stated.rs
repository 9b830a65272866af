//! What the axis file states of the axis, a mass, a delay or a Stribeck exponent, and the log shows to be another.
//!
//! A force of inertia that is missing or too much looks like a resonance, a low-pass of the force or a delay, and a force that is
//! taken at another instant like backlash or friction of another shape, so that it is looked for before these.

use super::condition::Conditioned;
use super::load::{Asked, Loaded};
use stiction_codes::Code;
use stiction_files::{Warning, symbols};
use stiction_identify as engine;
use stiction_identify::{
    Delay, Effect, Law, LawKind, Mass, Observer, Parameter, Settings, Status, Terms,
};
use stiction_number::{Percent, four_digits, full};
use stiction_parameters::Quantity;

/// Distance of a fitted Stribeck exponent from another one, of logarithms, that filters and encoder may have made: on simulated axes up to
/// 0.14 (decision 0064).
pub(super) const EXPONENT_APART: f64 = 0.22;

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
    let mut open = terms.clone();
    let (code, law, quantity, scale) = match effect {
        // Of a force in amperes it is the scale that is not known.
        Effect::Mass(_) if log.force_unit == symbols::force_unit(log.motion) => {
            open.mass = Mass::Fitted;
            (Code::MassDisagrees, law, Quantity::Mass, 1.0)
        }
        Effect::Delay(_) => {
            open.delay = Delay::Fitted;
            (Code::DelayDisagrees, law, Quantity::Delay, 1e3)
        }
        Effect::Curve if axis.stribeck_exponent.is_some() => (
            Code::ExponentDisagrees,
            law.with_fitted_exponent(),
            Quantity::StribeckExponent,
            1.0,
        ),
        _ => return None,
    };
    let has_none = |law: LawKind| law.has_elements() || !law.has_stribeck();
    if code == Code::ExponentDisagrees && asked.options.law.is_some_and(has_none) {
        return None;
    }
    let (free, _) = fit(law, &open)?;
    let found = free.parameter(quantity)?;
    let (low, high) = found.ci95?;
    let [value, low, high] = [found.value, low, high].map(|x| four_digits(scale * x));
    let unit = match code {
        Code::MassDisagrees => {
            let unit = symbols::unit(found.name.dimension(), log.motion, &log.force_unit, "");
            format!(" {unit}")
        }
        Code::DelayDisagrees => " ms".into(),
        _ => String::new(),
    };
    let stated = match (code, terms.mass, terms.delay) {
        (Code::MassDisagrees, Mass::Given(mass), _) => {
            format!("a mass of {}{unit}", four_digits(mass))
        }
        (Code::DelayDisagrees, _, Delay::Given(delay)) => {
            format!("a delay of {}{unit}", four_digits(1e3 * delay))
        }
        _ => format!("a Stribeck exponent of {}", full(axis.exponent())),
    };
    let left = Percent::error(100.0 * (free.fit.rmse / held.fit.rmse).powi(2)).digits(2);
    let line = match code {
        Code::MassDisagrees => {
            "Write mass = \"fit\" in its place in the axis file; a mass that is known surely is a force in another scale or unit"
        }
        Code::DelayDisagrees => "Write delay = \"fit\" in its place under [terms] in the axis file",
        _ => "Write stribeck_exponent = \"fit\" in its place under [terms] in the axis file",
    };
    Some(Warning::new(
        code,
        format!(
            "the axis file states {stated}, and the log shows {value}{unit} ({low} to {high}): with that {left} of what the law leaves beside the \
             stated one is left. {line}"
        ),
    ))
}

/// How many times larger or smaller than `limits.mass` what moves may be (docs/axis.md).
const OF_LIMITS: f64 = 2.0;

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
    (low > OF_LIMITS * mass || high < mass / OF_LIMITS).then_some(())?;
    let unit = symbols::unit(found.name.dimension(), log.motion, &log.force_unit, "");
    let [limit, value, low, high] = [mass, found.value, low, high].map(four_digits);
    Some(Warning::new(
        Code::MassDisagrees,
        format!(
            "limits.mass of the axis file is {limit} {unit}, within a factor of two, and the log shows {value} {unit} ({low} to {high}): the \
             position, the time or the force of the log has another unit or scale than the axis file says, and every number with it, or \
             limits.mass is not what moves. Correct the one that is wrong"
        ),
    ))
}

fn of(parameters: &[Parameter], name: Quantity) -> Option<Parameter> {
    parameters.iter().find(|p| p.name == name).cloned()
}
