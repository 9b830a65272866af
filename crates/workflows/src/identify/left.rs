//! What a law leaves systematically, and what to do about it, in words.

use super::coupled;
use stiction_codes::Code;
use stiction_files::result::MisfitEntry;
use stiction_files::{Warning, symbols};
use stiction_identify::{Cause, Dependence, Divided, FittedLaw, Misfit};
use stiction_log::Log;
use stiction_number::{Percent, four_digits};

/// What goes into the result.
pub(super) fn entry(law: &FittedLaw, force_unit: &str) -> Option<MisfitEntry> {
    let misfit = law.misfit.as_ref()?;
    let ripple = misfit
        .ripple
        .filter(|_| misfit.cause() == Some(Cause::Ripple));
    let mut entry = MisfitEntry {
        by: misfit.by.name().into(),
        cause: misfit.cause().map(|cause| code(cause).to_string()),
        rmse: misfit.rms,
        unit: force_unit.into(),
        share_percent: 100.0 * misfit.share,
        pitch: ripple.map(|r| r.pitch),
        amplitude: ripple.map(|r| r.amplitude),
        frequency_hz: None,
        resonance_hz: None,
        encoder: None,
        lost_motion: None,
        coupling_std_percent: None,
        load_percent: None,
    };
    if let Some(coupling) = &misfit.coupling {
        coupled::state(coupling, &mut entry);
    }
    Some(entry)
}

fn code(cause: Cause) -> Code {
    match cause {
        Cause::Drift => Code::FrictionDrift,
        Cause::Position => Code::PositionDependence,
        Cause::Load => Code::LoadDependence,
        Cause::Temperature => Code::TemperatureDependence,
        Cause::Ripple => Code::PositionRipple,
        Cause::Resonance => Code::Resonance,
        Cause::Backlash => Code::Backlash,
        Cause::Shape => Code::LawShape,
    }
}

/// Names the likely cause of what the residual leaves systematically.
pub(super) fn named(law: &FittedLaw, log: &Log, warnings: &mut Vec<Warning>) {
    let Some(misfit) = &law.misfit else { return };
    let Some(cause) = misfit.cause() else { return };
    let message = message(misfit, cause, law, log);
    warnings.push(Warning::new(code(cause), message));
}

fn message(misfit: &Misfit, cause: Cause, law: &FittedLaw, log: &Log) -> String {
    let share = Percent::error(100.0 * misfit.share).digits(2);
    let of_force = misfit.rms / law.fit.rmse * law.fit.relative_error_percent;
    let of_force = Percent::error(of_force).digits(2);
    let left = format!("{share} of what the law leaves ({of_force} of the force)");
    let levels = || {
        let (low, high) = misfit.levels;
        let part = |x: f64| Percent::error(100.0 * x).signed(0);
        format!("{} to {}", part(low), part(high))
    };
    let counted = "The intervals count it";
    match cause {
        Cause::Resonance | Cause::Backlash => {
            misfit.coupling.as_ref().map_or_else(String::new, |found| {
                coupled::message(found, law.fit.relative_error_percent, log)
            })
        }
        Cause::Drift => format!(
            "friction changes during the log: {left} is a level that goes from {} of its mean. {counted}; the values are \
                 means over the log. Record the axis warmed up{}",
            levels(),
            match has(law, &Dependence::CoulombTemperature(0.0)) {
                true => ": the temperature that is logged does not explain it",
                false =>
                    ", or its temperature beside the rest and set coulomb_temperature = true under [terms] in the axis file",
            }
        ),
        Cause::Position => format!(
            "friction changes along the stroke: {left} is a level that goes from {} of its mean. {counted}. Set \
                 coulomb_position = true under [terms] in the axis file",
            levels()
        ),
        Cause::Load => format!(
            "friction changes with the load: {left} is a level that goes from {} of its mean over the loads of the log. \
                 {counted}. {}",
            levels(),
            untaken(law, &[Dependence::CoulombLoad(0.0)])
        ),
        Cause::Temperature => format!(
            "friction changes with the temperature: {left} is a level that goes from {} of its mean over the temperatures of \
                 the log. {counted}. {}",
            levels(),
            untaken(
                law,
                &[
                    Dependence::CoulombTemperature(0.0),
                    Dependence::ViscousTemperature(0.0)
                ]
            )
        ),
        Cause::Ripple => {
            let unit = symbols::length_unit(log.motion);
            let line = misfit.ripple.map_or(String::new(), |ripple| {
                format!(
                    ", most of it a wave of {} {}. Set cogging = [\"{} {unit}\"] under [terms] in the axis file",
                    four_digits(ripple.amplitude),
                    log.force_unit,
                    four_digits(ripple.pitch)
                )
            });
            format!("a force repeats with the position: {left}{line}. {counted}")
        }
        Cause::Shape => format!(
            "friction or inertia has another shape than this law: {left} {}. {counted}, and what describes that shape is no constant of the machine. Compare the laws \
                 maxwell-slip and elasto-plastic. Neither a load on a spring nor one behind a gap explains it surely; a force logged \
                 late looks alike",
            match misfit.by {
                Divided::AfterReversals => "lies after reversals, beyond what is left elsewhere",
                _ => "comes back with speed and travel after each reversal",
            }
        ),
    }
}

/// Whether a fit has a term like this one.
fn has(law: &FittedLaw, term: &Dependence) -> bool {
    let mut dependences = law.terms.dependences.iter();
    dependences.any(|own| own.name() == term.name())
}

/// The first of some terms that the fit has not, as a line of the axis file.
fn untaken(law: &FittedLaw, terms: &[Dependence]) -> String {
    let open = terms.iter().find(|term| !has(law, term));
    open.map_or(
        "No straight line over it describes that: record within the range that the axis works in"
            .into(),
        |term| {
            let name = term.name();
            format!("Set {name} = true under [terms] in the axis file")
        },
    )
}
