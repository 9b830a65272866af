//! `--method static-then-dynamic`: the static map, then sigma0 and sigma1 with it held, beside the
//! joint fit of the same record.

use super::curve;
use crate::error::Error;
use crate::identify::beside::Beside;
use crate::identify::load::Asked;
use crate::identify::logs::refused;
use crate::identify::searched;
use crate::source::Source;
use stiction_files::Warning;
use stiction_files::result::{
    ResultFile, SearchedEntry, StaticMapEntry, TwoStepEntry, TwoStepParameter,
};
use stiction_files::symbols;
use stiction_identify as engine;
use stiction_identify::procedure::{dynamic_conditioned, dynamic_near};
use stiction_identify::{
    Accelerometer, Delay, Estimate, FittedLaw, Law, LawKind, Observer, Record, Settings, Terms,
};
use stiction_log::Motion;
use stiction_parameters::{Name, Quantity};
use stiction_policy::{agreement, choice, interval};
use stiction_say::{Differs, Notice, Sought};

/// Standard deviations beyond which their number says nothing more.
const MOST_DEVIATIONS_WRITTEN: f64 = 100.0;

/// What the two steps work on.
pub(in crate::identify) struct TwoStep<'a> {
    pub asked: Asked<'a>,
    pub sources: &'a [Source],
    pub beside: &'a Beside,
    pub record: &'a Record,
    /// Linear terms beside the law as asked for, and beside its counterpart: asymmetric for symmetric, or the
    /// reverse.
    pub terms: [&'a Terms; 2],
    pub low_speed: f64,
    pub settings: &'a Settings,
}

/// The joint fit beside the one in two steps, and where the statics come from.
pub(in crate::identify) struct TwoSteps {
    joint: Estimate,
    /// Whether the motion has another steady friction than the map.
    pub changed: bool,
    from: &'static str,
    map: Option<StaticMapEntry>,
    searched: Option<SearchedEntry>,
    pub warnings: Vec<Warning>,
    accelerometer: Option<Accelerometer>,
    has_acceleration: bool,
}

/// Fits in two steps, and all at once.
pub(in crate::identify) fn two_step(
    parts: TwoStep,
    observer: &mut dyn Observer,
) -> Result<(Estimate, TwoSteps), Error> {
    let allowed = "the dynamic parameters are those of lugre";
    let options = parts.asked.options;
    options.require(&[LawKind::LuGre], allowed)?;
    let known = curve::known(parts.asked, parts.sources, parts.beside, observer)?;
    let fail = |e| refused(parts.sources, e);
    let statics = &known.statics;
    // A model may be asymmetric where a symmetric law was asked for, or the reverse.
    let terms = parts.terms[usize::from(statics.asymmetric != options.asymmetric)];
    let law = Law {
        asymmetric: statics.asymmetric,
        exponent: statics.exponent,
        ..Law::new(LawKind::LuGre)
    };
    let low_speed = parts.low_speed;
    let measured = parts.record.with_accelerometer();
    let record = measured.as_ref().map_or(parts.record, |(record, _)| record);
    // Intervals rest on simulated encoders: a measured acceleration has none, and a search alone has no intervals.
    let is_derived = measured.as_ref().is_none_or(|(_, found)| !found.taken);
    let is_stated = is_derived && !options.searching.no_finish;
    let joint = match is_stated {
        true => engine::identify(record, law, terms, low_speed, parts.settings, observer),
        false => engine::fit_law(record, law, terms, low_speed, parts.settings, observer)
            .map(|(joint, _)| joint),
    };
    let joint = joint.map_err(fail)?;
    // The delay belongs to the log, not to friction: both see the same.
    let delay = match (joint.terms.delay, joint.value("delay")) {
        (Delay::Fitted, Some(time)) => Delay::Given(time),
        (known, _) => known,
    };
    let terms = Terms {
        delay,
        ..terms.clone()
    };
    let sources = parts.sources;
    let step = searched::dynamic(parts.asked, sources, record, statics, &terms, observer)?;
    let near = step.as_ref().map(|step| step.near[0]);
    let mut warnings = known.warnings;
    let mut estimate;
    if let Some(step) = step.as_ref().filter(|_| options.searching.no_finish) {
        warnings.extend(step.warning());
        let of = |quantity: Quantity| {
            let found = step.values.iter().find(|(name, _)| *name == quantity);
            found.map_or(0.0, |(_, value)| *value)
        };
        let coulomb = of(Quantity::Coulomb);
        let unknowns = [
            libm::log(of(Quantity::Sigma0) / coulomb),
            libm::log(of(Quantity::Static) / coulomb - 1.0),
            libm::log(of(Quantity::StribeckVelocity)),
        ];
        let held = [Quantity::Sigma1, Quantity::Sigma2, Quantity::Coulomb];
        let held = held.map(|quantity| (quantity.into(), of(quantity)));
        // The law and its terms, with the numbers of the search alone.
        let of_the_law = joint.clone().beside(terms);
        estimate = of_the_law
            .as_searched(record, &unknowns, &held)
            .map_err(fail)?;
    } else {
        let dynamic = |near, observer: &mut dyn Observer| {
            dynamic_near(near, record, statics, &terms, low_speed, observer).map_err(fail)
        };
        estimate = dynamic(near, observer)?;
        let everywhere = match near {
            Some(_) => Some(dynamic(None, observer)?),
            None => None,
        };
        if let Some(everywhere) = everywhere
            && everywhere.fit.rmse < estimate.fit.rmse * (1.0 - choice::MAX_EQUAL_RESIDUAL)
        {
            estimate = everywhere;
            let sought = Sought::Bristles;
            warnings.push(Notice::SearchMissed { sought }.into());
        }
    }
    if let Some(step) = &step {
        estimate.count(&step.counts);
    }
    if is_stated {
        let delay = joint.parameter(Quantity::Delay);
        let deviation = delay.and_then(|delay| delay.std).unwrap_or(0.0);
        dynamic_conditioned(record, statics, &mut estimate, deviation, observer);
    }
    let changed = changed(&mut estimate, &joint);
    warnings.extend(disagree(&changed, parts.sources));
    if known.interrupted || step.as_ref().is_some_and(|step| step.interrupted) {
        estimate = estimate.interrupted();
    }
    let beside = TwoSteps {
        joint,
        changed: !changed.is_empty(),
        from: known.from,
        map: known.map,
        searched: step.map(|step| step.entry),
        warnings,
        accelerometer: measured.map(|(_, found)| found),
        has_acceleration: sources.iter().any(|s| s.log.acceleration.is_some()),
    };
    Ok((estimate, beside))
}

