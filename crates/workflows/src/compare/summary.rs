//! From runs to rates, medians and curves.

use super::trial::{Point, Trial};
use stiction_files::compare_file::{Course, MethodEntry, ParameterError, RunEntry, Stage};
use stiction_policy::comparison;

/// Points of a convergence curve.
const CURVE_POINTS: usize = 60;

/// What success means.
pub(super) struct Judge<'a> {
    pub least: f64,
    pub truth: &'a [(String, f64)],
    /// Whether parameters decide: without noise the true parameters are known more exactly than the least cost.
    pub by_parameters: bool,
}

impl Judge<'_> {
    /// The rule, in words.
    pub fn rule(&self) -> &'static str {
        if self.by_parameters {
            "every parameter within 1 % of the truth"
        } else {
            "a cost within 1e-4 (relative) of the optimum"
        }
    }

    fn succeeds(&self, point: &Option<Point>) -> bool {
        point
            .as_ref()
            .is_some_and(|point| match self.by_parameters {
                true => self.within(point),
                false => point.cost <= self.threshold(),
            })
    }

    fn threshold(&self) -> f64 {
        match self.by_parameters {
            true => self.least + comparison::MAX_ARRIVED_COST,
            false => self.least * (1.0 + comparison::MAX_SUCCESS_EXCESS),
        }
    }

    /// Cost divided by that of the optimum, minus 1; NaN where the cost of the optimum is rounding error only.
    fn excess(&self, cost: f64) -> f64 {
        if self.least < comparison::MAX_ROUNDING_COST {
            return f64::NAN;
        }
        cost / self.least - 1.0
    }

    /// Whether every parameter whose true value is not zero is near it.
    fn within(&self, point: &Point) -> bool {
        let known = self.truth.iter().filter(|(_, value)| *value != 0.0);
        known.into_iter().all(|(name, _)| {
            self.error(point, name)
                .is_some_and(|error| error <= comparison::MAX_SUCCESS_ERROR)
        })
    }

    /// Relative error of a parameter.
    fn error(&self, point: &Point, name: &str) -> Option<f64> {
        let truth = self.truth.iter().find(|(n, _)| n == name)?.1;
        let found = point.parameters.iter().find(|(n, _)| n == name)?.1;
        Some((found / truth - 1.0).abs()).filter(|x| x.is_finite())
    }

    /// All runs of one method.
    pub fn method(&self, name: &str, trials: &[Trial]) -> MethodEntry {
        let own: Vec<&Trial> = trials.iter().filter(|t| t.method == name).collect();
        let runs: Vec<RunEntry> = own.iter().map(|t| self.run(t)).collect();
        let stage = |points: &dyn Fn(&Trial) -> &Option<Point>,
                     success: &dyn Fn(&RunEntry) -> bool| {
            let found = || own.iter().filter_map(|t| points(t).as_ref());
            let excess = found().map(|p| self.excess(p.cost)).collect();
            Stage {
                successes: runs.iter().filter(|r| success(r)).count(),
                cost: quartiles(found().map(|p| p.cost).collect()),
                excess: quartiles(excess),
                errors: self
                    .truth
                    .iter()
                    .map(|(parameter, _)| ParameterError {
                        name: parameter.clone(),
                        relative: quartiles(
                            found().filter_map(|p| self.error(p, parameter)).collect(),
                        ),
                    })
                    .collect(),
            }
        };
        let all =
            |f: &dyn Fn(&RunEntry) -> Option<f64>| quartiles(runs.iter().filter_map(f).collect());
        let evaluations: Vec<Steps> = own
            .iter()
            .map(|t| t.history.iter().map(|i| (i.evaluations, i.cost)).collect())
            .collect();
        let seconds: Vec<Steps> = own.iter().map(|t| t.times.clone()).collect();
        MethodEntry {
            name: name.into(),
            own: stage(&|t| &t.own, &|r| r.success_own),
            after_least_squares: stage(&|t| &t.last, &|r| r.success),
            evaluations: all(&|r| Some(r.evaluations.full_records)),
            seconds: all(&|r| Some(r.seconds)),
            evaluations_to_success: all(&|r| r.evaluations_to_success),
            seconds_to_success: all(&|r| r.seconds_to_success),
            by_evaluations: course(&evaluations, true),
            by_time: course(&seconds, false),
            generations: own
                .iter()
                .flat_map(|t| &t.generations)
                .map(|g| {
                    let finite = |x: &f64| Some(*x).filter(|x| x.is_finite());
                    (g.evaluations, g.quartiles.iter().map(finite).collect())
                })
                .collect(),
            runs,
        }
    }

    fn run(&self, trial: &Trial) -> RunEntry {
        let success = self.succeeds(&trial.last);
        let threshold = self.threshold();
        let reached = |evaluations: Option<f64>| evaluations.filter(|_| success);
        let steps = trial.history.iter();
        let mut steps = steps.map(|i| (i.evaluations, i.cost));
        let mut times = trial.times.iter().copied();
        let within = |(_, cost): &(f64, f64)| *cost <= threshold;
        RunEntry {
            seed: trial.seed,
            status: trial.status.clone(),
            evaluations: trial.evaluations,
            seconds: trial.seconds,
            cost_own: trial.own.as_ref().map(|p| p.cost),
            evaluations_own: trial.own.as_ref().map(|p| p.evaluations),
            cost: trial.cost(),
            parameters: trial
                .last
                .as_ref()
                .map_or_else(Vec::new, |p| p.parameters.clone()),
            success_own: self.succeeds(&trial.own),
            success,
            evaluations_to_success: reached(steps.find(within).map(|s| s.0)),
            seconds_to_success: reached(times.find(within).map(|s| s.0)),
        }
    }
}

