//! A genetic search of the paper, with the course of its cost.

use super::budget::Budget;
use super::fault::Fault;
use super::stage::Stage;
use crate::reproduce::watch::Watch;
use rayon::prelude::*;
use stiction_identify::candidates::{Candidates, Named};
use stiction_search::{
    Bounds, Control, Finish, Generation, Limits, Method, Plan, Progress, Run, Status, genetic,
};

/// The three of Z25 Fig. 7.
pub(super) const METHODS: [&str; 3] = ["ga", "adaptive-ga", "annealing-ga"];

/// The least squares after the annealing search: from points that are a fifth of the box apart, since the best points of a
/// search that ended in a wrong valley all lie there, and each long enough for the valley along which sigma1 and sigma2
/// trade.
const FINISH: Finish = Finish {
    starts: 16,
    apart: 0.2,
    steps: 400,
};

/// Result of a search.
#[derive(Clone, Debug)]
pub struct Searched {
    /// Name of the method.
    pub method: &'static str,
    /// Its seed.
    pub seed: u64,
    /// Evaluations until each new best of the method itself, and its cost J.
    pub course: Vec<(f64, f64)>,
    /// Evaluations at the end of each round, and the least J by then; none for a method without rounds.
    pub rounds: Vec<(f64, f64)>,
    /// The best point of the method itself, before any least squares.
    pub own: Named,
    /// The best after the least squares of the precision module, or the same where none follow.
    pub found: Named,
}

impl Searched {
    /// The least cost J of the method itself.
    pub fn cost(&self) -> f64 {
        self.course.last().map_or(f64::INFINITY, |(_, cost)| *cost)
    }

    /// Evaluations of the method itself until J was not above `target`; none where it never was.
    pub fn evaluations_to(&self, target: f64) -> Option<f64> {
        let mut course = self.course.iter();
        course.find(|(_, cost)| *cost <= target).map(|(n, _)| *n)
    }
}

/// Where the six parameters `[sigma0, sigma1, sigma2, Fc, Fs - Fc, vs]` of our stage are searched, SI: its own values ...
const OURS: [f64; 6] = [2e6, 1.5e3, 30.0, 12.0, 6.0, 3e-3];
/// ... and the ends of the boxes.
const ENDS: [[f64; 6]; 2] = [
    [1e4, 10.0, 0.1, 0.1, 0.1, 1e-4],
    [1e8, 1e5, 1e3, 100.0, 100.0, 0.1],
];

/// The lower and the upper ends of the box of an axis, SI: in the same ratios to its parameters as on our stage.
pub(super) fn search_box(stage: &Stage) -> [[f64; 6]; 2] {
    let truth = stage.genome();
    let part = |i: usize| truth[i] / OURS[i];
    let [force, speed] = [part(3), part(5)];
    // Where the axis has none of a parameter, by what it would be on one like our stage.
    let usual = [part(0), force / speed, force / speed, force, force, speed];
    let scale = |i: usize| if truth[i] > 0.0 { part(i) } else { usual[i] };
    ENDS.map(|ends| std::array::from_fn(|i| ends[i] * scale(i)))
}

/// The box of the logarithms.
pub(super) fn bounds(low: &[f64], high: &[f64]) -> Result<Bounds, Fault> {
    let logarithms = |ends: &[f64]| ends.iter().map(|x| libm::log(*x)).collect();
    Ok(Bounds::new(logarithms(low), logarithms(high))?)
}

/// A search by each method with each seed, in that order.
pub(super) fn each_seed(
    methods: &[&'static str],
    budget: Budget,
    one: impl Fn(&'static str, u64) -> Result<Searched, Fault> + Sync,
) -> Result<Vec<Searched>, Fault> {
    let tasks = methods
        .iter()
        .flat_map(|m| (1..=budget.seeds).map(move |seed| (*m, seed)));
    let tasks: Vec<(&str, u64)> = tasks.collect();
    tasks.par_iter().map(|(m, seed)| one(m, *seed)).collect()
}

/// Of searches, those by annealing: the paper's.
pub fn annealing(searches: &[Searched]) -> impl Iterator<Item = &Searched> {
    searches.iter().filter(|s| s.method == "annealing-ga")
}

/// Runs a method to its end on a cost with or without derivatives.
pub(super) fn search<P: Candidates>(
    problem: &P,
    method: &'static str,
    budget: Budget,
    seed: u64,
    watch: &Watch,
) -> Result<Searched, Fault> {
    let annealed = genetic::Settings {
        generations: budget.generations,
        rounds: budget.rounds,
        ..genetic::Settings::default()
    };
    let plain = |settings: genetic::Settings| genetic::Settings {
        generations: budget.generations * budget.rounds,
        ..settings
    };
    let (method_settings, finish) = match method {
        "ga" => (Method::Ga(plain(genetic::Settings::plain())), None),
        "adaptive-ga" => (
            Method::AdaptiveGa(plain(genetic::Settings::adaptive())),
            None,
        ),
        _ => (Method::AnnealingGa(annealed), Some(FINISH)),
    };
    let plan = Plan {
        method: method_settings,
        finish,
    };
    let dimensions = problem.bounds().dimensions();
    let mut run = Run::new(plan.start(dimensions, seed)?, problem);
    let mut watched = |_: &Progress| match watch.stopped() {
        true => Control::Stop,
        false => Control::Continue,
    };
    if run.advance(problem, &Limits::default(), &mut watched)? == Status::Interrupted {
        return Err(Fault::Stopped);
    }
    watch.done()?;
    let own = run.own_best().ok_or(Fault::Stopped)?;
    let last = run.best().ok_or(Fault::Stopped)?;
    let own_evaluations = own.counts.costs as f64;
    let improvements = run.history().improvements().iter();
    let course: Vec<(f64, f64)> = improvements
        .filter(|i| i.evaluations <= own_evaluations)
        .map(|i| (i.evaluations, i.cost))
        .collect();
    // Each round is drawn, which counts as a generation, and then bred.
    let length = budget.generations + 1;
    let generations = run.history().generations().iter();
    let ends = generations.filter(|g| (g.generation + 1).is_multiple_of(length));
    let least = |g: &Generation| {
        let by_then = course.iter().take_while(|(n, _)| *n <= g.evaluations);
        by_then.last().map(|(_, cost)| (g.evaluations, *cost))
    };
    let rounds = match method {
        "annealing-ga" => ends.filter_map(least).collect(),
        _ => Vec::new(),
    };
    Ok(Searched {
        method,
        seed,
        course,
        rounds,
        own: problem.parameters(&own.point),
        found: problem.parameters(&last.point),
    })
}
