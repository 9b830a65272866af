//! Where the descents of the separable method start, and which of them are followed to the end.

use crate::conditioning::record::Record;
use crate::law::terms::Terms;
use crate::law::{Law, LawKind};
use crate::separable::coarse::{Coarse, End};
use crate::separable::descent::{Descent, descend};
use crate::separable::objective::Objective;
use crate::separable::search_box::SearchBox;
use crate::separable::settings::Settings;
use crate::watch::Watch;
use stiction_search::{Control, Stage, Status};

/// Starts from the thinned record that go on to the full one.
const MOST_FINE: usize = 3;
/// Steps on the full record before the starts are compared.
const SHORT_STEPS: usize = 12;
/// Minima of the symmetric law that are paired for an asymmetric one.
const MOST_PAIRED: usize = 3;
/// Distance in the logarithms within which two minima are one.
const SAME_MINIMUM_DISTANCE: f64 = 1e-2;
/// Ratio of the cost of a start to that of the best above which it is not tried (decision 0036: three times).
pub(super) const HOPELESS_COST_RATIO: f64 = 3.0;
/// The same where costs were followed down on thousands of samples, which tell them apart better (decision
/// 0036).
const RIVAL_COST_RATIO: f64 = 1.3;
/// Ratio of the cost of the second minimum to that of the best below which it is also followed to the end.
const LAST_RIVAL_COST_RATIO: f64 = 1.05;
/// Number of stiffnesses tried with the curve of the static law.
pub(super) const LINE: usize = 16;

/// One search: an objective on the full record and the results so far.
pub(crate) struct Search<'a> {
    pub full: &'a Objective<'a>,
    /// The same with the delay as one more unknown, where it is fitted: only the last descent uses it.
    pub delayed: Option<&'a Objective<'a>>,
    /// A thinned copy of the record, where there is one.
    pub thinned: Option<&'a Record>,
    pub law: Law,
    pub terms: &'a Terms,
    pub settings: &'a Settings,
    pub iterations: usize,
}

impl<'a> Search<'a> {
    /// The best descent, and how the whole search ended.
    pub fn run(&mut self, bounds: &SearchBox, watch: &mut Watch) -> (Descent, Status) {
        if self.law.nonlinear() == 0 {
            watch.stage = Stage::Fine;
            let found = descend(self.full, bounds, &[], 1, watch);
            return self.finish(bounds, vec![found], watch);
        }
        let inner = match self.delayed {
            Some(_) => &bounds.without(bounds.len() - 1),
            None => bounds,
        };
        let starts = if self.law.layout().ratio.is_some() {
            self.symmetric_starts(inner, watch)
        } else {
            self.scan_starts(inner, watch)
        };
        let minima = self.short_descents(inner, &starts, watch);
        self.finish(bounds, minima, watch)
    }

