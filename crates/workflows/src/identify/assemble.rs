//! From what the engine found to what goes to disk.

use super::compensation;
use super::effects;
use super::load::Asked;
use super::method::Method;
use super::operating_range;
use super::remaining::remaining;
use super::trust::Judged;
use crate::entries;
use crate::source::Source;
use stiction_files::Axis;
use stiction_files::axis::{ListedLog, Use};
use stiction_files::result::{
    Action, CovarianceEntry, ElementsEntry, HalfWidthEntry, LawEntry, LowSpeedEntry, Origin,
    ParameterEntry, PartnerEntry, ResolvedAxis, ResultFile, SCHEMA, Search, Unsettled,
    ValidationEntry,
};
use stiction_files::symbols;
use stiction_identify::{
    Delay, DelayFrom, Fit, FittedLaw, IntervalKind, Parameter, Record, Series,
};
use stiction_log::Motion;
use stiction_number::four_digits;
use stiction_parameters::{Name, Quantity};
use stiction_policy::conditioning;

/// What a result is made of.
pub(super) struct Parts<'a> {
    pub asked: Asked<'a>,
    pub sources: &'a [Source],
    /// How the logs were treated.
    pub conditioning: Vec<String>,
    /// What of them is not fitted at the start and after gaps, where that is much.
    pub unsettled: Option<Unsettled>,
    pub law: &'a FittedLaw,
    pub validation: &'a [(String, Series)],
    /// Laws side by side; empty where they were not compared.
    pub laws: Vec<LawEntry>,
    /// By how much later than in their rows the force of all logs was taken, s.
    pub late: f64,
    /// What of the law is left out.
    pub without: Vec<String>,
    /// Who chose the law.
    pub law_chosen_by: &'static str,
    pub judged: Judged,
}

/// Whether logs are all that the axis file lists to be fitted.
fn are_listed(axis: &Axis, sources: &[Source]) -> bool {
    let fitted = |log: &&ListedLog| log.mapping(Use::Fitted).is_some();
    let given = |log: &ListedLog| sources.iter().any(|source| log.is(&source.path));
    let own = |source: &Source| axis.logs.iter().any(|log| log.is(&source.path));
    !axis.logs.is_empty() && axis.logs.iter().filter(fitted).all(given) && sources.iter().all(own)
}

/// What of a record is not fitted at the start and after gaps, where that is much.
pub(super) fn unsettled(record: &Record, travel: f64) -> Option<Unsettled> {
    let (seconds, part) = record
        .unsettled()
        .filter(|(_, part)| *part >= conditioning::MIN_REPORTED_SHARE)?;
    Some(Unsettled {
        seconds,
        part,
        travel,
    })
}

/// A cure as it goes into an axis file: in place of a line with its key, where the file has one. None where it is about one log and the
/// file lists several.
fn in_file(cure: Action, axis: &Axis) -> Option<Action> {
    let Action::Line { table, line, .. } = cure else {
        return Some(cure);
    };
    if table == "log" && !axis.logs.is_empty() {
        return None;
    }
    let replaces = axis.gives(&format!("{table}.{}", Action::key(&line)));
    Some(Action::Line {
        table,
        line,
        replaces,
    })
}

