//! The delay of the force beside Maxwell-slip elements, from the profile of the cost.
//!
//! Elements change between stick and slip at instants between samples, where the slope of their force by the delay jumps. So the
//! cost has kinks along the delay, and no descent finds where it is least. On the scale of tenths of a sample thousands of
//! reversals average them out: with all else fitted again at each delay the cost is smooth. It is followed downhill on the thinned
//! record from the delay that LuGre finds to where it rises on both sides, and a parabola through points around there, of the whole
//! record, says where it is least.
//!
//! Beside a delay that is too late the force begins before the motion turns. An element that yields at once takes that, with any
//! stiffness, and is missing among the others; the cost has a minimum of its own with it, which no step along the delay leaves. Beside
//! a delay that is too early nothing of the kind fits. So elements are looked for anew on the early side.

mod parabola;
mod profile;

use super::count::MOST;
use super::ladder::Search;
use super::search::{ELEMENTS_ABOVE, search};
use crate::conditioning::record::Record;
use crate::error::Error;
use crate::estimate::uncertainty::sandwich;
use crate::held_delay;
use crate::law::Law;
use crate::law::terms::{Delay, DelayFrom, Terms};
use crate::separable::logs::Logs;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::separable::search_box::MOST_DELAY;
use crate::separable::settings::Settings;
use crate::watch::Watch;
use parabola::Parabola;
use profile::{NARROW, Profile};
use stiction_policy::{choice, delay};
use stiction_search::{Observer, Stage, Status};

/// How much earlier than where the cost is least elements are looked for anew, samples.
const EARLIER: f64 = 1.0;
/// Steps of the descent on the whole record from where the thinned one ended.
const SETTLING_STEPS: usize = 20;
/// Change of the delay, samples, from which on their number is chosen anew.
const FAR: f64 = 0.25;

/// Fits the elements with the delay that they find, beginning at one that is held, which `terms` have and `held` was fitted with. Gives
/// those where the profile has no minimum within the range of a fitted delay, or is flat, and where the law that the delay is from leaves
/// less of the force: then it knows it better. `law` is the one that was asked for.
pub(crate) fn sought(
    record: &Record,
    law: Law,
    terms: &Terms,
    held: Optimum,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<(Terms, Optimum), Error> {
    let Delay::Given(start) = terms.delay else {
        return Ok((terms.clone(), held));
    };
    let start = (start / record.step()).clamp(-MOST_DELAY, MOST_DELAY);
    let mut watch = Watch::new(observer, Stage::Fine);
    watch.counts = held.counts;
    let found = found(record, law, (terms, start), &held, settings, &mut watch)?;
    if let Some(mut found) = found.filter(|_| !watch.stopped) {
        found.1.counts = watch.counts;
        return Ok(found);
    }
    let status = match watch.stopped {
        true => Status::Interrupted,
        false => held.status,
    };
    let kept = Optimum {
        counts: watch.counts,
        status,
        ..held
    };
    Ok((terms.clone(), kept))
}

/// Elements beside a delay, samples.
struct Place {
    delay: f64,
    law: Law,
    p: Vec<f64>,
}

/// The same from a delay, samples; `None` where nothing is found.
fn found(
    record: &Record,
    law: Law,
    (terms, start): (&Terms, f64),
    held: &Optimum,
    settings: &Settings,
    watch: &mut Watch,
) -> Result<Option<(Terms, Optimum)>, Error> {
    let Some(mut place) = walked(record, (terms, start), held, settings, watch)? else {
        return Ok(None);
    };
    let mut profile = Profile::new(record, place.law, terms, record.step())?;
    let near = profile.terms(place.delay);
    let mut search = of(record, law, &near, settings);
    watch.best = f64::INFINITY;
    let rung = search.follow(place.law, &place.p, SETTLING_STEPS, watch)?;
    let mut cost = rung.cost();
    place.p = rung.descent.p;
    let mut elements = held.elements.clone();
    if law.elements == 0 && (place.delay - start).abs() > FAR && !watch.stopped {
        // Beside another delay there may be more or fewer.
        let again = self::search(record, law, &near, settings, &mut *watch.observer)?;
        watch.counts.add(&again.counts);
        watch.stopped |= again.status == Status::Interrupted;
        if again.evaluation.cost <= choice::MAX_EQUAL_ERROR * choice::MAX_EQUAL_ERROR * cost {
            profile = Profile::new(record, again.law, terms, record.step())?;
            cost = again.evaluation.cost;
            elements = again.elements;
            (place.law, place.p) = (again.law, again.p);
        }
    }
    profile.begin(place.delay, cost, place.p);
    let Some(least) = profile.least(place.delay, watch) else {
        return Ok(None);
    };
    if watch.stopped {
        return Ok(None);
    }
    let near = profile.terms(least.at);
    let mut search = of(record, law, &near, settings);
    let rung = search.follow(place.law, &profile.start(least.at), 1, watch)?;
    let optimum = search.finish(rung, watch)?;
    let variance = variance(record, &near, &optimum, &least);
    let cost = optimum.evaluation.cost;
    let least = match terms.delay_from {
        DelayFrom::OtherLaw(rms) => rms * rms * record.kept() as f64,
        DelayFrom::Stated | DelayFrom::Elements => f64::INFINITY,
    };
    // Fewer elements that hold as well on samples that were left out may leave a little more.
    let no_worse = cost <= held.evaluation.cost || optimum.law.elements < held.law.elements;
    let found = variance < delay::MIN_FLAT_DEVIATION * delay::MIN_FLAT_DEVIATION
        && no_worse
        && cost < least;
    Ok(found.then(|| {
        let terms = Terms {
            delay_deviation: variance.sqrt() * record.step(),
            delay_from: DelayFrom::Elements,
            ..near
        };
        let iterations = held.iterations + optimum.iterations;
        let optimum = Optimum {
            elements,
            iterations,
            ..optimum
        };
        (terms, optimum)
    }))
}

/// A search for elements of a law.
fn of<'a>(record: &'a Record, law: Law, terms: &'a Terms, settings: &'a Settings) -> Search<'a> {
    Search {
        record,
        law: Law { elements: 0, ..law },
        terms,
        settings,
        iterations: 0,
    }
}