/// A parameter of the steady curve that the motion has differently from the map: its name, and the two values.
type Changed = (Name, [f64; 2]);

/// What of the steady curve the joint fit of the motion has by a tenth or more differently, beyond chance. It is no constant of
/// the machine, and neither is what was found with it held.
fn changed(estimate: &mut Estimate, joint: &Estimate) -> Vec<Changed> {
    let levels = [Quantity::Coulomb, Quantity::Static, Quantity::Sigma2];
    let mut found = Vec::new();
    for p in &joint.parameters {
        if !(levels.contains(&p.name.quantity) && p.identifiable) {
            continue;
        }
        let Some(held) = estimate.parameter(p.name).filter(|p| p.identifiable) else {
            continue;
        };
        let difference = p.value - held.value;
        let deviation = p.std.unwrap_or(0.0).hypot(held.std.unwrap_or(0.0));
        if difference.abs() >= agreement::MAX_CONSTANT_DIFFERENCE * held.value
            && difference.abs() > agreement::MAX_CHANCE_DEVIATIONS * deviation
        {
            found.push((p.name, [held.value, p.value]));
        }
    }
    if found.is_empty() {
        return found;
    }
    estimate.doubt(|p| {
        if found.iter().any(|(name, _)| p.name == *name) {
            return Some(
                "this motion has it by a tenth or more differently from the static parameters",
            );
        }
        let follows = [Quantity::Sigma0, Quantity::Sigma1, Quantity::Mass];
        follows
            .contains(&p.name.quantity)
            .then_some("was found with static parameters that this motion has not")
    });
    found
}

fn disagree(changed: &[Changed], sources: &[Source]) -> Option<Warning> {
    let log = &sources.first()?.log;
    let each: Vec<Differs> = changed
        .iter()
        .map(|(name, [there, here])| Differs {
            name: name.to_string(),
            here: *here,
            there: *there,
            unit: symbols::unit(name.dimension(), log.motion, &log.force_unit, ""),
        })
        .collect();
    (!each.is_empty()).then(|| Notice::StaticsDiffer { each }.into())
}

/// What became of a measured acceleration, in words.
fn worth(found: &Accelerometer, motion: Motion) -> String {
    let four = stiction_number::four_digits;
    let unit = symbols::acceleration_unit(motion);
    let choice = match found.taken {
        true => "as measured, with gain, lag and offset taken out",
        false => "the derivative of the position, since the measured one is not better",
    };
    format!(
        "acceleration: {choice}; the measured one has {} {unit} rms of noise after the filters, the derivative {}; it shows {} \
         times the acceleration, {} ms late, and {} {unit} without any (a gain within 5 % of 1 is taken)",
        four(found.noise),
        four(found.derivative_noise),
        four(found.gain),
        four(1e3 * found.lag),
        four(found.offset),
    )
}

