//! What the axis file states of the axis, a mass or a delay, and the log shows to be another.
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
use stiction_number::{Percent, four_digits};
use stiction_parameters::Quantity;

/// Part of the stated mass from which on another one is named: less is within what nameplates and drawings say.
const MASS_APART: f64 = 0.05;
/// The same of a delay, samples: less moves micro-damping by less than its interval on most logs.
const DELAY_APART: f64 = 0.1;
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
        settings: Settings {
            near: None,
            ..conditioned.settings.clone()
        },
        observer,
    };
    mass(loaded, stated, &mut fits).or_else(|| delay(stated, &mut fits))
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
    let (roughly, _) = fits.fit(LawKind::CoulombViscous, &open)?;
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

/// Fits of laws to one record.
struct Fits<'a> {
    record: &'a Record,
    settings: Settings,
    observer: &'a mut dyn Observer,
}

impl Fits<'_> {
    fn fit(&mut self, kind: LawKind, terms: &Terms) -> Option<(engine::Estimate, engine::Optimum)> {
        let (law, settings) = (Law::new(kind), &self.settings);
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
        let (held, _) = self.fit(LawKind::LuGre, stated)?;
        let (mut free, optimum) = self.fit(LawKind::LuGre, open)?;
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
