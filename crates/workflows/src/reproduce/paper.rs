//! The experiments of Zhang et al. 2025 (Z25, doi 10.1371/journal.pone.0322844) on a simulated axis of ours.
//!
//! Only the text of the paper is available: where it gives no number, one is assumed, and every assumption is listed
//! in the report. What is checked is whether the identification finds the axis that was simulated; the paper's claims
//! are shown beside our figures, but do not come from the same experiment.

mod assumptions;
mod budget;
mod claims;
mod compensation;
mod corner;
mod crawl;
mod delay;
mod dynamics;
mod fault;
mod law;
mod load;
mod measured;
mod own;
mod presliding;
mod rest;
mod results;
mod search;
mod stage;
mod statics;
mod stiffness;
mod tracking;
mod tune;
mod units;

pub use budget::Budget;
pub use compensation::Compensation;
pub use corner::{Cornered, Turn};
pub use crawl::{Crawled, Pull};
pub use delay::Delayed;
pub use dynamics::Dynamics;
pub use load::LoadFound;
pub use measured::Measured;
pub use own::OwnAxis;
pub use presliding::Presliding;
pub use rest::{Hold, Rested};
pub use results::{PARAMETERS, Paper, REACHED};
pub use search::{Searched, annealing};
pub use stage::{Control, Stage};
pub use statics::{LeftOut, Outliers, Statics};
pub use stiffness::Stiffness;
pub use tracking::Tracked;
pub use units::Units;

use super::outcome::{Body, Reproduction};
use super::watch::Watch;
use crate::error::Error;
use fault::Fault;
use law::law;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_search::Observer;

/// The experiments, with as much searching as `budget` allows. The observer is told the number of steps done and
/// their total, and may stop the work: the experiments that are done by then are kept.
pub fn zhang_2025(budget: Budget, observer: &mut dyn Observer) -> Reproduction {
    let stage = Stage::ours().expect("the axis of the experiments");
    run(stage, budget, observer)
}

/// The same on an axis of the user, twice where there are two axes. What cannot be run on it is said.
///
/// # Errors
/// Where a file cannot be read, or describes no axis that the experiments could be run on.
pub fn zhang_2025_on(
    own: &OwnAxis,
    budget: Budget,
    observer: &mut dyn Observer,
) -> Result<Reproduction, Error> {
    Ok(run(Stage::own(own)?, budget, observer))
}

/// What is searched by each method: the static step, the dynamic step, all six at once.
const STEPS: usize = 3;

fn run(stage: Stage, budget: Budget, observer: &mut dyn Observer) -> Reproduction {
    /// Static map, record of the dynamics, what encoder and noise allow, presliding, tracking, delay, corner, rest, crawl,
    /// stiffness, load.
    const EXPERIMENTS: usize = 11;
    /// The map with outliers by both costs.
    const OUTLIERS: usize = 2;
    let searches = search::METHODS.len() * STEPS * budget.seeds as usize
        + STEPS * measured::draws(budget) as usize
        + OUTLIERS;
    let watch = Watch::new(EXPERIMENTS + searches, observer);
    let mut paper = Paper::of(stage);
    let stopped = experiments(&mut paper, budget, &watch).is_err();
    let checks = paper.checks();
    Reproduction {
        file: ReproduceFile {
            status: if stopped { "interrupted" } else { "complete" }.into(),
            // Where nothing was checked nothing is within.
            all_within: paper.not_run.is_empty()
                && !checks.is_empty()
                && checks.iter().all(|c| c.within),
            checks,
            claims: paper.claims(),
            runs: paper.runs(),
            searches: paper.searches(),
            not_run: paper.not_run.clone(),
            assumptions: assumptions::of(&paper.stage),
            ..ReproduceFile::of("paper")
        },
        body: Body::Zhang2025(Box::new(paper)),
    }
}

/// The user stopped it.
struct Stopped;

/// The result of an experiment; where it has none, why not is noted.
fn tried<T>(
    not_run: &mut Vec<String>,
    name: &str,
    result: Result<T, Fault>,
) -> Result<Option<T>, Stopped> {
    match result {
        Ok(result) => Ok(Some(result)),
        Err(Fault::Stopped) => Err(Stopped),
        Err(fault) => {
            not_run.push(format!("{name}: {fault}"));
            Ok(None)
        }
    }
}

fn experiments(paper: &mut Paper, budget: Budget, watch: &Watch) -> Result<(), Stopped> {
    let stage = &paper.stage;
    let not_run = &mut paper.not_run;
    paper.statics = tried(
        not_run,
        "Static parameters",
        statics::run(stage, budget, watch),
    )?;
    let Some(statics) = &paper.statics else {
        return Ok(());
    };
    let Some(best) = annealing(&statics.searches).next() else {
        return Ok(());
    };
    let found = dynamics::run(stage, &best.found, budget, watch);
    paper.dynamics = tried(not_run, "Dynamic parameters", found)?;
    let Some(dynamics) = &paper.dynamics else {
        return Ok(());
    };
    let Some(best) = annealing(&dynamics.two).next() else {
        return Ok(());
    };
    let identified = &best.found;
    let measured = measured::run(stage, statics, budget, watch);
    let measured = tried(not_run, "From an encoder and with noise", measured)?;
    (paper.measured, paper.allowed) = measured.unwrap_or_default();
    let identified_law = law(identified).map_err(Fault::from);
    paper.law = tried(not_run, "Compensation", identified_law)?;
    let step = presliding::run(stage, identified, watch);
    paper.presliding = tried(not_run, "Presliding", step)?;
    let Some(law) = &paper.law else {
        return Ok(());
    };
    let tracked = tracking::run(stage, law, watch);
    paper.tracked = tried(not_run, "Compensation", tracked)?.unwrap_or_default();
    let delayed = delay::run(stage, law, watch);
    paper.delayed = tried(not_run, "A delay of the loop", delayed)?.unwrap_or_default();
    let cornered = corner::run(stage, law, watch);
    paper.cornered = tried(not_run, "A corner of two axes", cornered)?.unwrap_or_default();
    let rested = rest::run(stage, law, watch);
    paper.rested = tried(not_run, "Standstill", rested)?.unwrap_or_default();
    let crawled = crawl::run(stage, law, watch);
    paper.crawled = tried(not_run, "Crawling at low speed", crawled)?.unwrap_or_default();
    let stiffnesses = stiffness::run(stage, law, watch);
    paper.stiffnesses =
        tried(not_run, "The stiffness of the bristles", stiffnesses)?.unwrap_or_default();
    let loads = load::run(stage, law, watch);
    paper.loads = tried(not_run, "A change of load", loads)?.unwrap_or_default();
    Ok(())
}