    /// The record on which starts are looked for.
    fn near(&self) -> &'a Record {
        self.thinned.unwrap_or(self.full.record())
    }

    /// Starts for a symmetric law: the best descents from a scan of the box, and the static law's
    /// curve with the stiffness that suits it.
    fn scan_starts(&mut self, bounds: &SearchBox, watch: &mut Watch) -> Vec<Vec<f64>> {
        let objective = Objective::new(self.near(), self.law, self.terms);
        if let Some(starts) = self.starts_in_lanes(&objective, bounds, watch) {
            return starts;
        }
        let points = self.scan(&objective, bounds, watch);
        watch.stage = Stage::Coarse;
        let many = points.len().min(self.settings.starts);
        let mut found = Vec::new();
        for (i, start) in points.iter().take(many).enumerate() {
            if watch.stopped {
                break;
            }
            watch.fraction = i as f64 / many as f64;
            let descent = descend(&objective, bounds, start, SHORT_STEPS, watch);
            self.iterations += descent.iterations;
            found.push(descent);
        }
        let mut starts: Vec<Vec<f64>> = distinct(found)
            .into_iter()
            .take(MOST_FINE)
            .map(|d| d.p)
            .collect();
        if starts.is_empty() {
            starts = points.into_iter().take(1).collect();
        }
        starts.extend(self.static_starts(bounds, watch));
        starts
    }

    /// Starts for a law that the batch kernels know; `None` for others.
    fn starts_in_lanes(
        &mut self,
        objective: &Objective,
        bounds: &SearchBox,
        watch: &mut Watch,
    ) -> Option<Vec<Vec<f64>>> {
        let coarse = Coarse {
            objective,
            sums: objective.sums()?,
            bounds,
        };
        let minima = coarse.minima(
            self.seed(),
            self.settings.scan,
            self.settings.starts,
            self.law.layout().kappa?,
            watch,
        )?;
        self.iterations += minima.steps;
        let best = minima.ends.first()?.cost;
        let (most, hopeless) = (RIVAL_COST_RATIO * best, HOPELESS_COST_RATIO * best);
        let mut starts: Vec<Vec<f64>> = Vec::new();
        for End { p, cost, settled } in minima.ends {
            let counts = starts.is_empty() || cost <= most || !settled && cost <= hopeless;
            if counts && !starts.iter().any(|other| same(&p, other)) {
                starts.push(p);
            }
        }
        starts.truncate(MOST_FINE);
        Some(starts)
    }

    /// Starts for a law with its own parameters per direction: every pairing of two minima of the
    /// symmetric law, one for each direction, and the static law's curve.
    fn symmetric_starts(&mut self, bounds: &SearchBox, watch: &mut Watch) -> Vec<Vec<f64>> {
        let layout = self.law.layout();
        let law = Law {
            asymmetric: false,
            ..self.law
        };
        let objective = Objective::new(self.near(), law, self.terms);
        let inner = bounds.symmetric(&layout);
        let mut search = Search {
            full: &objective,
            delayed: None,
            thinned: None,
            law,
            iterations: 0,
            ..*self
        };
        let starts = search.scan_starts(&inner, watch);
        let minima = search.short_descents(&inner, &starts, watch);
        self.iterations += search.iterations;
        let from = law.layout();
        let mut pairs = Vec::new();
        for plus in minima.iter().take(MOST_PAIRED) {
            for minus in minima.iter().take(MOST_PAIRED) {
                let mut p = vec![0.0; layout.count];
                let mut copy = |to: Option<usize>, from: Option<usize>, source: &Descent| {
                    if let (Some(to), Some(from)) = (to, from) {
                        p[to] = source.p[from];
                    }
                };
                copy(layout.kappa, from.kappa, plus);
                copy(layout.breakaway, from.breakaway, plus);
                copy(layout.exponent, from.exponent, plus);
                for (side, source) in [(0, plus), (1, minus)] {
                    copy(layout.excess[side], from.excess[0], source);
                    copy(layout.velocity[side], from.velocity[0], source);
                }
                let p = bounds.clamp(&p);
                if watch.stopped && !pairs.is_empty() {
                    continue;
                }
                let cost = self.full.evaluate(&p, false).cost;
                watch.count(self.full, false);
                watch.report(self.full.relative(cost));
                pairs.push((cost, p));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut starts: Vec<Vec<f64>> = pairs.into_iter().take(MOST_FINE).map(|(_, p)| p).collect();
        starts.extend(self.static_starts(bounds, watch));
        starts
    }

    /// Starts whose cost on the full record is not far above that of the best, best first.
    fn promising(&self, starts: &[Vec<f64>], watch: &mut Watch) -> Vec<Vec<f64>> {
        if starts.len() < 2 || watch.stopped {
            return starts.to_vec();
        }
        let mut costs: Vec<(f64, &Vec<f64>)> = Vec::with_capacity(starts.len());
        for start in starts {
            let cost = self.full.cost(start);
            // NaN becomes the worst cost, but the point stays a possible start.
            costs.push((if cost.is_nan() { f64::INFINITY } else { cost }, start));
            watch.count(self.full, false);
        }
        costs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let most = HOPELESS_COST_RATIO * costs[0].0;
        costs
            .into_iter()
            .filter(|(cost, _)| *cost <= most)
            .map(|(_, p)| p.clone())
            .collect()
    }

    /// Short descents on the full record from the promising starts; distinct minima, best first.
    fn short_descents(
        &mut self,
        bounds: &SearchBox,
        starts: &[Vec<f64>],
        watch: &mut Watch,
    ) -> Vec<Descent> {
        watch.stage = Stage::Fine;
        watch.best = f64::INFINITY;
        let starts = self.promising(starts, watch);
        let mut found: Vec<Descent> = Vec::new();
        for (i, start) in starts.iter().enumerate() {
            if watch.stopped && !found.is_empty() {
                break;
            }
            watch.fraction = i as f64 / (starts.len() + 1) as f64;
            let steps = if watch.stopped {
                0
            } else {
                SHORT_STEPS.min(self.settings.steps)
            };
            let descent = descend(self.full, bounds, start, steps, watch);
            self.iterations += descent.iterations;
            found.push(descent);
        }
        distinct(found)
    }

    /// Follows the best minimum, and the next if it is nearly as good, to the end.
    fn finish(
        &mut self,
        bounds: &SearchBox,
        minima: Vec<Descent>,
        watch: &mut Watch,
    ) -> (Descent, Status) {
        let mut minima = minima.into_iter();
        let mut best = minima.next().expect("there is always a start");
        let close = LAST_RIVAL_COST_RATIO * best.evaluation.cost;
        let rival = minima
            .next()
            .filter(|r| r.status == Status::Budget && r.evaluation.cost < close)
            .map(|r| r.p);
        let open = best.status == Status::Budget || self.delayed.is_some();
        let own = open.then(|| best.p.clone());
        let objective = self.delayed.unwrap_or(self.full);
        for mut start in own.into_iter().chain(rival) {
            if watch.stopped && best.p.len() == objective.nonlinear() {
                break;
            }
            start.resize(objective.nonlinear(), 0.0);
            let steps = if watch.stopped {
                0
            } else {
                self.settings.steps
            };
            let mut descent = descend(objective, bounds, &start, steps, watch);
            self.iterations += descent.iterations;
            let first = best.p.len() < descent.p.len();
            if first || descent.evaluation.cost <= best.evaluation.cost {
                let mut history = std::mem::take(&mut best.history);
                history.append(&mut descent.history);
                best = Descent { history, ..descent };
            }
        }
        let mut status = best.status;
        if watch.stopped {
            status = Status::Interrupted;
            best = self.not_worse_than_near(best, bounds, watch);
        }
        watch.fraction = 1.0;
        watch.report(self.full.relative(best.evaluation.cost));
        (best, status)
    }

    /// What a stopped search has found, or the point of an earlier fit where that is better.
    fn not_worse_than_near(&self, best: Descent, bounds: &SearchBox, watch: &mut Watch) -> Descent {
        let objective = self.delayed.unwrap_or(self.full);
        let near = self.settings.near.as_ref();
        let Some((_, near)) = near.filter(|(law, _)| *law == self.law) else {
            return best;
        };
        let mut near = near.clone();
        near.resize(objective.nonlinear(), 0.0);
        let near = descend(objective, bounds, &near, 0, watch);
        match near.evaluation.cost < best.evaluation.cost {
            true => Descent {
                history: best.history,
                ..near
            },
            false => best,
        }
    }

    /// Starts for a law with bristle and Stribeck curve: the curve of the static law on this record,
    /// with the stiffness that suits it best. A stiff bristle comes near the static law, so the
    /// search never ends much worse than that.
    fn static_starts(&mut self, bounds: &SearchBox, watch: &mut Watch) -> Vec<Vec<f64>> {
        let layout = self.law.layout();
        let (Some(kappa), true) = (layout.kappa, self.law.has_stribeck()) else {
            return Vec::new();
        };
        let law = Law {
            kind: LawKind::Stribeck,
            ..self.law
        };
        // The break-away part of an elasto-plastic law comes after the curve in the vector.
        let inner = layout
            .breakaway
            .map_or_else(|| bounds.clone(), |i| bounds.without(i))
            .without(kappa);
        let objective = Objective::new(self.near(), law, self.terms);
        let own = Objective::new(self.near(), self.law, self.terms);
        let mut search = Search {
            full: &objective,
            delayed: None,
            thinned: None,
            law,
            iterations: 0,
            ..*self
        };
        let starts = if law.layout().ratio.is_some() {
            search.symmetric_starts(&inner, watch)
        } else {
            search
                .scan(&objective, &inner, watch)
                .into_iter()
                .take(3)
                .collect()
        };
        let curves = search.short_descents(&inner, &starts, watch);
        self.iterations += search.iterations;
        let Some(curve) = curves.first().filter(|_| !watch.stopped) else {
            return Vec::new();
        };
        let mut line = Vec::with_capacity(LINE);
        for i in 0..LINE {
            let part = i as f64 / (LINE - 1) as f64;
            let mut p = curve.p.clone();
            p.insert(
                kappa,
                bounds.low(kappa) + part * (bounds.high(kappa) - bounds.low(kappa)),
            );
            p.extend(
                layout
                    .breakaway
                    .map(|i| 0.5 * (bounds.low(i) + bounds.high(i))),
            );
            let cost = own.evaluate(&p, false).cost;
            watch.count(&own, false);
            if watch.report(own.relative(cost)) == Control::Stop {
                break;
            }
            line.push((cost, p));
        }
        let costs: Vec<f64> = line.iter().map(|(cost, _)| *cost).collect();
        valleys(&costs)
            .into_iter()
            .map(|i| line[i].1.clone())
            .collect()
    }

    fn seed(&self) -> u32 {
        (self.settings.seed ^ (self.settings.seed >> 32)) as u32
    }

    /// Sobol points of the box, best first.
    fn scan(&self, objective: &Objective, bounds: &SearchBox, watch: &mut Watch) -> Vec<Vec<f64>> {
        watch.stage = Stage::Scan;
        let seed = self.seed();
        let many = self.settings.scan.max(1);
        let mut points = Vec::with_capacity(many);
        for i in 0..many {
            let p = sobol(bounds, i, seed);
            let cost = objective.evaluate(&p, false).cost;
            watch.count(objective, false);
            points.push((if cost.is_nan() { f64::INFINITY } else { cost }, p));
            watch.fraction = (i + 1) as f64 / many as f64;
            if watch.report(objective.relative(cost)) == Control::Stop {
                break;
            }
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.into_iter().map(|(_, p)| p).collect()
    }
}

/// A point of the scrambled Sobol sequence in a box.
pub(super) fn sobol(bounds: &SearchBox, i: usize, seed: u32) -> Vec<f64> {
    let unit: Vec<f64> = (0..bounds.len())
        .map(|d| f64::from(sobol_burley::sample(i as u32, d as u32, seed)))
        .collect();
    bounds.at(&unit)
}

/// The two lowest local minima in a row of costs, the lower first.
pub(super) fn valleys(costs: &[f64]) -> Vec<usize> {
    let many = costs.len();
    let mut found: Vec<usize> = (0..many)
        .filter(|&i| {
            (i == 0 || costs[i] <= costs[i - 1]) && (i + 1 == many || costs[i] <= costs[i + 1])
        })
        .collect();
    found.sort_by(|&a, &b| costs[a].total_cmp(&costs[b]));
    found.truncate(2);
    found
}

/// Whether two minima are the same.
pub(super) fn same(a: &[f64], b: &[f64]) -> bool {
    a.iter()
        .zip(b)
        .all(|(a, b)| (a - b).abs() < SAME_MINIMUM_DISTANCE)
}

/// Best first, without those at the same minimum as a better one.
fn distinct(mut found: Vec<Descent>) -> Vec<Descent> {
    found.sort_by(|a, b| a.evaluation.cost.total_cmp(&b.evaluation.cost));
    let mut out: Vec<Descent> = Vec::new();
    for descent in found {
        if !out.iter().any(|other| same(&descent.p, &other.p)) {
            out.push(descent);
        }
    }
    out
}
