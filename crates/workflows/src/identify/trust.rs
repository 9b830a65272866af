//! Whether a result may be used: every rule that can say no, in one place.

use crate::source::Source;
use stiction_codes::Code;
use stiction_files::Warning;
use stiction_files::result::{LawEntry, Trust};
use stiction_files::symbols;
use stiction_identify::Parameter;
use stiction_identify::{FittedLaw, SimulationFit, Status};
use stiction_log::Motion;
use stiction_number::Percent;
use stiction_parameters::Quantity;

/// Part of the variance that a fit must explain.
const LEAST_R2: f64 = 0.5;
/// Part of the samples that may be saturated.
const MOST_SATURATED: f64 = 0.2;
/// How much worse than a simpler law the chosen one may do before it is said, relative.
const WORSE: f64 = 1.02;

/// How much better a richer law must do before it is said, relative.
pub(super) const BETTER: f64 = 0.8;
/// How much better it must do for the chosen law not to be trusted, relative.
const MUCH_BETTER: f64 = 0.5;
/// Independent samples of the residual, as a part of all, below which something systematic is left.
const SYSTEMATIC: f64 = 0.05;
/// Part of a parameter by which it may be shifted before it is said.
const FAR: f64 = 0.05;
/// Independent samples of the residual for each unknown below which an open loop tells too little.
const FOR_EACH: f64 = 5.0;
/// Residual in encoder steps below which nothing but the encoder is in it.
const ENCODER: f64 = 2.0;
/// Part of the samples near rest above which a static law is told of them.
const AT_REST: f64 = 0.05;

/// Adds warnings about the fit and says whether its numbers may be used.
pub(super) fn judge(
    estimate: &FittedLaw,
    moves_both_ways: bool,
    sources: &[Source],
    laws: &[LawEntry],
    motion: Motion,
    warnings: &mut Vec<Warning>,
) -> Trust {
    let mut reasons = Vec::new();
    match estimate.status {
        Status::Converged => {}
        Status::Interrupted => {
            let text = "the search was interrupted; the best found so far is given";
            warnings.push(Warning::new(Code::Interrupted, text));
            reasons.push(text.to_string());
        }
        Status::Budget | Status::Stalled => {
            let text = format!(
                "the search did not converge (status {})",
                estimate.status.name()
            );
            warnings.push(Warning::new(Code::NotConverged, text.clone()));
            reasons.push(text);
        }
    }
    if estimate.fit.r2 < LEAST_R2 || estimate.fit.r2.is_nan() {
        let text = format!(
            "the law explains {:.0} % of the variance of the force; at least {:.0} % are needed \
             to trust its parameters",
            100.0 * estimate.fit.r2.max(0.0),
            100.0 * LEAST_R2
        );
        warnings.push(Warning::new(Code::PoorFit, text.clone()));
        reasons.push(text);
    }
    if !moves_both_ways {
        let text = "the axis moves in one direction only: friction cannot be told from a constant \
                    force";
        if !warnings.iter().any(|w| w.code == Code::OneDirection) {
            warnings.push(Warning::new(Code::OneDirection, text));
        }
        reasons.push(text.to_string());
    }
    saturation(sources, &mut reasons);
    unidentifiable(estimate, motion, warnings, &mut reasons);
    another_wins(estimate, laws, warnings, &mut reasons);
    systematic(estimate, warnings);
    shifted(estimate, warnings);
    static_at_rest(estimate, motion, warnings);
    Trust {
        trustworthy: reasons.is_empty(),
        reasons,
    }
}

pub(super) fn saturation(sources: &[Source], reasons: &mut Vec<String>) {
    let total: usize = sources.iter().map(|s| s.log.time.len()).sum();
    let saturated: usize = sources
        .iter()
        .flat_map(|s| s.log.excluded.iter().filter(|e| e.code == Code::Saturation))
        .map(|e| e.samples.len())
        .sum();
    let part = saturated as f64 / total.max(1) as f64;
    if part > MOST_SATURATED {
        reasons.push(format!(
            "the force is saturated in {:.0} % of the samples (at most {:.0} % can be left out)",
            100.0 * part,
            100.0 * MOST_SATURATED
        ));
    }
}

/// Names each parameter that the data do not determine, what it is confused with, and the cure.
pub(super) fn unidentifiable(
    estimate: &FittedLaw,
    motion: Motion,
    warnings: &mut Vec<Warning>,
    reasons: &mut Vec<String>,
) {
    let unknown = || estimate.parameters.iter().filter(|p| !p.identifiable);
    let of_an_element = |p: &&Parameter| p.name.quantity.is_of_an_element();
    let elements: Vec<String> = unknown()
        .filter(of_an_element)
        .map(|p| p.name.to_string())
        .collect();
    for parameter in unknown().filter(|p| !of_an_element(p)) {
        let meaning = symbols::meaning_of(parameter.name, motion);
        let mut text = format!("{} ({meaning}): {}", parameter.name, parameter.reason);
        let partners: Vec<String> = parameter
            .moves_with
            .iter()
            .map(|(name, correlation)| format!("{name} (correlation {correlation:+.2})"))
            .collect();
        if !partners.is_empty() {
            text.push_str(&format!("; moves together with {}", partners.join(" and ")));
        }
        if !parameter.advice.is_empty() {
            text.push_str(&format!(". {}", parameter.advice));
        }
        warnings.push(Warning::new(Code::NotIdentifiable, text));
        if parameter.name.quantity == Quantity::Coulomb {
            reasons.push(format!(
                "{} is not determined by this log: the law may predict such motion, its parameters \
                 do not stand for the machine",
                parameter.name
            ));
        }
    }
    if !elements.is_empty() {
        warnings.push(Warning::new(
            Code::NotIdentifiable,
            format!(
                "{}: the data determine what the elements do together, not each of them. Record slow \
                 reversals of several depths, or ask for fewer elements ([terms] gms_elements)",
                elements.join(", ")
            ),
        ));
    }
}

