//! A mass that the axis file states, and the log shows to be another.
//!
//! A force of inertia that is missing or too much looks like a resonance, a low-pass of the force or a delay, so that it is looked
//! for before these.

use super::condition::Conditioned;
use super::load::{Asked, Loaded};
use stiction_files::symbols;
use stiction_identify as engine;
use stiction_identify::{Law, LawKind, Mass, Observer, Parameter, Status, Terms};
use stiction_number::{Percent, four_digits};
use stiction_parameters::Quantity;

/// Part of the stated mass from which on another one is named: less is within what nameplates and drawings say.
const APART: f64 = 0.05;
/// Part of the square of what is left beside the stated mass, at most, that is left beside the other.
const LEFT: f64 = 0.7;

/// Says which mass the log shows; `None` where it is the stated one, none is stated, or the log does not tell.
pub(super) fn named(
    asked: Asked,
    loaded: &Loaded,
    conditioned: &Conditioned,
    observer: &mut dyn Observer,
) -> Option<String> {
    let log = &loaded.sources[0].log;
    let stated = conditioned.terms(false);
    let record = &conditioned.record;
    let Mass::Given(mass) = stated.mass else {
        return None;
    };
    // Of a force in amperes it is the scale that is not known.
    let is_calibrated = log.force_unit == symbols::force_unit(log.motion);
    let fits = asked.options.procedures.method.fits_force();
    if !(fits && is_calibrated && record.moves_both_ways()) {
        return None;
    }
    let open = Terms {
        mass: Mass::Fitted,
        ..stated.clone()
    };
    let mut fit = |kind: LawKind, terms: &Terms| {
        let settings = engine::Settings {
            near: None,
            ..conditioned.settings.clone()
        };
        let law = Law::new(kind);
        let found = engine::fit_law(record, law, terms, 0.0, &settings, observer).ok()?;
        (found.1.status != Status::Interrupted).then_some(found)
    };
    let of = |parameters: &[Parameter]| {
        let mut all = parameters.iter();
        all.find(|p| p.name == Quantity::Mass).cloned()
    };
    let is_apart = |found: f64| found > 0.0 && (found - mass).abs() > APART * mass;
    // A law without bristles costs next to nothing, and has the mass within some percent.
    let (roughly, _) = fit(LawKind::CoulombViscous, &open)?;
    is_apart(of(&roughly.parameters)?.value).then_some(())?;
    let (held, _) = fit(LawKind::LuGre, stated)?;
    let (mut free, optimum) = fit(LawKind::LuGre, &open)?;
    let left = (free.fit.rmse / held.fit.rmse).powi(2);
    (left < LEFT && is_apart(of(&free.parameters)?.value)).then_some(())?;
    engine::intervals(record, &optimum, &mut free, observer);
    let found = of(&free.parameters)?;
    let (low, high) = found.ci95?;
    if !(found.identifiable && is_apart(found.value)) || (low..=high).contains(&mass) {
        return None;
    }
    let unit = symbols::unit(found.name.dimension(), log.motion, &log.force_unit, "");
    let [stated, value, low, high] = [mass, found.value, low, high].map(four_digits);
    Some(format!(
        "the axis file states a mass of {stated} {unit}, and the log shows {value} {unit} ({low} to {high}): with that {} of what the law leaves \
         beside the stated one is left, and what is fitted beside the stated one is of no machine. Write mass = \"fit\" in its place in the \
         axis file; a mass that is known surely is a force in another scale or unit",
        Percent::error(100.0 * left).digits(2)
    ))
}
