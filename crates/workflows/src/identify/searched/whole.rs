//! A search over whole records, in place of the separable one, and the least squares after it.

use super::checkpoint::{self, Checkpoint};
use super::course::{Course, Searched, run};
use super::ranges;
use super::watch::Ended;
use crate::error::Error;
use crate::identify::logs::paths;
use crate::identify::options::{CostKind, Options};
use crate::source::Source;
use std::time::Instant;
use stiction_files::Axis;
use stiction_files::result::SearchedEntry;
use stiction_identify as engine;
use stiction_identify::candidates::{Candidates, Nonlinear, Scheme, SixParameters, box_of_six};
use stiction_identify::{
    Estimate, Law, LawKind, Observer, Optimum, Record, SearchBox, Settings, Status, Terms,
};
use stiction_search::Bounds;

/// One search to make.
pub(in crate::identify) struct Task<'a> {
    pub options: &'a Options,
    pub axis: &'a Axis,
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
pub(in crate::identify) struct Found {
    pub estimate: Estimate,
    pub optimum: Optimum,
    pub entry: SearchedEntry,
    /// Why the state could not be kept.
    pub lost: Option<Error>,
}

/// Searches, then descends from the best point found.
pub(in crate::identify) fn search(task: Task, observer: &mut dyn Observer) -> Result<Found, Error> {
    let refused = |source: engine::Error| Error::identify(paths(task.inputs).join(", "), source);
    let six = match task.options.searching.cost {
        Some(cost) => cost == CostKind::Six,
        None => task.paper() && task.six_allowed(),
    };
    let (searched, start, held) = if six {
        let bounds = box_of_six(task.record).map_err(refused)?;
        let bounds = ranges::given(task.axis, task.inputs, bounds, ranges::SIX)?;
        let problem = SixParameters::new(task.record, task.law, task.terms, bounds, Scheme::Explin)
            .map_err(refused)?;
        let names = ranges::names(ranges::SIX);
        let searched = task.run(&problem, CostKind::Six, names, observer)?;
        let start = SixParameters::nonlinear(&searched.point);
        let held = SixParameters::held(&searched.point).to_vec();
        (searched, start, held)
    } else {
        ranges::refuse_beside_separable(task.axis)?;
        let bounds = SearchBox::from_record(task.record, &task.law).map_err(refused)?;
        let thinned = engine::candidates::thinned(task.record);
        let problem = Nonlinear::new(task.record, thinned.as_ref(), task.law, task.terms, &bounds)
            .map_err(refused)?;
        let names = task.law.unknowns();
        let searched = task.run(&problem, CostKind::Separable, names, observer)?;
        let start = searched.point.clone();
        (searched, start, Vec::new())
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
    if task.options.searching.no_finish {
        estimate = estimate
            .as_searched(task.record, &start, &held)
            .map_err(refused)?;
    }
    estimate.count(&searched.counts);
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

    /// Runs the search from its beginning, or from where a checkpoint left it.
    fn run<P: Candidates + Sync>(
        &self,
        problem: &P,
        cost: CostKind,
        unknowns: Vec<String>,
        observer: &mut dyn Observer,
    ) -> Result<Searched, Error> {
        let given = &self.options.searching;
        let name = self.options.procedures.method.name();
        let course = Course::of(self.options, self.axis, name, self.clock)?;
        let keep = Checkpoint {
            settings: self.settings(&course, cost, problem.bounds()),
            file: given.checkpoint.as_deref().filter(|_| self.keep),
        };
        let state = match &given.resume {
            Some(file) => Some(keep.read(file)?),
            None => None,
        };
        run(
            &course,
            problem,
            cost.name(),
            unknowns,
            Some((Some(&keep), state)),
            observer,
        )
    }

    /// What the course of the search depends on, in words; a checkpoint goes on only with the same.
    fn settings(&self, course: &Course, cost: CostKind, bounds: &Bounds) -> checkpoint::Settings {
        let axis = format!(
            "{:?} {:?} {bounds:?} {:?} {:?}",
            self.law, self.terms, self.record.notes, course.plan
        );
        checkpoint::Settings {
            version: env!("CARGO_PKG_VERSION").into(),
            method: course.plan.method.name().into(),
            cost: cost.name().into(),
            seed: self.options.seed,
            evaluations: course.evaluations,
            inputs: self.inputs.iter().map(|s| s.sha256.clone()).collect(),
            axis: stiction_files::sha256_of(axis.as_bytes()),
            samples: self.record.kept(),
        }
    }
}