impl TwoSteps {
    /// Puts the comparison into the result.
    pub fn into_result(self, law: &FittedLaw, result: &mut ResultFile, motion: Motion) {
        let unit = &result.axis.force_unit;
        let parameters: Vec<TwoStepParameter> = law
            .parameters
            .iter()
            .filter(|p| p.identified)
            .filter_map(|p| {
                let other = self.joint.parameter(p.name)?;
                Some(TwoStepParameter {
                    name: p.name.to_string(),
                    unit: symbols::unit(p.name.dimension(), motion, unit, ""),
                    value: p.value,
                    std: p.std,
                    joint: other.value,
                    joint_std: other.std,
                    difference_in_std: other
                        .std
                        .filter(|s| *s > 0.0)
                        .map(|s| (p.value - other.value) / s),
                })
            })
            .collect();
        let acceleration = match &self.accelerometer {
            Some(found) => Some(worth(found, motion)),
            None => self.has_acceleration.then(|| {
                "acceleration: the derivative; a measured one is compared where every log has it and a position, and shows the \
                 motion at all"
                    .to_string()
            }),
        };
        let mut explanation: Vec<String> = acceleration.into_iter().collect();
        explanation.extend(self.explanation(law, &parameters, unit));
        result.static_then_dynamic = Some(TwoStepEntry {
            statics: self.from.into(),
            rmse: law.fit.rmse,
            joint_rmse: self.joint.fit.rmse,
            parameters,
            explanation,
        });
        result.static_map = self.map;
        result.searched = self.searched;
    }

    fn explanation(
        &self,
        law: &FittedLaw,
        parameters: &[TwoStepParameter],
        unit: &str,
    ) -> Vec<String> {
        let mut out = Vec::new();
        let (two, one) = (law.fit.rmse, self.joint.fit.rmse);
        out.push(format!(
            "On this record the two steps leave {} {unit} rms and the joint fit {} {unit}: the joint \
             fit may change every parameter, so its residual is always the smaller one; the difference is \
             the cost of static parameters that were found on another motion.",
            stiction_number::four_digits(two),
            stiction_number::four_digits(one)
        ));
        let apart: Vec<&TwoStepParameter> = parameters
            .iter()
            .filter(|p| {
                p.difference_in_std
                    .is_some_and(|d| d.abs() > agreement::MIN_EXPLAINED_DEVIATIONS)
            })
            .collect();
        if apart.is_empty() {
            out.push(format!(
                "No parameter differs by more than {} standard deviations of the joint fit.",
                agreement::MIN_EXPLAINED_DEVIATIONS
            ));
        } else {
            let list: Vec<String> = apart
                .iter()
                .map(|p| {
                    let d = p.difference_in_std.unwrap_or(0.0);
                    let by = match d.abs() > MOST_DEVIATIONS_WRITTEN {
                        true => format!("more than {MOST_DEVIATIONS_WRITTEN}"),
                        false => format!("{d:+.1}"),
                    };
                    format!("{} by {by}", symbols::symbol(&p.name))
                })
                .collect();
            out.push(format!(
                "In standard deviations of the joint fit they differ in {}.",
                list.join(", ")
            ));
        }
        let differs = |stem: &str| apart.iter().any(|p| p.name.starts_with(stem));
        if differs("coulomb") || differs("sigma2") || differs("static") || differs("stribeck") {
            out.push(
                "The static map is made at constant velocity: no acceleration, no lag and no \
                 break-away are in it, so neither mass nor delay can bias it. The joint fit sees \
                 friction as it is in this motion, at its temperature and lubrication. If the two \
                 disagree, the steady curve is not the same in both, or force and position of the log \
                 do not belong to the same instants."
                    .into(),
            );
        }
        for (a, b) in self.confused() {
            out.push(format!(
                "In the joint fit {} and {} can hardly be told apart (correlation {:+.2}): a change of \
                 one is compensated by the other. The constant velocities tell them apart.",
                a.0.symbol(),
                a.1.symbol(),
                b
            ));
        }
        let wider = |name: &str| {
            let p = parameters.iter().find(|p| p.name == name)?;
            Some(p.std? > 2.0 * p.joint_std?)
        };
        if wider("sigma1") == Some(true) || wider("sigma0") == Some(true) {
            out.push(
                "σ₀ and σ₁ are less certain in two steps: errors of the static map add to theirs, \
                 and their intervals include that. More and longer runs at low speeds narrow them."
                    .into(),
            );
        }
        out
    }

    /// Pairs of steady parameters that the joint fit cannot tell apart.
    fn confused(&self) -> Vec<((Name, Name), f64)> {
        let covariance = &self.joint.covariance;
        let correlation = covariance.correlation();
        let steady = |name: &Name| {
            name.quantity.is_of_the_steady_curve()
                || matches!(
                    name.quantity,
                    Quantity::CoulombLoad
                        | Quantity::CoulombTemperature
                        | Quantity::CoulombPosition
                        | Quantity::CoulombPitch(..)
                        | Quantity::CoulombMap(_)
                        | Quantity::CoulombTransmitted
                        | Quantity::CoulombDriven
                        | Quantity::Sigma2Temperature
                )
        };
        let mut out = Vec::new();
        for (i, (a, row)) in covariance.names.iter().zip(&correlation).enumerate() {
            for (b, x) in covariance.names.iter().zip(row).skip(i + 1) {
                if steady(a) && steady(b) && x.abs() >= interval::MIN_CONFUSED_CORRELATION {
                    out.push(((*a, *b), *x));
                }
            }
        }
        out
    }
}
