//! The experiments of Zhang et al. 2025 (Z25, doi 10.1371/journal.pone.0322844) on a simulated axis of ours.
//!
//! Only the text of the paper is available: where it gives no number, one is assumed, and every assumption is listed
//! in the report. What is checked is whether the identification finds the axis that was simulated; the paper's claims
//! are shown beside our figures, but do not come from the same experiment.

mod budget;
mod claims;
mod compensation;
mod corner;
mod crawl;
mod dynamics;
mod fault;
mod law;
mod load;
mod measured;
mod presliding;
mod results;
mod search;
mod stage;
mod statics;
mod stiffness;
mod tracking;

pub use budget::Budget;
pub use compensation::Compensation;
pub use corner::Cornered;
pub use crawl::{Crawled, Pull};
pub use dynamics::Dynamics;
pub use load::LoadFound;
pub use measured::Measured;
pub use presliding::Presliding;
pub use results::{PARAMETERS, Paper, REACHED};
pub use search::Searched;
pub use stage::{Control, Stage};
pub use statics::Statics;
pub use stiffness::Stiffness;
pub use tracking::Tracked;

use super::outcome::{Body, Reproduction};
use super::watch::Watch;
use fault::Fault;
use law::law;
use stiction_files::reproduce_file::ReproduceFile;
use stiction_search::Observer;

/// What is assumed where the paper gives no number, each with what is known.
const ASSUMPTIONS: &[&str] = &[
    "Friction of the stage: σ₀ 2·10⁶ N/m, σ₁ 1500 N·s/m (constant), σ₂ 30 N·s/m, Fc 12 N, Fs 18 N, vs 3 mm/s. The \
     paper's table is an image that no text carries.",
    "172.8 N/V: 96 N/A are published, 1.8 A/V follow if 10 V are the 18 A of the drive's peak.",
    "Neither damper B nor spring K beside the friction, no disturbance force, no delay, no current loop of its own; a \
     thermal time of 10 s for the rated 221 N.",
    "PID and fuzzy PID: gains for a bandwidth of 60 Hz (45 Hz on the second axis), velocity and acceleration fed forward; \
     the fuzzy one with scales from the friction and gains within 30 % of those of the PID. Its tables of 49 rules have \
     the usual form. The paper gives neither gains nor tables.",
    "Baselines: Coulomb and viscous friction, and the steady curve, of the same identified law, both driven by the \
     reference velocity.",
    "Constant velocities: 16 from 0.2 to 100 mm/s in both directions, 0.3 s to settle and 0.3 s to average.",
    "Dynamic test: a sine of ±0.5 mm at 2 Hz, three cycles, with velocity and acceleration as the simulation has them.",
    "Voltage step: 20 mV (3.5 N, a fifth of the static level).",
    "Boxes of the searches: σ₀ 10⁴ to 10⁸ N/m, σ₁ 10 to 10⁵ N·s/m, σ₂ 0.1 to 1000 N·s/m, Fc and Fs − Fc 0.1 to 100 N, \
     vs 0.1 to 100 mm/s, in logarithms.",
    "Genetic searches: 50 individuals, 5 rounds of 100 generations (500 in one round for the others), crossover .6 to \
     .9, mutation .01 to .10, temperature 7, falling by .96 a generation.",
    "Tracked sine: ±20 mm at 0.5 Hz, 3.8 m/min at the most, for the published 3 s; what comes after 0.5 s counts.",
    "Corner: 20 mm by 20 mm at 3 m/min, with a stop at the corner, 0.2 s to either side of which count; the second axis is a slide of 10 kg, σ₀ 1.2·10⁵ N/m, \
     Fc 20 N, Fs 30 N, whose parameters are known to its compensation.",
    "Cross coupling: a PD on the deviation from the contour above both axes (Koren 1980), tuned for the slower axis. \
     The paper names cross coupling and does not say how it is made.",
    "Feed error: the velocity of both axes along the contour less that of the reference; contour error: the deviation across \
     it. The paper defines neither of its two metrics.",
    "Change of load: from 4.6 to 5.75, 6.9 and 9.2 kg after 1 s of a sine of ±15 mm at 1.5 Hz that lasts 3 s.",
    "Low speed: 1 mm/s for 3 s, on springs with dampers (the PID without its integral, for bandwidths of 2 to 120 Hz), and under \
     the controllers. The \
     paper does not say what pulls its axis.",
    "Stiffness of the bristles: 0.03 to 10 times that of the axis.",
    "From an encoder: steps of 50 nm as published, with noise of half a step before them; noise of 1 % of the static level on \
     the force. The paper does not say what its identification was given.",
];

/// The experiments, with as much searching as `budget` allows. The observer is told the number of steps done and
/// their total, and may stop the work: the experiments that are done by then are kept.
pub fn zhang_2025(budget: Budget, observer: &mut dyn Observer) -> Reproduction {
    /// Static map and its search, record of the dynamics and the search for sigma0 and sigma1, presliding, tracking,
    /// corner, crawl, stiffness, load.
    const EXPERIMENTS: usize = 10;
    /// Searches for each seed: all six with each method; three on what a drive records.
    const SEARCHES: usize = search::METHODS.len() + 3;
    let searches = SEARCHES * budget.seeds as usize;
    let watch = Watch::new(EXPERIMENTS + searches, observer);
    let mut paper = Paper {
        stage: Stage::ours().expect("the axis of the experiments"),
        statics: None,
        dynamics: None,
        measured: Vec::new(),
        presliding: None,
        law: None,
        tracked: Vec::new(),
        cornered: Vec::new(),
        crawled: Vec::new(),
        stiffnesses: Vec::new(),
        loads: Vec::new(),
    };
    let status = match experiments(&mut paper, budget, &watch) {
        Ok(()) => "complete",
        Err(Fault::Stopped) => "interrupted",
        Err(fault) => panic!("an experiment of the paper was refused: {fault}"),
    };
    let checks = paper.checks();
    Reproduction {
        file: ReproduceFile {
            status: status.into(),
            all_within: checks.iter().all(|c| c.within),
            checks,
            claims: paper.claims(),
            runs: paper.runs(),
            searches: paper.searches(),
            assumptions: ASSUMPTIONS.iter().copied().map(String::from).collect(),
            ..ReproduceFile::of("paper")
        },
        body: Body::Zhang2025(Box::new(paper)),
    }
}

fn experiments(paper: &mut Paper, budget: Budget, watch: &Watch) -> Result<(), Fault> {
    let stage = &paper.stage;
    let statics = paper.statics.insert(statics::run(stage, budget, watch)?);
    let dynamics = dynamics::run(stage, &statics.search.found, budget, watch)?;
    let identified = paper.dynamics.insert(dynamics).two.found.clone();
    paper.measured = measured::run(stage, statics, budget, watch)?;
    let law = *paper.law.insert(law(&identified)?);
    paper.presliding = Some(presliding::run(stage, &identified, watch)?);
    paper.tracked = tracking::run(stage, &law, watch)?;
    paper.cornered = corner::run(stage, &law, watch)?;
    paper.crawled = crawl::run(stage, &law, watch)?;
    paper.stiffnesses = stiffness::run(stage, &law, watch)?;
    paper.loads = load::run(stage, &law, watch)?;
    Ok(())
}
