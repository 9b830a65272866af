//! Results of the paper's experiments, and the numbers that are checked or set beside its claims.

use super::corner::Cornered;
use super::crawl::Crawled;
use super::delay::Delayed;
use super::dynamics::Dynamics;
use super::load::LoadFound;
use super::measured::Measured;
use super::presliding::Presliding;
use super::rest::Rested;
use super::search::{Searched, annealing};
use super::stage::Stage;
use super::statics::Statics;
use super::stiffness::Stiffness;
use super::tracking::Tracked;
use std::collections::BTreeMap;
use stiction_files::reproduce_file::{CheckEntry, SearchEntry};
use stiction_friction::LuGre;
use stiction_identify::candidates::Named;
use stiction_parameters::{Name, Quantity};
use stiction_policy::comparison;

/// The costs J at which searches are compared while they run: three thousandths and one of the force's mean square.
pub const REACHED: [f64; 2] = [3e-3, 1e-3];

/// Results of the experiments, as far as they were done.
#[derive(Clone, Debug)]
pub struct Paper {
    /// The axis that was simulated.
    pub stage: Stage,
    /// Static parameters from constant velocities.
    pub statics: Option<Statics>,
    /// Stiffness and micro-damping, and all six parameters at once.
    pub dynamics: Option<Dynamics>,
    /// The same from what a drive records: one entry for each draw of the noise.
    pub measured: Vec<Measured>,
    /// How far off encoder and noise allow each parameter to be then, as a part of its value.
    pub allowed: Named,
    /// A voltage step below break-away.
    pub presliding: Option<Presliding>,
    /// What could not be run, in words.
    pub not_run: Vec<String>,
    /// The law that all later experiments compensate with.
    pub law: Option<LuGre<f64>>,
    /// A sine under each controller with each compensation.
    pub tracked: Vec<Tracked>,
    /// The sine over the delay of the loop.
    pub delayed: Vec<Delayed>,
    /// A corner, likewise, with a stop and blended, each without and with coupling.
    pub cornered: Vec<Cornered>,
    /// Standstill after a move: without an integral, with it, under the cascade.
    pub rested: Vec<Rested>,
    /// A constant low velocity: springs, then controllers.
    pub crawled: Vec<Crawled>,
    /// The sine over the stiffness of the bristles.
    pub stiffnesses: Vec<Stiffness>,
    /// Loads found while running.
    pub loads: Vec<LoadFound>,
}

/// Names of what is identified, in the order of reports.
pub const PARAMETERS: [&str; 6] = [
    "sigma0",
    "sigma1",
    "sigma2",
    "coulomb",
    "static",
    "stribeck_velocity",
];

impl Paper {
    /// Nothing has been done yet on an axis.
    pub(super) fn of(stage: Stage) -> Self {
        Paper {
            stage,
            statics: None,
            dynamics: None,
            measured: Vec::new(),
            allowed: Named::new(),
            presliding: None,
            not_run: Vec::new(),
            law: None,
            tracked: Vec::new(),
            delayed: Vec::new(),
            cornered: Vec::new(),
            rested: Vec::new(),
            crawled: Vec::new(),
            stiffnesses: Vec::new(),
            loads: Vec::new(),
        }
    }

