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
    Delay, Law, LawKind, Mass, Observer, Parameter, Record, Settings, Status, Terms,
};
use stiction_number::{Percent, four_digits, full};
use stiction_parameters::Quantity;

/// Part of the stated mass from which on another one is named: less leaves the constants of most logs within their intervals.
const MASS_APART: f64 = 0.02;
/// The same of a delay, samples: less moves micro-damping by less than its interval on most logs.
const DELAY_APART: f64 = 0.1;
/// Distance of a fitted Stribeck exponent from another one, of logarithms, that filters and encoder may have made: on simulated axes up to
/// 0.14 (decision 0064).
pub(super) const EXPONENT_APART: f64 = 0.22;
/// Part of the square of what is left beside what is stated, at most, that is left beside the other.
const LEFT: f64 = 0.7;

/// Says what is stated, what the log shows, and what to do; `None` where it is what is stated, nothing is stated, or the log does not tell.
pub(super) fn named(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &Conditioned,
    observer: &mut dyn Observer,
) -> Option<Warning> {
    let record = &conditioned.record;
    if !(asked.options.procedures.method.fits_force() && record.moves_both_ways()) {
        return None;
    }
    let stated = conditioned.terms(false);
    let mut fits = Fits {
        record,
        exponent: asked.axis.exponent(),
        settings: Settings {
            near: None,
            ..conditioned.settings.clone()
        },
        observer,
    };
    mass(loaded, stated, &mut fits)
        .or_else(|| delay(stated, &mut fits))
        .or_else(|| exponent(asked, stated, &mut fits))
}

