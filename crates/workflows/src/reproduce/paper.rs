//! The experiments of Zhang et al. 2025 (Z25, doi 10.1371/journal.pone.0322844) on a simulated axis of ours.
//!
//! Of the paper only its words are at hand: what it gives no number for is assumed, and every assumption is listed in the
//! report. What is checked is whether the identification finds the axis that was simulated; the paper's claims stand
//! beside our figures without being the same experiment.

mod corner;
mod dynamics;
mod fault;
mod load;
mod presliding;
mod search;
mod stage;
mod statics;
mod tracking;

pub use corner::Cornered;
pub use dynamics::Dynamics;
pub use load::LoadFound;
pub use presliding::Presliding;
pub use search::Searched;
pub use statics::Statics;
pub use tracking::{Fed, Tracked};

use super::watch::Watch;
use super::{Body, Reproduction};
use fault::Fault;
use stiction_files::reproduce_file::{CheckEntry, ClaimEntry, ReproduceFile};
use stiction_friction::LuGre;
use stiction_identify::Control;
use stiction_identify::candidates::Named;
use stiction_parameters::{LawError, LawKind, Name, ParameterSet, Quantity};
use stiction_servo::known::KnownAxis;

/// How much searching is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Generations of a round, of 50 individuals each.
    pub generations: usize,
    /// Rounds of the annealing search; the others have as many generations in one.
    pub rounds: usize,
    /// Searches of all six parameters with each method.
    pub seeds: u64,
}

impl Default for Budget {
    /// 5 rounds of 100 generations, 5 seeds.
    fn default() -> Self {
        Budget {
            generations: 100,
            rounds: 5,
            seeds: 5,
        }
    }
}

/// What the experiments came to, as far as they were done.
#[derive(Clone, Debug)]
pub struct Paper {
    /// The axis that was simulated.
    pub truth: KnownAxis,
    /// Static parameters from constant velocities.
    pub statics: Option<Statics>,
    /// Stiffness and micro-damping, and all six parameters at once.
    pub dynamics: Option<Dynamics>,
    /// A voltage step below break-away.
    pub presliding: Option<Presliding>,
    /// The law that all later experiments compensate with.
    pub law: Option<LuGre<f64>>,
    /// A sine without and with compensation.
    pub tracked: Vec<Tracked>,
    /// A corner without and with compensation.
    pub cornered: Vec<Cornered>,
    /// A load found while running.
    pub load: Option<LoadFound>,
}

/// Part by which a found parameter may be off: what Liao et al. 2023 (doi 10.3390/s23042076), the closest relative of the
/// paper, claim without noise.
const TOLERANCE: f64 = 0.01;
/// The same of a mass found while running.
const LOAD_TOLERANCE: f64 = 0.02;

/// What is assumed where the paper gives no number, each with what is known.
const ASSUMPTIONS: [&str; 12] = [
    "Friction of the stage: σ₀ 2·10⁶ N/m, σ₁ 1500 N s/m (constant), σ₂ 30 N s/m, Fc 12 N, Fs 18 N, vs 3 mm/s. The \
     paper's table is an image that no text carries.",
    "172.8 N/V: 96 N/A are published, 1.8 A/V follow if 10 V are the 18 A of the drive's peak.",
    "Neither damper B nor spring K beside the friction, no disturbance force, no delay, no current loop of its own; a \
     thermal time of 10 s for the rated 221 N.",
    "Fuzzy PID: gains for a bandwidth of 60 Hz (45 Hz on the second axis), scales from the friction, gains within \
     30 % of them, velocity and acceleration fed forward. The paper gives no gains.",
    "Constant velocities: 16 from 0.2 to 100 mm/s in both directions, 0.3 s to settle and 0.3 s to average.",
    "Dynamic test: a sine of ±0.5 mm at 2 Hz, three cycles, with velocity and acceleration as the simulation has them.",
    "Voltage step: 20 mV (3.5 N, a fifth of the static level).",
    "Boxes of the searches: σ₀ 10⁴ to 10⁸ N/m, σ₁ 10 to 10⁵ N s/m, σ₂ 0.1 to 1000 N s/m, Fc and Fs − Fc 0.1 to 100 N, \
     vs 0.1 to 100 mm/s, in logarithms.",
    "Genetic searches: 50 individuals, 5 rounds of 100 generations (500 in one round for the others), crossover .6 to \
     .9, mutation .01 to .10, temperature 7, falling by .96 a generation.",
    "Tracked sine: ±20 mm at 0.5 Hz, 3.8 m/min at the most; its second cycle counts.",
    "Corner: 20 mm by 20 mm at 3 m/min, with a stop at the corner, 0.2 s to either side of which count; the second axis is a slide of 10 kg, σ₀ 1.2·10⁵ N/m, \
     Fc 20 N, Fs 30 N, whose parameters are known to its compensation.",
    "Change of load: from 4.6 to 6.9 kg after 2 s of a sine of ±15 mm at 1.5 Hz.",
];

/// The experiments with so much searching. `watch` is told how many steps of how many are done, and may stop the work: the
/// experiments that are done by then are kept.
pub fn zhang_2025(
    budget: Budget,
    watch: &mut (dyn FnMut(usize, usize) -> Control + Send),
) -> Reproduction {
    const EXPERIMENTS: usize = 8;
    let searches = search::METHODS.len() * budget.seeds as usize;
    let watch = Watch::new(EXPERIMENTS + searches, watch);
    let mut paper = Paper {
        truth: stage::truth().expect("the axis of the experiments"),
        statics: None,
        dynamics: None,
        presliding: None,
        law: None,
        tracked: Vec::new(),
        cornered: Vec::new(),
        load: None,
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
            assumptions: ASSUMPTIONS.map(String::from).into(),
            ..ReproduceFile::of("paper")
        },
        body: Body::Zhang2025(Box::new(paper)),
    }
}

