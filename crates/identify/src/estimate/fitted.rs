//! What any fit states of a law, whether it fitted the force, the position or points of the steady curve.

use crate::estimate::Series;
use crate::estimate::parameter::Parameter;
use crate::estimate::uncertainty::Covariance;
use crate::fit::Fit;
use crate::gms::choose::ElementsScore;
use crate::law::Law;
use crate::law::terms::Terms;
use crate::observe::Counts;
use crate::separable::levenberg::Status;

/// A fitted law: its parameters with their uncertainty, how well it fits, and how the search went.
#[derive(Clone, Debug)]
pub struct FittedLaw {
    /// The law.
    pub law: Law,
    /// The linear terms beside it.
    pub terms: Terms,
    /// Its parameters, in the order of tables.
    pub parameters: Vec<Parameter>,
    /// Covariance of the identified parameters.
    pub covariance: Covariance,
    /// Fit over all kept samples.
    pub fit: Fit,
    /// Fit over the kept samples slower than `low_speed_bound`.
    pub low_speed: Option<Fit>,
    /// That bound, m/s or rad/s.
    pub low_speed_bound: f64,
    /// Signals at the kept samples.
    pub series: Series,
    /// How the search ended.
    pub status: Status,
    /// Evaluations by kind.
    pub counts: Counts,
    /// Steps of all descents.
    pub iterations: usize,
    /// Evaluations and relative residual over the last descent.
    pub history: Vec<(usize, f64)>,
    /// The numbers of elements that were tried for a Maxwell-slip law; empty where it was given.
    pub elements: Vec<ElementsScore>,
}

impl FittedLaw {
    /// The parameter of this name.
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|p| p.name == name)
    }

    /// The value of this name.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.parameter(name).map(|p| p.value)
    }
}
