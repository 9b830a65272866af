//! One descent on a record: first on sums of products as far as their precision allows, then on the columns.

use crate::separable::in_lanes::InLanes;
use crate::separable::objective::{Evaluation, Objective};
use crate::separable::search_box::SearchBox;
use crate::separable::secant::Secant;
use crate::watch::Watch;
use stiction_search::descent::{self, LeastSquares, Settings, Sums};
use stiction_search::{Control, Derivatives, Status};

/// Result of one descent.
#[derive(Clone, Debug)]
pub(crate) struct Descent {
    pub p: Vec<f64>,
    pub evaluation: Evaluation,
    pub status: Status,
    /// What it learnt of the curvature.
    pub secant: Secant,
    pub iterations: usize,
    /// Relative residual after each accepted step, with the number of evaluations until then.
    pub history: Vec<(usize, f64)>,
}

/// Cost, relative to the energy (sum of squares) of the force, that is only rounding error: some ten
/// times the square of the rounding of a number.
const EXACT_COST: f64 = 1e-27;
/// Change of a cost from sums of squares, relative to the energy of the force, that may be rounding
/// error: such a cost is a difference of sums that hold some 15 digits of the energy.
const SUMS_ROUNDING: f64 = 1e-13;
/// Largest predicted gain of a step, relative to that of the step before, where costs are not precise
/// enough to tell whether either step lowered them.
const FADING_PROMISE: f64 = 0.1;

/// Settings of a descent of at most `most_trials` trials, on a record whose force has this energy (sum of
/// squares).
pub(crate) fn settings(energy: f64, most_trials: usize) -> Settings {
    Settings {
        most_trials,
        exact_cost: EXACT_COST * energy,
        ..Settings::default()
    }
}

/// Descends from `start` for at most `steps` trials.
///
/// Where the objective can be computed from sums alone, they are used as far as their precision allows,
/// and the columns only for the last steps.
pub(crate) fn descend(
    objective: &Objective,
    bounds: &SearchBox,
    start: &[f64],
    steps: usize,
    watch: &mut Watch,
) -> Descent {
    let settings = settings(objective.energy(), steps);
    descend_as(
        objective,
        bounds,
        start,
        &settings,
        Secant::default(),
        watch,
    )
}

/// The same by other rules, with what is known of the curvature from a descent near by.
pub(crate) fn descend_as(
    objective: &Objective,
    bounds: &SearchBox,
    start: &[f64],
    settings: &Settings,
    secant: Secant,
    watch: &mut Watch,
) -> Descent {
    let steps = settings.most_trials;
    let mut history = Vec::new();
    let led = objective
        .sums()
        .and_then(|sums| lead(objective, sums, bounds, start, steps, &mut history, watch));
    let (start, done, interrupted) = led.unwrap_or((bounds.clamp(start), 0, false));
    let evaluation = objective.evaluate(&start, true);
    watch.count(objective, true);
    history.push((watch.counts.total(), objective.relative(evaluation.cost)));
    let mut walk = descent::Descent::new(start.clone(), settings).after(done);
    if interrupted {
        walk.end(Status::Interrupted);
    }
    let sums = evaluation.reduced();
    let mut columns = Columns {
        objective,
        model: sums.clone(),
        sums,
        now: evaluation,
        at: start,
        secant,
        tried: None,
        history,
        watch,
    };
    let walk = descent::descend(&mut columns, walk, bounds.region(), settings);
    Descent {
        secant: columns.secant,
        evaluation: columns.now,
        status: walk.status().unwrap_or(Status::Budget),
        iterations: walk.trials(),
        history: columns.history,
        p: walk.into_point(),
    }
}

/// An objective evaluated with all of its columns.
struct Columns<'a, 'w, 'o> {
    objective: &'a Objective<'a>,
    /// Where the descent stands.
    at: Vec<f64>,
    now: Evaluation,
    sums: Derivatives,
    secant: Secant,
    /// The sums with the curvature that was learnt.
    model: Derivatives,
    tried: Option<(Vec<f64>, Evaluation)>,
    history: Vec<(usize, f64)>,
    watch: &'w mut Watch<'o>,
}

