//! The separable method: scan the box, descend from the best points, finish on the full record.

pub(crate) mod checked;
pub(crate) mod coarse;
pub(crate) mod descent;
pub(crate) mod dual;
pub(crate) mod elasto_plastic;
pub(crate) mod fixed;
pub(crate) mod in_lanes;
pub(crate) mod linear;
pub(crate) mod logs;
pub(crate) mod moving;
pub(crate) mod nonnegative;
pub(crate) mod objective;
pub(crate) mod optimum;
pub(crate) mod recursion;
pub(crate) mod reduced;
pub(crate) mod search;
pub(crate) mod search_box;
pub(crate) mod secant;
pub(crate) mod settings;

use crate::conditioning::record::Record;
use crate::error::Error;
use crate::gms;
use crate::law::Law;
use crate::law::terms::{Delay, Terms};
use crate::separable::checked::checked;
use crate::separable::descent::descend;
use crate::separable::objective::Objective;
use crate::separable::optimum::Optimum;
use crate::separable::search::Search;
use crate::separable::search_box::SearchBox;
use crate::separable::settings::Settings;
use crate::watch::Watch;
use stiction_search::{Observer, Stage};

/// Fits a law to a record: the global least-squares optimum inside the box.
///
/// Costs about `scan` cheap evaluations on a thinned record, a few tens of evaluations with
/// sensitivities there, and 10 to 40 on the full record.
pub fn separable(
    record: &Record,
    law: Law,
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Optimum, Error> {
    if law.kind.has_elements() {
        if !terms.dependences.is_empty() {
            return Err(Error::Setting {
                name: "dependences",
                found: terms.dependences.len() as f64,
                allowed: "none beside a Maxwell-slip law, whose elements have levels of their own",
            });
        }
        return gms::search::search(record, law, terms, settings, observer);
    }
    let mut bounds = match &settings.bounds {
        Some(bounds) => bounds.clone(),
        None => SearchBox::from_record(record, &law)?,
    };
    let fitted = terms.delay == Delay::Fitted;
    let mut still = terms.clone();
    if fitted {
        bounds = bounds.with_delay();
        still.delay = Delay::NONE;
    }
    let full = checked(record, law, &still)?;
    let delayed = fitted.then(|| Objective::new(record, law, terms));
    let mut watch = Watch::new(observer, Stage::Scan);
    let thinned = record.rough(settings.thin);
    let mut search = Search {
        full: &full,
        delayed: delayed.as_ref(),
        thinned: thinned.as_ref(),
        law,
        terms: &still,
        settings,
        iterations: 0,
    };
    let (descent, status) = search.run(&bounds, &mut watch);
    Ok(Optimum {
        law,
        p: descent.p,
        bounds,
        status,
        counts: watch.counts,
        iterations: search.iterations,
        history: descent.history,
        delay: fitted,
        elements: Vec::new(),
        secant: descent.secant,
        evaluation: descent.evaluation,
    })
}

/// Least squares on the full record from one point: the local optimum reached from there.
pub(crate) fn follow(
    start: &[f64],
    record: &Record,
    law: Law,
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Optimum, Error> {
    let delay = terms.delay == Delay::Fitted;
    let own = law.nonlinear();
    if start.len() != own && start.len() != own + 1 {
        return Err(Error::Setting {
            name: "nonlinear unknowns of the start",
            found: start.len() as f64,
            allowed: "as many as the law has, and the delay",
        });
    }
    let mut bounds = match &settings.bounds {
        Some(bounds) => bounds.clone(),
        None => SearchBox::from_record(record, &law)?,
    };
    let mut start = start.to_vec();
    start.truncate(own + usize::from(delay));
    if delay {
        bounds = bounds.with_delay();
        start.resize(own + 1, 0.0);
    }
    let objective = checked(record, law, terms)?;
    let mut watch = Watch::new(observer, Stage::Fine);
    let found = descend(&objective, &bounds, &start, settings.steps, &mut watch);
    Ok(Optimum {
        law,
        p: found.p,
        bounds,
        status: found.status,
        counts: watch.counts,
        iterations: found.iterations,
        history: found.history,
        delay,
        elements: Vec::new(),
        secant: found.secant,
        evaluation: found.evaluation,
    })
}
