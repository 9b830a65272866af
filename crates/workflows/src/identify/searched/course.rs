//! The course of a search: its method with settings, when it ends, and what it found.

use super::checkpoint::Checkpoint;
use super::watch::{Ended, Watch};
use crate::entries;
use crate::error::Error;
use crate::identify::options::Options;
use crate::spread::Spread;
use std::time::Instant;
use stiction_files::Axis;
use stiction_files::result::{SearchedEntry, SearchedParameter, SearchedPoint, end_of};
use stiction_identify::Observer;
use stiction_identify::candidates::Candidates;
use stiction_number::four_digits;
use stiction_search::{Best, Counts, Finish, Finished, Limits, Plan, Run, Searcher};

/// Most evaluations of the full record, where the command names none: enough for the genetic algorithms of the
/// publication to end by themselves on most logs.
const USUAL_EVALUATIONS: u64 = 20_000;

/// How a search is made, and when it ends.
pub(super) struct Course {
    pub plan: Plan,
    pub seed: u64,
    /// Most evaluations of the full record, and as many with derivatives.
    pub evaluations: u64,
    target: Option<f64>,
    time: Option<f64>,
    clock: Instant,
}

/// Where the state of a search is kept, and a state to go on from.
pub(super) type Keep<'a> = (Option<&'a Checkpoint<'a>>, Option<Run<Finished<Searcher>>>);

/// What a search ends with.
pub(super) struct Searched {
    pub entry: SearchedEntry,
    pub counts: Counts,
    pub point: Vec<f64>,
    pub ended: Ended,
    /// Unknowns that ended at an end of their range, in words; empty where none did.
    pub at_ends: Vec<String>,
    /// Why the state could not be kept.
    pub lost: Option<Error>,
}

impl Course {
    /// A search by name, with the settings of the axis file and the limits of the options.
    pub fn of(options: &Options, axis: &Axis, name: &str, clock: Instant) -> Result<Self, Error> {
        let given = &options.searching;
        let method = axis.search_method(name).expect("a method of the searches");
        // These methods descend by themselves and need no descents after them.
        let descends = matches!(name, "niched-ga" | "lm");
        Ok(Course {
            plan: Plan {
                method,
                finish: (!descends && !given.no_finish).then(Finish::default),
            },
            seed: options.seed,
            evaluations: given.evaluations.unwrap_or(USUAL_EVALUATIONS),
            target: given.target,
            time: given.time,
            clock,
        })
    }
}

/// Runs a search to one of its ends, from its beginning or from a state that was kept.
pub(super) fn run<P: Candidates + Sync>(
    course: &Course,
    problem: &P,
    cost: &str,
    unknowns: Vec<String>,
    keep: Option<Keep>,
    observer: &mut dyn Observer,
) -> Result<Searched, Error> {
    let bounds = problem.bounds().clone();
    let (file, state) = keep.unwrap_or_default();
    let mut run = match state {
        Some(state) => state,
        None => {
            let search = course.plan.start(bounds.dimensions(), course.seed);
            Run::new(search.expect("checked settings"), problem)
        }
    };
    let limits = Limits {
        costs: course.evaluations,
        derivatives: course.evaluations,
        target: course.target,
        ..Limits::default()
    };
    let (clock, time) = (course.clock, course.time);
    let mut watch = Watch::new(observer, clock, time, file.is_some(), &limits);
    let ended = loop {
        let stop = run
            .advance(&Spread(problem), &limits, &mut watch)
            .map_err(|e| Error::usage(e.to_string(), "a checkpoint of this very search"))?;
        match watch.ended(stop) {
            Some(ended) => break ended,
            // A checkpoint that cannot be written does not end the search; only a failure of the last one is
            // reported.
            None => drop(file.map(|file| file.write(&run))),
        }
    };
    let lost = file.and_then(|file| file.write(&run).err());
    let share = problem.coarse_share();
    let point = |best: &Best| SearchedPoint {
        cost: best.cost,
        evaluations: best.counts.full_records(share),
        parameters: problem
            .parameters(&best.point)
            .into_iter()
            .map(|(name, value)| SearchedParameter {
                name: name.to_string(),
                value,
            })
            .collect(),
    };
    let middle = || bounds.at(&vec![0.5; bounds.dimensions()]);
    let ends = bounds.low().iter().zip(bounds.high());
    let entry = SearchedEntry {
        method: course.plan.method.name().into(),
        cost: cost.into(),
        status: ended.name().into(),
        unknowns,
        bounds: ends.map(|(a, b)| [libm::exp(*a), libm::exp(*b)]).collect(),
        evaluations: entries::evaluations(&run.counts(), share),
        own: run.own_best().map(point),
        after_least_squares: run.best().map(point),
        history: (run.history().improvements().iter())
            .map(|i| (i.evaluations, i.cost))
            .collect(),
        generations: (run.history().generations().iter())
            .map(|g| {
                let finite = |x: &f64| Some(*x).filter(|x| x.is_finite());
                (g.evaluations, g.quartiles.iter().map(finite).collect())
            })
            .collect(),
    };
    let ends_at = |best: &Best| at_ends(&best.point, &entry);
    Ok(Searched {
        at_ends: run.best().map(ends_at).unwrap_or_default(),
        entry,
        counts: run.counts(),
        point: run.best().map_or_else(middle, |best| best.point.clone()),
        ended,
        lost,
    })
}

/// Which unknowns lie at an end of their range, which keeps the search from going on.
fn at_ends(point: &[f64], entry: &SearchedEntry) -> Vec<String> {
    let named = entry.unknowns.iter().zip(point).zip(&entry.bounds);
    named
        .filter_map(|((name, at), range)| {
            let end = end_of(*range, libm::exp(*at))?;
            let which = ["lower", "upper"][end];
            Some(format!(
                "{name} at the {which} end, {}",
                four_digits(range[end])
            ))
        })
        .collect()
}
