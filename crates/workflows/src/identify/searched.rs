//! A search of `stiction_search` in place of the separable one, and the least squares after it.

mod checkpoint;
mod watch;

use super::logs::paths;
use super::method::Method;
use super::options::{CostKind, Options, Searching};
use crate::entries;
use crate::error::Error;
use crate::source::Source;
use crate::spread::Spread;
use crate::wording::{Setting, TOGETHER_WITH};
use checkpoint::Checkpoint;
use std::time::Instant;
use stiction_files::result::{SearchedEntry, SearchedParameter, SearchedPoint};
use stiction_identify as engine;
use stiction_identify::candidates::{Candidates, Nonlinear, Scheme, SixParameters, box_of_six};
use stiction_identify::{
    Estimate, Law, LawKind, Observer, Optimum, Record, SearchBox, Settings, Status, Terms,
};
use stiction_search::{Best, Bounds, Finish, Finished, Limits, Plan, Run, Searcher};
use watch::{Ended, Watch};

/// Most evaluations of the full record, where the command names none: enough for the genetic algorithms of the
/// publication to end by themselves on most logs.
const USUAL_EVALUATIONS: u64 = 20_000;

/// Refuses limits of a search beside another method, and limits that are not positive.
pub(super) fn check(options: &Options) -> Result<(), Error> {
    let method = options.procedures.method;
    let given = &options.searching;
    if !matches!(method, Method::Searched(_)) {
        if *given == Searching::default() {
            return Ok(());
        }
        return Err(Error::usage(
            [
                Setting::Cost.into(),
                ", ".into(),
                Setting::Evaluations.into(),
                ", ".into(),
                Setting::Target.into(),
                ", ".into(),
                Setting::Time.into(),
                ", ".into(),
                Setting::Checkpoint.into(),
                " or ".into(),
                Setting::Resume.into(),
                TOGETHER_WITH.into(),
                Setting::Method.is(method.name()),
            ],
            format!(
                "one of the searches: {}",
                stiction_search::Method::NAMES.join(", ")
            ),
        ));
    }
    let limits = [(Setting::Target, given.target), (Setting::Time, given.time)];
    for (setting, found) in limits {
        if let Some(found) = found.filter(|x| !(*x > 0.0 && x.is_finite())) {
            return Err(Error::usage(setting.is(found), "a finite number above 0"));
        }
    }
    if given.evaluations == Some(0) {
        return Err(Error::usage(Setting::Evaluations.is(0), "at least 1"));
    }
    match &given.checkpoint {
        Some(file) => checkpoint::check_place(file),
        None => Ok(()),
    }
}

/// One search to make.
pub(super) struct Task<'a> {
    pub options: &'a Options,
    pub inputs: &'a [Source],
    pub record: &'a Record,
    pub law: Law,
    pub terms: &'a Terms,
    pub low_speed: f64,
    pub settings: &'a Settings,
    pub clock: Instant,
    /// Whether the same command would see the same record: only then is the state worth keeping.
    pub keep: bool,
}

/// What came of it.
pub(super) struct Found {
    pub estimate: Estimate,
    pub optimum: Optimum,
    pub entry: SearchedEntry,
    /// Why the state could not be kept.
    pub lost: Option<Error>,
}

/// What a search ends with.
struct Searched {
    entry: SearchedEntry,
    point: Vec<f64>,
    ended: Ended,
    lost: Option<Error>,
}

