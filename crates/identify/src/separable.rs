//! The separable method: scan the box, descend from the best points, finish on the full record.

use crate::error::Error;
use crate::law::{Law, LawKind, Terms};
use crate::levenberg::{Descent, Status, Watch, descend};
use crate::objective::{Evaluation, Objective};
use crate::observe::{Control, Counts, Observer, Stage};
use crate::record::Record;
use crate::search_box::SearchBox;

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
    /// common filter. Default 4000.
    pub thin: usize,
    /// Most steps of one descent. Default 200.
    pub steps: usize,
    /// Where to look; `None` takes the box that the record allows.
    pub bounds: Option<SearchBox>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { seed: 0, scan: 64, starts: 6, thin: 4000, steps: 200, bounds: None }
    }
}

/// What a search found.
#[derive(Clone, Debug)]
pub struct Optimum {
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
    /// The evaluation at the optimum, with sensitivities.
    pub evaluation: Evaluation,
}

/// Starts from the thinned record that go on to the full one.
const MOST_FINE: usize = 3;
/// Steps on the full record before the starts are compared.
const SHORT: usize = 12;
/// Minima of the symmetric law that are paired for an asymmetric one.
const MOST_PAIRED: usize = 3;
/// Distance in the logarithms within which two minima are one.
const SAME: f64 = 1e-2;
/// How much worse a start may then be and still be followed to the end.
const CLOSE: f64 = 1.05;
/// Stiffnesses tried with the curve of the static law.
const LINE: usize = 16;

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
    let bounds = match &settings.bounds {
        Some(bounds) => bounds.clone(),
        None => SearchBox::from_record(record, &law)?,
    };
    let unknowns = law.nonlinear() + terms.columns(&law).len();
    if record.kept() < 10 * unknowns {
        return Err(Error::TooFewSamples {
            found: record.kept(),
            needed: 10 * unknowns,
            dropped: record.len() - record.kept(),
            total: record.len(),
        });
    }
    let full = Objective::new(record, law, terms);
    if full.energy() <= 0.0 {
        return Err(Error::NoForce { value: 0.0 });
    }
    let mut watch = Watch {
        observer,
        stage: Stage::Scan,
        fraction: 0.0,
        counts: Counts::default(),
        thinned: false,
        best: f64::INFINITY,
        stopped: false,
    };
    let mut search = Search { full: &full, law, terms, settings, iterations: 0 };
    let (descent, status) = search.run(&bounds, &mut watch);
    Ok(Optimum {
        p: descent.p,
        bounds,
        status,
        counts: watch.counts,
        iterations: search.iterations,
        history: descent.history,
        evaluation: descent.evaluation,
    })
}

/// Fits from a known starting point on the full record, without a scan.
pub(crate) fn refine(
    record: &Record,
    law: Law,
    terms: &Terms,
    bounds: &SearchBox,
    start: &[f64],
    observer: &mut dyn Observer,
) -> (Vec<f64>, Vec<f64>, Status, Counts) {
    let objective = Objective::new(record, law, terms);
    let mut watch = Watch {
        observer,
        stage: Stage::CrossValidation,
        fraction: 0.0,
        counts: Counts::default(),
        thinned: false,
        best: f64::INFINITY,
        stopped: false,
    };
    let found = descend(&objective, bounds, start, 60, &mut watch);
    (found.p, found.evaluation.solution.coefficients, found.status, watch.counts)
}

struct Search<'a> {
    full: &'a Objective<'a>,
    law: Law,
    terms: &'a Terms,
    settings: &'a Settings,
    iterations: usize,
}

