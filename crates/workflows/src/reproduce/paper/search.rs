//! A genetic search of the paper, with the course of its cost.

use super::budget::Budget;
use super::fault::Fault;
use crate::reproduce::watch::Watch;
use stiction_identify::candidates::{Candidates, Named};
use stiction_search::{Control, Finish, Limits, Method, Plan, Progress, Run, Status, genetic};

/// The three of Z25 Fig. 7.
pub(super) const METHODS: [&str; 3] = ["ga", "adaptive-ga", "annealing-ga"];

/// Result of a search.
#[derive(Clone, Debug)]
pub struct Searched {
    /// Name of the method.
    pub method: &'static str,
    /// Evaluations until each new best of the method itself, and its cost J.
    pub course: Vec<(f64, f64)>,
    /// The best point of the method itself, before any least squares.
    pub own: Named,
    /// The best after the least squares of the precision module, or the same where none follow.
    pub found: Named,
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
        _ => (Method::AnnealingGa(annealed), Some(Finish::default())),
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
    Ok(Searched {
        method,
        course: improvements
            .filter(|i| i.evaluations <= own_evaluations)
            .map(|i| (i.evaluations, i.cost))
            .collect(),
        own: problem.parameters(&own.point),
        found: problem.parameters(&last.point),
    })
}