/// Searches, then descends from the best point found.
pub(super) fn search(task: Task, observer: &mut dyn Observer) -> Result<Found, Error> {
    let refused = |source: engine::Error| Error::Identify {
        inputs: paths(task.inputs).join(", "),
        source,
    };
    let six = match task.options.searching.cost {
        Some(cost) => cost == CostKind::Six,
        None => task.paper() && task.six_allowed(),
    };
    let (searched, start) = if six {
        let bounds = box_of_six(task.record).map_err(refused)?;
        let problem = SixParameters::new(task.record, task.law, task.terms, bounds, Scheme::Explin)
            .map_err(refused)?;
        let names = [
            "sigma0",
            "sigma1",
            "sigma2",
            "coulomb",
            "static - coulomb",
            "stribeck_velocity",
        ];
        let names = names.map(String::from).to_vec();
        let searched = run(&task, &problem, CostKind::Six, names, observer)?;
        let start = SixParameters::nonlinear(&searched.point);
        (searched, start)
    } else {
        let bounds = SearchBox::from_record(task.record, &task.law).map_err(refused)?;
        let thinned = engine::candidates::thinned(task.record);
        let problem = Nonlinear::new(task.record, thinned.as_ref(), task.law, task.terms, &bounds)
            .map_err(refused)?;
        let names = task.law.unknowns();
        let searched = run(&task, &problem, CostKind::Separable, names, observer)?;
        let start = searched.point.clone();
        (searched, start)
    };
    let (mut estimate, mut optimum) = engine::fit_law_from(
        &start,
        task.record,
        task.law,
        task.terms,
        task.low_speed,
        task.settings,
        observer,
    )
    .map_err(refused)?;
    let spent = &searched.entry.evaluations;
    estimate.count(&engine::Counts {
        costs: spent.costs,
        derivatives: spent.derivatives,
        coarse_costs: spent.coarse_costs,
        coarse_derivatives: spent.coarse_derivatives,
    });
    if searched.ended == Ended::Interrupted {
        estimate = estimate.interrupted();
        optimum.status = Status::Interrupted;
    }
    Ok(Found {
        estimate,
        optimum,
        entry: searched.entry,
        lost: searched.lost,
    })
}

impl Task<'_> {
    /// Whether the method is one of the genetic algorithms of the publication.
    fn paper(&self) -> bool {
        ["ga", "adaptive-ga", "annealing-ga"].contains(&self.options.procedures.method.name())
    }

    fn six_allowed(&self) -> bool {
        self.law
            == Law {
                exponent: self.law.exponent,
                ..Law::new(LawKind::LuGre)
            }
            && self.terms.dependences.is_empty()
    }

    fn evaluations(&self) -> u64 {
        self.options
            .searching
            .evaluations
            .unwrap_or(USUAL_EVALUATIONS)
    }

    /// What the course of the search depends on, in words; a checkpoint goes on only with the same.
    fn settings(&self, cost: CostKind, bounds: &Bounds) -> checkpoint::Settings {
        let axis = format!(
            "{:?} {:?} {bounds:?} {:?}",
            self.law, self.terms, self.record.notes
        );
        checkpoint::Settings {
            version: env!("CARGO_PKG_VERSION").into(),
            method: self.options.procedures.method.name().into(),
            cost: cost.name().into(),
            seed: self.options.seed,
            evaluations: self.evaluations(),
            inputs: self.inputs.iter().map(|s| s.sha256.clone()).collect(),
            axis: stiction_files::sha256_of(axis.as_bytes()),
            samples: self.record.kept(),
        }
    }
}

/// Runs the search to one of its ends.
fn run<P: Candidates + Sync>(
    task: &Task,
    problem: &P,
    cost: CostKind,
    unknowns: Vec<String>,
    observer: &mut dyn Observer,
) -> Result<Searched, Error> {
    let given = &task.options.searching;
    let name = task.options.procedures.method.name();
    let bounds = problem.bounds().clone();
    let keep = Checkpoint {
        settings: task.settings(cost, &bounds),
        file: given.checkpoint.as_deref().filter(|_| task.keep),
    };
    let mut plan = Plan::named(name).expect("a method of the searches");
    // These methods descend by themselves and need no descents after them.
    if !matches!(name, "niched-ga" | "lm") {
        plan.finish = Some(Finish::default());
    }
    let mut run: Run<Finished<Searcher>> = match &given.resume {
        Some(file) => keep.read(file)?,
        None => {
            let search = plan.start(bounds.dimensions(), task.options.seed);
            Run::new(search.expect("default settings"), problem)
        }
    };
    let limits = Limits {
        costs: task.evaluations(),
        derivatives: task.evaluations(),
        target: given.target,
        ..Limits::default()
    };
    let mut watch = Watch::new(
        observer,
        task.clock,
        given.time,
        keep.file.is_some(),
        &limits,
    );
    let ended = loop {
        let stop = run
            .advance(&Spread(problem), &limits, &mut watch)
            .map_err(|e| Error::usage(e.to_string(), "a checkpoint of this very search"))?;
        match watch.ended(stop) {
            Some(ended) => break ended,
            // A checkpoint that cannot be written does not end the search; only a failure of the last one is
            // reported.
            None => drop(keep.write(&run)),
        }
    };
    let lost = keep.write(&run).err();
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
        cost: cost.name().into(),
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
    Ok(Searched {
        entry,
        point: run.best().map_or_else(middle, |best| best.point.clone()),
        ended,
        lost,
    })
}
