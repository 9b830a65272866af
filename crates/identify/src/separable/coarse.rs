//! Starts for a law that the batch kernels know: scan and descents with many trials under way at once.

use crate::observe::Stage;
use crate::separable::in_lanes::InLanes;
use crate::separable::levenberg::{Status, Walk, Watch};
use crate::separable::objective::Objective;
use crate::separable::reduced::Reduced;
use crate::separable::search::{LINE, same, sobol, valleys};
use crate::separable::search_box::SearchBox;

/// Most steps of a descent. One more for all costs as much as a third of an evaluation of a long record, a
/// start too many as much as five.
const ROUNDS: usize = 30;
/// Trials under way at once; the observer is asked between.
const BATCH: usize = 16;
/// Points of a scan with the stiffest bristle, for one of the whole box.
const RIGID: usize = 4;

/// A start is good enough within this step in the logarithms, when it promises to lower the cost by no more
/// than this part: the record itself goes on.
const NEAR_ENOUGH: (f64, f64) = (0.1, 1e-3);

/// A point and what it came to.
struct Point {
    p: Vec<f64>,
    at: Reduced,
}

/// Where descents have ended.
pub(super) struct Minima {
    /// Cost and place, best first.
    pub ends: Vec<(f64, Vec<f64>)>,
    /// Trials that they took.
    pub steps: usize,
}

/// The objective on a record to look for starts on, and its sums.
pub(super) struct Coarse<'a> {
    pub objective: &'a Objective<'a>,
    pub sums: &'a InLanes,
    pub bounds: &'a SearchBox,
    /// Rounds that the others have left once the best of them has ended.
    pub patience: usize,
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
        let mut first = self.tried(points.collect(), watch)?;
        watch.fraction = 0.5;
        if !watch.stopped && self.bounds.len() > 1 {
            let stiff = self.bounds.holding(kappa, self.bounds.high(kappa));
            let points = (0..(scan / RIGID).max(1)).map(|i| sobol(&stiff, i, seed));
            let curves = self.tried(points.collect(), watch)?;
            let line = (0..LINE).map(|i| {
                let part = i as f64 / (LINE - 1) as f64;
                let mut p = curves[0].p.clone();
                p[kappa] = self.bounds.low(kappa)
                    + part * (self.bounds.high(kappa) - self.bounds.low(kappa));
                p
            });
            first.truncate(starts.max(1));
            let along = self.evaluated(line.collect(), watch)?;
            let costs: Vec<f64> = along.iter().map(|point| point.at.cost).collect();
            let chosen = valleys(&costs);
            first.extend(
                along
                    .into_iter()
                    .enumerate()
                    .filter_map(|(i, point)| chosen.contains(&i).then_some(point)),
            );
        } else {
            first.truncate(starts.max(1));
        }
        self.descended(first, watch)
    }

    /// Ends of descents from given points.
    pub fn followed(&self, points: Vec<Vec<f64>>, watch: &mut Watch) -> Option<Minima> {
        let points = self.evaluated(points, watch)?;
        self.descended(points, watch)
    }

    /// Points in the order given, whatever they come to; fewer where the observer stops it.
    fn evaluated(&self, points: Vec<Vec<f64>>, watch: &mut Watch) -> Option<Vec<Point>> {
        let mut out: Vec<Point> = Vec::with_capacity(points.len());
        for batch in points.chunks(BATCH) {
            if watch.stopped && !out.is_empty() {
                break;
            }
            let trials: Vec<&[f64]> = batch.iter().map(Vec::as_slice).collect();
            let found = self.sums.many(&trials)?;
            for (p, mut at) in batch.iter().zip(found) {
                if at.cost.is_nan() {
                    at.cost = f64::INFINITY;
                }
                out.push(Point { p: p.clone(), at });
            }
            let tried = &out[out.len() - batch.len()..];
            self.report(tried.iter().map(|point| point.at.cost), watch);
        }
        Some(out)
    }

    /// Counts trials, and tells of each until the observer has heard enough.
    fn report(&self, costs: impl Iterator<Item = f64>, watch: &mut Watch) {
        for cost in costs {
            watch.count(self.objective, true);
            if !watch.stopped {
                watch.report(self.objective.relative(cost));
            }
        }
    }

    /// The same, best first.
    fn tried(&self, points: Vec<Vec<f64>>, watch: &mut Watch) -> Option<Vec<Point>> {
        let mut out = self.evaluated(points, watch)?;
        out.sort_by(|a, b| a.at.cost.total_cmp(&b.at.cost));
        Some(out)
    }

    /// Follows all points down together.
    fn descended(&self, points: Vec<Point>, watch: &mut Watch) -> Option<Minima> {
        watch.stage = Stage::Coarse;
        let energy = self.objective.energy();
        let mut walks: Vec<Walk> = points
            .into_iter()
            .map(|point| {
                let mut walk = Walk::new(point.p, point.at, energy);
                walk.near_enough = NEAR_ENOUGH;
                walk.untried = true;
                walk
            })
            .collect();
        let mut steps = 0;
        let mut patience = self.patience;
        for round in 0..ROUNDS {
            watch.fraction = round as f64 / ROUNDS as f64;
            join(&mut walks);
            let ended = walks
                .first()
                .is_some_and(|best| best.status != Status::Budget);
            if watch.stopped || ended && patience == 0 {
                break;
            }
            patience -= usize::from(ended);
            let mut trials = Vec::new();
            for (i, walk) in walks.iter_mut().enumerate() {
                if let Some(p) = walk.propose(self.bounds, ROUNDS) {
                    trials.push((i, p));
                }
            }
            if trials.is_empty() {
                break;
            }
            let places: Vec<&[f64]> = trials.iter().map(|(_, p)| p.as_slice()).collect();
            let found = self.sums.many(&places)?;
            steps += trials.len();
            let costs: Vec<f64> = found.iter().map(|at| at.cost).collect();
            for ((i, p), at) in trials.into_iter().zip(found) {
                walks[i].take(p, at);
            }
            self.report(costs.into_iter(), watch);
        }
        let mut ends: Vec<(f64, Vec<f64>)> = walks
            .into_iter()
            .map(|walk| (walk.now.cost, walk.p))
            .collect();
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(Minima { ends, steps })
    }
}

/// Leaves out walks that have come to where a better one stands.
fn join(walks: &mut Vec<Walk>) {
    let mut kept: Vec<Walk> = Vec::new();
    walks.sort_by(|a, b| a.now.cost.total_cmp(&b.now.cost));
    for walk in walks.drain(..) {
        if !kept.iter().any(|better| same(&walk.p, &better.p)) {
            kept.push(walk);
        }
    }
    *walks = kept;
}