fn experiments(paper: &mut Paper, budget: Budget, watch: &Watch) -> Result<(), Fault> {
    let statics = paper.statics.insert(statics::run(budget, watch)?);
    let dynamics = dynamics::run(&statics.search.found, budget, watch)?;
    let identified = paper.dynamics.insert(dynamics).two.found.clone();
    let law = *paper.law.insert(law(&identified)?);
    paper.presliding = Some(presliding::run(&identified, watch)?);
    paper.tracked = tracking::run(&law, watch)?;
    paper.cornered = corner::run(&law, watch)?;
    paper.load = Some(load::run(&law, watch)?);
    Ok(())
}

/// The law of identified parameters, sigma1 constant as in the paper.
fn law(parameters: &Named) -> Result<LuGre<f64>, LawError> {
    ParameterSet::of(LawKind::LuGre, parameters.iter().copied()).lugre()
}

/// Names and units of what is identified, in the order of reports.
pub const PARAMETERS: [(&str, &str); 6] = [
    ("sigma0", "N/m"),
    ("sigma1", "N*s/m"),
    ("sigma2", "N*s/m"),
    ("coulomb", "N"),
    ("static", "N"),
    ("stribeck_velocity", "m/s"),
];

impl Paper {
    /// The true value of a parameter, SI.
    pub fn true_value(&self, name: &str) -> f64 {
        let law = &self.truth.law;
        let side = law.curve().positive();
        match name {
            "sigma0" => law.stiffness(),
            "sigma1" => law.damping().at_rest(),
            "sigma2" => side.viscous,
            "coulomb" => side.coulomb,
            "static" => side.static_friction,
            _ => side.stribeck_velocity,
        }
    }

    fn checks(&self) -> Vec<CheckEntry> {
        let mut checks = Vec::new();
        let mut parameters = |experiment: &str, found: &[(Name, f64)], names: &[&str]| {
            for (name, unit) in PARAMETERS.iter().filter(|(n, _)| names.contains(n)) {
                let value = found.iter().find(|(n, _)| n == name);
                checks.push(CheckEntry::relative(
                    experiment,
                    name,
                    unit,
                    self.true_value(name),
                    value.map_or(f64::NAN, |(_, x)| *x),
                    TOLERANCE,
                ));
            }
        };
        let dynamic = ["sigma0", "sigma1"];
        let steady = ["sigma2", "coulomb", "static", "stribeck_velocity"];
        if let Some(statics) = &self.statics {
            parameters("static", &statics.search.found, &steady);
        }
        if let Some(dynamics) = &self.dynamics {
            parameters("dynamic", &dynamics.two.found, &dynamic);
            if let Some(six) = dynamics.first_of_six() {
                parameters("six", &six.found, &PARAMETERS.map(|(name, _)| name));
            }
        }
        if let Some(step) = &self.presliding {
            let [s0, s1] = step.fitted;
            let found = [(Quantity::Sigma0.into(), s0), (Quantity::Sigma1.into(), s1)];
            parameters("step", &found, &dynamic);
        }
        if let Some(load) = &self.load {
            let (reference, found) = (load::HEAVIER, load.last());
            let tolerance = LOAD_TOLERANCE;
            checks.push(CheckEntry::relative(
                "load", "mass", "kg", reference, found, tolerance,
            ));
        }
        checks
    }

    /// Our metrics, those that the paper has a claim for with the claim.
    fn claims(&self) -> Vec<ClaimEntry> {
        let mut claims = Vec::new();
        let speed = "feed error 2.8 to 2.3 m/min, 17.8 %";
        let corner = "up to 25.1 % at corners";
        type Metric = fn(&Tracked) -> f64;
        let metrics: [(&str, &str, &str, Metric); 4] = [
            ("largest speed error", "m/s", speed, |t| t.speed_peak),
            ("rms speed error", "m/s", "", |t| t.speed_rms),
            ("largest error at reversals", "m", "", |t| {
                t.position.reversal_peak
            }),
            ("rms position error", "m", "", |t| t.position.rms),
        ];
        for (name, unit, published, metric) in metrics {
            let values = self.tracked.iter().map(|t| (t.fed, metric(t)));
            claims.extend(beside(name, unit, published, values.collect()));
        }
        let contour = self.cornered.iter();
        let peaks = contour.clone().map(|c| (c.fed, c.contour.peak));
        let name = "largest contour error, corner";
        claims.extend(beside(name, "m", corner, peaks.collect()));
        let rms = contour.map(|c| (c.fed, c.contour.rms));
        let name = "rms contour error, corner";
        claims.extend(beside(name, "m", "", rms.collect()));
        claims
    }
}

impl Dynamics {
    /// The annealing search of all six with the first seed.
    pub fn first_of_six(&self) -> Option<&Searched> {
        self.six.iter().find(|s| s.method == "annealing-ga")
    }
}

/// What each compensation leaves of the first value, which is that without.
fn beside(name: &str, unit: &str, published: &str, values: Vec<(Fed, f64)>) -> Vec<ClaimEntry> {
    let Some(((_, without), with)) = values.split_first() else {
        return Vec::new();
    };
    let entry = |(fed, with): &(Fed, f64)| ClaimEntry {
        name: name.into(),
        unit: unit.into(),
        compensation: fed.name().into(),
        without: *without,
        with: *with,
        reduction_percent: 100.0 * (1.0 - with / without),
        published: published.into(),
    };
    with.iter().map(entry).collect()
}