impl LeastSquares for Columns<'_, '_, '_> {
    fn sums(&mut self, _: f64) -> Option<Sums<'_>> {
        if let Some((trial, failed)) = self.tried.take() {
            // A trial that was not taken shows the curvature all the same.
            self.learn(&trial, &failed.reduced(), false);
        }
        self.model = self.secant.corrected(&self.sums, 1.0);
        Some((&self.model).into())
    }

    fn cost(&mut self, trial: &[f64], _: f64) -> f64 {
        let next = self.objective.evaluate(trial, true);
        self.watch.count(self.objective, true);
        let cost = next.cost;
        self.tried = Some((trial.to_vec(), next));
        cost
    }

    fn accept(&mut self) {
        if let Some((trial, next)) = self.tried.take() {
            let sums = next.reduced();
            self.learn(&trial, &sums, true);
            self.at = trial;
            self.sums = sums;
            self.now = next;
            let relative = self.objective.relative(self.now.cost);
            self.history.push((self.watch.counts.total(), relative));
        }
    }

    fn after_trial(&mut self) -> Control {
        self.watch.report(self.objective.relative(self.now.cost))
    }
}

impl Columns<'_, '_, '_> {
    /// Learns from the gradient at a trial, which is `taken` or not.
    fn learn(&mut self, trial: &[f64], there: &Derivatives, taken: bool) {
        // The elements of a Maxwell-slip law change between stick and slip at corners of the cost, which no parabola shows.
        if !there.cost.is_finite() || self.objective.law().kind.has_elements() {
            return;
        }
        let step = descent::difference(trial, &self.at);
        let change = descent::difference(&there.gradient, &self.sums.gradient);
        self.secant
            .judge(&self.sums, &step, self.sums.cost - there.cost);
        let normal = if taken {
            &there.normal
        } else {
            &self.sums.normal
        };
        self.secant.learn(&step, &change, normal);
    }
}

/// The descent on sums, including the steps that are too small to show in their costs. Returns the end
/// point, the number of trials, and whether it was stopped. `None` where a trial is outside the range of
/// the kernels.
fn lead(
    objective: &Objective,
    sums: &InLanes,
    bounds: &SearchBox,
    start: &[f64],
    steps: usize,
    history: &mut Vec<(usize, f64)>,
    watch: &mut Watch,
) -> Option<(Vec<f64>, usize, bool)> {
    let settings = Settings {
        cost_rounding: SUMS_ROUNDING * objective.energy(),
        take_untried: true,
        ..settings(objective.energy(), steps)
    };
    let region = bounds.region();
    let start = bounds.clamp(start);
    let mut now = sums.reduced(&start)?;
    watch.count(objective, true);
    let mut walk = descent::Descent::new(start, &settings);
    let mut before = 0.0;
    while let Some(trial) = walk.propose(&settings, region, (&now).into()) {
        before = walk.promised();
        let next = sums.reduced(&trial)?;
        watch.count(objective, true);
        if walk.take(&settings, trial, next.cost) {
            history.push((watch.counts.total(), objective.relative(next.cost)));
            now = next;
        }
        if watch.report(objective.relative(now.cost)) == Control::Stop {
            return Some((walk.point().to_vec(), walk.trials(), true));
        }
    }
    let ended = walk.status();
    let mut promised = walk.promised();
    let mut trials = walk.trials();
    let mut p = walk.into_point();
    // The last step was not tried. The gradient there is still accurate although changes of the cost are
    // below its rounding: it is followed as long as the predicted gains fall. The next predicted gain is
    // estimated from the ratio of the last two.
    let mut left = promised * (promised / before);
    while ended == Some(Status::Converged)
        && trials < steps
        && promised > 0.0
        && left > settings.no_gain * now.cost
    {
        let here = sums.reduced(&p)?;
        watch.count(objective, true);
        trials += 1;
        let Some(step) = descent::damped_step(&here, None, &p, region, 0.0, settings.longest_step)
        else {
            break;
        };
        let trial = region.moved(&p, &step);
        let promises = descent::predicted_gain(&here, &descent::difference(&trial, &p));
        let fades = promises < FADING_PROMISE * promised;
        if !fades || descent::largest(&trial, &p) > settings.trusted_step {
            break;
        }
        p = trial;
        left = promises * (promises / promised);
        promised = promises;
        now = here;
    }
    Some((p, trials, false))
}