/// The result without the entries that only one method has.
pub(super) fn result(parts: Parts) -> ResultFile {
    let Parts {
        asked,
        sources,
        law: estimate,
        mut judged,
        ..
    } = parts;
    if let Some(cause) = &mut judged.trust.cause {
        cause.cure = cause.cure.take().and_then(|cure| in_file(cure, asked.axis));
    }
    let first = &sources[0].log;
    let (motion, force_unit) = (first.motion, first.force_unit.as_str());
    let signal = symbols::driver(motion, force_unit);
    let fit_entry = |fit: &Fit| entries::fit(fit, signal, force_unit);
    let low_entry = |fit: &Fit| LowSpeedEntry {
        bound: estimate.low_speed_bound,
        bound_unit: symbols::speed_unit(motion).into(),
        fit: fit_entry(fit),
    };
    let validation = parts
        .validation
        .iter()
        .filter_map(|(path, series)| {
            let residual = series.residual();
            let fit = Fit::new(&series.measured, &residual)?;
            let slow = Fit::slow(
                &series.measured,
                &residual,
                &series.velocity,
                estimate.low_speed_bound,
            );
            Some(ValidationEntry {
                path: path.clone(),
                fit: fit_entry(&fit),
                low_speed: slow.as_ref().map(low_entry),
            })
        })
        .collect();
    let covariance = estimate.covariance.finite();
    ResultFile {
        schema: SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        seed: asked.options.seed,
        inputs: sources
            .iter()
            .map(|source| source.input(asked.options.procedures.method.fits_force()))
            .collect(),
        axis: ResolvedAxis {
            name: asked.axis.name.clone(),
            file: asked.axis.file().map(stiction_files::shell::text),
            listed: are_listed(asked.axis, sources),
            limits: asked.axis.limits.is_some(),
            kind: motion.to_string(),
            force_unit: force_unit.into(),
            columns: first.detected.clone(),
            conditioning: parts.conditioning,
            unsettled: parts.unsettled,
            terms: term_names(estimate, motion),
        },
        law: estimate.law.kind.name().into(),
        asymmetric: estimate.law.asymmetric,
        without: parts.without,
        law_chosen_by: parts.law_chosen_by.into(),
        method: asked.options.procedures.method.name().into(),
        trust: judged.trust,
        parameters: estimate
            .parameters
            .iter()
            .map(|p| match p.name.quantity {
                Quantity::Delay => whole_delay(p, parts.late),
                _ => p.clone(),
            })
            .map(|p| parameter(&p, motion, force_unit, &first.load_unit))
            .collect(),
        covariance: CovarianceEntry {
            names: covariance.names.iter().map(Name::to_string).collect(),
            matrix: covariance.matrix,
        },
        remaining: (asked.options.procedures.method.fits_force())
            .then(|| remaining(&estimate.series, presliding(estimate)))
            .flatten(),
        fit: fit_entry(&estimate.fit),
        low_speed: estimate.low_speed.as_ref().map(low_entry),
        effects: effects::entries(estimate, &parts.laws, motion, force_unit),
        validation,
        simulation: None,
        laws: parts.laws,
        static_map: None,
        static_then_dynamic: None,
        presliding_step: None,
        planned: None,
        break_away: Vec::new(),
        elements: elements(estimate),
        top_speed: top_speed(estimate),
        range: operating_range::range(sources, &estimate.series, &estimate.terms),
        pitch: operating_range::pitch(&estimate.terms),
        friction_curve: None,
        level_along: operating_range::level_along(estimate),
        search: Search {
            status: estimate.status.into(),
            evaluations: estimate.counts.total(),
            with_sensitivities: estimate.counts.with_derivatives(),
            thinned: estimate.counts.coarse(),
            iterations: estimate.iterations,
            wall_s: asked.clock.elapsed().as_secs_f64(),
        },
        searched: None,
        warnings: judged.warnings,
    }
}

/// Travel over which the friction of bristles reverses, m or rad; NaN for a law without bristles.
fn presliding(estimate: &FittedLaw) -> f64 {
    let value = |quantity: Quantity| {
        let of = estimate
            .parameters
            .iter()
            .filter(|p| p.name.quantity == quantity);
        of.map(|p| p.value).fold(f64::NAN, f64::max)
    };
    value(Quantity::Coulomb) / value(Quantity::Sigma0)
}

fn top_speed(estimate: &FittedLaw) -> Option<f64> {
    let top = compensation::top_speed(&estimate.series);
    (top > 0.0 && top.is_finite()).then_some(top)
}

fn elements(estimate: &FittedLaw) -> Vec<ElementsEntry> {
    let tried = estimate.elements.iter();
    tried
        .map(|score| ElementsEntry {
            elements: score.elements,
            fitted_error_percent: score.fitted_error_percent,
            held_out_error_percent: score.held_out_error_percent,
            chosen: score.elements == estimate.law.elements,
        })
        .collect()
}

/// The delay against the rows of the logs, of which the fit has seen what is left after the force was taken later.
fn whole_delay(further: &Parameter, late: f64) -> Parameter {
    Parameter {
        value: further.value + late,
        ci95: further.ci95.map(|(low, high)| (low + late, high + late)),
        ..further.clone()
    }
}

