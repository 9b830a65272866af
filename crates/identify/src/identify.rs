//! A law fitted to a record: the search, the delay, the estimate, its intervals.

use crate::conditioning::record::Record;
use crate::error::Error;
use crate::estimate::intervals::intervals;
use crate::estimate::{Estimate, estimate, uncertainty};
use crate::gms;
use crate::law::Law;
use crate::law::terms::{Delay, DelayFrom, Terms};
use crate::separable::optimum::Optimum;
use crate::separable::settings::Settings;
use crate::separable::{follow, separable};
use stiction_search::{Observer, Status};

/// Part of the weight by which what is transmitted may differ from the fitted one.
const SAME_WEIGHT: f64 = 1e-6;
/// Most renewals of what is transmitted; each leaves about the part of it that is friction, some tenths, of the difference.
const MOST_WEIGHTS: usize = 12;

/// Fits a law by the separable method and states its parameters, with intervals that count what encoder, filters and a
/// curved cost do ([`intervals`]). An interrupted search gives the best found so far, without intervals.
///
/// A fitted delay that reaches the end of its range is no delay but some other effect that the law does
/// not explain: it is set to zero and the law is fitted again, as the terms of the estimate then say. Where friction depends on
/// what is transmitted and the weight is fitted, it is fitted again with that weight until both are one. Beside a Maxwell-slip law
/// a delay that is to be fitted is first held at what LuGre finds of it on the same record, and from there looked for along the
/// profile of the cost of the elements; where that shows none, it stays there.
///
/// # Errors
/// Those of [`separable`].
pub fn identify(
    record: &Record,
    law: Law,
    terms: &Terms,
    low_speed_bound: f64,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Estimate, Error> {
    let (mut estimate, optimum) = fit_law(record, law, terms, low_speed_bound, settings, observer)?;
    if estimate.status != Status::Interrupted {
        intervals(record, &optimum, &mut estimate, observer);
    }
    Ok(estimate)
}

/// [`identify`] without the full intervals, for comparing laws: the intervals of the estimate are linear
/// and too narrow until [`intervals`] has widened them.
///
/// # Errors
/// Those of [`separable`].
pub fn fit_law(
    record: &Record,
    law: Law,
    terms: &Terms,
    low_speed_bound: f64,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<(Estimate, Optimum), Error> {
    if terms.asks_delay_of_another(&law) {
        let other = delay_of_another(record, law, terms, low_speed_bound, settings, observer);
        // What LuGre cannot be fitted to has too little for elements as well, which say what they need.
        let held = match other {
            Ok((other, _)) => terms.holding_delay_of(&other),
            Err(_) => Terms {
                delay: Delay::NONE,
                ..terms.clone()
            },
        };
        return fit_law(record, law, &held, low_speed_bound, settings, observer);
    }
    let (fitted, optimum) = stated(
        record,
        law,
        terms,
        low_speed_bound,
        |terms, from| match from {
            None => separable(record, law, terms, settings, observer),
            Some(from) => follow(from, record, law, terms, settings, observer),
        },
    )?;
    let seeks = law.kind.has_elements() && matches!(terms.delay_from, DelayFrom::OtherLaw(_));
    if !seeks || optimum.status == Status::Interrupted {
        return Ok((fitted, optimum));
    }
    let (terms, optimum) =
        gms::delay::sought(record, law, &fitted.terms, optimum, settings, observer)?;
    let fitted = estimate(record, law, &terms, &optimum, low_speed_bound);
    Ok((fitted, optimum))
}

/// The law that says where another one begins to look for the delay ([`Terms::asks_delay_of_another`]), with its full intervals, and the end of
/// its search, which [`fit_law`] leaves. [`Terms::holding_delay_of`] it is what stands beside the other law.
///
/// # Errors
/// Those of [`separable`].
pub fn delay_of_another(
    record: &Record,
    law: Law,
    terms: &Terms,
    low_speed_bound: f64,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<(Estimate, (Estimate, Optimum)), Error> {
    let settings = Settings {
        bounds: None,
        ..settings.clone()
    };
    let law = law.that_finds_delay();
    let left = fit_law(record, law, terms, low_speed_bound, &settings, observer)?;
    let mut estimate = left.0.clone();
    if estimate.status != Status::Interrupted {
        intervals(record, &left.1, &mut estimate, observer);
    }
    Ok((estimate, left))
}

/// [`fit_law`] by least squares from the end point of another search.
///
/// `start` holds the nonlinear unknowns in the order of the law, then the delay in samples, which may be left out;
/// [`Optimum::start_for`] makes one of the end point of another law.
///
/// # Errors
/// Those of [`separable`], and for another number of unknowns.
pub fn fit_law_from(
    start: &[f64],
    record: &Record,
    law: Law,
    terms: &Terms,
    low_speed_bound: f64,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<(Estimate, Optimum), Error> {
    stated(record, law, terms, low_speed_bound, |terms, from| {
        follow(
            from.unwrap_or(start),
            record,
            law,
            terms,
            settings,
            observer,
        )
    })
}

/// Fits with `fit`, which begins anew or from the end of another fit, until all that the terms assume is what comes out.
fn stated(
    record: &Record,
    law: Law,
    terms: &Terms,
    low_speed_bound: f64,
    mut fit: impl FnMut(&Terms, Option<&[f64]>) -> Result<Optimum, Error>,
) -> Result<(Estimate, Optimum), Error> {
    let mut optimum = fit(terms, None)?;
    let mut used = terms.clone();
    if terms.delay == Delay::Fitted
        && optimum.delay_at_bound()
        && optimum.status != Status::Interrupted
    {
        used.delay = Delay::NONE;
        optimum = fit(&used, None)?;
    }
    for _ in 0..MOST_WEIGHTS {
        let c = &optimum.evaluation.solution.coefficients;
        let renewed = used.weighing(record, &optimum.law, c, SAME_WEIGHT);
        let Some(renewed) = renewed.filter(|_| optimum.status != Status::Interrupted) else {
            break;
        };
        let mut next = fit(&renewed, Some(&optimum.p))?;
        next.counts.add(&optimum.counts);
        next.iterations += optimum.iterations;
        (optimum, used) = (next, renewed);
    }
    if terms.prior.is_none()
        && optimum.status != Status::Interrupted
        && let Some(prior) = uncertainty::prior(record, &optimum, &used)
    {
        used.prior = Some(prior);
        let mut starts = vec![optimum.p.clone()];
        if law.has_stribeck() {
            starts.push(prior.expected(&law, &optimum.p));
        }
        let mut found: Option<Optimum> = None;
        for start in starts {
            let mut next = fit(&used, Some(&start))?;
            next.counts.add(&optimum.counts);
            next.iterations += optimum.iterations;
            if found
                .as_ref()
                .is_none_or(|best| next.evaluation.cost < best.evaluation.cost)
            {
                found = Some(next);
            }
        }
        optimum = found.unwrap_or(optimum);
    }
    let estimate = estimate(record, law, &used, &optimum, low_speed_bound);
    Ok((estimate, optimum))
}
