//! Starts for a law that the batch kernels know: scan and descents with many trials under way at once.

use crate::separable::descent::settings;
use crate::separable::in_lanes::InLanes;
use crate::separable::objective::Objective;
use crate::separable::search::{HOPELESS_COST_RATIO, LINE, same, sobol, valleys};
use crate::separable::search_box::SearchBox;
use crate::watch::Watch;
use stiction_search::descent::{self, Descent};
use stiction_search::{Derivatives, Stage, Status};

/// Most steps of a descent. One more step of all descents costs as much as a third of an evaluation of a
/// long record, one unnecessary start as much as five.
const MOST_ROUNDS: usize = 30;
/// Number of rounds that descents with a hopeless cost may continue after the best has ended.
const PATIENCE: usize = 2;
/// So few trials are faster one by one, with the samples in lanes.
const FEW: usize = 3;
/// Trials under way at once; the observer is asked between.
const BATCH_TRIALS: usize = 16;
/// The scan with the stiffest bristle has the number of points of the scan of the whole box divided by this.
const RIGID_SCAN_DIVISOR: usize = 4;

/// A descent here ends when its step in the logarithms is at most this and the predicted fall of the cost
/// at most [`NEAR_GAIN`]: the search then continues on the full record.
const NEAR_STEP: f64 = 0.1;
/// That fall, relative to the cost.
const NEAR_GAIN: f64 = 1e-3;

/// A point and the reduced problem evaluated there.
struct Point {
    p: Vec<f64>,
    at: Derivatives,
}

/// A descent with the reduced problem at its current point.
struct Walk {
    descent: Descent,
    now: Derivatives,
}

impl Walk {
    /// Whether it has ended by itself, not for lack of trials.
    fn is_settled(&self) -> bool {
        let status = self.descent.status();
        status.is_some_and(|status| status != Status::Budget)
    }
}

/// Where a descent has ended.
pub(super) struct End {
    pub p: Vec<f64>,
    pub cost: f64,
    /// Whether it had ended by itself, not for lack of trials.
    pub settled: bool,
}

/// Where descents have ended.
pub(super) struct Minima {
    /// Best first.
    pub ends: Vec<End>,
    /// Trials that they took.
    pub steps: usize,
}

/// The objective on the record on which starts are looked for, and its sums.
pub(super) struct Coarse<'a> {
    pub objective: &'a Objective<'a>,
    pub sums: &'a InLanes,
    pub bounds: &'a SearchBox,
}