/// Where the cost is least on the thinned record, to some tenth of a sample: from a delay on, and with as many elements that are looked
/// for anew earlier than that.
fn walked(
    record: &Record,
    (terms, start): (&Terms, f64),
    held: &Optimum,
    settings: &Settings,
    watch: &mut Watch,
) -> Result<Option<Place>, Error> {
    let thinned = record.rough(settings.thin);
    let near = thinned.as_ref().unwrap_or(record);
    let unit = record.step();
    watch.best = f64::INFINITY;
    let mut own = Profile::new(near, held.law, terms, unit)?;
    own.descend(start, &held.p, watch);
    let Some(valley) = own.valley(start, watch) else {
        return Ok(None);
    };
    let early = (valley - EARLIER).max(-MOST_DELAY);
    let beside = own.terms(early);
    let wanted = held.law.elements;
    let most = (wanted + ELEMENTS_ABOVE).min(MOST);
    let mut search = of(near, held.law, &beside, settings);
    let rungs = search.ladder(most, wanted, watch)?;
    let mut best = (own, valley);
    if let Some(rung) = rungs.into_iter().next_back() {
        let mut anew = Profile::new(near, rung.law, terms, unit)?;
        anew.begin(early, rung.cost(), rung.descent.p);
        if let Some(other) = anew.valley(early, watch)
            && anew.cost(other, watch) < best.0.cost(valley, watch)
        {
            best = (anew, other);
        }
    }
    let (mut profile, valley) = best;
    let delay = profile.near(valley, watch);
    Ok(Some(Place {
        delay,
        law: profile.law,
        p: profile.start(delay),
    }))
}

/// Variance of the delay at a minimum, samples^2: of one more unknown beside all others, with the correlation of what is left counted
/// as for these. Where the cost rises less along the profile than beside linear unknowns, by as much more; and what the points of
/// the profile scatter about the parabola.
fn variance(record: &Record, terms: &Terms, optimum: &Optimum, least: &Parabola) -> f64 {
    let objective = Objective::new(record, optimum.law, terms);
    let at = &optimum.evaluation;
    let (unit, by) = (record.step(), NARROW);
    let fit = (&optimum.p[..], at);
    let mut column = held_delay::column(&objective, terms, fit, least.at * unit, by * unit);
    column.iter_mut().for_each(|x| *x /= by);
    let mut jacobian = at.jacobian();
    jacobian.push(&column);
    let within = Logs::of(record).and_then(|logs| logs.within(at));
    let residual = within.as_deref().unwrap_or(at.residual());
    let known = sandwich(&jacobian, residual, &record.breaks());
    let own = jacobian.len() - 1;
    let softer = (1.0 / (known.bread[(own, own)] * least.curvature)).max(1.0);
    known.covariance[(own, own)] * softer * softer + least.scatter
}