    pub(super) fn checks(&self) -> Vec<CheckEntry> {
        let mut checks = Vec::new();
        let (units, without) = (self.stage.units(), self.stage.without());
        let value = |all: &[(Name, f64)], name: &str| {
            let found = all.iter().find(|(n, _)| n == name);
            found.map_or(f64::NAN, |(_, x)| *x)
        };
        // Where encoder and noise allow no more, that; a part of the value.
        let noisy = |name: &str| comparison::MAX_PAPER_ERROR.max(value(&self.allowed, name));
        let exact = |_: &str| comparison::MAX_PAPER_ERROR;
        let mut parameters = |experiment: &str,
                              found: &[(Name, f64)],
                              names: &[&str],
                              allowed: &dyn Fn(&str) -> f64| {
            let asked = PARAMETERS.iter().filter(|n| names.contains(n));
            for name in asked.filter(|n| !without.contains(n)) {
                checks.push(CheckEntry::relative(
                    experiment,
                    name,
                    units.of_parameter(name),
                    self.stage.true_value(name),
                    value(found, name),
                    allowed(name),
                ));
            }
        };
        let dynamic = ["sigma0", "sigma1"];
        let steady = ["sigma2", "coulomb", "static", "stribeck_velocity"];
        let found = |searches: &[Searched]| self.worst(annealing(searches).map(|s| &s.found));
        if let Some(statics) = &self.statics {
            parameters("static", &found(&statics.searches), &steady, &exact);
            let robust = &statics.outliers.robust;
            parameters("outliers", robust, &steady, &exact);
        }
        if let Some(dynamics) = &self.dynamics {
            parameters("dynamic", &found(&dynamics.two), &dynamic, &exact);
            parameters("six", &found(&dynamics.six), &PARAMETERS, &exact);
        }
        if !self.measured.is_empty() {
            let draws = self.measured.iter();
            let statics = self.worst(draws.clone().map(|m| &m.statics.found));
            let two = self.worst(draws.map(|m| &m.two.found));
            parameters("measured", &statics, &steady, &noisy);
            parameters("measured", &two, &dynamic, &noisy);
        }
        if let Some(step) = &self.presliding {
            let [s0, s1] = step.fitted;
            let found = [(Quantity::Sigma0.into(), s0), (Quantity::Sigma1.into(), s1)];
            parameters("step", &found, &dynamic, &exact);
        }
        for load in &self.loads {
            let (reference, found) = (load.heavier, load.last());
            let tolerance = comparison::MAX_PAPER_MASS_ERROR;
            checks.push(CheckEntry::relative(
                "load", "mass", units.mass, reference, found, tolerance,
            ));
        }
        checks
    }

    /// Of several searches, the value of each parameter that is farthest from the true one.
    pub fn worst<'s>(&self, found: impl Iterator<Item = &'s Named>) -> Named {
        let mut worst: Named = Vec::new();
        for (name, value) in found.flatten() {
            let off = |x: f64| (x - self.stage.true_value(&name.to_string())).abs();
            match worst.iter_mut().find(|(n, _)| n == name) {
                Some((_, least)) if off(*value) > off(*least) => *least = *value,
                Some(_) => {}
                None => worst.push((*name, *value)),
            }
        }
        worst
    }

    /// Every search, for `reproduce.json`.
    pub(super) fn searches(&self) -> Vec<SearchEntry> {
        let statics = self.statics.iter().flat_map(|s| &s.searches);
        let statics = statics.map(|s| ("static", s));
        let dynamics = self.dynamics.iter().flat_map(|d| {
            let two = d.two.iter().map(|s| ("dynamic", s));
            two.chain(d.six.iter().map(|s| ("six", s)))
        });
        let measured = self.measured.iter().flat_map(|m| {
            [
                ("static, measured", &m.statics),
                ("dynamic, measured", &m.two),
                ("six, measured", &m.six),
            ]
        });
        let all = statics.chain(dynamics).chain(measured);
        all.map(|(experiment, search)| SearchEntry {
            experiment: experiment.into(),
            method: search.method.into(),
            seed: search.seed,
            cost: search.cost(),
            evaluations_to_3e3: search.evaluations_to(REACHED[0]),
            evaluations_to_1e3: search.evaluations_to(REACHED[1]),
            own: values(&search.own),
            found: values(&search.found),
        })
        .collect()
    }
}

/// Values by name.
fn values(parameters: &Named) -> BTreeMap<String, f64> {
    let named = parameters.iter();
    named.map(|(name, x)| (name.to_string(), *x)).collect()
}