impl<'a> Search<'a> {
    fn run(&mut self, bounds: &SearchBox, watch: &mut Watch) -> (Descent, Status) {
        if self.law.nonlinear() == 0 {
            watch.stage = Stage::Fine;
            let found = descend(self.full, bounds, &[], 1, watch);
            watch.fraction = 1.0;
            watch.report(self.full.relative(found.evaluation.cost));
            let status = found.status;
            return (found, status);
        }
        let starts = if self.law.layout().ratio.is_some() {
            self.from_symmetric(bounds, watch)
        } else {
            self.from_scan(bounds, watch)
        };
        let minima = self.short_descents(bounds, &starts, watch);
        self.finish(bounds, minima, watch)
    }

    /// Starts for a symmetric law: the best descents from a scan of the box, and the static law's
    /// curve with the stiffness that suits it.
    fn from_scan(&mut self, bounds: &SearchBox, watch: &mut Watch) -> Vec<Vec<f64>> {
        let coarse = self.full.record().thinned(self.settings.thin);
        let objective = match &coarse {
            Some(record) => Objective::new(record, self.law, self.terms),
            None => self.full.clone(),
        };
        watch.thinned = coarse.is_some();
        let points = self.scan(&objective, bounds, watch);
        watch.stage = Stage::Coarse;
        let many = points.len().min(self.settings.starts);
        let mut found = Vec::new();
        for (i, start) in points.iter().take(many).enumerate() {
            if watch.stopped {
                break;
            }
            watch.fraction = i as f64 / many as f64;
            let descent = descend(&objective, bounds, start, SHORT, watch);
            self.iterations += descent.iterations;
            found.push(descent);
        }
        let mut starts: Vec<Vec<f64>> =
            distinct(found).into_iter().take(MOST_FINE).map(|d| d.p).collect();
        if starts.is_empty() {
            starts = points.into_iter().take(1).collect();
        }
        watch.thinned = false;
        starts.extend(self.from_static(bounds, watch));
        starts
    }

    /// Starts for a law with its own parameters per direction: every pairing of two minima of the
    /// symmetric law, one for each direction, and the static law's curve.
    fn from_symmetric(&mut self, bounds: &SearchBox, watch: &mut Watch) -> Vec<Vec<f64>> {
        let layout = self.law.layout();
        let law = Law { asymmetric: false, ..self.law };
        let objective = Objective::new(self.full.record(), law, self.terms);
        let inner = bounds.symmetric(&layout);
        let mut search = Search { full: &objective, law, iterations: 0, ..*self };
        let starts = search.from_scan(&inner, watch);
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
                for (side, source) in [(0, plus), (1, minus)] {
                    copy(layout.excess[side], from.excess[0], source);
                    copy(layout.velocity[side], from.velocity[0], source);
                }
                let p = bounds.clamp(&p);
                if watch.stopped && !pairs.is_empty() {
                    continue;
                }
                let cost = self.full.evaluate(&p, false).cost;
                watch.count(false);
                watch.report(self.full.relative(cost));
                pairs.push((cost, p));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut starts: Vec<Vec<f64>> = pairs.into_iter().take(MOST_FINE).map(|(_, p)| p).collect();
        starts.extend(self.from_static(bounds, watch));
        starts
    }

