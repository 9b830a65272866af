//! Results of the paper's experiments, and the numbers that are checked or set beside its claims.

use super::corner::Cornered;
use super::dynamics::Dynamics;
use super::load::{HEAVIER, LoadFound};
use super::presliding::Presliding;
use super::search::Searched;
use super::stage::Stage;
use super::statics::Statics;
use super::tracking::Tracked;
use stiction_files::reproduce_file::CheckEntry;
use stiction_friction::LuGre;
use stiction_parameters::{Name, Quantity};

/// Largest relative error of a found parameter, dimensionless: what Liao et al. 2023 (doi 10.3390/s23042076), the work
/// closest to the paper, claim without noise.
const PARAMETER_TOLERANCE: f64 = 0.01;
/// The same for a mass found while running, dimensionless: it is found from a tenth of the record.
const MASS_TOLERANCE: f64 = 0.02;

/// Results of the experiments, as far as they were done.
#[derive(Clone, Debug)]
pub struct Paper {
    /// The axis that was simulated.
    pub stage: Stage,
    /// Static parameters from constant velocities.
    pub statics: Option<Statics>,
    /// Stiffness and micro-damping, and all six parameters at once.
    pub dynamics: Option<Dynamics>,
    /// A voltage step below break-away.
    pub presliding: Option<Presliding>,
    /// The law that all later experiments compensate with.
    pub law: Option<LuGre<f64>>,
    /// A sine under each controller with each compensation.
    pub tracked: Vec<Tracked>,
    /// A corner, likewise, without and with coupling.
    pub cornered: Vec<Cornered>,
    /// A load found while running.
    pub load: Option<LoadFound>,
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
        let law = &self.stage.truth.law;
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

    pub(super) fn checks(&self) -> Vec<CheckEntry> {
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
                    PARAMETER_TOLERANCE,
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
            let (reference, found) = (HEAVIER, load.last());
            let tolerance = MASS_TOLERANCE;
            checks.push(CheckEntry::relative(
                "load", "mass", "kg", reference, found, tolerance,
            ));
        }
        checks
    }
}

impl Dynamics {
    /// The annealing search of all six with the first seed.
    pub fn first_of_six(&self) -> Option<&Searched> {
        self.six.iter().find(|s| s.method == "annealing-ga")
    }
}