/// Places and costs, both in order.
type Steps = Vec<(f64, f64)>;

/// Lower quartile, median, upper quartile of what is finite; `None` without values.
fn quartiles(mut values: Vec<f64>) -> Option<[f64; 3]> {
    values.retain(|x| x.is_finite());
    (!values.is_empty()).then(|| between(values))
}

/// The same of all values, of which there is at least one.
fn between(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    [1, 2, 3].map(|q| {
        let place = q * last;
        let (at, part) = (place / 4, (place % 4) as f64 / 4.0);
        let above = values[(at + 1).min(last)];
        if part == 0.0 || above == values[at] {
            values[at]
        } else {
            values[at] + part * (above - values[at])
        }
    })
}

/// Quartiles over all runs of the best cost so far, at places common to them, from the place where three quarters of
/// the runs have a finite cost; a run without one counts as infinite.
fn course(runs: &[Steps], whole: bool) -> Course {
    let ends = runs.iter().filter_map(|run| run.last());
    let last = ends.map(|s| s.0).fold(0.0, f64::max);
    let firsts = runs.iter().filter_map(|run| run.first());
    let first = firsts.map(|s| s.0).fold(f64::INFINITY, f64::min);
    let mut out = Course::default();
    if !(first > 0.0 && first.is_finite()) {
        return out;
    }
    let ratio = libm::log(last / first) / (CURVE_POINTS - 1) as f64;
    for i in 0..CURVE_POINTS {
        let x = first * libm::exp(ratio * i as f64);
        let x = if whole { x.round() } else { x };
        if out.at.last().is_some_and(|before| x <= *before) {
            continue;
        }
        let best = |run: &Steps| match run.partition_point(|s| s.0 <= x * (1.0 + 1e-9)) {
            0 => f64::INFINITY,
            before => run[before - 1].1,
        };
        let [low, median, high] = between(runs.iter().map(best).collect());
        if high.is_finite() {
            out.at.push(x);
            out.low.push(low);
            out.median.push(median);
            out.high.push(high);
        }
    }
    out
}