    /// Short descents on the full record from every start; distinct minima, best first.
    fn short_descents(
        &mut self,
        bounds: &SearchBox,
        starts: &[Vec<f64>],
        watch: &mut Watch,
    ) -> Vec<Descent> {
        watch.stage = Stage::Fine;
        watch.best = f64::INFINITY;
        let mut found: Vec<Descent> = Vec::new();
        for (i, start) in starts.iter().enumerate() {
            if watch.stopped && !found.is_empty() {
                break;
            }
            watch.fraction = i as f64 / (starts.len() + 1) as f64;
            let steps = if watch.stopped { 0 } else { SHORT.min(self.settings.steps) };
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
        let close = CLOSE * best.evaluation.cost;
        let rival = minima
            .next()
            .filter(|r| r.status == Status::Budget && r.evaluation.cost < close)
            .map(|r| r.p);
        let own = (best.status == Status::Budget).then(|| best.p.clone());
        for start in own.into_iter().chain(rival) {
            if watch.stopped {
                break;
            }
            let mut descent = descend(self.full, bounds, &start, self.settings.steps, watch);
            self.iterations += descent.iterations;
            if descent.evaluation.cost <= best.evaluation.cost {
                let mut history = std::mem::take(&mut best.history);
                history.append(&mut descent.history);
                best = Descent { history, ..descent };
            }
        }
        let status = if watch.stopped { Status::Interrupted } else { best.status };
        watch.fraction = 1.0;
        watch.report(self.full.relative(best.evaluation.cost));
        (best, status)
    }

    /// Starts for a law with bristle and Stribeck curve: the curve of the static law on this record,
    /// with the stiffness that suits it best. A stiff bristle comes near the static law, so the
    /// search never ends much worse than that.
    fn from_static(&mut self, bounds: &SearchBox, watch: &mut Watch) -> Vec<Vec<f64>> {
        let (LawKind::LuGre, Some(kappa)) = (self.law.kind, self.law.layout().kappa) else {
            return Vec::new();
        };
        let law = Law { kind: LawKind::Stribeck, ..self.law };
        let inner = bounds.without(kappa);
        let objective = Objective::new(self.full.record(), law, self.terms);
        let mut search = Search { full: &objective, law, iterations: 0, ..*self };
        let starts = if law.layout().ratio.is_some() {
            search.from_symmetric(&inner, watch)
        } else {
            search.scan(&objective, &inner, watch).into_iter().take(3).collect()
        };
        let curves = search.short_descents(&inner, &starts, watch);
        self.iterations += search.iterations;
        let Some(curve) = curves.first().filter(|_| !watch.stopped) else { return Vec::new() };
        let mut line = Vec::with_capacity(LINE);
        for i in 0..LINE {
            let part = i as f64 / (LINE - 1) as f64;
            let mut p = curve.p.clone();
            p.insert(kappa, bounds.low(kappa) + part * (bounds.high(kappa) - bounds.low(kappa)));
            let cost = self.full.evaluate(&p, false).cost;
            watch.count(false);
            if watch.report(self.full.relative(cost)) == Control::Stop {
                return Vec::new();
            }
            line.push((cost, p));
        }
        let mut minima: Vec<_> = (0..LINE)
            .filter(|&i| {
                (i == 0 || line[i].0 <= line[i - 1].0)
                    && (i + 1 == LINE || line[i].0 <= line[i + 1].0)
            })
            .map(|i| line[i].clone())
            .collect();
        minima.sort_by(|a, b| a.0.total_cmp(&b.0));
        minima.into_iter().take(2).map(|(_, p)| p).collect()
    }

    /// Sobol points of the box, best first.
    fn scan(&self, objective: &Objective, bounds: &SearchBox, watch: &mut Watch) -> Vec<Vec<f64>> {
        watch.stage = Stage::Scan;
        let seed = (self.settings.seed ^ (self.settings.seed >> 32)) as u32;
        let many = self.settings.scan.max(1);
        let mut points = Vec::with_capacity(many);
        for i in 0..many {
            let unit: Vec<f64> = (0..bounds.len())
                .map(|d| f64::from(sobol_burley::sample(i as u32, d as u32, seed)))
                .collect();
            let p = bounds.at(&unit);
            let cost = objective.evaluate(&p, false).cost;
            watch.count(false);
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

/// Best first, without those that stand where a better one stands.
fn distinct(mut found: Vec<Descent>) -> Vec<Descent> {
    found.sort_by(|a, b| a.evaluation.cost.total_cmp(&b.evaluation.cost));
    let mut out: Vec<Descent> = Vec::new();
    for descent in found {
        let near = |other: &Descent| {
            descent.p.iter().zip(&other.p).all(|(a, b)| (a - b).abs() < SAME)
        };
        if !out.iter().any(near) {
            out.push(descent);
        }
    }
    out
}

/// A name for the law as a person writes it.
impl std::fmt::Display for LawKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
