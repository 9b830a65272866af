//! The separable method: scan the box, descend from the best points, finish on the full record.

pub(crate) mod coarse;
pub(crate) mod dual;
pub(crate) mod elasto_plastic;
pub(crate) mod in_lanes;
pub(crate) mod levenberg;
pub(crate) mod linear;
pub(crate) mod nonnegative;
pub(crate) mod objective;
pub(crate) mod recursion;
pub(crate) mod reduced;
pub(crate) mod search;
pub(crate) mod search_box;

use crate::conditioning::record::{Record, extent};
use crate::error::Error;
use crate::gms::{self, choose::ElementsScore};
use crate::law::Law;
use crate::law::terms::{Delay, Terms};
use crate::observe::{Counts, Observer, Stage};
use crate::separable::levenberg::{Status, Watch, descend};
use crate::separable::objective::{Evaluation, Objective};
use crate::separable::search::Search;
use crate::separable::search_box::SearchBox;

/// How the separable search works.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Seed of the scramble of the low-discrepancy scan.
    pub seed: u64,
    /// Points of the scan. Default 64.
    pub scan: usize,
    /// Descents on the thinned record. Default 6.
    pub starts: usize,
    /// Samples of the thinned record that the scan and its descents see, where the record has no
    /// common filter. For a law that the batch kernels know, the scan sees a quarter of them. Default 4000.
    pub thin: usize,
    /// Most steps of one descent. Default 200.
    pub steps: usize,
    /// Where to look; `None` takes the box that the record allows.
    pub bounds: Option<SearchBox>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            seed: 0,
            scan: 64,
            starts: 6,
            thin: 4000,
            steps: 200,
            bounds: None,
        }
    }
}

/// What a search found.
#[derive(Clone, Debug)]
pub struct Optimum {
    /// The law that was fitted, with the number of its elements.
    pub law: Law,
    /// Nonlinear unknowns (logarithms, in the order of the law).
    pub p: Vec<f64>,
    /// The box that was searched.
    pub bounds: SearchBox,
    /// How it ended.
    pub status: Status,
    /// Evaluations by kind.
    pub counts: Counts,
    /// Steps of all descents.
    pub iterations: usize,
    /// Evaluations and best `rms(residual)/rms(measured)` until then, over the last descent.
    pub history: Vec<(usize, f64)>,
    /// Whether the last nonlinear unknown is the delay.
    pub(crate) delay: bool,
    /// The numbers of elements that were tried for a Maxwell-slip law; empty where it was given.
    pub elements: Vec<ElementsScore>,
    /// The evaluation at the optimum, with sensitivities.
    pub evaluation: Evaluation,
}

impl Optimum {
    /// Whether the delay was fitted and stands at the bound of its range.
    pub fn delay_at_bound(&self) -> bool {
        let last = self.p.len().checked_sub(1);
        self.delay && last.is_some_and(|i| self.bounds.at_bound(&self.p, i))
    }
}

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
    let mut watch = Watch {
        observer,
        stage: Stage::Scan,
        fraction: 0.0,
        counts: Counts::default(),
        best: f64::INFINITY,
        stopped: false,
    };
    let thinned = record.thinned(settings.thin);
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
        evaluation: descent.evaluation,
    })
}

/// Least squares on the full record from one point: the optimum of its valley.
pub(crate) fn follow(
    start: &[f64],
    record: &Record,
    law: Law,
    terms: &Terms,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Optimum, Error> {
    if start.len() != law.nonlinear() {
        return Err(Error::Setting {
            name: "nonlinear unknowns of the start",
            found: start.len() as f64,
            allowed: "as many as the law has",
        });
    }
    let mut bounds = match &settings.bounds {
        Some(bounds) => bounds.clone(),
        None => SearchBox::from_record(record, &law)?,
    };
    let delay = terms.delay == Delay::Fitted;
    let mut start = start.to_vec();
    if delay {
        bounds = bounds.with_delay();
        start.push(0.0);
    }
    let objective = checked(record, law, terms)?;
    let mut watch = Watch {
        observer,
        stage: Stage::Fine,
        fraction: 0.0,
        counts: Counts::default(),
        best: f64::INFINITY,
        stopped: false,
    };
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
        evaluation: found.evaluation,
    })
}

/// The objective of a record with samples and force enough for this law.
pub(crate) fn checked<'a>(
    record: &'a Record,
    law: Law,
    terms: &Terms,
) -> Result<Objective<'a>, Error> {
    terms.check(record)?;
    let unknowns = law.nonlinear() + terms.columns(&law).len();
    if record.kept() < 10 * unknowns {
        return Err(Error::TooFewSamples {
            found: record.kept(),
            needed: 10 * unknowns,
            losses: record.losses(),
        });
    }
    let full = Objective::new(record, law, terms);
    if !full.energy().is_finite() {
        return Err(Error::Setting {
            name: "force",
            found: full.energy(),
            allowed: "numbers whose squares add up to a finite number",
        });
    }
    if let Some(value) = constant(full.force()) {
        return Err(Error::NoForce { value });
    }
    Ok(full)
}

/// The value of a force that never changes, rounding of the filters apart.
fn constant(force: &[f64]) -> Option<f64> {
    let (low, high) = extent(force);
    let still = high - low <= 1e-9 * low.abs().max(high.abs());
    still.then_some(high)
}

/// Fits from a known starting point, without a scan: nonlinear unknowns, coefficients, status.
pub(crate) fn refine(
    record: &Record,
    law: Law,
    terms: &Terms,
    bounds: &SearchBox,
    start: &[f64],
    observer: &mut dyn Observer,
) -> (Vec<f64>, Vec<f64>, Status) {
    let objective = Objective::new(record, law, terms);
    let mut watch = Watch {
        observer,
        stage: Stage::CrossValidation,
        fraction: 0.0,
        counts: Counts::default(),
        best: f64::INFINITY,
        stopped: false,
    };
    let found = descend(&objective, bounds, start, 60, &mut watch);
    (
        found.p,
        found.evaluation.solution.coefficients,
        found.status,
    )
}