fn another_wins(
    estimate: &FittedLaw,
    laws: &[LawEntry],
    warnings: &mut Vec<Warning>,
    reasons: &mut Vec<String>,
) {
    let is_chosen = |l: &&LawEntry| {
        l.law == estimate.law.kind.name() && l.asymmetric == estimate.law.asymmetric
    };
    let (Some(chosen), Some(best)) = (laws.iter().find(is_chosen), laws.iter().find(|l| l.best))
    else {
        return;
    };
    let (Some(mine), Some(least)) = (chosen.held_out_error_percent, best.held_out_error_percent)
    else {
        return;
    };
    let side = if best.asymmetric { " --asymmetric" } else { "" };
    let errors = format!(
        "on held-out samples --law {}{side} leaves {}, this law {}",
        best.law,
        Percent::error(least).decimals(2),
        Percent::error(mine).decimals(2)
    );
    if best.parameters < chosen.parameters && mine > WORSE * least {
        warnings.push(Warning::new(
            Code::SimplerLawHoldsBetter,
            format!("{errors}: the richer law is not supported by this log"),
        ));
    } else if best.parameters > chosen.parameters && least < BETTER * mine {
        warnings.push(Warning::new(
            Code::RicherLawHoldsBetter,
            format!("{errors}: this law is too simple for the axis, its parameters are biased"),
        ));
    }
    if least < MUCH_BETTER * mine {
        reasons.push(errors);
    }
}

/// Names the parameters that encoder, filters and noise shift far.
fn shifted(estimate: &FittedLaw, warnings: &mut Vec<Warning>) {
    let far = |p: &&stiction_identify::Parameter| {
        let part = p.bias.map_or(0.0, |bias| (bias / p.value).abs());
        p.identifiable && p.name != Quantity::Offset && p.name != Quantity::Delay && part > FAR
    };
    let names: Vec<String> = estimate
        .parameters
        .iter()
        .filter(far)
        .map(|p| {
            let part = Percent::error(100.0 * p.bias.unwrap_or(0.0) / p.value);
            format!("{} {}", p.name, part.signed(0))
        })
        .collect();
    if !names.is_empty() {
        warnings.push(Warning::new(
            Code::LargeShift,
            format!(
                "encoder steps, filters and noise shift {}: taken off, but a shift of this size is known \
                 in size only",
                names.join(", ")
            ),
        ));
    }
}

/// A residual that resembles itself over many samples is not noise.
fn systematic(estimate: &FittedLaw, warnings: &mut Vec<Warning>) {
    let fit = &estimate.fit;
    if fit.effective_samples < SYSTEMATIC * fit.samples as f64 {
        warnings.push(Warning::new(
            Code::CorrelatedResidual,
            format!(
                "the residual is worth {:.0} independent samples of {}: something systematic is left \
                 (another law, cogging, gravity, force and position logged at different instants); it \
                 may bias the parameters by more than their intervals",
                fit.effective_samples, fit.samples
            ),
        ));
    }
}

/// What the logged force did not do drives the simulated axis of an open loop all the same, is summed
/// up twice on its way to the position, and so ends in the parameters.
pub(super) fn open_loop(found: &SimulationFit, trust: &mut Trust, warnings: &mut Vec<Warning>) {
    let fit = &found.position;
    let encoder_only = found.floor.is_some_and(|floor| fit.rmse < ENCODER * floor);
    let shared = found.fitted.parameters.iter().filter(|p| p.identified);
    let unknowns = shared.count() + found.starts();
    if found.is_closed_loop() || encoder_only || fit.effective_samples >= FOR_EACH * unknowns as f64
    {
        return;
    }
    let worth = format!(
        "the residual is worth {:.0} independent samples for {unknowns} unknowns, the starts of the runs \
         included",
        fit.effective_samples
    );
    warnings.retain(|w| w.code != Code::CorrelatedResidual);
    warnings.push(Warning::new(
        Code::CorrelatedResidual,
        format!(
            "{worth}: the logged force drives the simulated axis, so its noise, and any force that is \
             not in it, adds up to a slow error of the position and shifts the parameters by more than \
             their intervals. Cut the log into shorter runs ([simulation] segment in the axis file), or \
             record a closed loop and give its controller ([controller]), which no force noise drives"
        ),
    ));
    trust.reasons.push(format!(
        "{worth}: noise of the logged force is in the parameters and not in their intervals"
    ));
    trust.trustworthy = false;
}

/// A static law says nothing of an axis at rest or in presliding.
fn static_at_rest(estimate: &FittedLaw, motion: Motion, warnings: &mut Vec<Warning>) {
    let Some(slow) = estimate
        .low_speed
        .filter(|_| !estimate.law.kind.has_bristle())
    else {
        return;
    };
    let part = slow.samples as f64 / estimate.fit.samples as f64;
    if part > AT_REST && slow.rmse > 1.5 * estimate.fit.rmse {
        warnings.push(Warning::new(
            Code::StaticLawAtRest,
            format!(
                "{:.0} % of the samples are slower than {:.3e} {}, where a static law says nothing and \
                 most of the residual is: leave them out with [conditioning] min_speed in the axis \
                 file, or use --law lugre",
                100.0 * part,
                estimate.low_speed_bound,
                symbols::speed_unit(motion)
            ),
        ));
    }
}