fn parameter(p: &Parameter, motion: Motion, force_unit: &str, load_unit: &str) -> ParameterEntry {
    ParameterEntry {
        name: p.name.to_string(),
        symbol: p.name.symbol(),
        value: p.value,
        unit: symbols::unit(p.name.dimension(), motion, force_unit, load_unit),
        std: p.std,
        bias: p.bias,
        ci95: p
            .ci95
            .map(|(low, high)| [low, high].map(|x| Some(x).filter(|x| x.is_finite()))),
        half_width: p.half.map(|half| HalfWidthEntry {
            at_once: half.at_once,
            repeat: half.repeat,
            transfer: half.transfer,
        }),
        interval: p.ci95.map(|_| p.interval.name().into()),
        identifiable: p.identifiable,
        origin: if p.identified {
            Origin::Identified
        } else {
            Origin::Given
        },
        reason: p.reason.clone(),
        moves_with: p
            .moves_with
            .iter()
            .map(|(name, correlation)| PartnerEntry {
                name: name.to_string(),
                correlation: *correlation,
            })
            .collect(),
        advice: p.advice.clone(),
    }
}

/// What the correction of the bias did to the parameters; nothing where there was none.
pub(super) fn correction_note(estimate: &FittedLaw) -> Option<String> {
    let correction = |p: &Parameter| -p.bias.unwrap_or(0.0);
    let relative = |p: &&Parameter| (correction(p) / p.value).abs();
    let most = estimate
        .parameters
        .iter()
        .filter(|p| p.identifiable && correction(p) != 0.0 && p.value != 0.0)
        .filter(|p| p.name != Quantity::Offset && p.name != Quantity::Delay)
        .max_by(|a, b| relative(a).total_cmp(&relative(b)))?;
    Some(format!(
        "bias of filters, encoder steps and noise measured on simulated logs of the fitted axis and \
         taken out: {} changed most, by {}",
        most.name,
        stiction_number::Percent::error(100.0 * correction(most) / most.value).signed(2)
    ))
}

/// A note on the last step, where the counts of the encoder were asked.
pub(super) fn counts_note(estimate: &FittedLaw) -> Option<String> {
    let on_counts = |p: &Parameter| p.interval == IntervalKind::StateSpace;
    estimate.parameters.iter().any(on_counts).then(|| {
        "the axis rests in much of the log, where a fit of the force takes filtered encoder counts for motion: parameters and \
         intervals are those of an axis simulated under the logged force (state-space likelihood of the counts); \
         fit.csv and the errors belong to the fit of the force"
            .into()
    })
}

/// A note on where the delay beside a Maxwell-slip law comes from, which no descent finds.
pub(super) fn delay_note(estimate: &FittedLaw, late: f64) -> Option<String> {
    let Delay::Given(delay) = estimate.terms.delay else {
        return None;
    };
    let deviation = estimate.terms.delay_deviation;
    let ms = |seconds: f64| four_digits(1e3 * seconds);
    let (all, open) = (ms(delay + late), ms(deviation));
    match estimate.terms.delay_from {
        DelayFrom::Elements => Some(format!(
            "delay between force and motion: {all} ms (std {open} ms), where the elements explain the force best, fitted again at each \
             delay; the intervals of all else count what is open of it"
        )),
        DelayFrom::OtherLaw(_) if deviation > 0.0 => Some(format!(
            "delay between force and motion: beside the elements it stays open, or lugre explains the force better; held at the {all} ms \
             (std {open} ms) that lugre finds on the same log, and the intervals count what is open of it"
        )),
        DelayFrom::OtherLaw(_) | DelayFrom::Stated => None,
    }
}

/// A note that a measured acceleration is not used by the method.
pub(super) fn acceleration_note(asked: Asked, sources: &[Source]) -> Option<String> {
    let has_one = sources.iter().any(|s| s.log.acceleration.is_some());
    let takes_it = asked.options.procedures.method == Method::StaticThenDynamic;
    (has_one && !takes_it).then(|| {
        format!(
            "the measured acceleration is compared with the position and not used: the method {} takes it, where it is \
             better than the derivative of the position",
            Method::StaticThenDynamic.name()
        )
    })
}

/// Names of the linear terms that stand beside the law.
fn term_names(estimate: &FittedLaw, motion: Motion) -> Vec<String> {
    let beside = |quantity: Quantity| {
        !matches!(
            quantity,
            Quantity::Sigma0
                | Quantity::Sigma1
                | Quantity::Sigma2
                | Quantity::Coulomb
                | Quantity::Static
                | Quantity::StribeckVelocity
                | Quantity::StribeckExponent
                | Quantity::BreakawayRatio
                | Quantity::Attraction
        ) && !quantity.is_a_reference()
    };
    estimate
        .parameters
        .iter()
        .filter(|p| beside(p.name.quantity) && !p.name.quantity.is_of_an_element())
        .map(|p| format!("{} ({})", p.name, symbols::meaning_of(p.name, motion)))
        .collect()
}