impl Coarse<'_> {
    /// Ends of `starts` descents from the best of `scan` points, and of one or two from the stiffness that
    /// suits the best curve of a stiff bristle. A stiff
    /// bristle is near the static law, so the search never ends much worse than that. `None` where a trial is
    /// beyond what the kernels can do.
    pub fn minima(
        &self,
        seed: u32,
        scan: usize,
        starts: usize,
        kappa: usize,
        watch: &mut Watch,
    ) -> Option<Minima> {
        watch.stage = Stage::Scan;
        let points = (0..scan.max(1)).map(|i| sobol(self.bounds, i, seed));
        let first = self.tried(points.collect(), watch)?;
        watch.fraction = 0.5;
        let mut chosen: Vec<Vec<f64>> = best_first(&first)
            .into_iter()
            .take(starts.max(1))
            .map(|i| first[i].0.clone())
            .collect();
        if !watch.stopped && self.bounds.len() > 1 {
            let stiff = self.bounds.holding(kappa, self.bounds.high(kappa));
            let points = (0..(scan / RIGID_SCAN_DIVISOR).max(1)).map(|i| sobol(&stiff, i, seed));
            let curves = self.tried(points.collect(), watch)?;
            let curve = &curves[best_first(&curves)[0]].0;
            let line = (0..LINE).map(|i| {
                let part = i as f64 / (LINE - 1) as f64;
                let mut p = curve.clone();
                p[kappa] = self.bounds.low(kappa)
                    + part * (self.bounds.high(kappa) - self.bounds.low(kappa));
                p
            });
            let along = self.tried(line.collect(), watch)?;
            let costs: Vec<f64> = along.iter().map(|(_, cost)| *cost).collect();
            chosen.extend(valleys(&costs).into_iter().map(|i| along[i].0.clone()));
        }
        let points = self.evaluated(chosen, watch)?;
        self.descended(points, watch)
    }

    /// Points and their costs, in the order given; fewer where the observer stops it.
    fn tried(&self, points: Vec<Vec<f64>>, watch: &mut Watch) -> Option<Vec<(Vec<f64>, f64)>> {
        let mut out: Vec<(Vec<f64>, f64)> = Vec::with_capacity(points.len());
        for batch in points.chunks(BATCH_TRIALS) {
            if watch.stopped && !out.is_empty() {
                break;
            }
            let trials: Vec<&[f64]> = batch.iter().map(Vec::as_slice).collect();
            let costs = self.sums.costs(&trials)?.into_iter().map(or_worst);
            let costs: Vec<f64> = costs.collect();
            self.report(&costs, false, watch);
            out.extend(batch.iter().cloned().zip(costs));
        }
        Some(out)
    }

    /// Points evaluated in the order given, whatever their costs; fewer where the observer stops it.
    fn evaluated(&self, points: Vec<Vec<f64>>, watch: &mut Watch) -> Option<Vec<Point>> {
        let mut out: Vec<Point> = Vec::with_capacity(points.len());
        for batch in points.chunks(BATCH_TRIALS) {
            if watch.stopped && !out.is_empty() {
                break;
            }
            let trials: Vec<&[f64]> = batch.iter().map(Vec::as_slice).collect();
            let mut found = self.reduced(&trials)?;
            found.iter_mut().for_each(|at| at.cost = or_worst(at.cost));
            let costs: Vec<f64> = found.iter().map(|at| at.cost).collect();
            self.report(&costs, true, watch);
            let points = batch.iter().cloned().zip(found);
            out.extend(points.map(|(p, at)| Point { p, at }));
        }
        Some(out)
    }

    fn reduced(&self, trials: &[&[f64]]) -> Option<Vec<Derivatives>> {
        if trials.len() <= FEW {
            return trials.iter().map(|p| self.sums.reduced(p)).collect();
        }
        self.sums.many(trials)
    }

    /// Counts trials, and reports each one until the observer asks to stop.
    fn report(&self, costs: &[f64], sensitivities: bool, watch: &mut Watch) {
        for &cost in costs {
            watch.count(self.objective, sensitivities);
            if !watch.stopped {
                watch.report(self.objective.relative(cost));
            }
        }
    }

    /// Runs the descents from all points together.
    fn descended(&self, points: Vec<Point>, watch: &mut Watch) -> Option<Minima> {
        watch.stage = Stage::Coarse;
        let settings = descent::Settings {
            trusted_step: NEAR_STEP,
            trusted_gain: NEAR_GAIN,
            take_untried: true,
            ..settings(self.objective.energy(), MOST_ROUNDS)
        };
        let walk = |point: Point| Walk {
            descent: Descent::new(point.p, &settings),
            now: point.at,
        };
        let mut walks: Vec<Walk> = points.into_iter().map(walk).collect();
        let mut steps = 0;
        let mut patience = PATIENCE;
        for round in 0..MOST_ROUNDS {
            watch.fraction = round as f64 / MOST_ROUNDS as f64;
            join(&mut walks);
            let ended = walks.first().is_some_and(Walk::is_settled);
            if watch.stopped {
                break;
            }
            // A simple minimum is reached soon; the right one may lie at the end of a long valley.
            let most = match ended && patience == 0 {
                true => HOPELESS_COST_RATIO * walks[0].now.cost,
                false => f64::INFINITY,
            };
            patience -= usize::from(ended && patience > 0);
            let mut trials = Vec::new();
            for (i, walk) in walks.iter_mut().enumerate() {
                if walk.now.cost > most {
                    continue;
                }
                let now = (&walk.now).into();
                if let Some(p) = walk.descent.propose(&settings, self.bounds.region(), now) {
                    trials.push((i, p));
                }
            }
            if trials.is_empty() {
                break;
            }
            let places: Vec<&[f64]> = trials.iter().map(|(_, p)| p.as_slice()).collect();
            let found = self.reduced(&places)?;
            steps += trials.len();
            let costs: Vec<f64> = found.iter().map(|at| at.cost).collect();
            for ((i, p), at) in trials.into_iter().zip(found) {
                if walks[i].descent.take(&settings, p, at.cost) {
                    walks[i].now = at;
                }
            }
            self.report(&costs, true, watch);
        }
        let end = |walk: Walk| End {
            cost: walk.now.cost,
            settled: walk.is_settled(),
            p: walk.descent.into_point(),
        };
        let mut ends: Vec<End> = walks.into_iter().map(end).collect();
        ends.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        Some(Minima { ends, steps })
    }
}

/// Replaces NaN by the worst cost.
fn or_worst(cost: f64) -> f64 {
    if cost.is_nan() { f64::INFINITY } else { cost }
}

/// Indices of points, the least cost first.
fn best_first(points: &[(Vec<f64>, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a].1.total_cmp(&points[b].1));
    order
}

/// Drops descents that have reached the point of a better one.
fn join(walks: &mut Vec<Walk>) {
    let mut kept: Vec<Walk> = Vec::new();
    walks.sort_by(|a, b| a.now.cost.total_cmp(&b.now.cost));
    for walk in walks.drain(..) {
        if !kept
            .iter()
            .any(|better| same(walk.descent.point(), better.descent.point()))
        {
            kept.push(walk);
        }
    }
    *walks = kept;
}