fn mass(loaded: &Loaded, stated: &Terms, fits: &mut Fits) -> Option<Warning> {
    let log = &loaded.sources[0].log;
    let Mass::Given(mass) = stated.mass else {
        return None;
    };
    // Of a force in amperes it is the scale that is not known.
    (log.force_unit == symbols::force_unit(log.motion)).then_some(())?;
    let open = Terms {
        mass: Mass::Fitted,
        ..stated.clone()
    };
    let is_apart = |found: f64| found > 0.0 && (found - mass).abs() > MASS_APART * mass;
    // A law without bristles costs next to nothing, and has the mass within some percent.
    let (roughly, _) = fits.fit(fits.law(LawKind::CoulombViscous), &open)?;
    is_apart(of(&roughly.parameters, Quantity::Mass)?.value).then_some(())?;
    let (found, left) = fits.shown(stated, &open, (Quantity::Mass, mass), is_apart)?;
    let (low, high) = found.ci95?;
    let unit = symbols::unit(found.name.dimension(), log.motion, &log.force_unit, "");
    let [stated, value, low, high] = [mass, found.value, low, high].map(four_digits);
    Some(Warning::new(
        Code::MassDisagrees,
        format!(
            "the axis file states a mass of {stated} {unit}, and the log shows {value} {unit} ({low} to {high}): with that {} of what the law \
             leaves beside the stated one is left, and what is fitted beside the stated one is of no machine. Write mass = \"fit\" in its \
             place in the axis file; a mass that is known surely is a force in another scale or unit",
            Percent::error(100.0 * left).digits(2)
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

fn delay(stated: &Terms, fits: &mut Fits) -> Option<Warning> {
    let Delay::Given(delay) = stated.delay else {
        return None;
    };
    let open = Terms {
        delay: Delay::Fitted,
        ..stated.clone()
    };
    let step = fits.record.step();
    let is_apart = |found: f64| (found - delay).abs() > DELAY_APART * step;
    let (found, left) = fits.shown(stated, &open, (Quantity::Delay, delay), is_apart)?;
    let (low, high) = found.ci95?;
    let [stated, value, low, high] =
        [delay, found.value, low, high].map(|seconds| four_digits(1e3 * seconds));
    Some(Warning::new(
        Code::DelayDisagrees,
        format!(
            "the axis file states a delay of {stated} ms, and the log shows {value} ms ({low} to {high}): with that {} of what the law leaves \
             beside the stated one is left, and micro-damping that is fitted beside the stated one makes up for it. Write delay = \"fit\" \
             in its place under [terms] in the axis file",
            Percent::error(100.0 * left).digits(2)
        ),
    ))
}

/// Only where a curve is fitted that has it.
fn exponent(asked: Asked, terms: &Terms, fits: &mut Fits) -> Option<Warning> {
    let stated = asked.axis.stribeck_exponent?;
    let has_none = |law: LawKind| law.has_elements() || !law.has_stribeck();
    if asked.options.law.is_some_and(has_none) {
        return None;
    }
    let is_apart = |found: f64| libm::log(found / stated).abs() > EXPONENT_APART;
    let law = fits.law(LawKind::LuGre).with_fitted_exponent();
    let (held, _) = fits.fit(fits.law(LawKind::LuGre), terms)?;
    let (mut free, optimum) = fits.fit(law, terms)?;
    is_apart(of(&free.parameters, Quantity::StribeckExponent)?.value).then_some(())?;
    let left = (free.fit.rmse / held.fit.rmse).powi(2);
    engine::intervals(fits.record, &optimum, &mut free, fits.observer);
    let found = of(&free.parameters, Quantity::StribeckExponent)?;
    // Much less that is left says so as well as an interval, which misfits of another kind may leave open.
    let is_outside =
        |(low, high): (f64, f64)| found.identifiable && (stated < low || stated > high);
    let shows = left < LEFT || found.ci95.is_some_and(is_outside);
    (shows && is_apart(found.value)).then_some(())?;
    let value = four_digits(found.value);
    let about = found.ci95.map_or(String::new(), |(low, high)| {
        format!(" ({} to {})", four_digits(low), four_digits(high))
    });
    Some(Warning::new(
        Code::ExponentDisagrees,
        format!(
            "the axis file states a Stribeck exponent of {}, and the log shows {value}{about}: static friction, the Stribeck \
             velocity and the stiffness that are fitted beside the stated one make up for it. Write stribeck_exponent = \"fit\" in its \
             place under [terms] in the axis file, or take the line out",
            full(stated)
        ),
    ))
}

/// Fits of laws to one record.
struct Fits<'a> {
    record: &'a Record,
    /// Stribeck exponent of their laws.
    exponent: f64,
    settings: Settings,
    observer: &'a mut dyn Observer,
}

impl Fits<'_> {
    fn law(&self, kind: LawKind) -> Law {
        Law {
            exponent: self.exponent,
            ..Law::new(kind)
        }
    }

    fn fit(&mut self, law: Law, terms: &Terms) -> Option<(engine::Estimate, engine::Optimum)> {
        let settings = &self.settings;
        let found = engine::fit_law(self.record, law, terms, 0.0, settings, self.observer).ok()?;
        (found.1.status != Status::Interrupted).then_some(found)
    }

    /// What LuGre finds in place of the stated `value` where that is `open`, with the part that it leaves of what is left beside
    /// the stated one.
    fn shown(
        &mut self,
        stated: &Terms,
        open: &Terms,
        (name, value): (Quantity, f64),
        is_apart: impl Fn(f64) -> bool,
    ) -> Option<(Parameter, f64)> {
        let law = self.law(LawKind::LuGre);
        let (held, _) = self.fit(law, stated)?;
        let (mut free, optimum) = self.fit(law, open)?;
        let left = (free.fit.rmse / held.fit.rmse).powi(2);
        (left < LEFT && is_apart(of(&free.parameters, name)?.value)).then_some(())?;
        engine::intervals(self.record, &optimum, &mut free, self.observer);
        let found = of(&free.parameters, name)?;
        let (low, high) = found.ci95?;
        let is_outside = value < low || value > high;
        (is_outside && is_apart(found.value)).then_some((found, left))
    }
}

fn of(parameters: &[Parameter], name: Quantity) -> Option<Parameter> {
    parameters.iter().find(|p| p.name == name).cloned()
}
